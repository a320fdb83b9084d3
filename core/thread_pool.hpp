// Work in fixed chunks on several threads; the calling thread only watches.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tactr {

/// Calls work(begin, end) for every chunk of [0, count), on as many threads as asked for. poll is called by the calling
/// thread some times a second; false stops the work after the chunks under way. Exceptions of the work come out here.
inline void in_chunks(std::size_t count, std::size_t chunk, int threads, const std::function<void(std::size_t, std::size_t)>& work,
                      const std::function<bool()>& poll) {
    constexpr auto WATCH = std::chrono::milliseconds(50);
    const std::size_t chunks = (count + chunk - 1) / chunk;
    const std::size_t workers = std::min(chunks, static_cast<std::size_t>(std::max(threads, 1)));
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::condition_variable done;
    std::size_t running = workers;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (std::size_t c = next++; c < chunks; c = next++) work(c * chunk, std::min(count, (c + 1) * chunk));
        } catch (...) {
            next = chunks;
            const std::lock_guard<std::mutex> lock(mutex);
            failure = std::current_exception();
        }
        const std::lock_guard<std::mutex> lock(mutex);
        --running;
        done.notify_one();
    };
    std::vector<std::thread> pool;
    for (std::size_t w = 0; w < workers; ++w) pool.emplace_back(run);
    {
        std::unique_lock<std::mutex> lock(mutex);
        while (running > 0) {
            if (done.wait_for(lock, WATCH, [&] { return running == 0; })) break;
            lock.unlock();
            if (!poll()) next = chunks;
            lock.lock();
        }
    }
    for (std::thread& thread : pool) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace tactr
