// Marks what runs on a graphics processor too.
#pragma once

#ifdef __CUDACC__
#define TACTR_ANY __host__ __device__
#else
#define TACTR_ANY
#endif
