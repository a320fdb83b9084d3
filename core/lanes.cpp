// Compiled twice: for any processor, and, with another name for all that is in it, for those with AVX2.
#ifdef TACTR_LANES_AVX2
#define tactr tactr_avx2
#endif
#include "lane_newton.hpp"
#include "lanes_door.hpp"
#include "pack.hpp"

namespace tactr {

template <class R, int N>
void run_lanes(const LanePlan& plan, int phase, long stride, const double* numbers, double* memory, double* results) {
    const LaneRows<const R> in{reinterpret_cast<const R*>(numbers), stride};
    LaneNewton<R, N> newton(plan, in, LaneRows<R>{reinterpret_cast<R*>(memory), stride}, LaneRows<R>{reinterpret_cast<R*>(results), stride});
    newton.go(phase);
}

template <class R>
int choose_lanes(const void* given, int phase, long stride, const double* numbers, double* memory, double* results) {
    const LanePlan& plan = *static_cast<const LanePlan*>(given);
    switch (plan.tubes) {
        case 1: run_lanes<R, 0>(plan, phase, stride, numbers, memory, results); break;
        case 2: run_lanes<R, 1>(plan, phase, stride, numbers, memory, results); break;
        case 3: run_lanes<R, 2>(plan, phase, stride, numbers, memory, results); break;
        default: run_lanes<R, 3>(plan, phase, stride, numbers, memory, results);
    }
    return 0;
}

}  // namespace tactr

#ifdef TACTR_LANES_AVX2
int tactr_lanes_avx2(const void* plan, int phase, long, long, const double* numbers, double* memory, double* results) {
    return tactr::choose_lanes<tactr::Pack>(plan, phase, 1, numbers, memory, results);
}
#else
int tactr_lanes_baseline(const void* plan, int phase, long, long, const double* numbers, double* memory, double* results) {
    return tactr::choose_lanes<tactr::Pack>(plan, phase, 1, numbers, memory, results);
}

int tactr_lanes_single(const void* plan, int phase, long count, long, const double* numbers, double* memory, double* results) {
    for (long t = 0; t < count; ++t) tactr::choose_lanes<double>(plan, phase, count, numbers + t, memory + t, results + t);
    return 0;
}
#endif
