// Work in chunks on several threads; the calling thread only watches.
#pragma once
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tactr {

/// Chunks of [0, count), one after the other: large first, then smaller, so that no thread is left with a large one at last.
class Chunks {
  public:
    Chunks(std::size_t count, std::size_t least, std::size_t most, std::size_t workers)
        : count_(count), least_(least), most_(most), workers_(workers) {}

    /// False: there is none left.
    bool take(std::size_t& begin, std::size_t& end) {
        const std::lock_guard<std::mutex> lock(mutex_);
        begin = next_;
        end = next_ = std::min(count_, begin + std::clamp((count_ - begin) / (2 * workers_), least_, most_));
        return begin < end;
    }

    void stop() {
        const std::lock_guard<std::mutex> lock(mutex_);
        next_ = count_;
    }

  private:
    const std::size_t count_, least_, most_, workers_;
    std::size_t next_ = 0;
    std::mutex mutex_;
};

/// Calls work(begin, end) for chunks of [0, count), on as many threads as asked for. poll is called by the calling
/// thread some times a second; false stops the work after the chunks under way. Exceptions of the work come out here.
inline void in_chunks(std::size_t count, std::size_t least, std::size_t most, int threads,
                      const std::function<void(std::size_t, std::size_t)>& work, const std::function<bool()>& poll) {
    constexpr auto WATCH = std::chrono::milliseconds(50);
    const std::size_t workers = std::min((count + least - 1) / least, static_cast<std::size_t>(std::max(threads, 1)));
    Chunks chunks(count, least, most, workers);
    std::mutex mutex;
    std::condition_variable done;
    std::size_t running = workers;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (std::size_t begin, end; chunks.take(begin, end);) work(begin, end);
        } catch (...) {
            chunks.stop();
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
            if (!poll()) chunks.stop();
            lock.lock();
        }
    }
    for (std::thread& thread : pool) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace tactr
