// An arm with joints to spare: which of them are held as parameters, within which limits, and what is solved
// for a value of them.
#pragma once

#include "cspace/ik/redundancy/basis.hpp"
#include "cspace/ik/redundancy/locked_joints.hpp"
#include "cspace/ik/redundancy/split_chain.hpp"

namespace cspace::ik {

struct Redundant {
    Chain chain;
    double lower[max_joints], upper[max_joints];  // infinite where a joint has no limit
    double weight[max_joints];                    // 1, or 0 for joints that do not count in distances
    double middle[max_joints];                    // of the limits; 0 without
    double length = 1;                            // of the arm [m]
    int rank = 6;                                 // of the Jacobian where nothing special happens
    int redundancy_degree = 0;                    // how many joints are held: n − rank
    LockedArm locked;                             // with the default choice of them
    Halves halves;  // where all joints count alike and none is missing to rank 6
};

// Where a joint may be: a turning joint with a whole turn of room or more is never stopped.
inline bool is_stopped(const Redundant& arm, int i) {
    constexpr double turn = 6.283185307179586;
    if (arm.chain.prismatic[i]) return std::isfinite(arm.lower[i]) || std::isfinite(arm.upper[i]);
    return arm.upper[i] - arm.lower[i] < turn;
}

}  // namespace cspace::ik

namespace cspace::inline CSPACE_ISA {

// By how much a value stays outside the limits of joint i whatever whole turn is taken; not positive inside.
inline double excess(const ik::Redundant& arm, int i, double q) {
    if (!ik::is_stopped(arm, i)) return -1;
    if (arm.chain.prismatic[i]) return max(arm.lower[i] - q, q - arm.upper[i]);
    const double middle = 0.5 * (arm.lower[i] + arm.upper[i]);
    return std::fabs(short_way(q - middle)) - 0.5 * (arm.upper[i] - arm.lower[i]);
}
inline bool is_within(const ik::Redundant& arm, const double* q, double slack) {
    for (int i = 0; i < arm.chain.n; ++i)
        if (excess(arm, i, q[i]) > slack) return false;
    return true;
}

// Joints that do not count in distances stand for what a goal leaves open, and keep to it: a tool looks
// ahead.
inline bool is_allowed(const ik::Redundant& arm, const double* q) {
    for (int i = 0; i < arm.chain.n; ++i)
        if (arm.weight[i] == 0 && excess(arm, i, q[i]) > 1e-9 * arm.length) return false;
    return true;
}

// The largest difference of a joint, turning ones the short way round.
inline double joint_gap(const ik::Chain& chain, const double* a, const double* b) {
    double most = 0;
    for (int i = 0; i < chain.n; ++i) {
        const double gap = a[i] - b[i];
        most = max(most, std::fabs(chain.prismatic[i] ? gap : short_way(gap)));
    }
    return most;
}

// Twice as far as anything of the arm is from its base or from the goal [m]: slides without limits are
// followed so far.
inline double far_away(const ik::Redundant& arm, const Posed& goal) {
    double reach = norm(goal.t) + norm(arm.chain.tip.t);
    for (int i = 0; i < arm.chain.n; ++i) reach += 2 * norm(arm.chain.point[i]);
    return reach > 0 ? 2 * reach : 2.0;
}

// The values a parameter takes: [lower, upper], a whole turn, or as far as a slide can be from the goal.
struct Domain {
    double lower, upper;
    bool is_circle;
};
inline Domain domain_of(const ik::Redundant& arm, int parameter, const Posed& goal) {
    const double lower = arm.lower[parameter], upper = arm.upper[parameter];
    if (!arm.chain.prismatic[parameter])
        return ik::is_stopped(arm, parameter) ? Domain{lower, upper, false} : Domain{-pi, pi, true};
    const double far = far_away(arm, goal);
    return {max(lower, -far), min(upper, far), false};
}

// A value for each joint at which nothing special is expected.
inline void typical_values(const ik::Redundant& arm, double* at) {
    for (int i = 0; i < arm.chain.n; ++i) {
        const bool bounded = std::isfinite(arm.lower[i]) && std::isfinite(arm.upper[i]);
        const double lower = bounded ? arm.lower[i] : -1, upper = bounded ? arm.upper[i] : 1;
        const double part = 0.6180339887498949 * (i + 1) - std::floor(0.6180339887498949 * (i + 1));
        at[i] = lower + (0.2 + 0.6 * part) * (upper - lower);
    }
}

// How good an arm is to be left with: closed forms on lanes before other closed forms before the general
// solver before nothing.
inline int rank_of(const ik::Arm& arm) {
    if (arm.has_plan) return arm.plan.on_lanes && arm.plan.virtual_joints == 0 ? 3 : 2;
    if (arm.has_few_joints) return 2;
    return is_solvable(arm) ? 1 : 0;
}
// The arm with all joints held but those of a basis.
inline ik::LockedArm lock_outside(const ik::Redundant& arm, unsigned basis, const double* typical,
                                  bool with_general) {
    int locked_joint[ik::max_joints], n_locked = 0;
    for (int i = 0; i < arm.chain.n; ++i)
        if (!(basis >> i & 1)) locked_joint[n_locked++] = i;
    return lock_joints(arm.chain, locked_joint, n_locked, typical, with_general);
}

// Sets of joints that may be left to move, the best to try first: neighbours from each joint on, with those
// nearest behind and before them where neighbours do each other's work; then all but one joint.
struct Bases {
    static constexpr int room = 2 * ik::max_joints;
    int count = 0;
    unsigned joints[room];
};
inline void add_basis(const ik::Redundant& arm, const int* order, Bases& out) {
    const Basis found = basis_of(arm.chain, arm.length, order, arm.chain.n);
    for (int k = 0; k < out.count; ++k)
        if (out.joints[k] == found.joints) return;
    if (found.rank == arm.rank) out.joints[out.count++] = found.joints;
}
inline bool are_neighbours(unsigned joints) {
    while (!(joints & 1)) joints >>= 1;
    return (joints & (joints + 1)) == 0;
}
inline Bases bases_of(const ik::Redundant& arm) {
    Bases out;
    const int n = arm.chain.n;
    int order[ik::max_joints];
    for (int first = 0; first <= arm.redundancy_degree; ++first) {
        int k = 0;
        for (int i = first; i < n; ++i) order[k++] = i;
        for (int i = first - 1; i >= 0; --i) order[k++] = i;
        add_basis(arm, order, out);
    }
    for (int last = 0; last < n; ++last) {
        int k = 0;
        for (int i = 0; i < n; ++i)
            if (i != last) order[k++] = i;
        order[k] = last;
        add_basis(arm, order, out);
    }
    return out;
}

// Chooses the joints to hold: at the ends, so that neighbours move and a value only moves the goal; the last
// ones if that is as good as any. Only if nothing solves neighbours, one between others is held.
inline void choose_locks(ik::Redundant& arm) {
    double typical[ik::max_joints];
    typical_values(arm, typical);
    const Bases bases = bases_of(arm);
    int best = -1, best_score = 0;
    for (int k = 0; k < bases.count; ++k) {
        if (arm.rank == 6 && !are_neighbours(bases.joints[k])) continue;
        const ik::LockedArm locked = lock_outside(arm, bases.joints[k], typical, false);
        const int rank = locked.at_ends ? rank_of(locked.arm) : min(rank_of(locked.arm), 2);
        const int score = 2 * rank + locked.at_ends;
        if (rank < 2 || score <= best_score) continue;
        best = k;
        best_score = score;
    }
    if (best >= 0) {
        arm.locked = lock_outside(arm, bases.joints[best], typical, true);
        return;
    }
    for (const bool at_ends : {true, false})
        for (int k = 0; k < bases.count; ++k) {
            if (are_neighbours(bases.joints[k]) != at_ends) continue;
            arm.locked = lock_outside(arm, bases.joints[k], typical, true);
            if (rank_of(arm.locked.arm) > 0) return;
        }
}

// How many dimensions a pose leaves free when some joints are held, one bit each.
inline int redundancy_degree_with(const ik::Redundant& arm, unsigned locked_joint) {
    int order[ik::max_joints], count = 0;
    for (int i = 0; i < arm.chain.n; ++i)
        if (!(locked_joint >> i & 1)) order[count++] = i;
    return count - basis_of(arm.chain, arm.length, order, count).rank;
}

// lower, upper, weight: per joint. An arm without a joint to spare has nothing to hold.
CSPACE_ONCE ik::Redundant make_redundant(const ik::Chain& chain, const double* lower, const double* upper,
                                         const double* weight) {
    ik::Redundant arm;
    arm.chain = chain;
    arm.length = characteristic_length(chain);
    for (int i = 0; i < chain.n; ++i) {
        arm.lower[i] = lower[i];
        arm.upper[i] = upper[i];
        arm.weight[i] = weight[i];
        const bool bounded = std::isfinite(lower[i]) && std::isfinite(upper[i]);
        arm.middle[i] = bounded ? 0.5 * (lower[i] + upper[i]) : 0;
    }
    arm.rank = basis_of(chain, arm.length).rank;
    arm.redundancy_degree = chain.n - arm.rank;
    if (arm.redundancy_degree) choose_locks(arm);
    bool alike = arm.rank == 6;
    for (int i = 0; i < chain.n; ++i) alike = alike && weight[i] == 1;
    if (alike) arm.halves = make_halves(chain, arm.length);
    return arm;
}

}  // namespace cspace::inline CSPACE_ISA
