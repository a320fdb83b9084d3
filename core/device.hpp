// Marks what runs on a graphics processor too; apart: not copied there into every place that calls it, which would take
// its compiler very long.
#pragma once

#ifdef __CUDACC__
#define TACTR_ANY __host__ __device__
#define TACTR_APART __host__ __device__ __noinline__
#else
#define TACTR_ANY
#define TACTR_APART
#endif
