// A redundant arm: the joints that are locked as parameters, their limits, and the solver of the other
// joints.
#pragma once

#include <algorithm>

#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/redundancy/locked_joints.hpp"
#include "cspace/ik/redundancy/split_chain.hpp"

namespace cspace::ik {

// Joints with linearly independent columns.
struct Basis {
    int rank = 0;
    unsigned joints = 0;   // one bit each
    double least = 1e300;  // the least part of a column that those before it do not span
};

struct Redundant {
    Chain chain;
    double lower[max_joints], upper[max_joints];  // infinite where a joint has no limit
    double weight[max_joints];                    // 1, or 0 for joints that do not count in distances
    double middle[max_joints];                    // of the limits; 0 without
    double length = 1;                            // of the arm [m]
    int rank = 6;                                 // of the Jacobian where nothing special happens
    int redundancy_degree = 0;                    // how many joints are held: n − rank
    LockedArm locked;                             // with the default choice of them
    SplitChain split_chain;  // where all joints count alike and none is missing to rank 6
};

// Whether the limits can stop a joint. A revolute joint with a range of 2π or more is never stopped.
inline bool is_stopped(const Redundant& arm, int i) {
    if (arm.chain.prismatic[i]) return std::isfinite(arm.lower[i]) || std::isfinite(arm.upper[i]);
    return arm.upper[i] - arm.lower[i] < 2 * pi;
}

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Independent joints: the generic rank of the Jacobian, and sets of joints whose columns alone have that
// rank.

// Orthogonalises a column against unit columns, twice because of rounding; returns the norm of the remainder.
inline double rest_of_column(const double (*unit)[6], int count, double* column) {
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < count; ++k) {
            const double along = dot_n(unit[k], column, 6);
            for (int j = 0; j < 6; ++j) column[j] -= along * unit[k][j];
        }
    return std::sqrt(dot_n(column, column, 6));
}

// Selects joints in a given order. A joint is skipped if the joints before it span its column. The first pass
// takes columns with a large remainder, the second any others that are independent.
inline Basis basis_at(const PoseError& at, const int* order, int count) {
    constexpr double much = 1e-2;
    Basis out;
    double unit[6][6];
    for (const double least : {much, tolerance::axis_relation})
        for (int k = 0; k < count && out.rank < 6; ++k) {
            if (out.joints >> order[k] & 1) continue;
            double column[6];
            for (int j = 0; j < 6; ++j) column[j] = at.jacobian.us[order[k]][j];
            const double size = rest_of_column(unit, out.rank, column);
            if (!(size > least)) continue;
            for (int j = 0; j < 6; ++j) unit[out.rank][j] = column[j] / size;
            out.joints |= 1u << order[k];
            out.least = min(out.least, size);
            ++out.rank;
        }
    return out;
}

// A basis at a generic configuration: of several sample configurations, the one with the best-separated
// columns. Lengths are divided by `length`, the size of the arm.
inline Basis basis_of(const Chain& chain, double length, const int* order, int count) {
    constexpr int looks = 8;
    Basis best;
    for (int look = 0; look < looks; ++look) {
        double q[max_joints];
        spread_configuration(look, chain.n, q);
        for (int i = 0; i < chain.n; ++i)
            if (chain.prismatic[i]) q[i] *= length;
        PoseError at;
        measure_error(chain, chain.tip, length, q, at);
        for (int i = 0; i < chain.n; ++i)
            for (int j = 0; j < 3 && chain.prismatic[i]; ++j) at.jacobian.us[i][j] *= length;
        const Basis found = basis_at(at, order, count);
        if (found.rank > best.rank || (found.rank == best.rank && found.least > best.least)) best = found;
    }
    return best;
}
inline Basis basis_of(const Chain& chain, double length) {
    int order[max_joints] = {};
    for (int i = 0; i < chain.n; ++i) order[i] = i;
    return basis_of(chain, length, order, chain.n);
}

// The least distance from a value to the limits of joint i over all multiples of 2π; not positive inside.
inline double limit_excess(const Redundant& arm, int i, double q) {
    if (!is_stopped(arm, i)) return -1;
    if (arm.chain.prismatic[i]) return max(arm.lower[i] - q, q - arm.upper[i]);
    const double middle = 0.5 * (arm.lower[i] + arm.upper[i]);
    return std::fabs(short_way(q - middle)) - 0.5 * (arm.upper[i] - arm.lower[i]);
}

inline constexpr double limit_slack = 1e-9;  // [rad or m] what rounding may put outside

// Whether all joints but one are within their limits.
inline bool is_within(const Redundant& arm, const double* q, double slack, int except = -1) {
    for (int i = 0; i < arm.chain.n; ++i)
        if (i != except && limit_excess(arm, i, q[i]) > slack) return false;
    return true;
}

// Joints without weight in the distance represent coordinates that the goal leaves free. They must stay in
// range: a tool has to point forwards.
inline bool is_allowed(const Redundant& arm, const double* q) {
    for (int i = 0; i < arm.chain.n; ++i)
        if (arm.weight[i] == 0 && limit_excess(arm, i, q[i]) > limit_slack * arm.length) return false;
    return true;
}

// The largest joint difference, by the shorter way for revolute joints.
inline double joint_gap(const Chain& chain, const double* a, const double* b) {
    double most = 0;
    for (int i = 0; i < chain.n; ++i) most = max(most, std::fabs(joint_difference(chain, i, a[i] - b[i])));
    return most;
}

// Twice the largest distance of any part of the arm from its base or from the goal [m]. Prismatic joints
// without limits are followed to this bound.
inline double far_away(const Redundant& arm, const Posed& goal) {
    double reach = norm(goal.t) + norm(arm.chain.tip.t);
    for (int i = 0; i < arm.chain.n; ++i) reach += 2 * norm(arm.chain.point[i]);
    return reach > 0 ? 2 * reach : 2.0;
}

// The domain of a parameter: [lower, upper], the full circle, or the bound of a prismatic joint.
struct Domain {
    double lower, upper;
    bool is_circle;
};
inline Domain domain_of(const Redundant& arm, int parameter, const Posed& goal) {
    const double lower = arm.lower[parameter], upper = arm.upper[parameter];
    if (!arm.chain.prismatic[parameter])
        return is_stopped(arm, parameter) ? Domain{lower, upper, false} : Domain{-pi, pi, true};
    const double far = far_away(arm, goal);
    return {max(lower, -far), min(upper, far), false};
}

// A generic value for each joint.
inline void typical_values(const Redundant& arm, double* at) {
    for (int i = 0; i < arm.chain.n; ++i) {
        const bool bounded = std::isfinite(arm.lower[i]) && std::isfinite(arm.upper[i]);
        const double lower = bounded ? arm.lower[i] : -1, upper = bounded ? arm.upper[i] : 1;
        const double part = 0.6180339887498949 * (i + 1) - std::floor(0.6180339887498949 * (i + 1));
        at[i] = lower + (0.2 + 0.6 * part) * (upper - lower);
    }
}

// Preference among the arms that remain after locking: closed forms on lanes, other closed forms, the general
// solver, no solver.
inline int rank_of(const Arm& arm) {
    if (arm.has_plan) return arm.plan.on_lanes && arm.plan.virtual_joints == 0 ? 3 : 2;
    if (arm.has_few_joints) return 2;
    return is_solvable(arm) ? 1 : 0;
}
// Whether the solutions at many values of the locked joint come from a closed form on lanes.
inline bool is_sampled_quickly(const Redundant& arm) {
    return arm.locked.at_ends && rank_of(arm.locked.arm) == 3 &&
           !arm.chain.prismatic[arm.locked.locked_joint[0]];
}
// Whether the nearest configuration is looked for along arcs that are followed: those of revolute joints, all
// of one scale.
inline bool has_arcs_to_follow(const Redundant& arm) {
    bool slides = false;
    for (int i = 0; i < arm.chain.n; ++i) slides = slides || arm.chain.prismatic[i];
    return arm.rank == 6 && arm.redundancy_degree == 1 && !slides && !is_sampled_quickly(arm);
}
// The arm with all joints locked except a basis.
inline LockedArm lock_outside(const Redundant& arm, unsigned basis, const double* typical,
                              bool with_general) {
    int locked_joint[max_joints], n_locked = 0;
    for (int i = 0; i < arm.chain.n; ++i)
        if (!(basis >> i & 1)) locked_joint[n_locked++] = i;
    return lock_joints(arm.chain, locked_joint, n_locked, typical, with_general);
}

// Sets of joints that may remain movable, in order of preference. First come consecutive joints from each
// joint on. Where consecutive joints are dependent, the nearest joints behind and before them are added. Then
// come all joints except one.
struct Bases {
    static constexpr int room = 2 * max_joints;
    int count = 0;
    unsigned joints[room];
};
inline void add_basis(const Redundant& arm, const int* order, Bases& out) {
    const Basis found = basis_of(arm.chain, arm.length, order, arm.chain.n);
    for (int k = 0; k < out.count; ++k)
        if (out.joints[k] == found.joints) return;
    if (found.rank == arm.rank) out.joints[out.count++] = found.joints;
}
inline bool are_neighbours(unsigned joints) {
    while (!(joints & 1)) joints >>= 1;
    return (joints & (joints + 1)) == 0;
}
inline Bases bases_of(const Redundant& arm) {
    Bases out;
    const int n = arm.chain.n;
    int order[max_joints];
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

// Chooses the joints to lock. Joints at the ends are preferred: the moving joints are then consecutive, and a
// locked value only moves the goal. Of equally good choices, the last joints are locked. An inner joint is
// locked only if no solver exists for consecutive joints.
inline void choose_locks(Redundant& arm) {
    double typical[max_joints];
    typical_values(arm, typical);
    const Bases bases = bases_of(arm);
    int best = -1, best_score = 0;
    for (int k = 0; k < bases.count; ++k) {
        if (arm.rank == 6 && !are_neighbours(bases.joints[k])) continue;
        const LockedArm locked = lock_outside(arm, bases.joints[k], typical, false);
        const int rank = locked.at_ends ? rank_of(locked.arm) : std::min(rank_of(locked.arm), 2);
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

// The number of dimensions that a pose leaves free when some joints are locked, given as a bit mask.
inline int redundancy_degree_with(const Redundant& arm, unsigned locked_joint) {
    int order[max_joints], count = 0;
    for (int i = 0; i < arm.chain.n; ++i)
        if (!(locked_joint >> i & 1)) order[count++] = i;
    return count - basis_of(arm.chain, arm.length, order, count).rank;
}

// lower, upper, weight: per joint. An arm without redundant joints has no joint to lock.
CSPACE_ONCE Redundant make_redundant(const Chain& chain, const double* lower, const double* upper,
                                     const double* weight) {
    Redundant arm;
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
    if (alike) arm.split_chain = make_split_chain(chain, arm.length);
    return arm;
}

}  // namespace cspace::ik::inline CSPACE_ISA
