// Refinement of a candidate to a solution on the true chain: damped least squares on the pose error
// (Levenberg 1944, Nakamura & Hanafusa 1986), and conditioning and null space from the Jacobian there.
#pragma once

#include "cspace/ik/dh_form.hpp"
#include "cspace/math/least_squares.hpp"
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

// The smallest singular value with its vectors: J v = σ u.
struct WeakDirection {
    double sigma, v[6], u[6];
    bool settled = false;  // whether the iteration told it from the next one
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
    for (int i = 0; i < chain.n; ++i)
        write_twist(kinematics::joint_twist(chain.prismatic[i], axis[i], point[i], T.t), 1 / length,
                    out.jacobian.us[i]);
}

// The size of the error of a configuration, the rotation to first order.
inline double miss_of(const Chain& chain, const Posed& goal, double length, const double* q) {
    double e[6];
    tip_error(forward_kinematics(chain, q), goal, length, e);
    return std::sqrt(dot_n(e, e, 6));
}

inline double size_of_error(const PoseError& error) { return std::sqrt(dot_n(error.e, error.e, 6)); }

// The damped least-squares step from a decomposed Jacobian. The step has no component in the null space: the
// remaining error there is rounding, and would move joints along their self-motion.
inline void damped_pose_step(const PoseError& error, double damping, double* dq) {
    least_norm_step(error.jacobian, error.e, damping, tolerance::free_joint, -1, dq);
}
// Newton's step without its component along the weakest direction: to the floor of the valley, not along it.
inline void step_to_floor(const PoseError& error, int weak, double* dq) {
    least_norm_step(error.jacobian, error.e, 0, tolerance::free_joint, weak, dq);
}

// Newton's step by QR decomposition, from a Jacobian that is not decomposed; by its singular values if it is
// nearly singular or has more columns than rows.
inline void newton_pose_step(PoseError& error, double* dq) {
    constexpr double regular = 1e-6;  // of the diagonal of R
    const int n = error.jacobian.columns;
    double A[6][6], diagonal[6], factor[6], b[6], least = 1e300, largest = 0;
    for (int i = 0; i < 6 && n <= 6; ++i) {
        for (int j = 0; j < n; ++j) A[i][j] = error.jacobian.us[j][i];
        b[i] = error.e[i];
    }
    for (int k = 0; k < n && n <= 6; ++k) {
        linear::reduce_column(A, 6, n, k, diagonal[k], factor[k]);
        linear::reflect_vector(A, 6, k, factor[k], b);
        least = min(least, std::fabs(diagonal[k]));
        largest = max(largest, std::fabs(diagonal[k]));
    }
    if (n > 6 || !(least > regular * largest)) {
        decompose_matrix(error.jacobian);
        damped_pose_step(error, 0, dq);
        return;
    }
    for (int k = n - 1; k >= 0; --k) {
        dq[k] = b[k];
        for (int j = k + 1; j < n; ++j) dq[k] -= A[k][j] * dq[j];
        dq[k] /= diagonal[k];
    }
}

// The direction in which an arm of six joints can hardly move its tip, by inverse iteration on the Jacobian.

inline double make_unit6(double* v) {
    const double size = std::sqrt(dot_n(v, v, 6));
    for (int i = 0; i < 6; ++i) v[i] /= size > 0 ? size : 1;
    return size;
}

// J = Q R of a Jacobian of six columns, as of linear::factor_qr.
struct SquareQr {
    double A[6][6], diagonal[6], factor[6];
};
inline SquareQr factor_jacobian(const PoseSvd& jacobian) {
    SquareQr out;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) out.A[i][j] = jacobian.us[j][i];
    linear::factor_qr(out.A, out.diagonal, out.factor);
    double floor = 0;
    for (const double d : out.diagonal) floor = max(floor, tolerance::last_digits * std::fabs(d));
    for (double& d : out.diagonal)
        if (std::fabs(d) < floor) d = std::copysign(floor, d);
    return out;
}
// x := R⁻¹ x and x := R⁻ᵀ x.
inline void solve_upper(const SquareQr& qr, double* x) {
    for (int k = 5; k >= 0; --k) {
        for (int j = k + 1; j < 6; ++j) x[k] -= qr.A[k][j] * x[j];
        x[k] /= qr.diagonal[k];
    }
}
inline void solve_lower(const SquareQr& qr, double* x) {
    for (int k = 0; k < 6; ++k) {
        for (int j = 0; j < k; ++j) x[k] -= qr.A[j][k] * x[j];
        x[k] /= qr.diagonal[k];
    }
}

// A bound below the smallest singular value: the five others multiply to at most the fifth power of their
// mean square's root.
inline double bound_weakest(const SquareQr& qr, const PoseSvd& jacobian) {
    double squares = 0, determinant = 1;
    for (int j = 0; j < 6; ++j) {
        squares += dot_n(jacobian.us[j], jacobian.us[j], 6) / 5;
        determinant *= std::fabs(qr.diagonal[j]);
    }
    return determinant / (squares * squares * std::sqrt(squares));
}
inline WeakDirection weak_direction(const SquareQr& qr) {
    constexpr double alone = 1e-6;  // relative change of 1/σ², the square of that of the direction
    WeakDirection out{1, {0.41, -0.37, 0.43, 0.31, -0.47, 0.45}, {}};
    double growth = 1;
    for (int step = 0; step < 4; ++step) {
        make_unit6(out.v);
        solve_lower(qr, out.v);
        for (int k = 0; k < 6; ++k) out.u[k] = out.v[k];
        solve_upper(qr, out.v);
        const double before = growth;
        growth = make_unit6(out.v);
        out.settled = std::fabs(growth - before) < alone * growth;
    }
    out.sigma = 1 / std::sqrt(growth);
    make_unit6(out.u);
    for (int k = 5; k >= 0; --k) linear::reflect_vector(qr.A, 6, k, qr.factor[k], out.u);
    return out;
}
// Of a Jacobian of six columns that is not decomposed. Where sigma is certainly above `enough`, a bound below
// it is returned, without directions.
inline WeakDirection weak_direction(const PoseSvd& jacobian,
                                    double enough = std::numeric_limits<double>::infinity()) {
    const SquareQr qr = factor_jacobian(jacobian);
    const double bound = bound_weakest(qr, jacobian);
    return bound > enough ? WeakDirection{bound, {}, {}} : weak_direction(qr);
}

// Applies a step, shortened to a stride; returns the remaining error.
inline double take_step(const Chain& chain, const Posed& goal, double length, const double* from,
                        const double* dq, double* to, PoseError& error) {
    constexpr double stride = 0.3;
    const double keep = shortening_factor(largest_of(dq, chain.n), stride);
    for (int i = 0; i < chain.n; ++i) to[i] = from[i] + keep * dq[i];
    measure_error(chain, goal, length, to, error);
    return size_of_error(error);
}

// Newton's method. Towards a double root it halves the distance and quarters the error with each step; twice
// the step then squares the distance (Schröder 1870). It may leave the valley of small errors on its way:
// near a singularity the solution can lie farther along the valley than any descent would go. True if it
// converged; q is then a solution, else unchanged.
inline bool solve_by_newton(const Chain& chain, const Posed& goal, double length, double* q,
                            PoseError& error) {
    constexpr int most_steps = 16;
    constexpr double settled = tolerance::last_digits, arrived = 1e-12;
    double best[max_joints], at[max_joints];
    for (int i = 0; i < chain.n; ++i) best[i] = at[i] = q[i];
    measure_error(chain, goal, length, at, error);
    double last = size_of_error(error), least = min(last, 1.0);
    bool halving = false;
    for (int step = 0; step < most_steps && least >= settled; ++step) {
        double dq[max_joints];
        newton_pose_step(error, dq);
        for (int i = 0; i < chain.n && halving; ++i) dq[i] *= 2;
        const double size = take_step(chain, goal, length, at, dq, at, error);
        halving = !halving && size > 0.2 * last && size < 0.3 * last;
        last = size;
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

// The step of a valley: to its floor, and along it from the floor on. False where the smallest singular value
// is not between rounding and `narrow`.
inline bool step_in_valley(PoseError& error, double narrow, double* dq) {
    PoseSvd& J = error.jacobian;
    const SquareQr qr = factor_jacobian(J);
    if (bound_weakest(qr, J) > narrow) return false;
    WeakDirection weak = weak_direction(qr);
    if (!weak.settled) {
        PoseSvd whole = J;
        decompose_matrix(whole);
        const int k = weakest_direction(whole);
        weak.sigma = whole.sigma[k];
        for (int i = 0; i < 6; ++i) {
            weak.v[i] = whole.v[k][i];
            weak.u[i] = whole.us[k][i] / (weak.sigma > 0 ? weak.sigma : 1);
        }
    }
    if (!(weak.sigma < narrow) || weak.sigma <= tolerance::free_joint) return false;
    const double along = dot_n(weak.u, error.e, 6);
    const bool on_floor = dot_n(error.e, error.e, 6) < 1.01 * along * along;
    for (int i = 0; i < 6; ++i) dq[i] = error.e[i] - along * weak.u[i];
    for (int k = 0; k < 6; ++k) linear::reflect_vector(qr.A, 6, k, qr.factor[k], dq);
    solve_upper(qr, dq);
    const double shift = (on_floor ? along / weak.sigma : 0) - dot_n(weak.v, dq, 6);
    for (int i = 0; i < 6; ++i) dq[i] += shift * weak.v[i];
    return true;
}

// In a valley with an almost flat floor, Newton's steps along the floor leave it sideways by more than the
// error on the floor. Here steps to the floor and along it alternate. For six joints; true if it converged, q
// is then a solution, else unchanged.
inline bool follow_valley(const Chain& chain, const Posed& goal, double length, double* q, PoseError& error) {
    constexpr int most_steps = 96;
    constexpr int patience = 4;  // steps that do not halve the error where it is rounding
    constexpr double narrow = 1e-2, settled = tolerance::last_digits, arrived = 1e-12;
    constexpr int stagnation = 20;  // steps that do not halve the error on the way
    double at[max_joints], best[max_joints], least = arrived, halved = 1e300;
    int halved_at = 0;
    for (int i = 0; i < chain.n; ++i) at[i] = q[i];
    measure_error(chain, goal, length, at, error);
    for (int step = 0, waited = 0; step < most_steps && least >= settled && waited < patience; ++step) {
        const double size = size_of_error(error);
        waited += least < arrived;
        if (size < 0.5 * halved) halved = size, halved_at = step;
        if (step - halved_at > stagnation) break;
        if (size < least) {
            if (size < 0.5 * least) waited = 0;
            least = size;
            for (int i = 0; i < chain.n; ++i) best[i] = at[i];
            if (least < settled) break;
        }
        double dq[max_joints];
        if (!step_in_valley(error, narrow, dq)) break;
        take_step(chain, goal, length, at, dq, at, error);
    }
    if (!(least < arrived)) return false;
    for (int i = 0; i < chain.n; ++i) q[i] = best[i];
    return true;
}

// The Jacobian of a descent, decomposed where its singular values are needed. The directions of the last
// decomposition shorten the next.
struct LazySvd {
    PoseSvd& jacobian;
    bool is_fresh = false, has_directions = false;

    void decompose_once() {
        if (is_fresh) return;
        decompose_matrix(jacobian, has_directions);
        is_fresh = has_directions = true;
    }
};

// What measure_error has written.
inline void copy_measured(const PoseError& from, PoseError& to) {
    for (int k = 0; k < 6; ++k) to.e[k] = from.e[k];
    to.position = from.position;
    to.rotation = from.rotation;
    for (int i = 0; i < from.jacobian.columns; ++i)
        for (int k = 0; k < 6; ++k) to.jacobian.us[i][k] = from.jacobian.us[i][k];
}

// Moves q to the nearest configuration that reaches the goal, or to a local minimum of the error, by damped
// least squares; returns the remaining error. On return `error` belongs to q and its Jacobian is decomposed.
// Damping by the square of the error converges fast to a self-motion (Yamashita & Fukushima 2001). Larger
// damping starts at the square of the smallest singular value, where it begins to restrain the weakest
// direction.
inline double descend_to_goal(const Chain& chain, const Posed& goal, double length, double* q,
                              PoseError& error, int most_steps, double settled = tolerance::last_digits) {
    constexpr double noise = 1e-13;
    constexpr double coarse = 1e-20;         // damping above which a free joint is at rest
    constexpr double least_damping = 1e-20;  // rises to one within thirty steps
    constexpr double growth = 4;
    double damping = 0, grow = growth;
    int stalls = 0;
    LazySvd svd{error.jacobian};
    measure_error(chain, goal, length, q, error);
    double size = size_of_error(error);
    for (int step = 0; step < most_steps && size > settled && stalls < 6; ++step) {
        double dq[max_joints], next[max_joints];
        PoseError trial;
        const double damped = damping + size * size;
        if (svd.is_fresh || damped < coarse) {
            svd.decompose_once();
            damped_pose_step(error, damped, dq);
        } else {
            damped_step_by_reflections(error.jacobian.columns, error.jacobian.us, error.e, damped, dq);
        }
        const double trial_size = take_step(chain, goal, length, q, dq, next, trial);
        const bool closer = trial_size < size, stalled = trial_size > 0.99 * size;
        if (!closer && (size < noise || damping > 1e3)) break;
        double sigma = 0;
        if (stalled) {
            svd.decompose_once();
            sigma = error.jacobian.sigma[weakest_direction(error.jacobian)];
        }
        if (closer) {
            for (int i = 0; i < chain.n; ++i) q[i] = next[i];
            copy_measured(trial, error);
            svd.is_fresh = false;
            size = trial_size;
            stalls = stalled ? stalls + 1 : 0;
        }
        if (!stalled) {
            damping *= 0.1;
            grow = growth;
        } else if (size > noise) {
            // It may have to rise by many powers of ten (Nielsen 1999).
            damping = max(grow * damping, max(0.1 * sigma * sigma, least_damping));
            grow *= growth;
        }
    }
    svd.decompose_once();
    return size;
}

// Refines a candidate to a solution, or as near to one as descent leads.
inline double refine_solution(const Chain& chain, const Posed& goal, double length, double* q,
                              PoseError& error, int most_steps = 60) {
    const bool arrived = solve_by_newton(chain, goal, length, q, error) ||
                         (chain.n == 6 && follow_valley(chain, goal, length, q, error));
    return arrived ? descend_to_goal(chain, goal, length, q, error, 2, tolerance::rounding)
                   : descend_to_goal(chain, goal, length, q, error, most_steps);
}

// Two Newton steps on the true chain, on lanes. They remove the error of a closed form for an idealised or
// ill-conditioned geometry. The second step shows whether the first has converged.

// One step of q (n = 6) to the goal, shortened if a joint would rotate by more than `stride` [rad]. Returns
// the largest joint change of the full step. Prismatic joints are divided by `length`.
template <class V>
CSPACE_NOINLINE V newton_step(const Chain& chain, const Pose<V>& goal, double length, V* q,
                              double stride = 1e300) {
    Vec3<V> axis[6], point[6];
    const auto keep_axis = [&](int i, const Vec3<V>& h, const Vec3<V>& p) { axis[i] = h, point[i] = p; };
    const Pose<V> T = move_joints(chain, 6, q, keep_axis) * fill_pose<V>(chain.tip);
    V A[6][6], b[6], twist[6];
    const V aligned = tip_error(T, goal, length, b);
    for (int i = 0; i < 6; ++i) {
        write_twist(kinematics::joint_twist(chain.prismatic[i], axis[i], point[i], T.t),
                    chain.prismatic[i] ? 1 : 1 / length, twist);
        for (int k = 0; k < 6; ++k) A[k][i] = twist[k];
    }
    solve_linear(A, b);
    const V largest = largest_of(b, 6), keep = shortening_factor(largest, stride);
    for (int i = 0; i < 6; ++i) q[i] = mul_add(chain.prismatic[i] ? length * keep : keep, b[i], q[i]);
    // Half a turn off, the sum of cross products vanishes as at the goal: nothing beyond a right angle has
    // settled.
    return select_lanes(aligned < 1.0, max(largest, fill_lanes<V>(1.0)), largest);
}

// Descents abreast by damped least squares, six joints, from q to where the error is small or stops
// decreasing: the damping of descend_to_goal, the steps from the normal equations, whose accuracy suffices to
// come near. Returns the size of the error, the rotation as twice the sine of half its angle.
template <class V>
CSPACE_NOINLINE V descend_abreast(const Chain& chain, const Posed& goal, double length, V* q,
                                  int most_steps) {
    constexpr double stride = 0.3, near = 1e-9, growth = 4, least_damping = 1e-4, half_turn = 1e-12;
    const Pose<V> goals = fill_pose<V>(goal);
    V A[6][6] = {}, b[6] = {}, next[6], damping = fill_lanes<V>(0.0), best2 = fill_lanes<V>(1e300);
    for (int i = 0; i < 6; ++i) next[i] = q[i];
    for (int step = 0; step <= most_steps; ++step) {
        Vec3<V> axis[6], point[6];
        const auto keep_axis = [&](int i, const Vec3<V>& h, const Vec3<V>& p) { axis[i] = h, point[i] = p; };
        const Pose<V> T = move_joints(chain, 6, next, keep_axis) * fill_pose<V>(chain.tip);
        V e[6], J[6][6], size2 = fill_lanes<V>(0.0);
        const V trace = tip_error(T, goals, length, e);
        const V scale = 2.0 / sqrt(max(1.0 + trace, fill_lanes<V>(half_turn)));
        for (int k = 3; k < 6; ++k) e[k] = scale * e[k];
        for (int k = 0; k < 6; ++k) size2 = mul_add(e[k], e[k], size2);
        const mask_of<V> closer = size2 < best2;
        best2 = select_lanes(closer, size2, best2);
        for (int i = 0; i < 6; ++i) q[i] = select_lanes(closer, next[i], q[i]);
        if (!any(best2 > near * near) || step == most_steps) break;
        damping = select_lanes(closer, 0.1 * damping, max(growth * damping, fill_lanes<V>(least_damping)));
        for (int i = 0; i < 6; ++i)
            write_twist(kinematics::joint_twist(chain.prismatic[i], axis[i], point[i], T.t), 1 / length,
                        J[i]);
        V factored[6][6], dq[6];
        for (int i = 0; i < 6; ++i) {
            V along = fill_lanes<V>(0.0);
            for (int k = 0; k < 6; ++k) along = mul_add(J[i][k], e[k], along);
            b[i] = select_lanes(closer, along, b[i]);
            for (int j = i; j < 6; ++j) {
                V sum = fill_lanes<V>(0.0);
                for (int k = 0; k < 6; ++k) sum = mul_add(J[i][k], J[j][k], sum);
                A[i][j] = select_lanes(closer, sum, A[i][j]);
                factored[i][j] = i == j ? A[i][j] + damping + best2 : A[i][j];
            }
            dq[i] = b[i];
        }
        factor_ldl(factored, 6);
        solve_ldl(factored, 6, dq);
        const V keep = shortening_factor(largest_of(dq, 6), stride);
        for (int i = 0; i < 6; ++i) next[i] = mul_add(keep, dq[i], q[i]);
    }
    return sqrt(best2);
}

// True if q, a candidate near a solution, has converged to it. Others are lost: the sine of a huge angle
// takes long.
template <class V>
CSPACE_INLINE mask_of<V> polish_solution(const Chain& chain, const Pose<V>& goal, double length, V* q) {
    const V first = newton_step(chain, goal, length, q);
    const mask_of<V> is_near = first < tolerance::polish_reach;
    for (int i = 0; i < chain.n; ++i) q[i] = keep_lanes(is_near, q[i]);
    if (!any(is_near && first > tolerance::polished_at_once)) return is_near;
    return is_near && newton_step(chain, goal, length, q) < tolerance::polished;
}

// The smallest singular value of the Jacobian (lengths over `length`) at the k-th of some generic
// configurations, at which the joints with is_zero(i) are zero.
template <class IsZero>
double generic_conditioning(const Chain& chain, double length, int k, const IsZero& is_zero) {
    double q[max_joints] = {};
    spread_configuration(k, chain.n, q);
    for (int i = 0; i < chain.n; ++i)
        if (is_zero(i)) q[i] = 0;
    PoseError error;
    measure_error(chain, chain.tip, length, q, error);
    if (chain.n == 6) return weak_direction(error.jacobian).sigma;
    decompose_matrix(error.jacobian);
    return error.jacobian.sigma[weakest_direction(error.jacobian)];
}

// Whether an arm has a redundant joint (two wrists, a wrist on axis 3, four parallel axes). Then each of its
// poses is singular, to within `blind`, and no list of solutions is complete.
inline bool is_always_singular(const Chain& chain, double length, double blind) {
    for (int k = 0; k < 8; ++k)
        if (generic_conditioning(chain, length, k, [](int) { return false; }) > blind) return false;
    return true;
}

// How well an arm that virtual joints complete is conditioned where they are zero: the median. Where it is
// more than `regular_enough` the branches of the completed arm coincide with those of the arm.
inline constexpr double regular_enough = 1e-3;  // as of real arms
template <class IsVirtual>
double completed_conditioning(const Chain& six, double length, const IsVirtual& is_virtual) {
    constexpr int trials = 5;
    double sigma[trials];
    for (int k = 0; k < trials; ++k) {
        const double value = generic_conditioning(six, length, k, is_virtual);
        int at = k;
        for (; at > 0 && sigma[at - 1] > value; --at) sigma[at] = sigma[at - 1];
        sigma[at] = value;
    }
    return sigma[trials / 2];
}

}  // namespace cspace::ik::inline CSPACE_ISA
