// Weights of particles as integers: their sums do not depend on the order, so neither does what is drawn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cspace::localization {

// Logarithms of weights are whole multiples of 2⁻²⁰, not above zero, and not below −1000.
inline constexpr double log_units = 1048576.0;
inline constexpr std::int32_t least_log = -1000 * 1048576;

// exp(x) for −30 ≤ x ≤ 0, the same on every machine: the series of exp(x / 1024), squared ten times.
constexpr double portable_exp(double x) {
    const double y = x / 1024;
    double sum = 1, term = 1;
    for (int k = 1; k < 9; ++k) term *= y / k, sum += term;
    for (int k = 0; k < 10; ++k) sum *= sum;
    return sum;
}

// exp as 32-bit integers by two tables: of the upper bits of the logarithm and of the lower twelve.
class WeightTable {
  public:
    WeightTable() {
        constexpr double top = 4294967295.0;
        for (std::size_t k = 0; k < coarse_.size(); ++k)
            coarse_[k] = std::uint32_t(portable_exp(-double(k << fine_bits) / log_units) * top + 0.5);
        for (std::size_t k = 0; k < fine_.size(); ++k)
            fine_[k] = std::uint32_t(portable_exp(-double(k) / log_units) * top + 0.5);
    }
    // log is not above zero.
    std::uint32_t weight_of(std::int32_t log) const {
        const std::uint32_t below = 0u - std::uint32_t(log), k = below >> fine_bits;
        if (k >= coarse_.size()) return 0;
        const std::uint64_t product = std::uint64_t(coarse_[k]) * fine_[below & (fine_.size() - 1)];
        return std::uint32_t(product >> 32);
    }

  private:
    static constexpr int fine_bits = 12;
    static constexpr std::size_t coarse_size = 23 << (20 - fine_bits);  // exp(−23) is less than 2⁻³²
    std::array<std::uint32_t, coarse_size> coarse_;
    std::array<std::uint32_t, 1 << fine_bits> fine_;
};

}  // namespace cspace::localization
