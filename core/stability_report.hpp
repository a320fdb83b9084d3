// What is known of a solution's stability.
#pragma once
#include <cmath>
#include <vector>

namespace tactr {

/// From base to tip. determinant: of D(s), scaled to 1 at the tip; conjugate: where D loses a rank, once for each rank.
struct StabilityReport {
    bool stable = true;
    double margin = 1.0;
    int conjugate_count = 0;
    std::vector<double> s, determinant, conjugate;
};

/// On a way of equilibria a conjugate point comes in at the base, where the determinant of d(base)/d(free end) passes zero (the
/// index grows with the length, Morse 1934): above least, and within a factor of where stability was proven, there is none yet.
inline bool is_still_stable(double determinant, double proven, double least, double factor) {
    const double ratio = determinant / proven;
    return std::fabs(determinant) > least && ratio > 1.0 / factor && ratio < factor;
}

}  // namespace tactr
