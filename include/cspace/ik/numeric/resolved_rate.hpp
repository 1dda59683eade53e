// Resolved-rate control (Whitney 1969): the joint velocities that give a frame a twist, damped where the
// Jacobian is nearly singular.
//
// With J = Σ σᵢ aᵢ uᵢᵀ the velocity is q̇ = Σ f(σᵢ) uᵢ (aᵢᵀ t). f = σ/(σ² + λ²) for a damping λ (Nakamura &
// Hanafusa 1986; Wampler 1986); Without damping f = σ / max(σ, ε)². It is exact for σ ≥ ε and tends to zero
// below ε, so no direction is amplified by more than 1/ε.
#pragma once

#include "cspace/math/linear.hpp"
#include "cspace/math/small_svd.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

inline constexpr int max_rate_columns = 128;

struct RateSettings {
    double damping;      // λ, or negative for none
    double threshold;    // ε, where there is no damping
    const double* most;  // largest speed of each joint (dof,), or null
};

using RateSvd = SmallSvd<max_rate_columns, 6>;

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The largest fraction of `extra`, up to 1, that keeps base + share · extra within ±most; 0 if base is
// outside.
inline double share_within(const double* base, const double* extra, const double* most, int n) {
    double share = 1;
    for (int j = 0; j < n; ++j) {
        if (std::fabs(base[j] + extra[j]) <= most[j]) continue;
        const double room = most[j] - (extra[j] > 0 ? base[j] : -base[j]);
        share = std::fmin(share, std::fmax(room, 0.0) / std::fabs(extra[j]));
    }
    return share;
}

// The inverse of a symmetric positive definite matrix; false if it is not positive definite.
inline bool invert_positive(const double (&M)[6][6], double (&inverse)[6][6]) {
    double A[6][6];
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) A[i][j] = M[i][j];
    if (!factor_ldl(A, 6)) return false;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) inverse[i][j] = i == j;
        solve_ldl(A, 6, inverse[i]);
    }
    return true;
}

// qd += share · Jᵀ A t
inline void add_transposed(const double* J, int dof, const double (&A)[6][6], const double* t, double share,
                           double* qd) {
    for (int r = 0; r < 6; ++r) {
        const double gain = share * dot_n(A[r], t, 6);
        for (int j = 0; j < dof; ++j) qd[j] += gain * J[r * dof + j];
    }
}

// The joint rate and the projected null-space velocity where every singular value of J is certainly above ε:
// 1/σ² is at most the norm of (J Jᵀ)⁻¹. False elsewhere.
inline bool regular_rate(const double* J, int dof, const double* twist, const RateSettings& settings,
                         double* qd, double* extra) {
    double M[6][6], inverse[6][6], square = 0;
    for (int r = 0; r < 6; ++r)
        for (int c = 0; c <= r; ++c) M[r][c] = M[c][r] = dot_n(J + r * dof, J + c * dof, dof);
    if (!invert_positive(M, inverse)) return false;
    for (const auto& row : inverse) square += dot_n(row, row, 6);
    const double threshold2 = settings.threshold * settings.threshold;
    if (!(std::sqrt(square) * threshold2 <= 1)) return false;
    double moved[6];
    for (int r = 0; r < 6; ++r) moved[r] = dot_n(J + r * dof, extra, dof);
    add_transposed(J, dof, inverse, moved, -1, extra);
    if (settings.damping > 0) {
        for (int r = 0; r < 6; ++r) M[r][r] += settings.damping * settings.damping;
        if (!invert_positive(M, inverse)) return false;
    }
    add_transposed(J, dof, inverse, twist, 1, qd);
    return true;
}

// The same for any J, from its singular values.
inline void singular_rate(const double* J, int dof, const double* twist, const RateSettings& settings,
                          RateSvd& svd, double* qd, double* extra) {
    svd.rows = dof;
    svd.columns = 6;
    for (int r = 0; r < 6; ++r)
        for (int j = 0; j < dof; ++j) svd.us[r][j] = J[r * dof + j];
    decompose_matrix(svd);
    for (int i = 0; i < 6; ++i) {
        const double sigma = svd.sigma[i];
        if (sigma <= tolerance::always_singular) continue;
        const double least = settings.damping >= 0 ? sigma : std::fmax(sigma, settings.threshold);
        const double damping = std::fmax(settings.damping, 0.0);
        const double gain = dot_n(svd.v[i], twist, 6) / (least * least + damping * damping);
        for (int j = 0; j < dof; ++j) qd[j] += gain * svd.us[i][j];
        const double along = dot_n(svd.us[i], extra, dof) / (sigma * sigma);
        for (int j = 0; j < dof; ++j) extra[j] -= along * svd.us[i][j];
    }
}

// J (6, dof), twist (6,), and the desired null-space velocity wish (dof,), or null. qd (dof,) receives the
// velocities. Where they would exceed the limits, the null-space motion is reduced first, then the whole
// twist is scaled down.
inline void resolved_rate(const double* J, int dof, const double* twist, const double* wish,
                          const RateSettings& settings, RateSvd& svd, double* qd) {
    double extra[max_rate_columns];
    const auto start = [&] {
        for (int j = 0; j < dof; ++j) {
            qd[j] = 0;
            extra[j] = wish ? wish[j] : 0;
        }
    };
    start();
    if (dof < 6 || !regular_rate(J, dof, twist, settings, qd, extra)) {
        start();
        singular_rate(J, dof, twist, settings, svd, qd, extra);
    }
    double share = 1;
    if (settings.most) {
        const double zero[max_rate_columns] = {};
        const double slowed = share_within(zero, qd, settings.most, dof);
        for (int j = 0; j < dof; ++j) qd[j] *= slowed;
        share = share_within(qd, extra, settings.most, dof);
    }
    for (int j = 0; j < dof; ++j) qd[j] += share * extra[j];
}

}  // namespace cspace::ik::inline CSPACE_ISA
