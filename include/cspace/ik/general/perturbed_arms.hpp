// Arms whose axes are parallel, square or meet in such a way that every formulation vanishes or finds each
// hidden angle twice: a neighbour, the arm with its axes disturbed a little, has neither fault, and leads to
// the solutions of the arm itself. There are two neighbours, on opposite sides: where two solutions of the
// arm are about to merge one of them may have lost the pair, and then the other keeps it apart.
#pragma once

#include <utility>

#include "cspace/ik/general/plan.hpp"
#include "cspace/ik/near_singular.hpp"

namespace cspace::ik::inline CSPACE_ISA {

inline constexpr double disturbance = 3e-4;  // [rad], and over the arm's length

// A vector of entries up to one, without a pattern.
inline Vec3d pattern_vector(int k) {
    double q[max_joints];
    spread_configuration(k, 3, q);
    return {q[0] / pi, q[1] / pi, q[2] / pi};
}

inline Chain perturb_chain(const Chain& chain, double size) {
    Chain out = chain;
    for (int i = 0; i < chain.n; ++i) {
        const Vec3d axis = chain.axis[i] + size * pattern_vector(2 * i);
        out.axis[i] = (1 / norm(axis)) * axis;
        out.point[i] = chain.point[i] + size * pattern_vector(2 * i + 1);
    }
    return out;
}

// Those of another arm.
inline void forget_spurious_roots(GeneralPlan& plan) {
    for (int& count : plan.spurious_roots) count = 0;
}

// What suffices for one suffices for the other.
inline void make_perturbed_arms(GeneralArm& arm) {
    make_general_plan(perturb_chain(arm.plan.chain, disturbance), arm.perturbed[0]);
    arm.perturbed[1] = arm.perturbed[0];
    arm.perturbed[1].chain = perturb_chain(arm.plan.chain, -disturbance);
    arm.perturbed[1].frames = loop_frames(arm.perturbed[1].chain);
    forget_spurious_roots(arm.perturbed[1]);
    arm.has_perturbed = arm.perturbed[0].regular > 0;
}

// Whether the disturbance may have cost an arm the pair that q belongs to: its twin stands close by.
inline bool is_about_to_merge(const GeneralPlan& plan, const Posed& goal, const double* q) {
    double near_double[6];
    return find_near_double(plan, goal, q, near_double);
}

// Which solutions of a neighbour, brought to the goal, became which of `out`, to which they are added.
struct Led {
    int count = 0;                  // of the neighbour's solutions
    bool complete = false;          // as the neighbour says
    bool lost[max_solutions] = {};  // those that became none
    int from[max_solutions] = {};   // how many became each of `out`
};
inline Led lead_to_goal(const GeneralPlan& plan, const Posed& goal, const Solutions& beside, Solutions& out) {
    Led led;
    led.count = beside.count;
    led.complete = beside.complete;
    Candidates start;
    for (int j = 0; j < beside.count; ++j) append_candidate(start, beside.q[j], false);
    admit_candidates(plan, goal, 0, start, out);
    Refined refined;
    refine_unsettled(plan, goal, start, out, refined);
    for (int j = 0; j < beside.count; ++j) {
        led.lost[j] = true;
        for (int m = 0; m < out.count; ++m)
            if (joint_distance(plan.chain, out.q[m], start.q[j]) < tolerance::same_solution) {
                ++led.from[m];
                led.lost[j] = false;
            }
    }
    return led;
}

// Complete if both neighbours are and both lead to every solution, pairs about to merge excepted.
inline void solve_perturbed(const GeneralArm& arm, const Posed& goal, Solutions& out) {
    const GeneralPlan& plan = arm.plan;
    Led led[2];
    out.complete = out.crowded = true;
    for (int k = 0; k < 2; ++k) {
        Solutions beside;
        solve_by_plan(arm.perturbed[k], goal, beside);
        led[k] = lead_to_goal(plan, goal, beside, out);
        out.complete = out.complete && led[k].complete;
        for (int j = 0; j < beside.count && out.complete; ++j)
            out.complete = !led[k].lost[j] || is_about_to_merge(arm.perturbed[k], goal, beside.q[j]);
    }
    for (int m = 0; m < out.count && out.complete; ++m)
        out.complete = (led[0].from[m] && led[1].from[m]) || is_about_to_merge(plan, goal, out.q[m]);
    out.complete = out.complete && out.count % 2 == 0;
}

// Whether the solutions of two goals tilted to opposite sides became those of the goal: one each, and two of
// one side, none of the other, a double root, where a pair of them merges and is lost.
inline bool accounts_for_tilts(const GeneralPlan& plan, const Posed& goal, const Led (&led)[2],
                               const Solutions& out) {
    int sum[2] = {}, all = 0;
    for (int m = 0; m < out.count; ++m) {
        const int a = led[0].from[m], b = led[1].from[m];
        const bool twice = (a == 2 && b == 0) || (a == 0 && b == 2);
        if (!(a == 1 && b == 1) && !(twice && is_double(plan, goal, out.q[m]))) return false;
        sum[0] += a, sum[1] += b;
        all += twice ? 2 : 1;
    }
    return all % 2 == 0 && led[0].count == sum[0] && led[1].count == sum[1];
}

// Goals that are special to an arm, say a tool held along its first axis, have solutions that share every
// hidden angle: goals tilted to either side have not, if by enough. True if both certify their solutions, and
// these become those of `out`, one each.
inline bool certify_by_tilting(const GeneralPlan& plan, const Posed& goal, double size, int way,
                               Solutions& out) {
    const Vec3d turn = pattern_vector(2 * way + 1), away = pattern_vector(2 * way + 2);
    const Vec3d axis = (1 / norm(turn)) * turn;
    constexpr int best = 2;  // formulations: a goal that takes more is not off what is special
    Led led[2];
    for (int k = 0; k < 2; ++k) {
        const double by = k ? -size : size;
        const Posed tilted = {spatial::rotation_of_rotvec(by * axis) * goal.R, goal.t + by * away};
        Solutions beside;
        solve_by_plan(plan, tilted, beside, best);
        if (!beside.complete) return false;
        led[k] = lead_to_goal(plan, goal, beside, out);
    }
    return out.count > 0 && accounts_for_tilts(plan, goal, led, out);
}

// Whether descents from all over the joints come to solutions that `out` lacks: self-motions attract them.
inline bool lacks_by_descent(const GeneralPlan& plan, const Posed& goal, const Solutions& out) {
    Solutions more = out;
    search_by_descent(plan.chain, goal, 1, 16, more, out.count + 1);
    return more.count > out.count;
}

// At goals that are special to the formulations: complete if tilting says so, and a formulation announces no
// more at the goal itself or descents find no more.
inline void solve_tilted(const GeneralPlan& plan, const Posed& goal, const Tried& tried_all, Solutions& out) {
    bool shared = false, drowned = plan.regular > 0;
    for (int k = 0; k < tried_all.count; ++k) {
        shared = shared || tried_all.seen[k].shared;
        drowned = drowned && tried_all.seen[k].hidden.alias > regular_alias;
    }
    if (!shared && !drowned) return;
    constexpr double sizes[] = {3e-3, 2e-2};  // [rad], and over the arm's length
    for (int trial = 0; trial < 6; ++trial) {
        Solutions tried = out;
        if (!certify_by_tilting(plan, goal, sizes[trial % 2], trial / 2, tried)) continue;
        if (!is_announced_by_one(plan, goal, tried_all, true, tried) && lacks_by_descent(plan, goal, tried))
            return;
        out = tried;
        out.complete = out.crowded = true;
        return;
    }
}

// Whether the arm's own plan does well on its poses.
inline bool suffices_alone(const GeneralPlan& plan) {
    constexpr int poses = 24, light = 70;
    int doubtful = 0, work = 0;
    for (int k = 0; k < poses && doubtful < 2 && work <= light * poses; ++k) {
        Solutions out;
        work += solve_by_plan(plan, own_pose(plan.chain, k), out);
        doubtful += !out.complete;
    }
    return doubtful < 2 && work <= light * poses;
}

// Whether it does with one of the best formulations asked first: their prices come of few poses.
inline bool suffices_in_some_order(GeneralPlan& plan) {
    constexpr int best = 3;
    for (int k = 0; k < best && (k == 0 || k < plan.regular); ++k) {
        std::swap(plan.order[0], plan.order[k]);
        if (suffices_alone(plan)) return true;
        std::swap(plan.order[0], plan.order[k]);
    }
    return false;
}

// By the wrist that the arm has. Where solutions merge or joints are free its list may be short.
inline void solve_with_wrist(const GeneralArm& arm, const Posed& goal, Solutions& out) {
    const auto list = [&](const auto& add) { return solve_position_first(arm.position_first, goal, add); };
    out.crowded = admit_listed(arm.plan, goal, list, out);
    out.complete = true;
}

inline void solve_general(const GeneralArm& arm, const Posed& goal, Solutions& out) {
    if (arm.position_first.applies) return solve_with_wrist(arm, goal, out);
    if (arm.has_perturbed) solve_perturbed(arm, goal, out);
    if (arm.has_perturbed && out.complete) return;
    Tried tried_all;
    try_formulations(arm.plan, goal, out, tried_all);
    if (!arm.has_perturbed && !out.complete) solve_tilted(arm.plan, goal, tried_all, out);
}

// Goals near one that is searched are regular: what the best formulations leave out there, others find at the
// other goals.
inline void propose_solutions(const GeneralArm& arm, const Posed& goal, Solutions& out) {
    constexpr int best = 3;
    if (arm.position_first.applies) return solve_with_wrist(arm, goal, out);
    if (arm.has_perturbed) return solve_perturbed(arm, goal, out);
    solve_by_plan(arm.plan, goal, out, best);
}

}  // namespace cspace::ik::inline CSPACE_ISA
