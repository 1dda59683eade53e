// How long computations are stopped: they poll, and the check of whoever called them throws to end them.
//
// Not for kernels: it uses the standard library. Loops over kernels poll between two calls.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "cspace/math/isa.hpp"

namespace cspace {

// Called every few milliseconds by the thread that a long computation began on; throws to end it.
using InterruptCheck = void (*)();

// Thrown in helper threads that are to stop.
struct Stopped {};

namespace interrupts {

using Clock = std::chrono::steady_clock;
inline std::atomic<InterruptCheck> check = nullptr;
inline thread_local const std::atomic<bool>* stop_of_helper = nullptr;  // null on a caller's own thread
inline constexpr Clock::duration least_period = std::chrono::milliseconds(2);
inline thread_local Clock::time_point next_check;
inline thread_local Clock::duration period = least_period;  // between two checks

}  // namespace interrupts

// Null: nothing is called.
inline void set_interrupt_check(InterruptCheck check) { interrupts::check = check; }

// Takes some ten nanoseconds, but every few milliseconds. Checks that take long again and again, because
// others hold what they need, are made less and less often.
CSPACE_COLD inline void poll_interrupts() {
    constexpr interrupts::Clock::duration longest = std::chrono::milliseconds(32);
    constexpr int least_share = 8;  // of the time between two checks to that of one
    if (interrupts::stop_of_helper) {
        if (*interrupts::stop_of_helper) throw Stopped();
        return;
    }
    const InterruptCheck check = interrupts::check.load(std::memory_order_relaxed);
    if (!check) return;
    const auto begin = interrupts::Clock::now();
    if (begin < interrupts::next_check) return;
    check();
    const auto end = interrupts::Clock::now();
    auto& period = interrupts::period;
    period = least_share * (end - begin) > period ? std::min(2 * period, longest)
                                                  : std::max(period / 2, interrupts::least_period);
    interrupts::next_check = end + period;
}

// Polls in a loop: every so many steps, which take some ten microseconds.
class InterruptPoll {
  public:
    explicit InterruptPoll(std::uint32_t stride) : stride_(stride), left_(stride) {}
    CSPACE_INLINE void step() {
        if (--left_ == 0) [[unlikely]] {
            left_ = stride_;
            poll_interrupts();
        }
    }

  private:
    std::uint32_t stride_, left_;
};

// Calls visit(begin) … visit(end − 1), and polls between some thousands of them.
template <class Visit>
CSPACE_INLINE void visit_range(std::size_t begin, std::size_t end, const Visit& visit) {
    constexpr std::size_t part = 4096;
    while (begin < end) {
        const std::size_t stop = std::min(end, begin + part);
        for (; begin < stop; ++begin) visit(begin);
        if (begin < end) poll_interrupts();
    }
}

// Sorts, and polls between some thousands of comparisons.
template <class T, class Less = std::less<>>
void sort_polled(std::vector<T>& values, const Less& less = {}) {
    InterruptPoll poll(1 << 12);
    std::sort(values.begin(), values.end(), [&](const T& x, const T& y) {
        poll.step();
        return less(x, y);
    });
}

// A long vector of equal numbers: new pages of memory take long.
template <class T>
std::vector<T> filled_vector(std::size_t size, const T& value = {}) {
    constexpr std::size_t part = (std::size_t(1) << 20) / sizeof(T);
    std::vector<T> made;
    made.reserve(size);
    while (made.size() < size) {
        made.resize(std::min(size, made.size() + part), value);
        poll_interrupts();
    }
    return made;
}

}  // namespace cspace
