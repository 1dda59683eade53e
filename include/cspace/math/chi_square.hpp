// χ² with a whole number of degrees of freedom, in closed form (Abramowitz & Stegun 1972, 26.4.4 and 26.4.5).
#pragma once

#include <cmath>

namespace cspace {

// The share of χ² above a value: 1 or 2 degrees of freedom, and a term for each two more.
inline double chi_square_tail(double value, int dof) {
    constexpr double half_pi = 1.5707963267948966;
    if (!(value > 0)) return 1;
    const double half = value / 2;
    double tail, term;
    if (dof % 2) {
        tail = std::erfc(std::sqrt(half));
        term = std::exp(-half) * std::sqrt(half / half_pi) * std::sqrt(2.0);
    } else {
        tail = term = std::exp(-half);
        if (dof > 2) term *= half;
    }
    for (int d = dof % 2 ? 3 : 4; d <= dof; d += 2) {
        tail += term;
        term *= value / d;
    }
    return tail;
}

// The value with a share of χ² below it, by bisection.
inline double chi_square_quantile(double share, int dof) {
    constexpr int halvings = 100;  // reach the last digit
    constexpr double most = 1e6;   // the tail has long been zero there
    double low = 0, high = 1;
    while (1 - chi_square_tail(high, dof) < share && high < most) high *= 2;
    for (int k = 0; k < halvings; ++k) {
        const double middle = (low + high) / 2;
        (1 - chi_square_tail(middle, dof) < share ? low : high) = middle;
    }
    return high;
}

// Quantiles of one share, each computed when it is first needed.
class ChiSquareGate {
  public:
    explicit ChiSquareGate(double share) : share_(share) {}
    double limit(int dof) {
        while (int(limits_size_) < dof && limits_size_ < kept) {
            limits_[limits_size_] = chi_square_quantile(share_, int(limits_size_) + 1);
            ++limits_size_;
        }
        return dof <= int(kept) ? limits_[dof - 1] : chi_square_quantile(share_, dof);
    }

  private:
    static constexpr unsigned kept = 64;  // degrees of freedom of 32 readings at once
    double share_, limits_[kept] = {};
    unsigned limits_size_ = 0;
};

}  // namespace cspace
