// The way into the lock-step solver, compiled once for each instruction set: plain C, so that nothing of one unit is taken
// for another's.
#pragma once

#define TACTR_LANES_SIDE_BY_SIDE 8

/// plan: a tactr::LanePlan. phase: a tactr::LanePhase. numbers, memory and results: rows of count numbers, or, side by side,
/// of 8, of which the first count are wanted; of memory there are memory_rows, which a device has for itself. Returns 0, or
/// a device's error.
extern "C" {
using TactrLanesDoor = int (*)(const void* plan, int phase, long count, long memory_rows, const double* numbers, float* memory,
                               double* results);
int tactr_lanes_baseline(const void*, int, long, long, const double*, float*, double*);
int tactr_lanes_avx2(const void*, int, long, long, const double*, float*, double*);
int tactr_lanes_single(const void*, int, long, long, const double*, float*, double*);  // one by one, as on a device
}
