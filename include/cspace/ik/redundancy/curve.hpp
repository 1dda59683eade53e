// The self-motion curve of an arm with one redundant joint: tangent, curvature, Newton's method back onto the
// curve, and the folds, where a joint reverses its direction.
#pragma once

#include "cspace/ik/redundancy/tip_jacobian.hpp"
#include "cspace/math/least_squares.hpp"

namespace cspace::ik {

// A point of the curve of n = chain.n joints: q(s) = q + tangent s + ½ bend s² + …
struct CurvePoint {
    double q[max_joints], tangent[max_joints], bend[max_joints];
    double error;  // what is left of the goal [rad, m over the arm's length]
    TipMotion<double> motion;
    SplitJacobian<double> split;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// One Newton step from q back onto the curve, and the quantities of the curve at q before the step.
CSPACE_ONCE void onto_curve(const Chain& chain, int rank, const Posed& goal, double length, CurvePoint& at) {
    TipMotion<double>& motion = at.motion;
    SplitJacobian<double>& split = at.split;
    const int n = chain.n;
    double step[max_joints];
    tip_motion<0>(chain, goal, length, at.q, motion);
    split_jacobian<0>(motion, n, rank, split);
    free_direction<0>(split, n, 0, at.tangent);
    // The pose's second derivative along the tangent; what bends the curve takes it back.
    Vec3d linear = {0, 0, 0}, angular = {0, 0, 0}, turned = {0, 0, 0};
    for (int j = 0; j < n; ++j) {
        const double* c = motion.column[j];
        const double t = at.tangent[j];
        const Vec3d v = {c[0], c[1], c[2]}, h = {c[3], c[4], c[5]};
        linear = linear + t * cross(2 * turned + t * h, v);
        angular = angular + t * cross(turned, h);
        turned = turned + t * h;
    }
    const double back[6] = {-linear.x, -linear.y, -linear.z, -angular.x, -angular.y, -angular.z};
    shortest_step<0>(split, n, back, at.bend);
    shortest_step<0>(split, n, motion.error, step);
    at.error = largest_of(motion.error, 6);
    const double keep = shortening(largest_of(step, n), 0.3);
    for (int i = 0; i < n; ++i) at.q[i] += keep * step[i];
}

// ‖J⁺ (J′ − J)‖ for the Jacobian J at `at` and J′ at `other`. If it is below 1 on a convex set, every
// solution in that set lies on one arc. Two solutions then differ in their component along the tangent.
inline double jacobian_change(const CurvePoint& at, const CurvePoint& other, int n) {
    const SplitJacobian<double>& split = at.split;
    double square = 0, y[6];
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < split.rank; ++k) {
            const int c = split.chosen[k];
            y[k] = other.motion.column[i][c] - at.motion.column[i][c];
            for (int j = 0; j < k; ++j) y[k] -= split.A[j][k] * y[j];
            y[k] /= away_from_zero(split.diagonal[k]);
            square += y[k] * y[k];
        }
    return std::sqrt(square);
}

// Moves q along the curve to the fold of joint p, by Newton's method on component p of the tangent. Returns
// false if it leads farther than `reach` away or does not converge.
inline bool settle_fold(const Chain& chain, int rank, const Posed& goal, double length, int p, double reach,
                        CurvePoint& at) {
    double start[max_joints];
    for (int i = 0; i < chain.n; ++i) start[i] = at.q[i];
    for (int k = 0; k < 20; ++k) {
        onto_curve(chain, rank, goal, length, at);
        const double slope = at.bend[p];
        double step = std::fabs(slope) > 1e-9 ? -at.tangent[p] / slope : 1;
        const bool settled = std::fabs(step) < 1e-10 && at.error < 1e-10;
        step = max(-0.1, min(0.1, step));
        double away = 0;
        for (int i = 0; i < chain.n; ++i) {
            at.q[i] += step * at.tangent[i] + 0.5 * step * step * at.bend[i];
            away = max(away, std::fabs(at.q[i] - start[i]));
        }
        if (!(away < reach)) return false;
        if (settled) return true;
    }
    return false;
}

}  // namespace cspace::ik::inline CSPACE_ISA
