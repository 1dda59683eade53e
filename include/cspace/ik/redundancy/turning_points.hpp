// Folds of the branches as functions of a locked joint: the double roots of a closed form.
//
// With axes 1 and 2 of the form meeting (see pieper.hpp), t3 solves a cos t3 + b sin t3 = r(v),
// where r is of first degree in the cosine and sine of v, so that n² − r² is a trigonometric polynomial of
// degree 2. The discriminant of t2 is U ± √(n² − r²) W for the two t3. The product U² − (n² − r²) W² has
// degree 4. All roots are isolated by the method of the general solver's determinant.
#pragma once

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/general/isolate.hpp"
#include "cspace/ik/redundancy/redundant_arm.hpp"
#include "cspace/ik/redundancy/tip_jacobian.hpp"
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

struct FoldValues {
    static constexpr int room = 256;
    int count = 0;
    double value[room];  // of the locked joint, in (−π, π]
    int branch[room];    // which branch folds there; −1: whichever vanish there
    bool exact = false;  // none is missing
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// All solutions at many values of one locked joint. If that joint is at an end of the chain, the goal of the
// six moving joints is an affine function of its cosine and sine (or of its value, if it is prismatic). The
// closed form is evaluated for several values at once, on lanes.

// a + b − c and the like, entry by entry.
inline Posed combine_poses(const Posed& A, double a, const Posed& B, double b) {
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
        out.cosine = combine_poses(goal_at(1.0), 1, zero, -1);
        out.sine = combine_poses(zero, 0, zero, 0);
        return out;
    }
    const Posed half = goal_at(pi), quarter = goal_at(0.5 * pi);
    out.still = combine_poses(zero, 0.5, half, 0.5);
    out.cosine = combine_poses(zero, 0.5, half, -0.5);
    out.sine = combine_poses(quarter, 1, out.still, -1);
    return out;
}
template <class V>
CSPACE_INLINE Pose<V> goal_at(const MovingGoal& goal, V c, V s) {
    const auto entry = [&](double still, double cosine, double sine) {
        return mul_add(s, fill_lanes<V>(sine), mul_add(c, fill_lanes<V>(cosine), fill_lanes<V>(still)));
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
        s = fill_lanes<V>(0.0);
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
    b = closed_form(plan, goal_at(sweep.in_form, c, s), closed_form_settings(plan));
    for (int k = 0; k < max_branches; ++k) {
        V angles[6];
        for (int i = 0; i < 6; ++i) angles[plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
        if (plan.polish && any(b.ok[k])) {
            const Pose<V> goal = goal_at(sweep.in_chain, c, s);
            b.doubt = b.doubt || (b.ok[k] && !polish_solution(plan.chain, goal, plan.form.length, angles));
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
        if (sweep.on_lanes) branches_at(sweep, load_lanes<V>(values + first, lanes), b);
        for (int l = 0; l < lanes; ++l) {
            if (!sweep.on_lanes || get_lane(b.doubt, l)) {
                near_singular_rows(sweep, values[first + l], rows);
                visit(first + l, rows);
                continue;
            }
            rows.count = 0;
            rows.complete = true;
            for (int k = 0; k < max_branches; ++k) {
                if (!get_lane(b.ok[k], l)) continue;
                double* q = rows.q[rows.count];
                for (int i = 0; i < locked.n_locked; ++i)
                    q[locked.locked_joint[i]] = sweep.at[locked.locked_joint[i]];
                q[sweep.parameter] = values[first + l];
                for (int i = 0; i < 6; ++i) q[locked.moving[i]] = get_lane(b.t[k][i], l);
                rows.branch[rows.count++] = k;
            }
            visit(first + l, rows);
        }
    }
}

// n² − r² and the product of the discriminants of t2, at a goal on the circle.
template <class V>
struct Rooms {
    V elbow, lift;
};
template <class V>
CSPACE_INLINE Rooms<V> rooms_of(const ThreeJoints& g, const Vec3<V>& p) {
    const auto [fixed, a, b] = half_square_behind(g);
    const double n2 = a * a + b * b;
    const V r = 0.5 * dot(p, p) - fixed;
    const V room = n2 - r * r;
    // (cos t3, sin t3) = (r (a, b) ∓ h (b, −a)) / n², h² = room, and v is linear in them.
    const auto behind = [&](V c, V s) {
        const V x = c * g.w.x - s * g.w.y, y = s * g.w.x + c * g.w.y;
        return Vec3<V>{x, g.ca2 * y, g.sa2 * y};
    };
    const Vec3<V> level = behind(r * (a / n2), r * (b / n2));
    const Vec3<V> tilt = behind(fill_lanes<V>(-b / n2), fill_lanes<V>(a / n2));
    const Vec3<V> middle = {level.x + g.a2, level.y - g.sa2 * g.w.z, level.z + (g.ca2 * g.w.z + g.d2)};
    // room of t2 = sin²α1 (v_x² + v_y²) − (p_z − cos α1 v_z)²
    const double sa2 = g.sa1 * g.sa1;
    const V across = p.z - g.ca1 * middle.z, slope = -g.ca1 * tilt.z;
    const V even =
        sa2 * (middle.x * middle.x + middle.y * middle.y + room * (tilt.x * tilt.x + tilt.y * tilt.y)) -
        (across * across + room * slope * slope);
    const V odd = 2.0 * (sa2 * (middle.x * tilt.x + middle.y * tilt.y) - across * slope);
    return {room, even * even - room * odd * odd};
}

// Whether the two solutions of the wrist coincide at isolated configurations only: both its twist angles are
// 90°.
inline bool has_square_wrist(const Wrist& w) {
    constexpr double square = 1e-4;  // as far as calibration moves an axis
    return std::fabs(w.ca4) < square && std::fabs(w.ca5) < square;
}

inline void add_fold(FoldValues& out, double value, int branch) {
    if (out.count == FoldValues::room) {
        out.exact = false;
        return;
    }
    out.value[out.count] = wrap_angle(value);
    out.branch[out.count++] = branch;
}
// The folds of an idealised form are close to those of the arm, at a slightly different value for each pair
// of branches.
inline void add_true_folds(const Redundant& arm, const Sweep& sweep, double value, FoldValues& out) {
    constexpr double around_fold = 1e-3;  // of a square root's argument: as far as an idealised form is off
    const Plan& plan = sweep.locked->arm.plan;
    const Posed goal = goal_at(sweep.in_form, std::cos(value), std::sin(value));
    ClosedFormSettings settings = closed_form_settings(plan);
    settings.band = around_fold;
    const Branches<double> b = solve_closed_form(plan, goal, settings);
    for (int k = 0; k < max_branches; ++k) {
        if (!b.ok[k]) continue;
        CurvePoint at;
        for (int i = 0; i < sweep.locked->n_locked; ++i)
            at.q[sweep.locked->locked_joint[i]] = sweep.at[sweep.locked->locked_joint[i]];
        at.q[sweep.parameter] = value;
        for (int i = 0; i < 6; ++i)
            at.q[sweep.locked->moving[plan.joint[i]]] = joint_angle(plan, i, b.t[k][i]);
        if (settle_fold(arm.chain, arm.rank, sweep.goal, arm.length, sweep.parameter, 0.1, at))
            add_fold(out, at.q[sweep.parameter], k);
    }
}
// Isolated roots are accurate to 1e-8; two Newton steps refine them to rounding.
template <class Function>
inline double settled_root(const Function& f, double value) {
    constexpr double h = 1e-5, farthest = 1e-6;
    for (int step = 0; step < 2; ++step) {
        Pack<4> at = fill_lanes<Pack<4>>(value), c, s;
        for (int k = 0; k < 4; k += 2) set_lane(at, k, value + (k - 1) * h);
        sincos(at, s, c);
        const Pack<4> there = f(c, s);
        const double slope = (get_lane(there, 2) - get_lane(there, 0)) / (2 * h),
                     change = get_lane(there, 1) / slope;
        if (!(std::fabs(change) < farthest)) break;
        value -= change;
    }
    return value;
}
template <class Function>
inline void add_roots(const Redundant& arm, const Sweep& sweep, const Function& f, FoldValues& out) {
    constexpr double slip = 1e-8;  // of a function whose values keep half of their digits
    HiddenAngles hidden;
    isolate_roots(f, slip, hidden);
    out.exact = out.exact && !hidden.overflow;
    for (int k = 0; k < hidden.count; ++k) {
        hidden.root[k].angle = settled_root(f, hidden.root[k].angle);
        if (sweep.locked->arm.plan.idealised)
            add_true_folds(arm, sweep, hidden.root[k].angle, out);
        else
            add_fold(out, hidden.root[k].angle, -1);
    }
}

CSPACE_ONCE FoldValues fold_values(const Redundant& whole, const Sweep& sweep) {
    FoldValues out;
    if (!sweep.on_lanes || sweep.in_form.slides) return out;
    const Plan& plan = sweep.locked->arm.plan;
    const SphericalWrist& arm = plan.wrist;
    if (plan.family != Family::spherical_wrist || arm.first.kind != PieperCase::first_meet ||
        !has_square_wrist(arm.last))
        return out;
    out.exact = true;
    const auto rooms = [&](Pack<4> c, Pack<4> s) {
        return rooms_of(arm.first, goal_at(sweep.in_form, c, s).t);
    };
    add_roots(whole, sweep, [&](Pack<4> c, Pack<4> s) { return rooms(c, s).elbow; }, out);
    add_roots(whole, sweep, [&](Pack<4> c, Pack<4> s) { return rooms(c, s).lift; }, out);
    return out;
}

// [rad, m] Values of the parameter closer than this count as one place: the square root of the form's error.
// Where two branches all but meet, nothing can be told from a value in between.
inline double fuzz_of(const Plan& plan) {
    constexpr double merging = 1e-6, merging_idealised = 1e-4;
    return plan.idealised ? merging_idealised : merging;
}

// The folds in [start, start + 2π), sorted; the first is repeated at + 2π.
inline int sort_folds(const FoldValues& folds, double start, double* sorted) {
    const int n = folds.count;
    for (int k = 0; k < n; ++k) {
        const double value = wrap_above(folds.value[k], start);
        int at = k;
        for (; at > 0 && sorted[at - 1] > value; --at) sorted[at] = sorted[at - 1];
        sorted[at] = value;
    }
    if (n > 0) sorted[n] = sorted[0] + 2 * pi;
    return n;
}

}  // namespace cspace::ik::inline CSPACE_ISA
