// Virtual joints for arms of four and five joints: they complete the arm to six, at a place where the
// completed arm has a closed form. A pose that the arm reaches is one that the completed arm reaches with its
// virtual joints at zero.
#pragma once

#include <initializer_list>

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/refine.hpp"

namespace cspace::ik {

struct Axis {
    Vec3d direction, point;
};
struct AxisChoices {
    static constexpr int most = 40;
    int count = 0;
    Axis axis[most];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline void add_axis_choice(AxisChoices& choices, const Vec3d& direction, const Vec3d& point) {
    const double size = norm(direction);
    if (size > 0.1 && choices.count < AxisChoices::most)
        choices.axis[choices.count++] = {(1 / size) * direction, point};
}

// Candidate directions at a point on axis h whose adjacent axis is k.
inline void offer_at(AxisChoices& choices, const Vec3d& point, const Vec3d& h, const Vec3d& k) {
    add_axis_choice(choices, cross(h, k), point);
    add_axis_choice(choices, any_perpendicular(h), point);
    add_axis_choice(choices, cross(h, any_perpendicular(h)), point);
    add_axis_choice(choices, k, point);
}

// Candidate axes between joints at − 1 and `at`: through the points where the adjacent axes intersect their
// own neighbours, perpendicular to them or along them.
inline AxisChoices axes_to_insert(const Chain& c, int at) {
    AxisChoices choices;
    for (const int side : {-1, 1}) {
        const int near = side < 0 ? at - 1 : at, far = near + side;
        if (near < 0 || near >= c.n) continue;
        if (far < 0 || far >= c.n) {
            offer_at(choices, c.point[near], c.axis[near], any_perpendicular(c.axis[near]));
            continue;
        }
        const bool is_parallel = norm(cross(c.axis[near], c.axis[far])) < tolerance::axis_relation;
        const CommonNormal normal =
            common_normal(c.axis[near], c.point[near], c.axis[far], c.point[far], is_parallel, c.point[near]);
        offer_at(choices, normal.from, c.axis[near], c.axis[far]);
        if (normal.a > 0) offer_at(choices, normal.to, c.axis[near], c.axis[far]);
    }
    if (at == c.n) add_axis_choice(choices, any_perpendicular(c.axis[c.n - 1]), c.tip.t);
    return choices;
}

inline Chain with_axis(const Chain& c, int at, const Axis& axis) {
    Chain longer = c;
    for (int i = c.n; i > at; --i) {
        longer.axis[i] = c.axis[i - 1];
        longer.point[i] = c.point[i - 1];
    }
    longer.axis[at] = axis.direction;
    longer.point[at] = axis.point;
    longer.n = c.n + 1;
    return longer;
}

// `source[i]`: the joint of the arm that is joint i of the completed arm, or −1 for a virtual joint.
inline bool complete_plan(Plan& plan, const Chain& c, const int* source) {
    if (c.n == 6) {
        const auto is_virtual = [&](int i) { return source[i] < 0; };
        plan.completed = c;
        return completed_conditioning(c, characteristic_length(c), is_virtual) > regular_enough &&
               plan_six(plan, c, source);
    }
    for (int at = c.n; at >= 0; --at) {
        const AxisChoices choices = axes_to_insert(c, at);
        int longer_source[6];
        for (int i = 0; i <= c.n; ++i) longer_source[i] = i < at ? source[i] : i == at ? -1 : source[i - 1];
        for (int k = 0; k < choices.count; ++k)
            if (complete_plan(plan, with_axis(c, at, choices.axis[k]), longer_source)) return true;
    }
    return false;
}

// The plan of an arm of four to six revolute joints.
CSPACE_ONCE bool make_plan(Plan& plan, const Chain& chain) {
    plan.chain = chain;
    plan.family = Family::none;
    if (chain.n < 4 || chain.n > 6) return false;
    for (int i = 0; i < chain.n; ++i)
        if (chain.prismatic[i]) return false;
    const int source[6] = {0, 1, 2, 3, 4, 5};
    plan.virtual_joints = 6 - chain.n;
    constexpr double rounding = tolerance::always_singular;
    if (chain.n < 6)
        return !is_always_singular(chain, characteristic_length(chain), rounding) &&
               complete_plan(plan, chain, source);
    if (plan_six(plan, chain, source) &&
        !is_always_singular(chain, plan.form.length, max(rounding, 10 * plan.form.deviation)))
        return true;
    plan.family = Family::none;
    return false;
}

}  // namespace cspace::ik::inline CSPACE_ISA
