// Arms whose axes are parallel, square or meet in such a way that every formulation vanishes or finds each
// hidden angle twice: a neighbour, the arm with its axes disturbed a little, has neither fault, and leads to
// the solutions of the arm itself. There are two neighbours, on opposite sides: where two solutions of the
// arm are about to merge one of them may have lost the pair, and then the other keeps it apart.
#pragma once

#include "cspace/ik/general/plan.hpp"

namespace cspace::inline CSPACE_ISA {

inline constexpr double disturbance = 3e-4;  // [rad], and over the arm's length

// A vector of entries up to one, without a pattern.
inline Vec3d pattern(int k) {
    double q[ik::max_joints];
    spread_configuration(k, 3, q);
    return {q[0] / pi, q[1] / pi, q[2] / pi};
}

inline ik::Chain disturbed(const ik::Chain& chain, double size) {
    ik::Chain out = chain;
    for (int i = 0; i < chain.n; ++i) {
        const Vec3d axis = chain.axis[i] + size * pattern(2 * i);
        out.axis[i] = (1 / norm(axis)) * axis;
        out.point[i] = chain.point[i] + size * pattern(2 * i + 1);
    }
    return out;
}

// Those of another arm.
inline void forget_ghosts(ik::GeneralPlan& plan) {
    for (int& count : plan.ghosts) count = 0;
}

// What serves the one serves the other.
inline void make_neighbours(ik::GeneralArm& arm) {
    make_general_plan(disturbed(arm.plan.chain, disturbance), arm.neighbour[0]);
    arm.neighbour[1] = arm.neighbour[0];
    arm.neighbour[1].chain = disturbed(arm.plan.chain, -disturbance);
    arm.neighbour[1].frames = loop_frames(arm.neighbour[1].chain);
    forget_ghosts(arm.neighbour[1]);
    arm.has_neighbours = arm.neighbour[0].regular > 0;
}

// Whether the disturbance may have cost an arm the pair that q belongs to: its twin stands close by.
inline bool is_about_to_merge(const ik::GeneralPlan& plan, const Posed& goal, const double* q) {
    double twin[6];
    return find_twin(plan, goal, q, twin);
}

// Complete if both neighbours are and both lead to every solution, pairs about to merge excepted.
inline void solve_beside(const ik::GeneralArm& arm, const Posed& goal, ik::Solutions& out) {
    const ik::Chain& chain = arm.plan.chain;
    bool led[2][ik::max_solutions] = {};
    out.complete = true;
    out.crowded = true;
    for (int k = 0; k < 2; ++k) {
        ik::Solutions beside;
        solve_by_plan(arm.neighbour[k], goal, beside);
        out.complete = out.complete && beside.complete;
        ik::Candidates start;
        for (int j = 0; j < beside.count; ++j) put(start, beside.q[j], false);
        admit_candidates(arm.plan, goal, 0, start, out);
        refine_unsettled(arm.plan, goal, start, out);
        for (int j = 0; j < beside.count; ++j) {
            bool arrived = false;
            for (int m = 0; m < out.count; ++m)
                if (distance(chain, out.q[m], start.q[j]) < tolerance::same_solution)
                    led[k][m] = arrived = true;
            if (!arrived && !is_about_to_merge(arm.neighbour[k], goal, beside.q[j])) out.complete = false;
        }
    }
    for (int m = 0; m < out.count && out.complete; ++m)
        out.complete = (led[0][m] && led[1][m]) || is_about_to_merge(arm.plan, goal, out.q[m]);
    out.complete = out.complete && out.count % 2 == 0;
    out.status = out.count ? ik::Status::exact : ik::Status::unreachable;
}

// Whether the arm's own plan does well on its poses.
inline bool serves_alone(const ik::GeneralPlan& plan) {
    constexpr int poses = 24, light = 60;
    int doubtful = 0, work = 0;
    for (int k = 0; k < poses && doubtful < 2 && work <= light * poses; ++k) {
        ik::Solutions out;
        work += solve_by_plan(plan, own_pose(plan.chain, k), out);
        doubtful += !out.complete;
    }
    return doubtful < 2 && work <= light * poses;
}

// By the wrist that the arm has. Where solutions merge or joints are free its list may be short.
inline void solve_with_wrist(const ik::GeneralArm& arm, const Posed& goal, ik::Solutions& out) {
    const PlacedAndTurned found = solve(arm.position_first, goal);
    ik::Candidates start;
    for (int k = 0; k < found.count; ++k) put(start, found.q[k], found.close[k]);
    admit_candidates(arm.plan, goal, 0, start, out);
    admit_twins(arm.plan, goal, start, out);
    refine_unsettled(arm.plan, goal, start, out);
    out.complete = true;
    out.crowded = found.doubt;
    out.status = out.count ? ik::Status::exact : ik::Status::unreachable;
}

inline void solve_general(const ik::GeneralArm& arm, const Posed& goal, ik::Solutions& out) {
    if (arm.position_first.serves) return solve_with_wrist(arm, goal, out);
    if (arm.has_neighbours) solve_beside(arm, goal, out);
    if (!arm.has_neighbours || !out.complete) solve_by_plan(arm.plan, goal, out);
}

}  // namespace cspace::inline CSPACE_ISA
