// Which formulations of the loop apply to an arm, and in what order; and all solutions of a goal by as many
// of them as it takes.
#pragma once

#include <initializer_list>

#include "cspace/ik/general/solve.hpp"

namespace cspace::ik {

// How a formulation did on the poses of an arm.
struct FormulationTrial {
    static constexpr int most_poses = 24;
    int poses = 0, drowned = 0, work = 0, shared = 0;
    double sensitivity = 0;
    int found[most_poses];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Whether the link that the goal makes of tip and base is longer than all the others together.
inline bool is_beyond_reach(const LoopFrames& frames, const Posed& goal) {
    constexpr double rounding = 1e-9;  // of a stretched arm, which still reaches
    double others = 0;
    for (const Posed& link : frames.between) others += norm(link.t);
    return norm(closing_link(frames, goal).t) > (1 + rounding) * others;
}

// Solutions come in pairs, those on folds counted twice: where one is left over its partner is missing.
inline bool come_in_pairs(const GeneralPlan& plan, const Posed& goal, const Solutions& found) {
    int count = found.count;
    for (int k = 0; k < found.count && found.count % 2; ++k) count += is_double(plan, goal, found.q[k]);
    return count % 2 == 0;
}

// Looks across the folds that are very near: pairs there may hide behind one hidden angle. True if it found a
// twin that had been missed.
inline bool add_hidden_near_doubles(const GeneralPlan& plan, const Posed& goal, Solutions& found) {
    constexpr double very_near = 1e-4, hardly_bent = 1e-7;
    Candidates start;
    double near_double[6];
    for (int k = 0; k < found.count; ++k)
        if (find_near_double(plan, goal, found.q[k], near_double, very_near, hardly_bent))
            append_candidate(start, near_double, false);
    const int before = found.count;
    admit_candidates(plan, goal, 0, start, found);
    return found.count > before;
}

// The formulations that a goal was put to.
struct Tried {
    int count = 0, work = 0;
    int number[formulations];
    Certificate seen[formulations];
    Refined refined;
};

// Whether what one of them announced is there; `sharing`: those count as well whose solutions share a hidden
// angle.
inline bool is_announced_by_one(const GeneralPlan& plan, const Posed& goal, const Tried& tried_all,
                                bool sharing, const Solutions& found) {
    bool twice[max_solutions];
    mark_doubles(plan, goal, found, twice);
    for (int k = 0; k < tried_all.count; ++k) {
        const Certificate& seen = tried_all.seen[k];
        if (!seen.trusted || !all_matched(seen, found, twice)) continue;
        if (sharing || !share_angles(seen, plan.chain, found, twice, plan.paired[tried_all.number[k]]))
            return true;
    }
    return false;
}

inline void try_formulation(const GeneralPlan& plan, const Posed& goal, int number, Solutions& out,
                            Tried& tried_all) {
    Certificate& seen = tried_all.seen[tried_all.count];
    tried_all.number[tried_all.count++] = number;
    seen = solve_formulation(plan, goal, number, tried_all.refined, out);
    tried_all.work += seen.work;
    out.crowded = out.crowded || seen.clusters > 0;
    out.complete = seen.complete && !(seen.clusters > 0 && add_hidden_near_doubles(plan, goal, out));
    seen.trusted = seen.trusted && (out.complete || !seen.complete);
}

// One formulation after the other until one of them certifies that nothing is missing; where none does, what
// all of them found together may be what one of them announced. Where solutions share an angle others that
// hide it are of no use.
inline void try_formulations(const GeneralPlan& plan, const Posed& goal, Solutions& out, Tried& tried_all,
                             int most = formulations) {
    constexpr int most_shared = 3;  // a goal special to so many joints is special to most
    out.crowded = false;
    if (plan.slides == 3) {
        const auto list = [&](const auto& add) { return solve_orientation_first(plan.chain, goal, add); };
        out.complete = plan.regular > 0 && admit_listed(plan, goal, list, out);
        out.crowded = !out.complete;
    } else {
        out.complete = plan.slides == 0 && is_beyond_reach(plan.frames, goal);
    }
    int shared = 0;
    bool shares[6] = {};
    for (int k = 0;
         k < std::min(plan.regular, most) && plan.slides < 3 && !out.complete && shared < most_shared; ++k) {
        const int joint = hidden_joint(formulation_of(plan.order[k]));
        if (shares[joint]) continue;
        try_formulation(plan, goal, plan.order[k], out, tried_all);
        shares[joint] = tried_all.seen[tried_all.count - 1].shared;
        shared += shares[joint];
    }
    if (tried_all.count > 0 && !out.complete)
        out.complete = is_announced_by_one(plan, goal, tried_all, false, out);
    out.complete = out.complete && come_in_pairs(plan, goal, out);
}

// Returns the work.
inline int solve_by_plan(const GeneralPlan& plan, const Posed& goal, Solutions& out,
                         int most = formulations) {
    Tried tried_all;
    try_formulations(plan, goal, out, tried_all, most);
    return tried_all.work;
}

inline constexpr double usual_sensitivity = 1e5, useless_sensitivity = 1e8;

// By how much more than their own the relative errors of the six equations change the determinant: where an
// arm is almost, but not quite, one for which a formulation vanishes, its values are rounding enlarged.
inline double pose_sensitivity(const GeneralPlan& plan, const Posed& goal, int number) {
    using V = Pack<4>;
    constexpr double slip = 1e-9;
    const Loop loop = make_loop(plan.frames, plan.chain.prismatic, goal, formulation_of(number));
    if (!is_possible(loop, formulation_of(number))) return useless_sensitivity;
    if (plan.slides == 2) return 0;
    const Elimination e = eliminate_angles(loop);
    Elimination slipped = e;
    int sign = 1;
    for (int i = 0; i < 6; ++i)
        for (int m = 0; m < 9; ++m) {
            for (double* entry : {&slipped.level[m][i], &slipped.across[m][i], &slipped.quarter[m][i]}) {
                *entry += sign * slip;
                sign = (7 * i + 5 * m + (sign > 0)) % 3 ? -sign : sign;
            }
        }
    const SamplerTables& tables = sampler_tables();
    double largest = 0, change = 0;
    for (int j = 0; j < samples; j += 4) {
        const V c = load_lanes<V>(tables.cosine + j), s = load_lanes<V>(tables.sine + j);
        const V exact = determinant(e, c, s), other = determinant(slipped, c, s);
        for (int k = 0; k < 4; ++k) {
            largest = max(largest, std::fabs(get_lane(exact, k)));
            change = max(change, std::fabs(get_lane(other, k) - get_lane(exact, k)));
        }
    }
    return change / (slip * largest);
}

// Tries one on poses of its own arm, up to number `last`; one that drowns in noise, or whose roots always
// come in close pairs, is known for it after a few.
inline void try_formulation(const GeneralPlan& plan, const Posed* goal, int last, int number,
                            FormulationTrial& trial) {
    constexpr int first_look = 4, heavy = 400;
    for (int k = trial.poses; k < last; ++k) {
        if (k < first_look)
            trial.sensitivity = max(trial.sensitivity, pose_sensitivity(plan, goal[k], number));
        if (!(trial.sensitivity < useless_sensitivity)) break;
        if (k == first_look && (trial.drowned == k || trial.work > heavy * k)) break;
        Solutions out;
        Refined refined;
        const Certificate seen = solve_formulation(plan, goal[k], number, refined, out);
        trial.drowned += seen.hidden.alias > regular_alias;
        trial.work += seen.work;
        trial.shared += seen.shared;
        trial.found[trial.poses++] = out.count;
    }
}

// The k-th of some poses of an arm without a pattern.
inline Posed own_pose(const Chain& chain, int k) {
    double q[max_joints];
    spread_configuration(k, 6, q);
    return forward_kinematics(chain, q);
}

// A plan without formulations.
inline void describe_formulation(const Chain& chain, GeneralPlan& plan) {
    plan = {};
    plan.chain = chain;
    plan.frames = loop_frames(chain);
    for (int i = 0; i < 6; ++i) plan.slides += chain.prismatic[i];
}

// The formulations in the order of their prices: what they miss, their work and how much they enlarge
// rounding.
inline void rank_formulations(const FormulationTrial (&trial)[formulations], GeneralPlan& plan) {
    int most[FormulationTrial::most_poses] = {};
    for (const FormulationTrial& t : trial)
        for (int k = 0; k < t.poses; ++k) most[k] = t.found[k] > most[k] ? t.found[k] : most[k];
    double cost[formulations];
    plan.regular = 0;
    for (int number = 0; number < formulations; ++number) {
        const FormulationTrial& t = trial[number];
        plan.sensitivity[number] = t.sensitivity;
        plan.paired[number] = plan.paired[number] || 2 * t.shared > t.poses;
        if (t.drowned == t.poses || !(t.sensitivity < useless_sensitivity)) continue;
        int missed = 0;
        for (int k = 0; k < t.poses; ++k) missed += most[k] - t.found[k];
        const double slips = max(0.0, std::log10(t.sensitivity / usual_sensitivity));
        cost[number] = double(t.work + 100 * missed) / t.poses + 20 * slips;
        int at = plan.regular++;
        for (; at > 0 && cost[plan.order[at - 1]] > cost[number]; --at) plan.order[at] = plan.order[at - 1];
        plan.order[at] = number;
    }
}

// The hidden angles of a formulation at which it has roots for each of three goals: factors that come of axes
// almost parallel or almost meeting, where no solution need be.
inline void find_spurious_roots(const Posed* goal, int number, GeneralPlan& plan) {
    constexpr double fine = 1e-8, same = 1e-7;
    if (plan.slides == 2) return;
    HiddenAngles hidden[3];
    for (int k = 0; k < 3; ++k) {
        const Loop loop = make_loop(plan.frames, plan.chain.prismatic, goal[k], formulation_of(number));
        const Elimination e = eliminate_angles(loop);
        isolate_roots([&](auto c, auto s) { return determinant(e, c, s); }, fine, hidden[k]);
    }
    const auto has = [&](const HiddenAngles& h, const HiddenAngle& root) {
        const double spread = root.order > 2 ? order_seen : same;  // several on one place are known less well
        for (int j = 0; j < h.count; ++j)
            if (std::fabs(short_way(h.root[j].angle - root.angle)) < spread) return true;
        return false;
    };
    int& spurious_roots = plan.spurious_roots[number];
    for (int j = 0; j < hidden[0].count && spurious_roots < GeneralPlan::most_spurious; ++j) {
        const HiddenAngle& root = hidden[0].root[j];
        if (has(hidden[1], root) && has(hidden[2], root))
            plan.spurious[number * GeneralPlan::most_spurious + spurious_roots++] = root.angle;
    }
}

// For arms with parallel or meeting axes most determinants vanish identically; others lose solutions or find
// them at great cost. All regular ones are ordered after a few poses, the best of them once more after many.
inline void make_general_plan(const Chain& chain, GeneralPlan& plan) {
    constexpr int few = 6, best = 4;
    describe_formulation(chain, plan);
    if (plan.slides > 3) return;
    if (plan.slides == 3) {
        plan.regular = is_regular(orientation_first(chain).turns);
        return;
    }
    Posed goal[FormulationTrial::most_poses];
    for (int k = 0; k < FormulationTrial::most_poses; ++k) goal[k] = own_pose(chain, k);
    FormulationTrial trial[formulations];
    for (int number = 0; number < formulations; ++number)
        try_formulation(plan, goal, few, number, trial[number]);
    rank_formulations(trial, plan);
    for (int k = 0; k < best && k < plan.regular; ++k)
        try_formulation(plan, goal, FormulationTrial::most_poses, plan.order[k], trial[plan.order[k]]);
    rank_formulations(trial, plan);
    for (int k = 0; k < plan.regular; ++k) find_spurious_roots(goal, plan.order[k], plan);
}

}  // namespace cspace::ik::inline CSPACE_ISA
