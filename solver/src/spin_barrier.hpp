#pragma once
// Where threads of equal work wait for one another.

#include <atomic>
#include <cstddef>
#include <thread>

namespace crossdem {

/// Waits by looking again and again: steps of a large bed are thousands of times shorter than a thread takes to wake
/// up. A thread that has looked for long lets others have its processor, should there be fewer of them than threads.
class SpinBarrier {
 public:
  explicit SpinBarrier(std::size_t threads) : threads_(threads), missing_(threads) {}

  /// Returns when every thread has come; what they wrote before can then be read.
  void arrive_and_wait() {
    const std::size_t round = round_.load(std::memory_order_relaxed);
    if (missing_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
      missing_.store(threads_, std::memory_order_relaxed);
      round_.store(round + 1, std::memory_order_release);
      return;
    }
    for (std::size_t looks = 0; round_.load(std::memory_order_acquire) == round; ++looks)
      if (looks > patience) std::this_thread::yield();
  }

 private:
  static constexpr std::size_t patience = 20000;  // some ten microseconds

  std::size_t threads_;
  std::atomic<std::size_t> missing_;
  std::atomic<std::size_t> round_ = 0;
};

}  // namespace crossdem
