// Low-variance (systematic) resampling with whole numbers, and how many particles a posterior needs.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cspace::localization {

// Visits the draws of a systematic sample: n evenly spaced places in a total weight, behind a random offset.
class SystematicDraws {
  public:
    SystematicDraws(std::uint64_t total, std::size_t n, std::uint64_t random)
        : step_(total / n), rest_(total % n), n_(n), place_(step_ ? random % step_ : 0) {}
    // How many of the draws lie below an upper bound of the summed weights, and were not counted before.
    std::size_t count_below(std::uint64_t bound) {
        std::size_t count = 0;
        for (; taken_ < n_ && place_ < bound; ++count) advance();
        return count;
    }

  private:
    std::uint64_t step_, rest_;
    std::size_t n_, taken_ = 0;
    std::uint64_t place_, carried_ = 0;

    void advance() {
        ++taken_;
        place_ += step_, carried_ += rest_;
        if (carried_ >= n_) carried_ -= n_, ++place_;
    }
};

// How many particles make the divergence of their histogram over k bins from the posterior at most `error`,
// with the probability whose normal quantile is z (Fox 2003). One bin needs none.
inline double count_for_bins(std::size_t k, double error, double z) {
    if (k < 2) return 0;
    const double m = double(k - 1), a = 2 / (9 * m), root = 1 - a + std::sqrt(a) * z;
    return m / (2 * error) * root * root * root;
}

}  // namespace cspace::localization
