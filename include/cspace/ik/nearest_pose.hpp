// The configuration nearest to a goal, reachable or not. Gauss–Newton converges slowly where the remaining
// error is large. Newton's method with the second derivative of the tip position does not (Dennis & Schnabel
// 1983).
#pragma once

#include "cspace/ik/refine.hpp"
#include "cspace/ik/solution.hpp"
#include "cspace/math/least_squares.hpp"

namespace cspace::ik::inline CSPACE_ISA {

inline double cost_of(const PoseError& error, double weight) {
    const double* e = error.e;
    return 0.5 * (dot_n(e, e, 3) + weight * weight * dot_n(e + 3, e + 3, 3));
}

// The cost as a problem of descend_damped, with its exact Hessian. The second derivative of the position by
// q_i and q_j, i ≤ j, is axis i × column j.
struct NearestPoseProblem {
    static constexpr int size = max_joints;
    const Chain& chain;
    const Posed& goal;
    double length, weight;
    int n = chain.n;

    double evaluate(const double* q, PoseError& at) const {
        measure_error(chain, goal, length, q, at);
        return cost_of(at, weight);
    }
    bool model(const double*, const PoseError& at, double (*H)[size], double* down) const {
        const double *e = at.e, w2 = weight * weight;
        for (int j = 0; j < n; ++j) {
            const double* b = at.jacobian.us[j];
            down[j] = dot_n(b, e, 3) + w2 * dot_n(b + 3, e + 3, 3);
            for (int i = 0; i <= j; ++i) {
                const double* a = at.jacobian.us[i];
                const double bend[3] = {a[4] * b[2] - a[5] * b[1], a[5] * b[0] - a[3] * b[2],
                                        a[3] * b[1] - a[4] * b[0]};
                H[i][j] = dot_n(a, b, 3) + w2 * dot_n(a + 3, b + 3, 3) - dot_n(bend, e, 3);
            }
        }
        return true;
    }
    double add_step(double q, double step) const { return q + step; }
};

// Descends from q to a local minimum of the cost; `error` belongs to q on return.
inline double minimise_pose_error(const Chain& chain, const Posed& goal, double length, double weight,
                                  double* q, PoseError& error) {
    constexpr double stride = 0.5, settled = 1e-10, definite = 1e-13;
    constexpr double gentle = 1e-6;  // share of the largest curvature: damps no step that descends
    const double first_damping = gentle * (1 + weight * weight);
    return descend_damped(NearestPoseProblem{chain, goal, length, weight}, q, error,
                          NewtonDamping{0, settled, stride, first_damping, definite}, 100);
}

}  // namespace cspace::ik::inline CSPACE_ISA
