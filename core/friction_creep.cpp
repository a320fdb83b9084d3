#include <cmath>
#include <cstddef>

#include "friction_settled.hpp"

namespace tactr {

namespace {

constexpr int EVENLY = 32;  // places along a channel

/// Of the path from every place (ascending) to the tendon's end, m.
std::vector<double> lengths_beyond(const Wrap& wrap, const std::vector<double>& places) {
    const ChebyshevRules& rules = ChebyshevRules::get();
    std::vector<double> out(places.size());
    double beyond = 0.0;  // from the panel's proximal end on
    size_t last = places.size();
    for (size_t k = wrap.rate.size(); k-- > 0;) {
        const double start = wrap.rise.edges[k], half = 0.5 * (wrap.rise.edges[k + 1] - start);
        for (int p = 0; p < CURVE_POINTS; ++p) beyond += rules.weight[p] * wrap.rate[k][p] * half;
        size_t first = last;
        while (first > 0 && (k == 0 || places[first - 1] >= start - EDGE_GAP)) --first;
        size_t inside = first;
        if (inside < last && places[inside] <= start + EDGE_GAP) out[inside++] = beyond;
        if (inside < last) {
            const PointValues upto = ChebyshevRules::times(rules.integral, wrap.rate[k]);
            for (size_t i = inside; i < last; ++i) out[i] = (places[i] - start) / half - 1.0;
            chebyshev_at(upto, &out[inside], last - inside, &out[inside]);
        }
        for (; inside < last; ++inside) out[inside] = beyond - half * out[inside];
        last = first;
    }
    return out;
}

}  // namespace

std::vector<double> watched_places(const FrictionChannel& channel) {
    std::vector<double> all = channel.contacts, out;
    for (int i = 0; i < EVENLY && !channel.over_disks; ++i) all.push_back(channel.end * i / EVENLY);
    for (double place : all)
        if (channel.coefficient(place) > 0.0) out.push_back(place);
    return out;
}

void friction_creep(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, FrictionSettled& after,
                    std::vector<double>& creep) {
    const bool begins = before.length_when_slid.size() != channels.size();
    after.length_when_slid.resize(channels.size());
    creep.assign(channels.size(), 0.0);
    for (size_t c = 0; c < channels.size(); ++c) {
        const std::vector<double>& places = channels[c].watched;
        const std::vector<double> now = lengths_beyond(after.wraps[c], places);
        std::vector<double>& then = after.length_when_slid[c];
        then = begins ? lengths_beyond(before.wraps[c], places) : before.length_when_slid[c];
        const auto& profile = after.profiles[c];
        size_t piece = 0;
        for (size_t i = 0; i < places.size(); ++i) {
            while (profile && piece + 1 < profile->slides.size() && profile->log.edges[piece + 1] <= places[i] + EDGE_GAP) ++piece;
            if (!profile || profile->slides[piece] != 0) then[i] = now[i];
            else creep[c] = larger(creep[c], std::fabs(then[i] - now[i]));
        }
    }
}

}  // namespace tactr
