#pragma once
// How threads of equal work wait for one another.

#include <atomic>
#include <cstddef>
#include <thread>

namespace crossdem {

/// Waits by looking again and again: what threads wait for in a step comes sooner than one of them could wake up. A
/// thread that has looked for long lets others have its processor, should there be fewer of them than threads.
template <class Condition>
void wait_until(Condition condition) {
  constexpr std::size_t patience = 20000;  // some ten microseconds
  for (std::size_t looks = 0; !condition(); ++looks)
    if (looks > patience) std::this_thread::yield();
}

class SpinBarrier {
 public:
  explicit SpinBarrier(std::size_t threads) : threads_(threads), missing_(threads) {}

  /// Returns when every thread has come; what they wrote before can then be read.
  void arrive_and_wait() {
    const std::size_t round = round_.load(std::memory_order_relaxed);
    if (missing_.fetch_sub(1, std::memory_order_acq_rel) > 1) {
      wait_until([&] { return round_.load(std::memory_order_acquire) != round; });
      return;
    }
    missing_.store(threads_, std::memory_order_relaxed);
    round_.store(round + 1, std::memory_order_release);
  }

 private:
  std::size_t threads_;
  std::atomic<std::size_t> missing_;
  std::atomic<std::size_t> round_ = 0;
};

}  // namespace crossdem
