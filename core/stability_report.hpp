// What is known of a solution's stability.
#pragma once
#include <vector>

namespace tactr {

/// From base to tip. determinant: of D(s), scaled to 1 at the tip; conjugate: where D loses a rank, once for each rank.
struct StabilityReport {
    bool stable = true;
    double margin = 1.0;
    int conjugate_count = 0;
    std::vector<double> s, determinant, conjugate;
};

}  // namespace tactr
