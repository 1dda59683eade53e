// A small convex quadratic program in a box: min ½ xᵀ H x − gᵀ x with lower ≤ x ≤ upper, H positive definite.
//
// The primal active-set method (Nocedal & Wright 2006, section 16.5): the free unknowns step towards their
// minimum until one of them meets a bound and becomes active. At the minimum an active unknown whose gradient
// points inward is released. In a box the multiplier of a bound is the gradient itself, and the bounds are
// linearly independent. The method therefore ends after finitely many steps, exact to rounding.
//
// Not for kernels: it uses the standard library.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cspace/math/linear.hpp"

namespace cspace {

struct BoxQp {
    int n;
    std::vector<double> H;  // (n, n)
    std::vector<double> g, lower, upper;

    // Working arrays.
    std::vector<double> factor, step, gradient;
    std::vector<int> loose;
    std::vector<signed char> active;  // −1 at lower, 1 at upper, 0 in between

    explicit BoxQp(int size)
        : n(size),
          H(std::size_t(size) * std::size_t(size)),
          g(std::size_t(size)),
          lower(std::size_t(size)),
          upper(std::size_t(size)),
          factor(std::size_t(size) * std::size_t(size)),
          step(std::size_t(size)),
          gradient(std::size_t(size)),
          loose(std::size_t(size)),
          active(std::size_t(size)) {}
};

namespace box_qp {

// gradient = H x − g
inline void find_gradient(BoxQp& p, const double* x) {
    for (int i = 0; i < p.n; ++i) {
        const double* row = p.H.data() + std::size_t(i) * std::size_t(p.n);
        double sum = -p.g[std::size_t(i)];
        for (int j = 0; j < p.n; ++j) sum += row[j] * x[j];
        p.gradient[std::size_t(i)] = sum;
    }
}

// The step of the m free unknowns to their minimum; false if H is not positive definite on them.
inline bool find_step(BoxQp& p, int m) {
    struct Rows {
        double* first;
        std::size_t n;
        double* operator[](int i) const { return first + n * std::size_t(i); }
    };
    const std::size_t n = std::size_t(p.n);
    const Rows H{p.H.data(), n}, A{p.factor.data(), n};
    for (int i = 0; i < m; ++i) {
        const int row = p.loose[std::size_t(i)];
        for (int j = i; j < m; ++j) A[i][j] = H[row][p.loose[std::size_t(j)]];
        p.step[std::size_t(i)] = -p.gradient[std::size_t(row)];
    }
    return solve_positive(A, m, p.step.data());
}

// Moves x by the step of the free unknowns, up to the first bound, which becomes active. Returns true if the
// full step was taken.
inline bool step_to_bound(BoxQp& p, int m, double* x) {
    double share = 1;
    int first = -1;
    for (int k = 0; k < m; ++k) {
        const std::size_t i = std::size_t(p.loose[std::size_t(k)]);
        const double d = p.step[std::size_t(k)], bound = d < 0 ? p.lower[i] : p.upper[i];
        if (d == 0 || !std::isfinite(bound)) continue;
        const double room = std::max((bound - x[i]) / d, 0.0);
        if (room < share) {
            share = room;
            first = k;
        }
    }
    for (int k = 0; k < m; ++k) {
        const std::size_t i = std::size_t(p.loose[std::size_t(k)]);
        x[i] = std::clamp(x[i] + share * p.step[std::size_t(k)], p.lower[i], p.upper[i]);
    }
    if (first < 0) return true;
    const std::size_t i = std::size_t(p.loose[std::size_t(first)]);
    p.active[i] = p.step[std::size_t(first)] < 0 ? -1 : 1;
    x[i] = p.active[i] < 0 ? p.lower[i] : p.upper[i];
    return false;
}

// The active unknown whose gradient points inward most, −1 if there is none.
inline int to_release(const BoxQp& p) {
    int worst = -1;
    double most = 0;
    for (int i = 0; i < p.n; ++i) {
        const std::size_t k = std::size_t(i);
        const double inward = p.active[k] * p.gradient[k];
        if (p.lower[k] < p.upper[k] && inward > most) {
            most = inward;
            worst = i;
        }
    }
    return worst;
}

}  // namespace box_qp

// x: the start, which is clipped to the box first; the solution on return. Returns the number of steps, or −1
// if H is not positive definite or contains NaN.
inline int solve_box_qp(BoxQp& p, double* x) {
    for (int i = 0; i < p.n; ++i) {
        const std::size_t k = std::size_t(i);
        x[k] = std::clamp(x[k], p.lower[k], p.upper[k]);
        p.active[k] = p.lower[k] == p.upper[k] ? -1 : 0;
    }
    const int most_steps = 50 * (p.n + 1);
    for (int step = 0; step < most_steps; ++step) {
        int m = 0;
        for (int i = 0; i < p.n; ++i)
            if (!p.active[std::size_t(i)]) p.loose[std::size_t(m++)] = i;
        box_qp::find_gradient(p, x);
        if (!box_qp::find_step(p, m)) return -1;
        if (!box_qp::step_to_bound(p, m, x)) continue;
        box_qp::find_gradient(p, x);
        const int released = box_qp::to_release(p);
        if (released < 0) return step + 1;
        p.active[std::size_t(released)] = 0;
    }
    return -1;
}

}  // namespace cspace
