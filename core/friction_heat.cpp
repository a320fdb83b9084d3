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

/// By how much the path beyond a place gets shorter in a step: where the tendon begins to slide in it, and elsewhere.
struct Slip {
    double begun = 0.0, even = 0.0;

    double& share(bool begins) { return begins ? begun : even; }
};

/// At a place where the tension falls so.
double loss(double before, double after, const Slip& slip) {
    const double mean = 0.5 * (before + after);
    return (before * after > 0.0 ? mean : after) * slip.begun + mean * slip.even;
}

int slides_at(const std::optional<FrictionProfile>& profile, double sigma) {
    return profile ? profile->slides[profile->log.piece(sigma)] : 0;
}

Curve rate_curve(const Wrap& wrap) {
    Curve out{wrap.rise.edges, {}};
    for (const PointValues& values : wrap.rate) out.coefficients.push_back(ChebyshevRules::times(ChebyshevRules::get().fit, values));
    return out;
}

/// The rate of a wrap, and as a curve, at the points between two places of one of its panels.
PointValues rates_between(const Wrap& wrap, const Curve& curve, double start, double end) {
    const int k = curve.piece(0.5 * (start + end));
    if (start == curve.edges[k] && end == curve.edges[k + 1]) return wrap.rate[k];
    return curve.on(k, points_between(start, end));
}

}  // namespace

void friction_heat(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const FrictionSettled& after,
                   std::vector<double>& heat) {
    const ChebyshevRules& rules = ChebyshevRules::get();
    heat.assign(channels.size(), 0.0);
    for (size_t c = 0; c < channels.size(); ++c) {
        std::vector<double> all{0.0, channels[c].end};
        for (const FrictionSettled* settled : {&before, &after}) {
            if (settled->profiles[c]) add_inner(settled->profiles[c]->log.edges, channels[c].end, all);
            add_inner(settled->wraps[c].rise.edges, channels[c].end, all);
        }
        const std::vector<double> edges = merged(all);
        const Curve rates[2] = {rate_curve(before.wraps[c]), rate_curve(after.wraps[c])};
        const Falls falls[2] = {{before.profiles[c], edges}, {after.profiles[c], edges}};
        Slip beyond;  // from the panel's distal end on, then from its proximal end
        for (size_t k = edges.size() - 1; k-- > 0;) {
            const double half = 0.5 * (edges[k + 1] - edges[k]), middle = edges[k] + half;
            const int way = slides_at(after.profiles[c], middle);
            const bool begins = way != 0 && way != slides_at(before.profiles[c], middle);
            PointValues shorter = rates_between(before.wraps[c], rates[0], edges[k], edges[k + 1]);
            const PointValues now = rates_between(after.wraps[c], rates[1], edges[k], edges[k + 1]);
            double whole = 0.0, along = 0.0;
            for (int p = 0; p < CURVE_POINTS; ++p) {
                shorter[p] -= now[p];
                whole += rules.weight[p] * shorter[p] * half;
            }
            beyond.share(begins) += whole;
            const PointValues inside = ChebyshevRules::times(rules.upto, shorter);
            for (int p = 0; p < CURVE_POINTS; ++p) {
                Slip slip = beyond;
                slip.share(begins) -= inside[p] * half;
                along += rules.weight[p] * loss(falls[0].along[k][p], falls[1].along[k][p], slip);
            }
            heat[c] += along * half + loss(falls[0].at_edges[k], falls[1].at_edges[k], beyond);
        }
    }
}

}  // namespace tactr
