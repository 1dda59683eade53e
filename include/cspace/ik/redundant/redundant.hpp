// An arm with joints to spare: which of them are held as parameters, within which limits, and what is solved
// for a value of them.
#pragma once

#include "cspace/ik/redundant/locked_arm.hpp"

namespace cspace::ik {

struct Redundant {
    Chain chain;
    double lower[max_joints], upper[max_joints];  // infinite where a joint has no limit
    double weight[max_joints];                    // 1, or 0 for joints that do not count in distances
    double middle[max_joints];                    // of the limits; 0 without
    double length = 1;                            // of the arm [m]
    int spare = 0;                                // how many joints are held: n − 6
    LockedArm locked;                             // with the default choice of them
};

// Where a joint may be: a turning joint with a whole turn of room or more is never stopped.
inline bool is_stopped(const Redundant& arm, int i) {
    constexpr double turn = 6.283185307179586;
    const double room = arm.upper[i] - arm.lower[i];
    return arm.chain.prismatic[i] ? room < 1e300 : room < turn;
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

// The largest difference of a joint, turning ones the short way round.
inline double joint_gap(const ik::Chain& chain, const double* a, const double* b) {
    double most = 0;
    for (int i = 0; i < chain.n; ++i) {
        const double gap = a[i] - b[i];
        most = max(most, std::fabs(chain.prismatic[i] ? gap : short_way(gap)));
    }
    return most;
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
    double reach = norm(goal.t) + norm(arm.chain.tip.t);
    for (int i = 0; i < arm.chain.n; ++i) reach += 2 * norm(arm.chain.point[i]);
    return {max(lower, -2 * reach), min(upper, 2 * reach), false};
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

// How good it is to hold the joints outside six neighbours from `first` on: closed forms on lanes before
// other closed forms before the general solver before nothing.
inline int rank_of(const ik::Arm& arm) {
    if (arm.has_plan) return arm.plan.on_lanes && arm.plan.virtual_joints == 0 ? 3 : 2;
    return is_solvable(arm) ? 1 : 0;
}
inline ik::LockedArm lock_outside(const ik::Redundant& arm, int first, const double* typical,
                                  bool (*plan_general)(const ik::Chain&, ik::GeneralArm&)) {
    int held[ik::max_joints], n_held = 0;
    for (int i = 0; i < arm.chain.n; ++i)
        if (i < first || i >= first + 6) held[n_held++] = i;
    return lock_joints(arm.chain, held, n_held, typical, plan_general);
}
inline bool no_general_arm(const ik::Chain&, ik::GeneralArm&) { return false; }

// Chooses the joints to hold: at the ends, so that six neighbours move and a value only moves the goal; the
// last ones if that is as good as any. Only if nothing solves six neighbours, one between others is held.
inline void choose_locks(ik::Redundant& arm, bool (*plan_general)(const ik::Chain&, ik::GeneralArm&)) {
    double typical[ik::max_joints];
    typical_values(arm, typical);
    int best = -1, best_rank = 1;
    for (int first = 0; first <= arm.spare; ++first) {
        const int rank = rank_of(lock_outside(arm, first, typical, no_general_arm).arm);
        if (rank <= best_rank) continue;
        best = first;
        best_rank = rank;
    }
    if (best >= 0) {
        arm.locked = lock_outside(arm, best, typical, plan_general);
        return;
    }
    for (int first = 0; first <= arm.spare; ++first) {
        arm.locked = lock_outside(arm, first, typical, plan_general);
        if (rank_of(arm.locked.arm) > 0) return;
    }
    for (int i = 1; arm.spare == 1 && i < arm.chain.n - 1; ++i) {
        arm.locked = lock_joints(arm.chain, &i, 1, typical, plan_general);
        if (rank_of(arm.locked.arm) > 0) return;
    }
}

// lower, upper, weight: per joint. Arms of up to six joints have none to spare and nothing to hold.
inline ik::Redundant make_redundant(const ik::Chain& chain, const double* lower, const double* upper,
                                    const double* weight,
                                    bool (*plan_general)(const ik::Chain&, ik::GeneralArm&)) {
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
    arm.spare = chain.n > 6 ? chain.n - 6 : 0;
    if (arm.spare) choose_locks(arm, plan_general);
    return arm;
}

}  // namespace cspace::inline CSPACE_ISA
