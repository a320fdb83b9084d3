#include "friction_history.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactr {

namespace {

constexpr int LOOKS = FrictionHistory::LOOKS, PARTS = 8;
using Course = FrictionHistory::Course;

void sizes_between(const double (&a)[3][LOOKS], const double (&b)[3][LOOKS], double part, double (&out)[LOOKS]) {
    for (int i = 0; i < LOOKS; ++i) {
        const double x = a[0][i] + part * (b[0][i] - a[0][i]), y = a[1][i] + part * (b[1][i] - a[1][i]), z = a[2][i] + part * (b[2][i] - a[2][i]);
        out[i] = std::sqrt(x * x + y * y + z * z);
    }
}

/// By how much log tension may fall or rise from the place before, at a part of the way.
void cone_between(const Course& before, const Course& after, double part, double spacing, double (&out)[LOOKS]) {
    double bend[LOOKS];
    sizes_between(before.bend, after.bend, part, bend);
    if (before.kinked || after.kinked) sizes_between(before.kink, after.kink, part, out);
    else std::fill(out, out + LOOKS, 0.0);
    for (int i = 1; i < LOOKS; ++i) out[i] += 0.5 * (bend[i - 1] + bend[i]) * spacing;
}

/// y onto the cone, from the base on.
void move_on(const double (&cone)[LOOKS], double base, double (&y)[LOOKS]) {
    for (int i = 0; i < LOOKS; ++i) base = y[i] = smaller(larger(y[i], base - cone[i]), base + cone[i]);
}

void fit_bend(const Wrap& wrap, int k, std::array<PointValues, 3>& c) {
    for (int a = 0; a < 3; ++a) {
        PointValues values;
        for (int p = 0; p < CURVE_POINTS; ++p) values[p] = wrap.bend[k][p][a];
        c[a] = ChebyshevRules::times(ChebyshevRules::get().fit, values);
    }
}

}  // namespace

FrictionHistory::Course::Course(const Wrap& wrap) : bend{}, kink{} {
    const auto& edges = wrap.rise.edges;
    const double end = edges.back();
    int fitted = -1;
    std::array<PointValues, 3> c;
    for (int i = 0; i < LOOKS && !wrap.straight; ++i) {
        const double sigma = end * i / (LOOKS - 1);
        const int k = wrap.rise.piece(sigma);
        if (k != fitted) fit_bend(wrap, fitted = k, c);
        const double x = (2.0 * sigma - (edges[k] + edges[k + 1])) / (edges[k + 1] - edges[k]);
        for (int a = 0; a < 3; ++a) bend[a][i] = chebyshev_at(c[a], x);
    }
    for (size_t k = 0; k < edges.size(); ++k) {
        if (!(wrap.jumps[k] > 0.0)) continue;
        const int i = std::min(LOOKS - 1, static_cast<int>(std::ceil(edges[k] / end * (LOOKS - 1) - 1e-9)));  // not before the edge
        for (int a = 0; a < 3; ++a) kink[a][i] += wrap.kinks[k][a];
        kinked = true;
    }
}

FrictionHistory::FrictionHistory(const std::vector<FrictionChannel>& channels, const FrictionSettled& before)
    : channels_(channels), tension_(before.solution.tension) {
    for (size_t c = 0; c < channels.size(); ++c) {
        const auto& profile = before.profiles[c];
        const double end = channels[c].end;
        Start start{Course(before.wraps[c]), {}};
        for (int i = 0; i < LOOKS; ++i)
            start.y[i] = profile ? profile->log.at(smaller(end * i / (LOOKS - 1), end - 1e-12)) : NO_TENSION;
        starts_.push_back(start);
    }
}

double FrictionHistory::missed(const std::vector<Wrap>& wraps, const std::vector<double>& tension) const {
    double worst = 0.0;
    for (size_t c = 0; c < channels_.size(); ++c) {
        const int j = channels_[c].tendon;
        if (tension[j] > 0.0) worst = larger(worst, missed_by(starts_[c], Course(wraps[c]), channels_[c].end, tension_[j], tension[j]));
    }
    return worst;
}

double FrictionHistory::missed_by(const Start& start, const Course& after, double end, double from, double to) {
    double slowly[LOOKS], at_once[LOOKS], cone[LOOKS], worst = 0.0;
    std::copy(start.y, start.y + LOOKS, slowly);
    std::copy(start.y, start.y + LOOKS, at_once);
    for (int k = 1; k <= PARTS; ++k) {
        const double part = static_cast<double>(k) / PARTS, base = std::log(larger((1.0 - part) * from + part * to, 1e-300));
        cone_between(start.course, after, part, end / (LOOKS - 1), cone);
        move_on(cone, base, slowly);
        if (k == PARTS) move_on(cone, base, at_once);
    }
    for (int i = 0; i < LOOKS; ++i) worst = larger(worst, std::fabs(slowly[i] - at_once[i]));
    return worst;
}

}  // namespace tactr
