// Ends a long computation after a given time, or at an interrupt.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>

#include "cspace/math/interrupts.hpp"

namespace cspace::shapes {

// Thrown where the time is over.
struct OutOfTime {};

class Watch {
  public:
    using Clock = std::chrono::steady_clock;
    // seconds: from now on; infinite without a limit.
    explicit Watch(double seconds = std::numeric_limits<double>::infinity())
        : begin_(Clock::now()), seconds_(seconds) {}
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
    // Called every few microseconds: looks now and then.
    void step() {
        if (--left_ == 0) look();
    }
    // Polls for interrupts and looks at the clock: called at least every few milliseconds.
    void look() {
        left_ = stride;
        poll_interrupts();
        if (elapsed() > seconds_) throw OutOfTime();
    }

  private:
    static constexpr std::uint32_t stride = 256;
    Clock::time_point begin_;
    double seconds_;
    std::uint32_t left_ = stride;
};

}  // namespace cspace::shapes
