// Levenberg–Marquardt descent for many starts in parallel, one per lane: Newton's method and damped least
// squares on the pose error, within joint limits if there are any. A lane that has finished takes the next
// start at once. Lanes are independent: the result of a start does not depend on the other starts.
//
// The damping follows the error, λ = μ |e|². Successful steps decrease μ, and unsuccessful steps increase it
// (Yamashita & Fukushima 2001; Fan 2006). Convergence is quadratic even where the Jacobian is rank-deficient.
// Limits are enforced by projection: a coordinate at its limit that the gradient pushes outward stays fixed,
// the others step, and the result is clipped to the box (Bertsekas 1982).
#pragma once

#include <cstdint>

#include "cspace/ik/goal.hpp"
#include "cspace/ik/numeric/error.hpp"
#include "cspace/math/least_squares.hpp"

namespace cspace::ik {

struct DescentEnd {
    Ending ending = Ending::unknown;
    std::int32_t steps = 0;             // how many it took
    double cost = 0;                    // ½ |e|²
    double position = 0, rotation = 0;  // errors left [m, rad]
};

// Items k = 0 … count − 1: item k is row `pick[k]`, or k where pick is null. A stride is the number of values
// per row, and 0 where all rows share one.
struct DescentRows {
    const Path* path;
    const Task* task;
    const double* goals;  // T_base_tip, 16 numbers each
    std::size_t goal_stride;
    const double* starts;  // (n,) each
    std::size_t start_stride;
    const std::int64_t* pick;
    std::size_t count;
    bool first_only;  // stop as soon as the first item that reaches its goal is known
    // Outputs, one per row; a row that is there already (ending < unknown) is replaced by a better one alone.
    double* q;  // (n,) each
    DescentEnd* ends;
};

// The lanes of a descent.
template <class V>
struct Descent {
    Pose<V> T_goal_first;
    V q[max_joints], trial[max_joints];
    Gap<V> at, there;  // at q, and at the trial
    V cost, mu, slow, steps;
    V fresh, near;  // 1 or 0: just begun; within the tolerance already
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

namespace descent {
inline constexpr double first_mu = 0.1, least_mu = 1e-7, largest_mu = 1e7;
inline constexpr double gained = 0.5, lost = 4.0;
inline constexpr double stride =
    2.0;  // largest change of a coordinate in one step [rad, lengths of the path]
// A step that leaves more than this fraction of the cost makes no progress. After several such steps in a row
// the descent ends.
inline constexpr double nothing = 0.97;
inline constexpr double patience = 5.0;
// An error this small is rounding [rad, m over the length]: further steps cannot reduce it.
inline constexpr double rounding = 1e-14;
// Relative regularisation of Newton's normal equations, as a fraction of their trace. It bounds the step at a
// singular Jacobian.
inline constexpr double newton_floor = 1e-15;
inline constexpr double never_zero = 1e-30;  // damping that bounds the step where all rows vanish
}  // namespace descent

// Evaluates the trial. It becomes the current iterate if it is better, or if it must be accepted.
template <class V>
CSPACE_INLINE void take_trial(const Path& path, const Rows& rows, bool always, Descent<V>& d) {
    V cost = fill_lanes<V>(0.0);
    for (int r = 0; r < rows.m; ++r) cost = mul_add(0.5 * d.there.e[r], d.there.e[r], cost);
    const mask_of<V> begun = d.fresh > 0.5;
    const mask_of<V> better = begun || (cost < d.cost), taken = always ? cost == cost : better;
    const mask_of<V> gains = begun || (cost < descent::nothing * d.cost);
    d.slow = keep_lanes(!gains, d.slow + 1.0);
    const V mu = select_lanes(taken, max(descent::gained * d.mu, fill_lanes<V>(descent::least_mu)),
                              descent::lost * d.mu);
    d.mu = select_lanes(begun, fill_lanes<V>(descent::first_mu), mu);
    d.cost = select_lanes(taken, cost, d.cost);
    d.at.position = select_lanes(taken, d.there.position, d.at.position);
    d.at.rotation = select_lanes(taken, d.there.rotation, d.at.rotation);
    for (int j = 0; j < path.n; ++j) d.q[j] = select_lanes(taken, d.trial[j], d.q[j]);
    for (int r = 0; r < rows.m; ++r) {
        d.at.e[r] = select_lanes(taken, d.there.e[r], d.at.e[r]);
        for (int j = 0; j < path.n; ++j) d.at.J[r][j] = select_lanes(taken, d.there.J[r][j], d.at.J[r][j]);
    }
    d.steps = keep_lanes(!begun, d.steps + 1.0);
    d.fresh = fill_lanes<V>(0.0);
}

// The lanes that have finished. A descent within the tolerance continues while it makes good progress: the
// last steps cost little and reduce the error to rounding.
template <class V>
CSPACE_INLINE mask_of<V> find_ended(const Path& path, const Task& task, Descent<V>& d) {
    const V gap = max(d.at.position, d.at.rotation);
    const mask_of<V> inside = gap <= task.tolerance;
    const mask_of<V> settled =
        inside &&
        ((d.near > 0.5) || (max(d.at.position * (1 / path.length), d.at.rotation) <= descent::rounding));
    d.near = keep_lanes(inside, fill_lanes<V>(1.0));
    const mask_of<V> stalled = (d.slow >= descent::patience) || (d.mu > descent::largest_mu);
    return settled || stalled || (d.steps >= double(task.most_steps));
}

// The next trial of each lane.
template <class V>
CSPACE_INLINE void next_trial(const Path& path, const Task& task, const Rows& rows, Descent<V>& d) {
    V loose[max_joints], dx[max_joints];
    const V one = fill_lanes<V>(1.0), zero = fill_lanes<V>(0.0);
    for (int j = 0; j < path.n; ++j) {
        loose[j] = one;
        if (!task.limited) continue;
        V pull = zero;
        for (int r = 0; r < rows.m; ++r) pull = mul_add(d.at.J[r][j], d.at.e[r], pull);
        const mask_of<V> active =
            ((d.q[j] <= task.lower[j]) && (pull < 0.0)) || ((d.q[j] >= task.upper[j]) && (pull > 0.0));
        loose[j] = select_lanes(active, zero, one);
    }
    V damping = 2.0 * d.mu * d.cost + descent::never_zero;
    if (task.method == Method::newton) {
        damping = fill_lanes<V>(descent::never_zero);
        for (int r = 0; r < rows.m; ++r)
            for (int j = 0; j < path.n; ++j)
                damping = mul_add(descent::newton_floor * d.at.J[r][j], d.at.J[r][j], damping);
    }
    damped_step(rows.m, path.n, d.at.J, d.at.e, loose, damping, dx);
    const V keep = shortening_factor(largest_of(dx, path.n), descent::stride);
    for (int j = 0; j < path.n; ++j) {
        V to = mul_add(keep * unit_of(path, j), dx[j], d.q[j]);
        if (task.limited) to = min(max(to, fill_lanes<V>(task.lower[j])), fill_lanes<V>(task.upper[j]));
        d.trial[j] = to;
    }
}

// Loads row `row` into lane l.
template <class V>
void begin_lane(const DescentRows& rows, std::size_t row, int l, Descent<V>& d) {
    const Posed goal = read_goal(rows.goals + row * rows.goal_stride).T;
    const double* start = rows.starts + row * rows.start_stride;
    set_pose_lane(d.T_goal_first, l, inverse(goal) * rows.path->T_base_first);
    for (int j = 0; j < rows.path->n; ++j) {
        double q = start[j];
        if (rows.task->limited) q = min(max(q, rows.task->lower[j]), rows.task->upper[j]);
        set_lane(d.trial[j], l, q);
    }
    set_lane(d.fresh, l, 1.0);
    set_lane(d.near, l, 0.0);
    set_lane(d.slow, l, 0.0);
}

// Writes the result of lane l to row `row`; true if it reaches the goal.
template <class V>
bool end_lane(const DescentRows& rows, std::size_t row, int l, const Descent<V>& d) {
    const double position = get_lane(d.at.position, l), rotation = get_lane(d.at.rotation, l),
                 cost = get_lane(d.cost, l);
    const bool reached = position <= rows.task->tolerance && rotation <= rows.task->tolerance;
    DescentEnd& end = rows.ends[row];
    const bool known = end.ending != Ending::unknown;
    if (known && (end.ending == Ending::reached || !(cost < end.cost))) return reached;
    const auto steps = std::int32_t(get_lane(d.steps, l));
    const Ending missed = steps >= rows.task->most_steps ? Ending::exhausted : Ending::stalled;
    end = {reached ? Ending::reached : missed, steps, cost, position, rotation};
    for (int j = 0; j < rows.path->n; ++j)
        rows.q[row * std::size_t(rows.path->n) + std::size_t(j)] = get_lane(d.q[j], l);
    return reached;
}

template <class V>
void run_descents(const DescentRows& rows) {
    constexpr int lanes = Lanes<V>::count;
    const Rows counted = rows_of(*rows.task);
    const bool always = rows.task->method == Method::newton;
    Descent<V> d;
    for (V& x : d.trial) x = fill_lanes<V>(0.0);
    d.T_goal_first = fill_pose<V>(rows.path->T_base_first);
    d.cost = d.mu = d.slow = d.steps = d.near = fill_lanes<V>(0.0);
    d.fresh = fill_lanes<V>(1.0);
    std::size_t item[lanes], next = 0, stop = rows.count;
    bool live[lanes];
    const auto row_of = [&](std::size_t k) { return rows.pick ? std::size_t(rows.pick[k]) : k; };
    const auto refill = [&](int l) {
        live[l] = next < stop;
        if (!live[l]) return;
        item[l] = next++;
        begin_lane(rows, row_of(item[l]), l, d);
    };
    for (int l = 0; l < lanes; ++l) refill(l);
    for (;;) {
        measure_gap(*rows.path, counted, d.T_goal_first, d.trial, d.there);
        take_trial(*rows.path, counted, always, d);
        const mask_of<V> done = find_ended(*rows.path, *rows.task, d);
        next_trial(*rows.path, *rows.task, counted, d);
        if (!any(done)) continue;
        bool alive = false;
        for (int l = 0; l < lanes; ++l) {
            if (live[l] && get_lane(done, l)) {
                if (end_lane(rows, row_of(item[l]), l, d) && rows.first_only && item[l] < stop)
                    stop = item[l];
                refill(l);
            }
            live[l] = live[l] && item[l] < stop;
            alive = alive || live[l];
        }
        if (!alive) return;
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
