// The nearest configuration of the whole self-motion manifold. Coarse samples over the locked joints give the
// starts, and Newton's method on the distance refines them. A weighted joint cannot be farther away than the
// best distance found so far. This bound reduces the search from a nearby seed to a few samples.
#pragma once

#include <algorithm>

#include "cspace/ik/redundancy/narrow_valleys.hpp"
#include "cspace/ik/redundancy/nearest_proof.hpp"
#include "cspace/ik/redundancy/tip_jacobian.hpp"
#include "cspace/ik/redundancy/turning_points.hpp"
#include "cspace/math/linear.hpp"
#include "cspace/math/turn.hpp"

namespace cspace::ik {

// The best starts so far, by distance from the seed.
struct Starts {
    static constexpr int room = 12;
    int count = 0;
    double q[room][max_joints];
    double distance[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The configuration of the self-motion manifold that is nearest to a seed: sequential quadratic programming
// with exact second derivatives (Nocedal & Wright 2006, chapter 18). It converges quadratically from a start
// in the basin of the minimum.

// q − seed, by the shorter way for revolute joints.
template <int N = 0, class V>
CSPACE_INLINE void from_seed(const Chain& chain, const double* seed, const double* weight, const V* q,
                             V* gap) {
    const int n = size_or<N>(chain.n);
    for (int i = 0; i < n; ++i) gap[i] = weight[i] * joint_difference(chain, i, q[i] - fill<V>(seed[i]));
}

// H d for the Hessian of the Lagrangian ½ Σ w (q − seed)² − λ · pose(q). The pose's second derivative by q_i
// and q_j, i ≤ j, is [axis i × column j; ½ axis i × axis j].
template <int N, class V>
CSPACE_INLINE void lagrangian_times(const Chain& chain, const TipMotion<V>& motion, const double* weight,
                                    const V* lambda, const V* d, V* out) {
    const int n = size_or<N>(chain.n);
    const Vec3<V> force = {lambda[0], lambda[1], lambda[2]};
    const Vec3<V> moment = {0.5 * lambda[3], 0.5 * lambda[4], 0.5 * lambda[5]};
    // force · (h_i × v_j) = v_j · (force × h_i), so that one running sum serves the rows above and one those
    // below.
    const V zero = fill<V>(0.0);
    Vec3<V> lever[max_joints], twist[max_joints], turned = {zero, zero, zero}, twisted = turned;
    for (int j = 0; j < n; ++j) {
        const V* c = motion.column[j];
        const Vec3<V> v = {c[0], c[1], c[2]}, h = {c[3], c[4], c[5]};
        lever[j] = cross(force, h);
        twist[j] = cross(moment, h);
        out[j] = weight[j] * d[j] - dot(v, turned) - dot(h, twisted);
        turned = turned + d[j] * lever[j];
        twisted = twisted + d[j] * twist[j];
    }
    Vec3<V> linear = {zero, zero, zero}, angular = linear;
    for (int i = n - 1; i >= 0; --i) {
        const V* c = motion.column[i];
        const Vec3<V> v = {c[0], c[1], c[2]}, h = {c[3], c[4], c[5]};
        linear = linear + d[i] * v;
        out[i] = out[i] - dot(linear, lever[i]) - dot(angular, twist[i]);
        angular = angular + d[i] * h;
    }
}

inline constexpr int max_free = max_joints - 1;

// One step of q to the nearest point. Returns the largest joint change of the full step. motion, lambda: the
// split Jacobian before the step, and its multipliers.
template <int N, class V>
CSPACE_NOINLINE V step_to_nearest(const Chain& chain, int rank, const Pose<V>& goal, double length,
                                  const double* seed, const double* weight, V* q, TipMotion<V>& motion,
                                  V (&lambda)[6]) {
    constexpr double stride = 0.4;
    constexpr int room = N ? N : max_joints, most_free = N ? N - 6 : max_free;
    const int n = size_or<N>(chain.n), free = N ? N - 6 : n - rank;
    SplitJacobian<V> split;
    tip_motion<N>(chain, goal, length, q, motion);
    split_jacobian<N>(motion, n, rank, split);
    V gap[room], step[room], bent[room], along[most_free][room];
    V newton[max_free], plain[max_free], H[max_free][max_free], G[max_free][max_free];
    from_seed<N>(chain, seed, weight, q, gap);
    find_multipliers<N>(split, n, gap, lambda);
    shortest_step<N>(split, n, motion.error, step);
    for (int k = 0; k < free; ++k) {
        free_direction<N>(split, n, k, along[k]);
        lagrangian_times<N>(chain, motion, weight, lambda, along[k], bent);
        newton[k] = plain[k] = fill<V>(0.0);
        for (int i = 0; i < n; ++i) {
            newton[k] = newton[k] - along[k][i] * gap[i] - bent[i] * step[i];
            plain[k] = plain[k] - along[k][i] * (gap[i] + weight[i] * step[i]);
        }
        for (int m = 0; m <= k; ++m) {
            H[m][k] = G[m][k] = fill<V>(0.0);
            for (int i = 0; i < n; ++i) {
                H[m][k] = mul_add(along[m][i], bent[i], H[m][k]);
                G[m][k] = mul_add(weight[i] * along[m][i], along[k][i], G[m][k]);
            }
        }
        G[k][k] = G[k][k] + 0.06;  // joints that do not count leave directions undecided
    }
    const mask_of<V> curved = solve_positive(H, free, newton, 0.05);
    if (!all(curved)) {
        solve_positive(G, free, plain);
        for (int k = 0; k < free; ++k) newton[k] = select(curved, newton[k], plain[k]);
    }
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < free; ++k) step[i] = mul_add(newton[k], along[k][i], step[i]);
    const V largest = largest_of(step, n), keep = shortening(largest, stride);
    for (int i = 0; i < n; ++i) q[i] = mul_add(keep, step[i], q[i]);
    return largest;
}

inline double distance_from_seed(const Redundant& arm, const double* seed, const double* q) {
    double gap[max_joints], sum = 0;
    from_seed(arm.chain, seed, arm.weight, q, gap);
    for (int i = 0; i < arm.chain.n; ++i) sum += gap[i] * gap[i];
    return std::sqrt(sum);
}

// Adds a start. If there is no room, it replaces the worst one.
inline void add_start(const Redundant& arm, Starts& starts, const double* q, double distance) {
    int at = starts.count;
    if (at == Starts::room) {
        at = 0;
        for (int k = 1; k < Starts::room; ++k)
            if (starts.distance[k] > starts.distance[at]) at = k;
        if (distance >= starts.distance[at]) return;
    } else {
        ++starts.count;
    }
    for (int i = 0; i < arm.chain.n; ++i) starts.q[at][i] = q[i];
    starts.distance[at] = distance;
}

// Keeps a start unless it is worse than all others, or lies in the valley of a better one.
inline void keep_start(const Redundant& arm, Starts& starts, const double* q, double distance) {
    constexpr double valley = 0.4;
    if (!is_allowed(arm, q)) return;
    for (int k = 0; k < starts.count; ++k) {
        if (joint_gap(arm.chain, starts.q[k], q) > valley) continue;
        if (distance >= starts.distance[k]) return;
        for (int i = 0; i < arm.chain.n; ++i) starts.q[k][i] = q[i];
        starts.distance[k] = distance;
        return;
    }
    add_start(arm, starts, q, distance);
}

inline constexpr double settled_step = 1e-6;  // squared it is the error that Newton's method leaves
inline constexpr int most_nearest_steps = 25;

// The best result of Newton's method so far.
struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    double q[max_joints];
};

// Newton's method on as many starts as V has lanes; keeps the best result that converges. rank: of the
// Jacobian along the iterates.
template <int N, class V>
inline void settle_abreast(const Redundant& arm, int rank, const Posed& goal, const double* seed,
                           const double* const* starts, int count, Nearest& best) {
    V q[max_joints], step = fill<V>(1.0);
    for (int i = 0; i < arm.chain.n; ++i)
        for (int l = 0; l < Lanes<V>::count; ++l) set_lane(q[i], l, starts[l < count ? l : 0][i]);
    const Pose<V> goals = fill_pose<V>(goal);
    TipMotion<V> motion;
    V lambda[6];
    for (int k = 0; k < most_nearest_steps && any(step > settled_step); ++k)
        step = step_to_nearest<N>(arm.chain, rank, goals, arm.length, seed, arm.weight, q, motion, lambda);
    tip_motion<N>(arm.chain, goals, arm.length, q, motion);
    double row[max_joints];
    for (int l = 0; l < count; ++l) {
        double error = 0;
        for (const V& e : motion.error) error = max(error, std::fabs(lane(e, l)));
        if (!(lane(step, l) <= settled_step) || !(error < tolerance::reached) ||
            !(lane(motion.aligned, l) > 2))
            continue;
        for (int i = 0; i < arm.chain.n; ++i) row[i] = lane(q[i], l);
        if (!is_allowed(arm, row)) continue;
        const double distance = distance_from_seed(arm, seed, row);
        if (!(distance < best.distance)) continue;
        best.distance = distance;
        for (int i = 0; i < arm.chain.n; ++i) best.q[i] = row[i];
    }
}

// On lanes where the rank is full. Otherwise the selected pose coordinates differ from start to start.
inline void settle_all(const Redundant& arm, const Posed& goal, const double* seed,
                       const double* const* starts, int count, Nearest& best) {
    const bool full = arm.rank == 6;
    const int lanes = full ? 4 : 1;
    const auto settle = !full              ? settle_abreast<0, double>
                        : arm.chain.n == 7 ? settle_abreast<7, Pack<4>>
                                           : settle_abreast<0, Pack<4>>;
    for (int first = 0; first < count; first += lanes)
        settle(arm, arm.rank, goal, seed, starts + first, std::min(lanes, count - first), best);
}

// Refines the starts whose valley may contain a point below the best one. `also`: an additional start, on the
// manifold or off it.
inline void settle_starts(const Redundant& arm, const Posed& goal, const double* seed, const Starts& starts,
                          const double* also, Nearest& best) {
    const double* chosen[Starts::room + 1];
    int count = 0;
    double nearest = best.distance;
    if (also) chosen[count++] = also;
    for (int k = 0; k < starts.count; ++k) nearest = min(nearest, starts.distance[k]);
    for (int k = 0; k < starts.count; ++k)
        if (starts.distance[k] <= 1.5 * nearest + 0.2) chosen[count++] = starts.q[k];
    settle_all(arm, goal, seed, chosen, count, best);
}

// Starts at the seed and at two points along the curve on either side of it. Their distance from the seed is
// about that of the curve, because near a singularity the curve doubles back. Returns that distance.
inline double settle_around(const Redundant& arm, const Posed& goal, const double* seed, Nearest& best) {
    const int n = arm.chain.n;
    TipMotion<double> motion;
    SplitJacobian<double> split;
    double step[max_joints], along[max_joints], beside[3][max_joints];
    tip_motion<0>(arm.chain, goal, arm.length, seed, motion);
    split_jacobian<0>(motion, n, arm.rank, split);
    shortest_step<0>(split, n, motion.error, step);
    free_direction<0>(split, n, 0, along);
    const double off = std::sqrt(dot_n(step, step, n)), far = min(0.5, 1.5 * off);
    const double* starts[4] = {seed, beside[0], beside[1], beside[2]};
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < n; ++i)
            beside[k][i] = seed[i] + (k == 0 ? far : k == 1 ? -far : 2 * far) * along[i];
    settle_all(arm, goal, seed, starts, 4, best);
    return off;
}

// The lowest samples of a curve within a window of the parameter, by a closed form on lanes.
inline void sample_window(const Redundant& arm, const Sweep& sweep, const double* seed, const double* values,
                          int count, double window, const Nearest& best, Starts& starts) {
    CurveSamples samples;
    add_samples(arm, sweep, values, nullptr, count, seed, samples);
    if (has_changes(samples)) {
        const FoldValues folds = fold_values(arm, sweep);
        double between[CurveSamples::room];
        const double at = seed[sweep.parameter];
        const int n = values_between_folds(folds, at, window, between, CurveSamples::room - 64);
        if (n > 0) {
            samples.count = 0;
            add_samples(arm, sweep, between, nullptr, n, seed, samples);
        }
    }
    divide_samples(arm, sweep, best.distance, seed, samples);
    lowest_samples(arm.chain, samples, std::isfinite(best.distance) ? best.q : nullptr,
                   [&](const double* q, double d) { add_start(arm, starts, q, d); });
}

// One redundant joint: starts at the seed, then at parameter values around the seed within the bound of the
// best solution.
inline void nearest_of_curve(const Redundant& arm, const Posed& goal, const double* seed, Nearest& best) {
    constexpr double spacing = 0.1;
    constexpr int most = 64;
    const int p = arm.locked.locked_joint[0];
    const bool slides = arm.chain.prismatic[p];
    const Domain domain = domain_of(arm, p, goal);
    const double far = slides ? max(domain.upper - seed[p], seed[p] - domain.lower) : pi;
    const double off = settle_around(arm, goal, seed, best);
    const double window = arm.weight[p] > 0 ? min(best.distance, far) : far;
    const Sweep sweep = make_sweep(arm.locked, p, goal, seed);
    const double unit = slides ? 2 * far / most : spacing;
    const int count = int(max(4.0, min(double(most), std::ceil(2 * window / unit))));
    double values[most];
    for (int k = 0; k < count; ++k) values[k] = seed[p] + window * ((2 * k + 1.0) / count - 1);
    Starts starts;
    if (sweep.on_lanes && !slides) {
        sample_window(arm, sweep, seed, values, count, window, best, starts);
    } else {
        sweep_values(sweep, values, count, [&](int, const SweptRows& rows) {
            for (int k = 0; k < rows.count; ++k)
                keep_start(arm, starts, rows.q[k], distance_from_seed(arm, seed, rows.q[k]));
        });
    }
    settle_starts(arm, goal, seed, starts, nullptr, best);
    // Close by there is more than a curve where the tip cannot move as it should: axes in line, say.
    if (best.distance > 3 * off) settle_abreast<0, double>(arm, arm.rank - 1, goal, seed, &seed, 1, best);
}

// Several redundant joints: the locked joints start at the seed, then at samples farther and farther from it.
inline void nearest_of_surface(const Redundant& arm, const Posed& goal, const double* seed, Nearest& best) {
    constexpr int most = 48;
    const LockedArm& locked = arm.locked;
    Starts starts;
    double at[max_joints], row[max_joints], spread[max_joints];
    for (int k = 0; k < most; ++k) {
        spread_configuration(k, arm.chain.n, spread);
        for (int i = 0; i < arm.chain.n; ++i) {
            const double reach = arm.chain.prismatic[i] ? arm.length / pi : 1;
            const double part = arm.weight[i] > 0 ? k / (most - 1.0) : (k > 0);
            at[i] = seed[i] + part * reach * spread[i];
        }
        const Solutions found = solve_locked(locked, goal, at, seed);
        for (int j = 0; j < found.count; ++j) {
            whole_row(locked, at, found.q[j], row);
            keep_start(arm, starts, row, distance_from_seed(arm, seed, row));
        }
        if (k >= 12 && starts.count == Starts::room) break;
    }
    settle_starts(arm, goal, seed, starts, seed, best);
}

// By descent from configurations around the seed, if no sample of the locked joints gave a solution.
inline void nearest_by_descent(const Redundant& arm, const Posed& goal, const double* seed, Nearest& best) {
    constexpr int most = 32;
    constexpr double on_floor = 1e-5;
    Starts starts;
    double q[max_joints];
    for (int k = 0; k < most; ++k) {
        spread_configuration(k, arm.chain.n, q);
        for (int i = 0; i < arm.chain.n; ++i)
            q[i] = seed[i] + (arm.chain.prismatic[i] ? arm.length / pi : k / (most - 1.0)) * q[i];
        PoseError error;
        double left = refine_solution(arm.chain, goal, arm.length, q, error);
        // On the floor of a valley that rounded axes have made: from there Newton's method goes along it.
        if (left > tolerance::reached && left < on_floor)
            left = refine_solution(arm.chain, goal, arm.length, q, error);
        if (left <= tolerance::reached) keep_start(arm, starts, q, distance_from_seed(arm, seed, q));
    }
    settle_starts(arm, goal, seed, starts, nullptr, best);
    for (int k = 0; k < starts.count; ++k) {  // at least a solution, where Newton's method did not settle
        if (!(starts.distance[k] < best.distance) || !is_allowed(arm, starts.q[k])) continue;
        best.distance = starts.distance[k];
        for (int i = 0; i < arm.chain.n; ++i) best.q[i] = starts.q[k][i];
    }
}

// Returns false if no configuration reaches the goal. q: revolute joints in (−π, π].
inline bool nearest_configuration(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    if (arm.halves.exist && nearest_by_proof(arm.halves, goal, arm.length, seed, q)) {
        for (int i = 0; i < arm.chain.n; ++i) q[i] = wrap_joint(arm.chain, i, q[i]);
        return true;
    }
    Nearest best;
    if (rank_of(arm.locked.arm) > 0 && arm.redundancy_degree > 0) {
        if (arm.redundancy_degree == 1)
            nearest_of_curve(arm, goal, seed, best);
        else
            nearest_of_surface(arm, goal, seed, best);
    }
    if (!std::isfinite(best.distance)) nearest_by_descent(arm, goal, seed, best);
    if (!std::isfinite(best.distance)) return false;
    for (int i = 0; i < arm.chain.n; ++i) q[i] = wrap_joint(arm.chain, i, best.q[i]);
    return true;
}

}  // namespace cspace::ik::inline CSPACE_ISA
