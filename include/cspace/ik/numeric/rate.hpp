// Resolved motion rate (Whitney 1969): the joint velocities that give a frame a twist, damped where the
// Jacobian is weak.
//
// With J = Σ σᵢ aᵢ uᵢᵀ the velocity is q̇ = Σ f(σᵢ) uᵢ (aᵢᵀ t). f = σ/(σ² + λ²) for a damping λ (Nakamura &
// Hanafusa 1986; Wampler 1986); without one f = σ / max(σ, ε)², exact down to ε and fading to zero below it,
// so that no direction is ever amplified by more than 1/ε.
#pragma once

#include "cspace/math/small_svd.hpp"
#include "cspace/tolerances.hpp"

namespace cspace {

inline constexpr int max_rate_columns = 128;

struct RateSettings {
    double damping;      // λ, or negative for none
    double threshold;    // ε, where there is no damping
    const double* most;  // largest speed of each joint (dof,), or null
};

using RateSvd = SmallSvd<max_rate_columns, 6>;

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// The largest share of `extra`, up to 1, that keeps base + share · extra within ±most; 0 if base is outside.
inline double share_within(const double* base, const double* extra, const double* most, int n) {
    double share = 1;
    for (int j = 0; j < n; ++j) {
        if (std::fabs(base[j] + extra[j]) <= most[j]) continue;
        const double room = most[j] - (extra[j] > 0 ? base[j] : -base[j]);
        share = std::fmin(share, std::fmax(room, 0.0) / std::fabs(extra[j]));
    }
    return share;
}

// J (6, dof), twist (6,) and the wish (dof,) of the null space, or null; qd (dof,) takes the velocities.
// Where they would be too fast, the motion in the null space gives way first, then the twist is slowed down
// as a whole.
inline void resolved_rate(const double* J, int dof, const double* twist, const double* wish,
                          const RateSettings& settings, RateSvd& svd, double* qd) {
    svd.rows = dof;
    svd.columns = 6;
    for (int r = 0; r < 6; ++r)
        for (int j = 0; j < dof; ++j) svd.us[r][j] = J[r * dof + j];
    decompose(svd);
    double extra[max_rate_columns];
    for (int j = 0; j < dof; ++j) {
        qd[j] = 0;
        extra[j] = wish ? wish[j] : 0;
    }
    for (int i = 0; i < 6; ++i) {
        const double sigma = svd.sigma[i];
        if (sigma <= tolerance::always_singular) continue;
        const double least = settings.damping >= 0 ? sigma : std::fmax(sigma, settings.threshold);
        const double damping = std::fmax(settings.damping, 0.0);
        const double gain = dot_n(svd.v[i], twist, 6) / (least * least + damping * damping);
        for (int j = 0; j < dof; ++j) qd[j] += gain * svd.us[i][j];
        if (!wish) continue;
        const double along = dot_n(svd.us[i], extra, dof) / (sigma * sigma);
        for (int j = 0; j < dof; ++j) extra[j] -= along * svd.us[i][j];
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

}  // namespace cspace::inline CSPACE_ISA
