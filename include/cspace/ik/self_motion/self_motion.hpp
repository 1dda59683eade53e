// Self-motion test: whether an arm can move at a configuration while its tip stays fixed. The null space of
// the Jacobian gives candidate directions, and a finite stride along each decides.
#pragma once

#include <initializer_list>

#include "cspace/ik/refine.hpp"
#include "cspace/ik/self_motion/continuation.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// Maximum number of steps from a stride back to the goal. On a self-motion three steps suffice. Near one (a
// fold on top of a self-motion) each step halves the error.
inline constexpr int steps_back = 30;

// A stride from q and back to the goal: returns the fraction of the stride that remains; 0 if the final error
// exceeds `most`. `floor`: the steps back ignore directions that hardly move the tip, as occur with rounded
// axes.
inline double kept_of_stride(const Chain& chain, const Posed& goal, double length, const double* q,
                             const double* direction, double stride, bool floor, double most) {
    double moved[max_joints] = {}, along = 0;
    for (int i = 0; i < chain.n; ++i) moved[i] = q[i] + stride * direction[i];
    PoseError error;
    if (floor)
        onto_curve(chain, {goal, true, length}, moved, error);
    else
        refine_solution(chain, goal, length, moved, error, steps_back);
    for (int i = 0; i < chain.n; ++i) along += (moved[i] - q[i]) * direction[i];
    return size_of_error(error) <= most ? along / stride : 0;
}

// Whether the arm can move along `direction` with its tip fixed: a stride in that direction, and a correction
// back to the goal. On a self-motion the arm has then moved by about the stride, for every stride. At a fold
// it returns to q, or reaches a nearby solution at one fixed distance.
inline bool moves_freely(const Chain& chain, const Posed& goal, double length, const double* q,
                         const double* direction) {
    // What may be missed along a self-motion, and where rounded axes leave a valley instead of one.
    constexpr double exactly = 1e-12, nearly = 1e-11;
    PoseError at;
    measure_error(chain, goal, length, q, at);
    const double on_floor = max(nearly, 2 * size_of_error(at));
    for (const double stride : {0.02, 0.05}) {
        bool moved_on = false;
        for (const bool floor : {false, true})
            for (const double way : {stride, -stride}) {
                if (moved_on) break;
                const double kept =
                    kept_of_stride(chain, goal, length, q, direction, way, floor, floor ? on_floor : exactly);
                moved_on = 0.8 < kept && kept < 1.25;
            }
        if (!moved_on) return false;
    }
    return true;
}

// Whether a closed self-motion too small for such strides passes through q.
inline bool runs_round(const Chain& chain, const Posed& goal, double length, const double* q,
                       const double* direction) {
    constexpr double least = 1e-3;
    constexpr int most_steps = 400;
    double farthest = 0;
    const auto visit = [&](const double* at, const double*, double) {
        for (int i = 0; i < chain.n; ++i) farthest = max(farthest, std::fabs(at[i] - q[i]));
    };
    const TipConstraint constraint = {goal, true, length};
    return follow_curve(chain, constraint, q, direction, visit, most_steps) == CurveEnd::closed &&
           farthest > least;
}

// Whether a stride both ways along the weakest direction of J, the decomposed Jacobian at q, misses the goal
// by more than `most`: then q lies on no self-motion. The steps back across that direction keep J (chord
// steps) and converge only where no other direction is weak; false says nothing.
inline bool leaves_goal(const Chain& chain, const Posed& goal, double length, const double* q,
                        const PoseSvd& J, double most) {
    constexpr double stride = 0.05, firm = 0.05, all_along = 1.0001;
    constexpr int most_steps = 12;
    const int weak = weakest_direction(J);
    for (int j = 0; j < J.columns; ++j)
        if (j != weak && J.sigma[j] < firm) return false;
    for (const double way : {stride, -stride}) {
        double moved[max_joints], e[6], dq[max_joints];
        bool left = false;
        for (int i = 0; i < chain.n; ++i) moved[i] = q[i] + way * J.v[weak][i];
        for (int step = 0; step < most_steps && !left; ++step) {
            tip_error(forward_kinematics(chain, moved), goal, length, e);
            const double along = dot_n(J.us[weak], e, 6) / J.sigma[weak];
            left = std::fabs(along) > most && dot_n(e, e, 6) < all_along * along * along;
            least_norm_step(J, e, 0, 0, weak, dq);
            for (int i = 0; i < chain.n; ++i) moved[i] += dq[i];
        }
        if (!left) return false;
    }
    return true;
}

// The direction in the null space to which a stride along `trial` leads; false if it leads back.
inline bool led_away(const Chain& chain, const Posed& goal, double length, const double* q,
                     const double* const* basis, int k, double* trial) {
    constexpr double stride = 0.03;
    double moved[max_joints];
    for (int i = 0; i < chain.n; ++i) moved[i] = q[i] + stride * trial[i];
    PoseError error;
    if (refine_solution(chain, goal, length, moved, error, steps_back) > tolerance::exact) return false;
    double away = 0;
    for (int i = 0; i < chain.n; ++i) {
        trial[i] = moved[i] - q[i];
        away += trial[i] * trial[i];
    }
    return away > 0.25 * stride * stride && project_vector(basis, k, chain.n, trial) > 0;
}

// The vectors of a null space of dimension 2 or 3 in which one or two joints do not move. Self-motions of
// real arms move few joints (a wrist rolling against the forearm). If the null space is larger than the
// self-motion, the self-motion lies among these vectors. basis[0 … k): orthonormal, length n.
struct SparseDirections {
    int count = 0;
    double d[2 + max_joints * max_joints][max_joints];
};
inline SparseDirections sparse_directions(const double* const* basis, int k, int n) {
    SparseDirections out;
    for (int i = 0; i < n; ++i)
        for (int j = k == 2 ? n - 1 : i + 1; j < n; ++j) {
            constexpr double parallel2 = 1e-8;  // square below which they cancel all joints
            // The weights that cancel joint i (and j).
            const double a = basis[0][i], b = basis[1][i], c = k == 2 ? 0 : basis[2][i];
            const double e = k == 2 ? 0 : basis[0][j], f = k == 2 ? 0 : basis[1][j],
                         g = k == 2 ? 1 : basis[2][j];
            const double w[3] = {b * g - c * f, c * e - a * g, a * f - b * e};
            double* const d = out.d[out.count];
            double size2 = 0;
            for (int m = 0; m < n; ++m) {
                d[m] = w[0] * basis[0][m] + w[1] * basis[1][m] + (k == 2 ? 0 : w[2] * basis[2][m]);
                size2 += d[m] * d[m];
            }
            if (size2 < parallel2) continue;
            for (int m = 0; m < n; ++m) d[m] /= std::sqrt(size2);
            ++out.count;
        }
    return out;
}

// Searches for a self-motion at q with the decomposed Jacobian J; on success `direction` is its unit
// velocity. If the rank drops by two or more (a stretched elbow and an aligned wrist), the null space has
// more dimensions than the motion. Then its sparse directions are tried first, and after them directions
// spread over it.
CSPACE_ONCE bool find_self_motion(const Chain& chain, const Posed& goal, double length, const double* q,
                                  const PoseSvd& J, double* direction) {
    constexpr double lost = 1e-7, firm = 0.1;
    constexpr double off_curve = 2e-11;  // more than a rounded self-motion may miss
    const double* basis[max_joints];
    int k = 0;
    for (int j = 0; j < J.columns; ++j)
        if (J.sigma[j] < lost) basis[k++] = J.v[j];
    if (k == 0) return false;
    const double left = miss_of(chain, goal, length, q);
    if (k == 1 && leaves_goal(chain, goal, length, q, J, max(off_curve, 3 * left))) return false;
    bool bends = false;  // so much that a self-motion may be smaller than the strides
    for (int j = 0; j < J.columns; ++j) bends = bends || (k == 1 && J.sigma[j] >= lost && J.sigma[j] < firm);
    const auto accept = [&](const double* d) {
        if (!moves_freely(chain, goal, length, q, d) && !(bends && runs_round(chain, goal, length, q, d)))
            return false;
        for (int i = 0; i < chain.n; ++i) direction[i] = d[i];
        return true;
    };
    if (k == 1) return accept(basis[0]);
    if (k <= 3) {
        const SparseDirections sparse = sparse_directions(basis, k, chain.n);
        for (int m = 0; m < sparse.count; ++m)
            if (accept(sparse.d[m])) return true;
    }
    constexpr int around = 6;
    for (int a = 0; a < k; ++a)
        for (int b = a + 1; b < k; ++b)
            for (int m = 0; m < around; ++m) {
                const double c = std::cos(pi * m / around), s = std::sin(pi * m / around);
                double trial[max_joints];
                for (int i = 0; i < chain.n; ++i) trial[i] = c * basis[a][i] + s * basis[b][i];
                if (led_away(chain, goal, length, q, basis, k, trial) && accept(trial)) return true;
            }
    return false;
}

}  // namespace cspace::ik::inline CSPACE_ISA
