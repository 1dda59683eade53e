// Folds of the branches as functions of a locked joint: the double roots of a closed form.
//
// With axes 1 and 2 of the form meeting (see pieper.hpp), t3 solves a cos t3 + b sin t3 = r(v),
// where r is of first degree in the cosine and sine of v, so that n² − r² is a trigonometric polynomial of
// degree 2. The discriminant of t2 is U ± √(n² − r²) W for the two t3. The product U² − (n² − r²) W² has
// degree 4. All roots are isolated by the method of the general solver's determinant.
#pragma once

#include "cspace/ik/general/isolate.hpp"
#include "cspace/ik/redundancy/curve.hpp"
#include "cspace/ik/redundancy/sweep.hpp"

namespace cspace::ik {

struct FoldValues {
    static constexpr int room = 256;
    int count = 0;
    double value[room];  // of the locked joint, in (−π, π]
    int branch[room];    // which branch folds there; −1: whichever vanish there
    bool exact = false;  // none is missing
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// n² − r² and the product of the discriminants of t2, at a goal on the circle.
template <class V>
struct Rooms {
    V elbow, lift;
};
template <class V>
CSPACE_INLINE Rooms<V> rooms_of(const ThreeJoints& g, const Vec3<V>& p) {
    const double a = g.a2 * g.w.x + g.d2 * g.sa2 * g.w.y, b = g.d2 * g.sa2 * g.w.x - g.a2 * g.w.y;
    const double fixed = 0.5 * (g.a2 * g.a2 + g.d2 * g.d2 + dot(g.w, g.w)) + g.d2 * g.ca2 * g.w.z;
    const double n2 = a * a + b * b;
    const V r = 0.5 * dot(p, p) - fixed;
    const V room = n2 - r * r;
    // (cos t3, sin t3) = (r (a, b) ∓ h (b, −a)) / n², h² = room, and v is linear in them.
    const auto behind = [&](V c, V s) {
        const V x = c * g.w.x - s * g.w.y, y = s * g.w.x + c * g.w.y;
        return Vec3<V>{x, g.ca2 * y, g.sa2 * y};
    };
    const Vec3<V> level = behind(r * (a / n2), r * (b / n2));
    const Vec3<V> tilt = behind(fill<V>(-b / n2), fill<V>(a / n2));
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
inline bool has_square_wrist(const Wrist& w) { return std::fabs(w.ca4) < 1e-4 && std::fabs(w.ca5) < 1e-4; }

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
    const Plan& plan = sweep.locked->arm.plan;
    const Posed goal = goal_at(sweep.in_form, std::cos(value), std::sin(value));
    Care care = care_of(plan);
    care.band = 1e-3;
    const Branches<double> b = solve_closed_form(plan, goal, care);
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
        Pack<4> at = fill<Pack<4>>(value), c, s;
        for (int k = 0; k < 4; k += 2) set_lane(at, k, value + (k - 1) * h);
        sincos(at, s, c);
        const Pack<4> there = f(c, s);
        const double slope = (lane(there, 2) - lane(there, 0)) / (2 * h), change = lane(there, 1) / slope;
        if (!(std::fabs(change) < farthest)) break;
        value -= change;
    }
    return value;
}
template <class Function>
inline void add_roots(const Redundant& arm, const Sweep& sweep, const Function& f, FoldValues& out) {
    HiddenAngles hidden;
    isolate(f, 1e-8, hidden);
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
    if (plan.family != Family::spherical_wrist || arm.first.kind != FirstThree::first_meet ||
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
