// The way into the lock-step solver, compiled once for each instruction set: plain C, so that nothing of one unit is taken
// for another's.
#pragma once

/// plan: a tactr::LanePlan. phase: a tactr::LanePhase. numbers, memory and results: rows of count doubles,
/// aligned to 32 bytes; of memory there are memory_rows, which a device has for itself. Returns 0, or a device's error.
extern "C" {
using TactrLanesDoor = int (*)(const void* plan, int phase, long count, long memory_rows, const double* numbers, double* memory,
                               double* results);
int tactr_lanes_baseline(const void*, int, long, long, const double*, double*, double*);  // count: 4
int tactr_lanes_avx2(const void*, int, long, long, const double*, double*, double*);      // count: 4
int tactr_lanes_single(const void*, int, long, long, const double*, double*, double*);    // one by one, as on a device
}
