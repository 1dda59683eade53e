// How far the error of one edge is from what all others explain, with two scales of the covariances.
//
// The squared error of an edge is measured against the covariance s W⁻¹ + m J Σ Jᵀ: its own, times s, and
// that of its poses by all other edges, times m. Single measurements may have heavy tails, so that s is
// large. The poses move by the sum of many measurements, whose tails average out, so that m stays near χ² per
// degree of freedom.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cspace/localization/graph/residuals.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::localization {

struct ErrorScales {
    double own = 1, graph = 1;  // of the covariance of an edge, and of that of its poses
};

inline constexpr double least_pivot = 1e-14;  // of the diagonal of an information

// The error of an edge in units of its information, and the covariance of its poses in these.
template <std::size_t n>
struct WhiteError {
    std::array<double, n> e;
    std::array<double, n * n> C;
};

// H, g: the information of an error and the gradient; C: Jᵀ Σ J of the derivatives J of that gradient for the
// poses.
template <std::size_t n>
WhiteError<n> whiten_error(const std::array<double, n * n>& H, const std::array<double, n>& g,
                           const std::array<double, n * n>& C) {
    const std::array<double, n * n> L = factor_semidefinite<n>(H, least_pivot);
    const auto divide = [&](auto value) {  // L⁻¹, by forward substitution
        std::array<double, n> x{};
        for (std::size_t r = 0; r < n; ++r) {
            if (!(L[r * n + r] > 0)) continue;
            double sum = value(r);
            for (std::size_t k = 0; k < r; ++k) sum -= L[r * n + k] * x[k];
            x[r] = sum / L[r * n + r];
        }
        return x;
    };
    WhiteError<n> white{divide([&](std::size_t r) { return g[r]; }), {}};
    std::array<double, n * n> half;  // L⁻¹ C
    for (std::size_t c = 0; c < n; ++c) {
        const std::array<double, n> x = divide([&](std::size_t r) { return C[r * n + c]; });
        for (std::size_t r = 0; r < n; ++r) half[r * n + c] = x[r];
    }
    for (std::size_t r = 0; r < n; ++r) {
        const std::array<double, n> x = divide([&](std::size_t c) { return half[r * n + c]; });
        for (std::size_t c = 0; c < n; ++c) white.C[r * n + c] = x[c];
    }
    return white;
}

// S: covariance of both poses, 2n × 2n, row by row.
template <std::size_t n>
WhiteError<n> whiten_edge(const QuadraticModel<n, n>& model, const std::array<double, 4 * n * n>& S) {
    constexpr std::size_t wide = 2 * n;
    std::array<double, n * wide> J;
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t c = 0; c < n; ++c)
            J[r * wide + c] = model.ab[c * n + r], J[r * wide + n + c] = model.bb[r * n + c];
    }
    const std::array<double, n * wide> JS = multiply<n, wide, wide>(J, S);
    std::array<double, n * n> C{};
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t c = 0; c < n; ++c) {
            for (std::size_t k = 0; k < wide; ++k) C[r * n + c] += JS[r * wide + k] * J[c * wide + k];
        }
    }
    return whiten_error<n>(model.bb, model.gb, C);
}

// eᵀ M⁻¹ e, or 0 where M is singular: nothing else measures what the edge says.
template <std::size_t n>
double divide_square(const std::array<double, n * n>& M, const std::array<double, n>& e) {
    constexpr double singular = 1e-12;
    double rows[n][n], y[n], pivots[n], sum = 0;
    for (std::size_t r = 0; r < n; ++r) std::copy_n(M.data() + r * n, n, rows[r]), y[r] = e[r];
    linear::eliminate_lower<int(n)>(rows, y, pivots);
    for (std::size_t k = 0; k < n; ++k) {
        if (!(std::fabs(pivots[k]) > singular)) return 0;
        sum += e[k] * y[k];
    }
    return sum;
}

// The squared error of an edge that the poses do not follow; with both scales 1, by how much χ² rises with
// it.
template <std::size_t n>
double measure_rise(const WhiteError<n>& white, const ErrorScales& scales) {
    std::array<double, n * n> M = white.C;
    for (double& x : M) x *= scales.graph;
    for (std::size_t r = 0; r < n; ++r) M[r * n + r] += scales.own;
    return divide_square<n>(M, white.e);
}

// I − C: the shares of the others in what is measured along the axes of the error.
template <std::size_t n>
std::array<double, n * n> find_shares(const WhiteError<n>& white) {
    std::array<double, n * n> R = white.C;
    for (double& x : R) x = -x;
    for (std::size_t r = 0; r < n; ++r) R[r * n + r] += 1;
    return R;
}

// A bound below the least of these shares along any axis; 0 where there is none.
template <std::size_t n>
double find_least_share(const WhiteError<n>& white) {
    const std::array<double, n * n> R = find_shares(white);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
        std::array<double, n> axis{};
        axis[k] = 1;
        const double inverse = divide_square<n>(R, axis);
        if (!(inverse > 0)) return 0;
        sum += inverse;
    }
    return 1 / sum;
}

// As `measure_rise`, at poses that follow the edge, as if they did not; with both scales 1, by how much χ²
// falls without it.
template <std::size_t n>
double measure_pull(const WhiteError<n>& white, const ErrorScales& scales) {
    // With the shares R of others, the error without the edge is R⁻¹e, and the covariance of that is
    // m R⁻¹ + (s − m) I.
    const std::array<double, n * n> R = find_shares(white);
    std::array<double, n * n> M = multiply<n, n, n>(R, R);
    for (std::size_t k = 0; k < n * n; ++k) M[k] = scales.graph * R[k] + (scales.own - scales.graph) * M[k];
    return divide_square<n>(M, white.e);
}

}  // namespace cspace::localization
