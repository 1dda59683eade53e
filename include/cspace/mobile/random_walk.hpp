// White noise along an arc: variances in proportion to distance, turn and time.
//
// Q = ∫ Ad(exp(−sξ)) D Ad(exp(−sξ))ᵀ ds over s in [0, 1], so that two halves of a step have the noise of the
// whole (Barfoot 2017, section 7.2; the same in cspace.mobile of the package).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "cspace/mobile/walk_rates.hpp"
#include "cspace/spatial/left_jacobian.hpp"

namespace cspace::mobile {

using Covariance3 = std::array<double, 9>;

namespace walk {

// A with rows (c, s, u), (−s, c, v), (0, 0, 1), the adjoint of exp(−ξ).
struct Adjoint {
    double c, s, u, v;
};
inline Adjoint adjoint_back(const double* xi, double share) {
    const double v[2] = {share * xi[0], share * xi[1]}, w = share * xi[2], c = std::cos(w), s = std::sin(w);
    // The position of exp(ξ), turned back: −Rᵀ t.
    const auto [px, py] = spatial::PlanarJacobian(w, c, s).times(v);
    const double qx = -(c * px + s * py), qy = s * px - c * py;
    return {c, s, qy, -qx};
}
// Q += A C Aᵀ of a symmetric C.
inline void add_carried(Covariance3& Q, const Adjoint& A, const Covariance3& C) {
    const double rows[3][3] = {{A.c, A.s, A.u}, {-A.s, A.c, A.v}, {0, 0, 1}};
    double AC[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            AC[i][j] = rows[i][0] * C[j] + rows[i][1] * C[3 + j] + rows[i][2] * C[6 + j];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            Q[3 * i + j] += AC[i][0] * rows[j][0] + AC[i][1] * rows[j][1] + AC[i][2] * rows[j][2];
    }
}

}  // namespace walk

// The covariance of the disturbance w of T exp(ξ) exp(w), in the new base; ξ is a twist times its duration.
inline Covariance3 walk_covariance(const RandomWalk& noise, const double* xi, double duration) {
    constexpr double longest_turn = 0.0625;  // [rad]: three Gauss points integrate such an arc to rounding
    constexpr double nodes[] = {0.11270166537925831, 0.5, 0.8872983346207417};
    constexpr double weights[] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
    const double length = std::hypot(xi[0], xi[1]), angle = std::fabs(xi[2]);
    int doublings = 0;
    double scale = 1;
    for (double turn = angle; turn > longest_turn; turn /= 2, scale /= 2) ++doublings;
    const double along = noise.distance * length + noise.rest * duration;
    const double across = noise.side * length + noise.rest * duration;
    const double turning = noise.turn * angle + noise.drift * length + noise.rest_turn * duration;
    Covariance3 Q{};
    for (int k = 0; k < 3; ++k) {
        const double share = scale * weights[k];
        walk::add_carried(Q, walk::adjoint_back(xi, scale * nodes[k]),
                          {along * share, 0, 0, 0, across * share, 0, 0, 0, turning * share});
    }
    for (; doublings; --doublings, scale *= 2) {
        Covariance3 whole = Q;
        walk::add_carried(whole, walk::adjoint_back(xi, scale), Q);
        Q = whole;
    }
    return Q;
}

}  // namespace cspace::mobile
