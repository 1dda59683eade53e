// The configuration nearest to a goal, reachable or not. Gauss–Newton converges slowly where the remaining
// error is large. Newton's method with the second derivative of the tip position does not (Dennis & Schnabel
// 1983).
#pragma once

#include "cspace/ik/refine.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik {

struct NearestPose {
    double q[max_joints];
    double position = 0;  // [m]
    double rotation = 0;  // [rad]
    double cost = 0;      // ½ (‖Δp‖/length)² + ½ (weight · angle)²
};

// Gradient and Hessian of the cost. The Hessian is symmetric and stored in full.
struct Quadratic {
    int n;
    double gradient[max_joints];
    double hessian[max_joints][max_joints];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double cost_of(const PoseError& error, double weight) {
    const double* e = error.e;
    return 0.5 * (dot_n(e, e, 3) + weight * weight * dot_n(e + 3, e + 3, 3));
}

// From a pose error whose Jacobian is not yet decomposed. The second derivative of the position by q_i and
// q_j, i ≤ j, is axis i × column j.
inline Quadratic quadratic_model(const PoseError& error, double weight) {
    Quadratic out;
    const PoseSvd& J = error.jacobian;
    const double *e = error.e, w2 = weight * weight;
    out.n = J.columns;
    for (int j = 0; j < out.n; ++j) {
        const double* b = J.us[j];
        out.gradient[j] = -(dot_n(b, e, 3) + w2 * dot_n(b + 3, e + 3, 3));
        for (int i = 0; i <= j; ++i) {
            const double* a = J.us[i];
            const double bend[3] = {a[4] * b[2] - a[5] * b[1], a[5] * b[0] - a[3] * b[2],
                                    a[3] * b[1] - a[4] * b[0]};
            out.hessian[i][j] = out.hessian[j][i] =
                dot_n(a, b, 3) + w2 * dot_n(a + 3, b + 3, 3) - dot_n(bend, e, 3);
        }
    }
    return out;
}

// Solves (H + damping) x = −gradient; false if the matrix is not clearly positive definite.
inline bool solve_damped(const Quadratic& m, double damping, double* x) {
    Quadratic damped = m;
    double largest = 0;
    for (int i = 0; i < m.n; ++i) {
        damped.hessian[i][i] += damping;
        largest = max(largest, std::fabs(damped.hessian[i][i]));
        x[i] = -m.gradient[i];
    }
    return solve_positive(damped.hessian, m.n, x, 1e-13 * largest);
}

// Descends from q to a local minimum of the cost; `error` belongs to q on return.
inline double minimise(const Chain& chain, const Posed& goal, double length, double weight, double* q,
                       PoseError& error) {
    constexpr int most_steps = 60;
    constexpr double stride = 0.5, settled = 1e-10;
    measure_error(chain, goal, length, q, error);
    double cost = cost_of(error, weight), damping = 0;
    const double first_damping = 1e-6 * (1 + weight * weight);
    for (int step = 0; step < most_steps; ++step) {
        const Quadratic model = quadratic_model(error, weight);
        bool taken = false;
        double reach = 0;
        for (int trial = 0; trial < 30 && !taken; ++trial) {
            double dq[max_joints], next[max_joints];
            if (solve_damped(model, damping, dq)) {
                reach = 0;
                for (int i = 0; i < chain.n; ++i) reach = max(reach, std::fabs(dq[i]));
                const double keep = reach > stride ? stride / reach : 1.0;
                for (int i = 0; i < chain.n; ++i) next[i] = q[i] + keep * dq[i];
                PoseError there;
                measure_error(chain, goal, length, next, there);
                const double next_cost = cost_of(there, weight);
                if (next_cost < cost) {
                    taken = true;
                    cost = next_cost;
                    error = there;
                    for (int i = 0; i < chain.n; ++i) q[i] = next[i];
                } else if (reach < settled) {
                    return cost;
                }
            }
            damping = taken ? (damping < first_damping ? 0 : 0.1 * damping) : max(4 * damping, first_damping);
        }
        if (!taken || reach < settled) break;
    }
    return cost;
}

}  // namespace cspace::ik::inline CSPACE_ISA
