// Compiled for every set of instructions, each time with another name for the namespace (CMakeLists.txt).
#include "lane_solver.hpp"
#include "lanes_door.hpp"
#include "pack.hpp"

namespace tactr {

template <>
struct Precisions<Pack> {
    static constexpr int COUNT = Pack::COUNT;
    using Rough = RoughPack;
};

template <class R>
void choose_phase(const void* given, int phase, long count, long stride, const double* numbers, float* memory, double* results) {
    const LanePlan& plan = *static_cast<const LanePlan*>(given);
    const auto run = plan.tubes == 1 ? run_phase<R, 0> : plan.tubes == 2 ? run_phase<R, 1> : plan.tubes == 3 ? run_phase<R, 2> : run_phase<R, 3>;
    run(plan, phase, static_cast<int>(count), stride, numbers, memory, results);
}

}  // namespace tactr

#ifdef TACTR_LANES_AVX2
int tactr_lanes_avx2(const void* plan, int phase, long count, long, const double* numbers, float* memory, double* results) {
    tactr::choose_phase<tactr::Pack>(plan, phase, count, TACTR_LANES_SIDE_BY_SIDE, numbers, memory, results);
    return 0;
}
#else
int tactr_lanes_baseline(const void* plan, int phase, long count, long, const double* numbers, float* memory, double* results) {
    tactr::choose_phase<tactr::Pack>(plan, phase, count, TACTR_LANES_SIDE_BY_SIDE, numbers, memory, results);
    return 0;
}

int tactr_lanes_single(const void* plan, int phase, long count, long, const double* numbers, float* memory, double* results) {
    for (long t = 0; t < count; ++t) tactr::choose_phase<double>(plan, phase, 1, count, numbers + t, memory + t, results + t);
    return 0;
}
#endif
