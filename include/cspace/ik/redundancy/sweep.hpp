// All solutions at many values of one locked joint. If that joint is at an end of the chain, the goal of the
// six moving joints is an affine function of its cosine and sine (or of its value, if it is prismatic). The
// closed form is evaluated for several values at once, on lanes.
#pragma once

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/redundancy/redundant_arm.hpp"
#include "cspace/ik/refine.hpp"

namespace cspace::ik {

// G(v) = still + c · cosine + s · sine, entry by entry; c = v, s = 0 for a prismatic joint.
struct MovingGoal {
    Posed still, cosine, sine;
    bool slides;
};

// Solves arm `locked` at values of its locked joint `parameter`.
struct Sweep {
    const LockedArm* locked;
    int parameter;
    Posed goal;
    double at[max_joints];  // of the other locked joints
    bool on_lanes;
    MovingGoal in_chain, in_form;
};

// The solutions at one value, as rows of the whole chain.
struct SweptRows {
    int count = 0;
    bool complete = true;
    double q[max_solutions][max_joints];
    int branch[max_solutions];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// a + b − c and the like, entry by entry.
inline Posed combined(const Posed& A, double a, const Posed& B, double b) {
    Posed out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out.R.m[i][j] = a * A.R.m[i][j] + b * B.R.m[i][j];
    out.t = a * A.t + b * B.t;
    return out;
}
// From the goal at 0, π/2 and π, or at 0 and 1 for a prismatic joint.
template <class GoalAt>
inline MovingGoal moving_goal(bool slides, const GoalAt& goal_at) {
    MovingGoal out;
    out.slides = slides;
    const Posed zero = goal_at(0.0);
    if (slides) {
        out.still = zero;
        out.cosine = combined(goal_at(1.0), 1, zero, -1);
        out.sine = combined(zero, 0, zero, 0);
        return out;
    }
    const Posed half = goal_at(pi), quarter = goal_at(0.5 * pi);
    out.still = combined(zero, 0.5, half, 0.5);
    out.cosine = combined(zero, 0.5, half, -0.5);
    out.sine = combined(quarter, 1, out.still, -1);
    return out;
}
template <class V>
CSPACE_INLINE Pose<V> goal_at(const MovingGoal& goal, V c, V s) {
    const auto entry = [&](double still, double cosine, double sine) {
        return mul_add(s, fill<V>(sine), mul_add(c, fill<V>(cosine), fill<V>(still)));
    };
    Pose<V> out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out.R.m[i][j] = entry(goal.still.R.m[i][j], goal.cosine.R.m[i][j], goal.sine.R.m[i][j]);
    out.t = {entry(goal.still.t.x, goal.cosine.t.x, goal.sine.t.x),
             entry(goal.still.t.y, goal.cosine.t.y, goal.sine.t.y),
             entry(goal.still.t.z, goal.cosine.t.z, goal.sine.t.z)};
    return out;
}
template <class V>
CSPACE_INLINE void value_on_circle(const MovingGoal& goal, V value, V& c, V& s) {
    if (goal.slides) {
        c = value;
        s = fill<V>(0.0);
    } else {
        sincos(value, s, c);
    }
}

// at: the values of all locked joints; the value of the parameter is ignored.
CSPACE_ONCE Sweep make_sweep(const LockedArm& locked, int parameter, const Posed& goal, const double* at) {
    Sweep sweep;
    sweep.locked = &locked;
    sweep.parameter = parameter;
    sweep.goal = goal;
    for (int i = 0; i < locked.whole.n; ++i) sweep.at[i] = at[i];
    sweep.on_lanes = locked.at_ends && rank_of(locked.arm) == 3;
    if (!sweep.on_lanes) return sweep;
    const Plan& plan = locked.arm.plan;
    const auto in_chain = [&](double value) {
        sweep.at[parameter] = value;
        return goal_between_ends(locked, goal, sweep.at);
    };
    const bool slides = locked.whole.prismatic[parameter];
    sweep.in_chain = moving_goal(slides, in_chain);
    sweep.in_form = moving_goal(slides, [&](double value) { return goal_in_form(plan, in_chain(value)); });
    return sweep;
}

inline void near_singular_rows(const Sweep& sweep, double value, SweptRows& out) {
    double at[max_joints];
    for (int i = 0; i < sweep.locked->whole.n; ++i) at[i] = sweep.at[i];
    at[sweep.parameter] = value;
    const Solutions found = solve_locked(*sweep.locked, sweep.goal, at, nullptr);
    out.count = found.count;
    out.complete = found.complete;
    for (int k = 0; k < found.count; ++k) {
        whole_row(*sweep.locked, at, found.q[k], out.q[k]);
        out.branch[k] = found.branch[k];
    }
}

// The angles of every branch on lanes, corrected on the true chain where the closed form idealises it.
template <class V>
CSPACE_NOINLINE void branches_at(const Sweep& sweep, V value, Branches<V>& b) {
    const Plan& plan = sweep.locked->arm.plan;
    V c, s;
    value_on_circle(sweep.in_form, value, c, s);
    b = closed_form(plan, goal_at(sweep.in_form, c, s), care_of(plan));
    for (int k = 0; k < max_branches; ++k) {
        V angles[6];
        for (int i = 0; i < 6; ++i) angles[plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
        if (plan.polish && any(b.ok[k])) {
            const Pose<V> goal = goal_at(sweep.in_chain, c, s);
            b.doubt = b.doubt || (b.ok[k] && !polish(plan.chain, goal, plan.form.length, angles));
            for (int i = 0; i < 6; ++i) angles[i] = wrap_once(angles[i]);
        }
        for (int i = 0; i < 6; ++i) b.t[k][i] = angles[i];
    }
}

// Calls visit(index, rows) for every value, in order.
template <class Visit>
inline void sweep_values(const Sweep& sweep, const double* values, int n, const Visit& visit) {
    using V = Pack<4>;
    SweptRows rows;
    const LockedArm& locked = *sweep.locked;
    for (int first = 0; first < n; first += 4) {
        const int lanes = n - first < 4 ? n - first : 4;
        Branches<V> b;
        if (sweep.on_lanes) branches_at(sweep, load<V>(values + first, lanes), b);
        for (int l = 0; l < lanes; ++l) {
            if (!sweep.on_lanes || lane(b.doubt, l)) {
                near_singular_rows(sweep, values[first + l], rows);
                visit(first + l, rows);
                continue;
            }
            rows.count = 0;
            rows.complete = true;
            for (int k = 0; k < max_branches; ++k) {
                if (!lane(b.ok[k], l)) continue;
                double* q = rows.q[rows.count];
                for (int i = 0; i < locked.n_locked; ++i)
                    q[locked.locked_joint[i]] = sweep.at[locked.locked_joint[i]];
                q[sweep.parameter] = values[first + l];
                for (int i = 0; i < 6; ++i) q[locked.moving[i]] = lane(b.t[k][i], l);
                rows.branch[rows.count++] = k;
            }
            visit(first + l, rows);
        }
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
