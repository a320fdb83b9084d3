// The lock-step solver on a graphics processor: one configuration a thread, every number in a row of its own.
#include <cuda_runtime.h>

#include "lane_solver.hpp"
#include "lanes_door.hpp"

namespace tactr {

namespace {

constexpr int THREADS = 64;  // a block; each needs many registers

template <int N>
__global__ void solve_lanes_on_device(const LanePlan* plan, int phase, long count, const double* numbers, float* memory, double* results) {
    const long t = static_cast<long>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (t >= count) return;
    run_phase<double, N>(*plan, phase, 1, count, numbers + t, memory + t, results + t);
}

/// Memory on the device that grows as it is needed, one for each thread of the host.
class DeviceBuffer {
  public:
    ~DeviceBuffer() { cudaFree(data_); }

    cudaError_t fit(size_t bytes) {
        if (bytes <= size_) return cudaSuccess;
        cudaFree(data_);
        data_ = nullptr;
        size_ = 0;
        const cudaError_t error = cudaMalloc(&data_, bytes);
        if (error == cudaSuccess) size_ = bytes;
        return error;
    }
    template <class T>
    T* as() const { return static_cast<T*>(data_); }

  private:
    void* data_ = nullptr;
    size_t size_ = 0;
};

cudaError_t launch(const LanePlan& plan, int phase, long count, long memory_rows, const double* numbers, double* results) {
    thread_local DeviceBuffer on_plan, on_numbers, on_memory, on_results;
    const size_t wide = sizeof(double) * static_cast<size_t>(count);
    const size_t numbers_size = wide * plan.numbers, results_size = wide * LaneResults::ROWS;
    cudaError_t error = on_plan.fit(sizeof plan);
    if (error == cudaSuccess) error = on_numbers.fit(numbers_size);
    if (error == cudaSuccess) error = on_results.fit(results_size);
    if (error == cudaSuccess) error = on_memory.fit(sizeof(float) * static_cast<size_t>(count) * memory_rows);
    const auto send = [&error](void* to, const void* from, size_t size, cudaMemcpyKind kind) {
        if (error == cudaSuccess) error = cudaMemcpyAsync(to, from, size, kind, cudaStreamPerThread);
    };
    send(on_plan.as<void>(), &plan, sizeof plan, cudaMemcpyHostToDevice);
    send(on_numbers.as<void>(), numbers, numbers_size, cudaMemcpyHostToDevice);
    send(on_results.as<void>(), results, results_size, cudaMemcpyHostToDevice);
    if (error != cudaSuccess) return error;
    const auto run = plan.tubes == 1 ? solve_lanes_on_device<0> : plan.tubes == 2 ? solve_lanes_on_device<1>
                   : plan.tubes == 3 ? solve_lanes_on_device<2> : solve_lanes_on_device<3>;
    run<<<static_cast<unsigned>((count + THREADS - 1) / THREADS), THREADS, 0, cudaStreamPerThread>>>(
        on_plan.as<LanePlan>(), phase, count, on_numbers.as<double>(), on_memory.as<float>(), on_results.as<double>());
    error = cudaGetLastError();
    send(results, on_results.as<void>(), results_size, cudaMemcpyDeviceToHost);
    return error == cudaSuccess ? cudaStreamSynchronize(cudaStreamPerThread) : error;
}

}  // namespace

}  // namespace tactr

extern "C" {

int tactr_lanes_cuda(const void* plan, int phase, long count, long memory_rows, const double* numbers, float*, double* results) {
    return static_cast<int>(tactr::launch(*static_cast<const tactr::LanePlan*>(plan), phase, count, memory_rows, numbers, results));
}

/// Empty: there is a device. Otherwise what is wrong.
const char* tactr_cuda_trouble() {
    int devices = 0;
    const cudaError_t error = cudaGetDeviceCount(&devices);
    if (error != cudaSuccess) return cudaGetErrorString(error);
    return devices > 0 ? "" : "no device";
}

}  // extern "C"
