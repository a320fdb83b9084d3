// How rounds of friction are mixed, and where a way goes on to from what was found on it.
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "friction_settled.hpp"

namespace tactr {

constexpr double MOST_MIXED = 20.0;  // weight of a pair

/// Least-squares shares of the pairs in what was missed, newest pairs first; those that say nothing new have none.
inline std::vector<double> shares(const std::vector<RoundsPair>& pairs, std::vector<double> missed) {
    const size_t count = pairs.size();
    std::vector<std::vector<double>> q(count);
    std::vector<double> R(count * count, 0.0), share(count, 0.0);
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    };
    for (size_t c = 0; c < count; ++c) {
        q[c] = pairs[c].missed;
        const double size = std::sqrt(dot(q[c], q[c]));
        for (size_t r = 0; r < c; ++r) {
            R[r * count + c] = dot(q[r], q[c]);
            for (size_t i = 0; i < q[c].size(); ++i) q[c][i] -= R[r * count + c] * q[r][i];
        }
        const double left = std::sqrt(dot(q[c], q[c]));
        const bool new_one = left > 1e-6 * size;
        R[c * count + c] = new_one ? left : 0.0;
        for (double& x : q[c]) x = new_one ? x / left : 0.0;
    }
    for (size_t c = count; c-- > 0;) {
        if (R[c * count + c] == 0.0) continue;
        double sum = dot(q[c], missed);
        for (size_t d = c + 1; d < count; ++d) sum -= R[c * count + d] * share[d];
        share[c] = sum / R[c * count + c];
    }
    for (double s : share)
        if (!(std::fabs(s) < MOST_MIXED)) return std::vector<double>(count, 0.0);
    return share;
}

/// Where those of the past are on the straight way from one place, at 0, to another, at 1, as far back as they lie on it; none
/// where the last step was much shorter than this one.
inline std::vector<double> places_before(const std::vector<double>& from, const std::vector<double>& to,
                                  const std::vector<const FrictionSettled*>& past) {
    std::vector<double> places;
    double length = 0.0;
    for (size_t i = 0; i < from.size(); ++i) length += (to[i] - from[i]) * (to[i] - from[i]);
    for (const FrictionSettled* settled : past) {
        double along = 0.0, square = 0.0;
        for (size_t i = 0; i < from.size(); ++i) {
            const double back = from[i] - settled->at[i];
            along += back * (to[i] - from[i]);
            square += back * back;
        }
        if (along <= 0.0 || along * along <= 0.999 * square * length || (places.empty() && length >= 4.0 * square)) break;
        places.push_back(-along / length);
    }
    return places;
}

/// Shares at place 1 of what was found at places 0 and before: the polynomial through them.
inline std::vector<double> carrying_on(std::vector<double> places) {
    places.insert(places.begin(), 0.0);
    std::vector<double> share(places.size(), 1.0);
    for (size_t k = 0; k < places.size(); ++k)
        for (size_t j = 0; j < places.size(); ++j)
            if (j != k) share[k] *= (1.0 - places[j]) / (places[k] - places[j]);
    return share;
}

inline std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> out(a.size());
    for (size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
    return out;
}

}  // namespace tactr
