// Self-motion to a preferred posture: the configuration that reaches the goal and is nearest to the posture.
//
// min ½ Σ wⱼ (qⱼ − restⱼ)² with e(q) = 0 and q in its limits. A step follows the projected gradient in the
// null space of the Jacobian (Liégeois 1977). Newton's method then returns to the goal. The step is halved
// until it reduces the cost.
#pragma once

#include "cspace/ik/numeric/error.hpp"
#include "cspace/math/least_squares.hpp"

namespace cspace::ik {

struct Posture {
    double rest[max_joints];
    double weight[max_joints];  // positive
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

namespace posture {
inline constexpr int most_steps = 300, corrections = 8;
inline constexpr double settled = 1e-10;  // a move this small ends the motion [rad, lengths of the path]
inline constexpr double shortest = 1e-3;  // share of a step below which no gain is expected any more
inline constexpr double slowest = 0.01, fastest = 100;  // share of a move
inline constexpr double at_limit = 1e-9;  // this close to a limit is at it [rad, lengths of the path]
inline constexpr double on_goal = 1e-12;  // an error as good as none [rad, lengths of the path]
inline constexpr double stride = 0.5;     // of a step [rad, lengths of the path]
inline constexpr double damping = 1e-14;  // keeps a singular Jacobian from overflowing
}  // namespace posture

// A robot and its goal.
struct SelfMotion {
    const Path* path;
    const Task* task;
    const Posture* posture;
    Rows rows;
    Posed T_goal_first;
};

inline double posture_cost(const SelfMotion& at, const double* q) {
    double cost = 0;
    for (int j = 0; j < at.path->n; ++j) {
        const double away = q[j] - at.posture->rest[j];
        cost += 0.5 * at.posture->weight[j] * away * away;
    }
    return cost;
}
inline double size_of(const Gap<double>& gap, const Path& path) {
    return max(gap.position / path.length, gap.rotation);
}
inline bool is_at_limit(const Task& task, const double* q, const double* move, int j) {
    return task.limited && ((q[j] <= task.lower[j] && move[j] < 0) || (q[j] >= task.upper[j] && move[j] > 0));
}

// The null-space direction of steepest descent. Coordinates at limits that it pushes outward stay fixed.
inline void null_space_move(const SelfMotion& at, const double* q, const Gap<double>& gap, double* move) {
    const int n = at.path->n, m = at.rows.m;
    double scaled[6][max_joints], root[max_joints], loose[max_joints];
    for (int j = 0; j < n; ++j) {
        root[j] = std::sqrt(at.posture->weight[j]) * unit_of(*at.path, j);
        loose[j] = 1;
        for (int r = 0; r < m; ++r) scaled[r][j] = gap.J[r][j] / root[j];
    }
    for (bool changed = true; changed;) {
        double wanted[max_joints], back[max_joints], moved[6] = {};
        for (int j = 0; j < n; ++j) {
            wanted[j] = loose[j] * root[j] * (at.posture->rest[j] - q[j]) / unit_of(*at.path, j);
            for (int r = 0; r < m; ++r) moved[r] += scaled[r][j] * wanted[j];
        }
        damped_step(m, n, scaled, moved, loose, posture::damping, back);
        changed = false;
        for (int j = 0; j < n; ++j) {
            move[j] = loose[j] * (wanted[j] - back[j]) / root[j] * unit_of(*at.path, j);
            if (loose[j] == 0 || !is_at_limit(*at.task, q, move, j)) continue;
            loose[j] = 0;
            changed = true;
        }
    }
}

// The largest fraction of a move, up to 1, that keeps every coordinate within its limits.
inline double share_inside(const SelfMotion& at, const double* q, const double* move) {
    double share = 1;
    for (int j = 0; j < at.path->n && at.task->limited; ++j) {
        if (move[j] < 0) share = min(share, (at.task->lower[j] - q[j]) / move[j]);
        if (move[j] > 0) share = min(share, (at.task->upper[j] - q[j]) / move[j]);
    }
    return max(share, 0.0);
}

// Adds `share` of a move to q, with coordinates clipped to their limits.
inline void add_move(const SelfMotion& at, const double* q, const double* move, double share, double* to) {
    for (int j = 0; j < at.path->n; ++j) {
        to[j] = q[j] + share * move[j];
        if (!at.task->limited) continue;
        // What comes to a limit up to rounding is at the limit, where it can be held.
        const double near = posture::at_limit * unit_of(*at.path, j);
        if (to[j] <= at.task->lower[j] + near) to[j] = at.task->lower[j];
        if (to[j] >= at.task->upper[j] - near) to[j] = at.task->upper[j];
    }
}

// Returns q to the goal; coordinates at limits stay there. True if it converged. `gap` belongs to q on
// return.
inline bool back_onto_goal(const SelfMotion& at, double good_enough, double* q, Gap<double>& gap) {
    const int n = at.path->n;
    double loose[max_joints], dx[max_joints];
    for (int j = 0; j < n; ++j)
        loose[j] = !at.task->limited || (at.task->lower[j] < q[j] && q[j] < at.task->upper[j]);
    for (int k = 0; k <= posture::corrections; ++k) {
        measure_gap(*at.path, at.rows, at.T_goal_first, q, gap);
        if (size_of(gap, *at.path) <= good_enough) return true;
        damped_step(at.rows.m, n, gap.J, gap.e, loose, posture::damping, dx);
        for (int j = 0; j < n; ++j) dx[j] *= unit_of(*at.path, j);
        add_move(at, q, dx, 1, q);
    }
    return false;
}

// Step length along the next move, from the change of the move in the last step (Barzilai & Borwein 1988).
// The move is the negative gradient on the goal, in the metric of the weights.
struct Pace {
    double q[max_joints], move[max_joints];
    bool known = false;
};
inline double next_pace(const SelfMotion& at, const double* q, const double* move, Pace& last) {
    double along = 0, bent = 0;
    for (int j = 0; j < at.path->n; ++j) {
        const double step = q[j] - last.q[j], weight = at.posture->weight[j];
        along += weight * step * step;
        bent -= weight * step * (move[j] - last.move[j]);
        last.q[j] = q[j];
        last.move[j] = move[j];
    }
    const double pace = last.known && bent > 0 ? along / bent : 1.0;
    last.known = true;
    return min(max(pace, posture::slowest), posture::fastest);
}

// Moves q, which reaches the goal, to the posture on the goal that is nearest to rest; returns the error
// there.
inline Gap<double> settle_posture(const Path& path, const Task& task, const Posture& wish,
                                  const Posed& T_base_tip, double* q) {
    const SelfMotion at = {&path, &task, &wish, rows_of(task), inverse(T_base_tip) * path.T_base_first};
    Gap<double> gap;
    Pace last{};
    measure_gap(path, at.rows, at.T_goal_first, q, gap);
    const double good_enough = max(size_of(gap, path), posture::on_goal);
    double cost = posture_cost(at, q);
    for (int step = 0; step < posture::most_steps; ++step) {
        double move[max_joints], next[max_joints], reach = 0;
        null_space_move(at, q, gap, move);
        for (int j = 0; j < path.n; ++j) reach = max(reach, std::fabs(move[j]) / unit_of(path, j));
        if (!(reach > posture::settled)) break;
        const double pace = min(next_pace(at, q, move, last), posture::stride / reach);
        for (int j = 0; j < path.n; ++j) move[j] *= pace;
        bool gained = false;
        const double longest = share_inside(at, q, move);
        for (double share = longest; !gained && share > posture::shortest * longest; share *= 0.5) {
            Gap<double> there;
            add_move(at, q, move, share, next);
            if (!back_onto_goal(at, good_enough, next, there)) continue;
            const double next_cost = posture_cost(at, next);
            if (!(next_cost < cost)) continue;
            gained = true;
            cost = next_cost;
            gap = there;
            for (int j = 0; j < path.n; ++j) q[j] = next[j];
        }
        if (!gained) break;
    }
    return gap;
}

}  // namespace cspace::ik::inline CSPACE_ISA
