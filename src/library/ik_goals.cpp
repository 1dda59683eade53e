#include "ik_goals.hpp"

#include <algorithm>
#include <cmath>

#include "cspace/ik/goal.hpp"
#include "cspace/ik/redundancy/tip_jacobian.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/math/least_squares.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "ik_self_motion.hpp"

namespace cspace::ik {

namespace {

constexpr int pose_dimensions = 6;
constexpr double same = 1e-8;     // [rad, m] configurations closer than this are one
constexpr double behind = -1e-6;  // [m] a point to look at that lies this far behind the tip is refused

// A search among infinitely many configurations, from a seed or else from the middle of the limits, does not
// prove that there is none. Where none is within limits, the answer is the nearest of all.
void answer_nearest(Solver& solver, const double* goal, const double* seed, GoalAnswer& out) {
    double q[max_joints];
    RedundantSolver& arm = solver.redundant();
    if (seed) {
        const RedundantSolver::NearestFound found = arm.find_nearest_within(goal, seed, q);
        out.complete = found.complete;
        if (!found.any) return;
    } else {
        out.complete = arm.find_near_middle(goal, q);
        if (!out.complete) return;
    }
    out.status = Status::exact;
    out.append_row(q, solver.chain().n, -1, false);
}

void answer_sampled(Solver& solver, const double* goal, int samples, GoalAnswer& out) {
    const bool has_intervals = solver.redundant().sample(goal, samples, out), complete = out.complete;
    if (out.count) return;
    out = {};
    answer_nearest(solver, goal, nullptr, out);
    // Where joints almost share their work, single values may reach what no interval does.
    if (!out.count) out.complete = !has_intervals && complete && solver.chain().n > pose_dimensions;
}

// Brings the joints that stand for what a partial goal leaves free (negative in `own_of`) to where they meet
// the goal best with the other joints where they are: Gauss–Newton steps on the pose.
void meet_goal(const Solver& solver, const Posed& goal, const int* own_of, double* q) {
    constexpr int most_steps = 40, most = 8;
    constexpr double settled = 1e-12, stride = 0.5, damping = 1e-9;
    const Chain& chain = solver.chain();
    int open[most], count = 0;
    const double loose[most] = {1, 1, 1, 1, 1, 1, 1, 1};
    for (int j = 0; j < chain.n; ++j) {
        if (own_of[j] >= 0) continue;
        q[j] = 0;
        if (!solver.leads_ahead(j) && count < most) open[count++] = j;
    }
    const double away = norm(goal.t - forward_kinematics(chain, q).t);
    for (int j = 0; j < chain.n; ++j)  // the distance to a point to look at does not depend on the direction
        if (own_of[j] < 0 && solver.leads_ahead(j)) q[j] = away;
    for (int step = 0; step < most_steps; ++step) {
        TipMotion<double> motion;
        tip_motion<0>(chain, goal, 1.0, q, motion);
        const Vec3d turned = spatial::rotvec_of_rotation(goal.R * transpose(forward_kinematics(chain, q).R));
        const double error[6] = {motion.error[0], motion.error[1], motion.error[2],
                                 turned.x,        turned.y,        turned.z};
        double J[6][most], dq[most], reach = stride;
        for (int i = 0; i < count; ++i)
            for (int k = 0; k < 6; ++k) J[k][i] = motion.column[open[i]][k];
        damped_step(6, count, J, error, loose, damping, dq);
        for (int i = 0; i < count; ++i)
            if (!chain.prismatic[open[i]]) reach = std::fmax(reach, std::fabs(dq[i]));
        for (int i = 0; i < count; ++i) q[open[i]] += dq[i] * stride / reach;
        if (largest_of(dq, count) < settled) break;
    }
}

// The solver's joints at a seed of the user's arm.
void seed_solver(const Solver& solver, const GoalRequest& request, const double* goal, const double* seed,
                 double* q) {
    int own_of[max_joints];
    std::fill(own_of, own_of + max_joints, -1);
    for (int j = 0; j < request.own; ++j) {
        const int column = request.whole.column[request.first + j];
        if (column >= 0) own_of[column] = j;
    }
    bool all = true;
    for (int j = 0; j < solver.chain().n; ++j) {
        all = all && own_of[j] >= 0;
        if (own_of[j] >= 0) q[j] = seed[own_of[j]];
    }
    if (!all) meet_goal(solver, read_goal(goal).T, own_of, q);
}

// From rows of the solver to rows of the whole arm and of the user's arm.
void map_rows(const GoalRequest& request, int n, GoalAnswer& out) {
    const RowMap& whole = request.whole;
    if (whole.n == n && !request.is_partial) return;  // they are the same
    const std::vector<double> rows = std::move(out.q);
    out.q.clear();
    for (int k = 0; k < out.count; ++k) {
        double row[max_joints];
        for (int j = 0; j < whole.n; ++j)
            row[j] = whole.column[j] < 0 ? whole.value[j] : rows[std::size_t(k * n + whole.column[j])];
        out.q.insert(out.q.end(), row + request.first, row + request.first + request.own);
        if (request.is_partial) out.whole.insert(out.whole.end(), row, row + whole.n);
    }
}

bool is_same(const Solver& solver, const GoalRequest& request, const double* a, const double* b) {
    for (int j = 0; j < request.own; ++j) {
        const int column = request.whole.column[request.first + j];
        double d = a[j] - b[j];
        if (column >= 0 && !solver.chain().prismatic[column]) d = short_way(d);
        if (!(std::fabs(d) < same)) return false;
    }
    return true;
}

bool has_point_ahead(const Solver& solver, const RowMap& whole, const double* row) {
    for (int j = 0; j < whole.n; ++j)
        if (whole.column[j] >= 0 && solver.leads_ahead(whole.column[j]) && row[j] < behind) return false;
    return true;
}

// Whether the user's own joints take part in the self-motion through a row of the solver.
bool moves_own_joints(Solver& solver, const GoalRequest& request, const double* q) {
    double direction[max_joints];
    if (!self_motion_direction(solver.arm(), q, true, direction)) return true;
    const double* own = direction + request.first;
    return std::any_of(own, own + request.own, [](double d) { return std::fabs(d) > tolerance::resting; });
}

// Of a partial goal: rows that differ in the virtual joints alone are one, and a tool that looks at a point
// has it in front.
void keep_own_rows(Solver& solver, const GoalRequest& request, GoalAnswer& out) {
    const std::size_t own = std::size_t(request.own), n = std::size_t(request.whole.n);
    GoalAnswer kept;
    bool any_moves = false;
    for (std::size_t k = 0; k < std::size_t(out.count); ++k) {
        const double *whole = out.whole.data() + n * k, *q = out.q.data() + own * k;
        bool keep = has_point_ahead(solver, request.whole, whole);
        for (std::size_t i = 0; i < kept.branch.size() && keep; ++i)
            keep = !is_same(solver, request, kept.q.data() + own * i, q);
        if (!keep) continue;
        const bool moves =
            out.self_motion[k] && (solver.is_redundant() || moves_own_joints(solver, request, whole));
        kept.append_row(q, request.own, n == own ? out.branch[k] : -1, moves);
        kept.whole.insert(kept.whole.end(), whole, whole + n);
        any_moves |= moves;
    }
    kept.status = any_moves ? Status::singular : kept.count ? Status::exact : Status::unreachable;
    kept.complete = out.complete;
    kept.values = out.values;
    kept.feasible = out.feasible;
    out = std::move(kept);
    if (any_moves && solver.is_redundant()) {  // self-motions that nobody describes where joints are locked
        out.status = Status::exact;
        out.complete = false;
        std::fill(out.self_motion.begin(), out.self_motion.end(), 0);
    }
}

GoalAnswer answer_goal(Solver& solver, const GoalRequest& request, std::size_t i) {
    const std::size_t n = std::size_t(solver.chain().n);
    const double* goal = request.goals + 16 * i;
    GoalAnswer out;
    if (request.locked || !solver.is_redundant()) {
        SolutionStore store;
        SolutionRows rows = {};
        if (request.locked)
            solve_locked_goal(*request.locked, goal, request.at + (request.at_each ? n * i : 0), store, rows);
        else
            list_solutions(solver.arm(), goal, nullptr, store, rows);
        out.append(rows, int(n));
    } else if (solver.exceeds_reach(goal)) {
        return out;
    } else if (request.seeds) {
        double seed[max_joints];
        const std::size_t stride = request.seed_each ? std::size_t(request.own) : 0;
        seed_solver(solver, request, goal, request.seeds + stride * i, seed);
        answer_nearest(solver, goal, seed, out);
    } else if (solver.redundant().redundant_joints() == 1) {
        answer_sampled(solver, goal, request.samples, out);
    } else {
        answer_nearest(solver, goal, nullptr, out);
    }
    map_rows(request, int(n), out);
    if (request.is_partial) keep_own_rows(solver, request, out);
    return out;
}

}  // namespace

std::vector<GoalAnswer> answer_goals(Solver& solver, const GoalRequest& request) {
    std::vector<GoalAnswer> out(request.n);
    over_rows(request.n, std::max(request.threads, 1), 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            out[i] = answer_goal(solver, request, i);
            poll_interrupts();
        }
        return true;
    });
    return out;
}

}  // namespace cspace::ik
