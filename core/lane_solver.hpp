// The phases of the solver for packs: single precision from cold to near a solution, double from there.
#pragma once
#include "lane_approach.hpp"
#include "lane_newton.hpp"
#include "rough_real.hpp"

namespace tactr {

/// How many configurations one R stands for, and what they are in single precision.
template <class R>
struct Precisions;
template <>
struct Precisions<double> {
    static constexpr int COUNT = 1;
    using Rough = RoughReal;
};

/// count: configurations, up to as many as go side by side in single precision; stride: from one row of theirs to the next.
template <class R, int N>
TACTR_ANY inline void run_phase(const LanePlan& plan, int phase, int count, long stride, const double* numbers, float* memory, double* results) {
    using Rough = typename Precisions<R>::Rough;
    if (phase != LANES_NEAR) {
        LaneApproach<Rough, N> approach(plan, LaneNumbers<Rough>{numbers, stride}, LaneStore<Rough>{memory, stride}, LaneOut<Rough>{results, stride});
        if (phase == LANES_BEGIN)
            approach.begin();
        else
            approach.run();
    }
    if (phase == LANES_BEGIN) return;
    for (int first = 0; first < count; first += Precisions<R>::COUNT) {
        LaneNewton<R, N> newton(plan, LaneNumbers<R>{numbers + first, stride}, LaneStore<R>{memory + first, stride},
                                LaneOut<R>{results + first, stride});
        newton.run(phase == LANES_FAR);
    }
}

}  // namespace tactr
