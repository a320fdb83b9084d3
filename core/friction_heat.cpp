#include "friction_settled.hpp"

#include <cmath>
#include <cstddef>

namespace tactr {

namespace {

/// Falls of the tension: along every panel at its points, N/m, and at its proximal edge, N.
struct Falls {
    std::vector<PointValues> along;
    std::vector<double> at_edges;

    Falls(const std::optional<FrictionProfile>& profile, const std::vector<double>& edges)
        : along(edges.size() - 1, PointValues{}), at_edges(edges.size() - 1, 0.0) {
        double before = 0.0;
        for (size_t k = 0; k < along.size() && profile; ++k) {
            const double start = edges[k], end = edges[k + 1];
            const int piece = profile->log.piece(0.5 * (start + end));
            if (profile->log.is_even(piece)) {
                const double even = std::exp(profile->log.coefficients[piece][0]);
                if (k > 0) at_edges[k] = before - even;
                before = even;
                continue;
            }
            PointValues tension = profile->log.on(piece, points_between(start, end));
            for (double& x : tension) x = std::exp(x);
            along[k] = ChebyshevRules::times(ChebyshevRules::get().slope, tension);
            for (double& x : along[k]) x *= -2.0 / (end - start);
            if (k > 0) at_edges[k] = before - std::exp(profile->log.on(piece, start));
            before = std::exp(profile->log.on(piece, end));
        }
    }
};

double rubbing(double before, double after) { return before * after > 0.0 ? 0.5 * (before + after) : after; }

Curve rate_curve(const Wrap& wrap) {
    Curve out{wrap.rise.edges, {}};
    for (const PointValues& values : wrap.rate) out.coefficients.push_back(ChebyshevRules::times(ChebyshevRules::get().fit, values));
    return out;
}

}  // namespace

void friction_heat(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const FrictionSettled& after,
                   std::vector<double>& heat, std::vector<double>& creep) {
    const ChebyshevRules& rules = ChebyshevRules::get();
    heat.assign(channels.size(), 0.0);
    creep.assign(channels.size(), 0.0);
    for (size_t c = 0; c < channels.size(); ++c) {
        std::vector<double> all{0.0, channels[c].end};
        for (const FrictionSettled* settled : {&before, &after}) {
            if (settled->profiles[c]) add_inner(settled->profiles[c]->log.edges, channels[c].end, all);
            add_inner(settled->wraps[c].rise.edges, channels[c].end, all);
        }
        const std::vector<double> edges = merged(all);
        const Curve rates[2] = {rate_curve(before.wraps[c]), rate_curve(after.wraps[c])};
        const Falls falls[2] = {{before.profiles[c], edges}, {after.profiles[c], edges}};
        double beyond = 0.0;  // how much shorter the path is from the panel's distal end on
        for (size_t k = edges.size() - 1; k-- > 0;) {
            const double half = 0.5 * (edges[k + 1] - edges[k]), middle = edges[k] + half;
            const PointValues places = points_between(edges[k], edges[k + 1]);
            const int pieces[2] = {rates[0].piece(middle), rates[1].piece(middle)};
            PointValues shorter = rates[0].on(pieces[0], places);
            const PointValues now = rates[1].on(pieces[1], places);
            double whole = 0.0, along = 0.0;
            for (int p = 0; p < CURVE_POINTS; ++p) {
                shorter[p] -= now[p];
                whole += rules.weight[p] * shorter[p] * half;
            }
            beyond += whole;
            const PointValues inside = ChebyshevRules::times(rules.upto, shorter);
            for (int p = 0; p < CURVE_POINTS; ++p)
                along += rules.weight[p] * rubbing(falls[0].along[k][p], falls[1].along[k][p]) * (beyond - inside[p] * half);
            heat[c] += along * half + rubbing(falls[0].at_edges[k], falls[1].at_edges[k]) * beyond;
            const auto& profile = after.profiles[c];
            if (profile && profile->slides[profile->log.piece(edges[k] + 1e-10)] == 0) creep[c] = larger(creep[c], std::fabs(beyond));
        }
    }
}

}  // namespace tactr
