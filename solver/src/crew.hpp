#pragma once
// Threads of equal work: how they wait for one another, and help one of them.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace crossdem {

/// Waits by looking again and again: what threads wait for in a step comes sooner than one of them could wake up. A
/// thread that has looked for long lets others have its processor, should there be fewer of them than threads.
template <class Condition>
void wait_until(Condition condition) {
  constexpr std::size_t patience = 20000;  // some ten microseconds
  for (std::size_t looks = 0; !condition(); ++looks)
    if (looks > patience) std::this_thread::yield();
}

/// Part number `part` of `parts` of [0, count), as multiples of `unit` where they end before `count`.
inline std::pair<std::size_t, std::size_t> share(std::size_t count, std::size_t part, std::size_t parts,
                                                 std::size_t unit = 1) {
  const std::size_t units = (count + unit - 1) / unit;
  const auto end_of = [&](std::size_t number) { return std::min(units * number / parts * unit, count); };
  return {end_of(part), end_of(part + 1)};
}

class Crew {
 public:
  explicit Crew(std::size_t size = 1) : size_(size), missing_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Returns when every thread has come; what they wrote before can then be read.
  void wait_for_all() {
    const std::size_t round = round_.load(std::memory_order_relaxed);
    if (missing_.fetch_sub(1, std::memory_order_acq_rel) > 1) {
      wait_until([&] { return round_.load(std::memory_order_acquire) != round; });
      return;
    }
    missing_.store(size_, std::memory_order_relaxed);
    round_.store(round + 1, std::memory_order_release);
  }

  /// By the thread that leads, while all others serve(): task(number) for each number below size(), all at a time.
  /// Throws what a task has thrown, when all have ended.
  void each(std::function<void(std::size_t)> task) {
    task_ = std::move(task);
    wait_for_all();
    do_task(0);
    wait_for_all();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  /// By the thread that leads: ends the others' serve().
  void dismiss() {
    task_ = nullptr;
    wait_for_all();
  }

  void serve(std::size_t number) {
    for (wait_for_all(); task_; wait_for_all()) {
      do_task(number);
      wait_for_all();
    }
  }

 private:
  void do_task(std::size_t number) {
    try {
      task_(number);
    } catch (...) {
      const std::lock_guard lock(failing_);
      failure_ = std::current_exception();
    }
  }

  std::size_t size_;
  std::atomic<std::size_t> missing_;
  std::atomic<std::size_t> round_ = 0;
  std::function<void(std::size_t)> task_;
  std::mutex failing_;
  std::exception_ptr failure_;
};

}  // namespace crossdem
