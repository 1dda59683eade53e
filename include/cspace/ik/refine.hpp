// Refinement of a candidate to a solution on the true chain: damped least squares on the pose error
// (Levenberg 1944, Nakamura & Hanafusa 1986), and conditioning and null space from the Jacobian there.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/math/small_svd.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

using PoseSvd = SmallSvd<6, max_joints>;

// The error of a configuration relative to a goal: twist [Δp/length; rotation vector], and the Jacobian of
// the tip in the same units.
struct PoseError {
    double e[6];
    double position;  // [m]
    double rotation;  // [rad]
    PoseSvd jacobian;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline void measure_error(const Chain& chain, const Posed& goal, double length, const double* q,
                          PoseError& out) {
    Vec3d axis[max_joints], point[max_joints];
    const auto keep_axis = [&](int i, const Vec3d& h, const Vec3d& p) { axis[i] = h, point[i] = p; };
    const Posed T = move_joints(chain, chain.n, q, keep_axis) * chain.tip;
    const Vec3d dp = goal.t - T.t, w = spatial::rotvec_of_rotation(goal.R * transpose(T.R));
    out.position = norm(dp);
    out.rotation = norm(w);
    const double e[6] = {dp.x / length, dp.y / length, dp.z / length, w.x, w.y, w.z};
    for (int k = 0; k < 6; ++k) out.e[k] = e[k];
    out.jacobian.rows = 6;
    out.jacobian.columns = chain.n;
    for (int i = 0; i < chain.n; ++i) {
        const Vec3d v = chain.prismatic[i] ? axis[i] : cross(axis[i], T.t - point[i]);
        const Vec3d h = chain.prismatic[i] ? Vec3d{0, 0, 0} : axis[i];
        double* const column_i = out.jacobian.us[i];
        const double col[6] = {v.x / length, v.y / length, v.z / length, h.x, h.y, h.z};
        for (int k = 0; k < 6; ++k) column_i[k] = col[k];
    }
}

inline double size_of_error(const PoseError& error) { return std::sqrt(dot_n(error.e, error.e, 6)); }

// The damped least-squares step from a decomposed Jacobian. The step has no component in the null space: the
// remaining error there is rounding, and would move joints along their self-motion.
inline void damped_step(const PoseError& error, double damping, double* dq) {
    const PoseSvd& J = error.jacobian;
    for (int i = 0; i < J.columns; ++i) dq[i] = 0;
    for (int j = 0; j < J.columns; ++j) {
        const double s2 = J.sigma[j] * J.sigma[j];
        if (J.sigma[j] <= tolerance::free_joint) continue;
        const double along = dot_n(J.us[j], error.e, 6) / (s2 + damping);
        for (int i = 0; i < J.columns; ++i) dq[i] += along * J.v[j][i];
    }
}

inline int weakest_direction(const PoseSvd& J) {
    int k = 0;
    for (int j = 1; j < J.columns; ++j)
        if (J.sigma[j] < J.sigma[k]) k = j;
    return k;
}

// Applies a step, shortened to a stride; returns the remaining error.
inline double take_step(const Chain& chain, const Posed& goal, double length, const double* from,
                        const double* dq, double* to, PoseError& error) {
    constexpr double stride = 0.3;
    double reach = 0;
    for (int i = 0; i < chain.n; ++i) reach = max(reach, std::fabs(dq[i]));
    const double keep = reach > stride ? stride / reach : 1.0;
    for (int i = 0; i < chain.n; ++i) to[i] = from[i] + keep * dq[i];
    measure_error(chain, goal, length, to, error);
    return size_of_error(error);
}

// Newton's method. It may leave the valley of small errors on its way: near a singularity the solution can
// lie farther along the valley than any descent would go. True if it converged; q is then a solution, else
// unchanged.
inline bool newton(const Chain& chain, const Posed& goal, double length, double* q, PoseError& error) {
    constexpr int most_steps = 16;
    constexpr double settled = 1e-15, arrived = 1e-12;
    double best[max_joints], at[max_joints];
    for (int i = 0; i < chain.n; ++i) best[i] = at[i] = q[i];
    measure_error(chain, goal, length, at, error);
    double least = min(size_of_error(error), 1.0);
    for (int step = 0; step < most_steps && least >= settled; ++step) {
        double dq[max_joints];
        decompose(error.jacobian);
        damped_step(error, 0, dq);
        const double size = take_step(chain, goal, length, at, dq, at, error);
        const bool better = size < least;
        if (better) {
            least = size;
            for (int i = 0; i < chain.n; ++i) best[i] = at[i];
        }
        if (least < settled || (least < arrived && !better)) break;
    }
    if (!(least < arrived)) return false;
    for (int i = 0; i < chain.n; ++i) q[i] = best[i];
    return true;
}

// Newton's step without its component along the weakest direction: to the floor of the valley, not along it.
inline void step_to_floor(const PoseError& error, int weak, double* dq) {
    const PoseSvd& J = error.jacobian;
    for (int i = 0; i < J.columns; ++i) dq[i] = 0;
    for (int j = 0; j < J.columns; ++j) {
        if (j == weak || J.sigma[j] <= tolerance::free_joint) continue;
        const double part = dot_n(J.us[j], error.e, 6) / (J.sigma[j] * J.sigma[j]);
        for (int i = 0; i < J.columns; ++i) dq[i] += part * J.v[j][i];
    }
}

// In a valley with an almost flat floor, Newton's steps along the floor leave it sideways by more than the
// error on the floor. Here steps to the floor and along it alternate. For six joints; true if it converged, q
// is then a solution, else unchanged.
inline bool follow_valley(const Chain& chain, const Posed& goal, double length, double* q, PoseError& error) {
    constexpr int most_steps = 96;
    constexpr double narrow = 1e-2, settled = 1e-15, arrived = 1e-12;
    double at[max_joints], size = 1;
    for (int i = 0; i < chain.n; ++i) at[i] = q[i];
    measure_error(chain, goal, length, at, error);
    for (int step = 0; step < most_steps; ++step) {
        size = size_of_error(error);
        if (size < settled) break;
        PoseSvd& J = error.jacobian;
        decompose(J);
        const int weak = weakest_direction(J);
        if (!(J.sigma[weak] < narrow) || J.sigma[weak] <= tolerance::free_joint) break;
        const double along = dot_n(J.us[weak], error.e, 6) / J.sigma[weak];
        const bool on_floor = size * size < 1.01 * along * along;
        double dq[max_joints];
        step_to_floor(error, weak, dq);
        for (int i = 0; i < chain.n && on_floor; ++i) dq[i] += along / J.sigma[weak] * J.v[weak][i];
        take_step(chain, goal, length, at, dq, at, error);
    }
    if (!(size < arrived)) return false;
    for (int i = 0; i < chain.n; ++i) q[i] = at[i];
    return true;
}

// Moves q to the nearest configuration that reaches the goal, or to a local minimum of the error, by damped
// least squares; returns the remaining error. On return `error` belongs to q and its Jacobian is decomposed.
// Damping by the square of the error converges fast to a self-motion (Yamashita & Fukushima 2001). Larger
// damping starts at the square of the smallest singular value, where it begins to restrain the weakest
// direction.
inline double descend(const Chain& chain, const Posed& goal, double length, double* q, PoseError& error,
                      int most_steps) {
    constexpr double settled = 1e-15, noise = 1e-13;
    constexpr double growth = 4;
    double damping = 0, grow = growth;
    int stalls = 0;
    measure_error(chain, goal, length, q, error);
    double size = size_of_error(error);
    decompose(error.jacobian);
    for (int step = 0; step < most_steps && size > settled && stalls < 6; ++step) {
        double dq[max_joints], next[max_joints];
        PoseError trial;
        damped_step(error, damping + size * size, dq);
        const double trial_size = take_step(chain, goal, length, q, dq, next, trial);
        const bool closer = trial_size < size, stalled = trial_size > 0.99 * size;
        const double sigma = error.jacobian.sigma[weakest_direction(error.jacobian)];
        if (!closer && (size < noise || damping > 1e3)) break;
        if (closer) {
            for (int i = 0; i < chain.n; ++i) q[i] = next[i];
            error = trial;
            decompose(error.jacobian);
            size = trial_size;
            stalls = stalled ? stalls + 1 : 0;
        }
        if (!stalled) {
            damping *= 0.1;
            grow = growth;
        } else if (size > noise) {
            // It may have to rise by many powers of ten (Nielsen 1999).
            damping = max(grow * damping, max(0.1 * sigma * sigma, 1e-20));
            grow *= growth;
        }
    }
    return size;
}

// Refines a candidate to a solution, or as near to one as descent leads.
inline double refine(const Chain& chain, const Posed& goal, double length, double* q, PoseError& error,
                     int most_steps = 60) {
    const bool arrived = newton(chain, goal, length, q, error) ||
                         (chain.n == 6 && follow_valley(chain, goal, length, q, error));
    return descend(chain, goal, length, q, error, arrived ? 2 : most_steps);
}

}  // namespace cspace::ik::inline CSPACE_ISA
