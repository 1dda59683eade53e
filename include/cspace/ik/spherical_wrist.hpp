// Arms with a spherical wrist: the last three axes intersect in a point. The first three joints position this
// point, the last three orient the tool (Pieper 1968). Up to 4 × 2 solutions.
#pragma once

#include "cspace/ik/dh_form.hpp"
#include "cspace/ik/pieper.hpp"
#include "cspace/ik/solution.hpp"

namespace cspace::ik {

struct SphericalWrist {
    ThreeJoints first;
    Wrist last;
    double ca3, sa3;  // from joint 3 to joint 4
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline SphericalWrist make_spherical_wrist(const DhForm& f) {
    SphericalWrist arm;
    const Vec3d w = {f.a[2], -f.sa[2] * f.d[3], f.d[2] + f.ca[2] * f.d[3]};
    const double reach = std::hypot(w.x, w.y);
    const Turn<double> w_angle = {reach > 0 ? w.x / reach : 1, reach > 0 ? w.y / reach : 0};
    // A planar pair of links first: it is the cheapest and the best conditioned.
    const PieperCase kind = f.parallel[1]   ? PieperCase::last_parallel
                            : f.parallel[0] ? PieperCase::first_parallel
                            : f.meeting[0]  ? PieperCase::first_meet
                            : f.meeting[1]  ? PieperCase::last_meet
                                            : PieperCase::general;
    arm.first = {kind,    f.a[0],  f.ca[0], f.sa[0],  f.d[1], f.a[1],
                 f.ca[1], f.sa[1], w,       f.length, reach,  w_angle};
    arm.last = make_wrist(f.ca[3], f.sa[3], f.ca[4], f.sa[4]);
    arm.ca3 = f.ca[2];
    arm.sa3 = f.sa[2];
    return arm;
}

template <class V>
CSPACE_INLINE Triples<V> place_wrist(const ThreeJoints& g, const Vec3<V>& p,
                                     const ClosedFormSettings& settings) {
    switch (g.kind) {
        case PieperCase::last_parallel:
            return last_parallel(g, p, settings);
        case PieperCase::first_meet:
            return first_meet(g, p, settings);
        case PieperCase::last_meet:
            return last_meet(g, p, settings);
        case PieperCase::first_parallel:
            return first_parallel(g, p, settings);
        default:
            return pieper_quartic(g, p, settings);
    }
}

// The angles of both wrist solutions for a triple t of the first three joints, in two rows; R: the
// orientation in the base frame of the form, up to its tool frame. Returns the common view of the wrist.
template <class V>
CSPACE_INLINE WristView<V> write_wrist(const SphericalWrist& arm, const Turn<V> (&t)[3], const Mat3<V>& R,
                                       const ClosedFormSettings& settings, V* up, V* down) {
    const auto seen = [&](Vec3<V> v) {
        v = undo_joint(t[0], arm.first.ca1, arm.first.sa1, v);
        v = undo_joint(t[1], arm.first.ca2, arm.first.sa2, v);
        return undo_joint(t[2], arm.ca3, arm.sa3, v);
    };
    const Wrist& w = arm.last;
    const WristView<V> view =
        look_at_wrist(w, seen(matrix_column(R, 2)), seen(matrix_column(R, 0)), settings);
    for (int i = 0; i < 3; ++i) up[i] = down[i] = angle_of(t[i]);
    const WristSide<V> r = wrist_side(w, view, view.s5, settings.unconstrained[3]);
    up[3] = angle_of(r.t4);
    up[4] = atan2(r.t5.s, r.t5.c);
    up[5] = angle_of(r.t6);
    down[4] = -up[4];
    if (w.right_angled) {
        down[3] = up[3] - copysign(fill_lanes<V>(pi), up[3]);
        down[5] = up[5] - copysign(fill_lanes<V>(pi), up[5]);
    } else {
        const WristSide<V> other = wrist_side(w, view, -view.s5, settings.unconstrained[3]);
        down[3] = angle_of(other.t4);
        down[5] = angle_of(other.t6);
    }
    return view;
}

// goal: in the base frame of the form, up to its tool frame.
template <class V>
CSPACE_INLINE Branches<V> solve_spherical_wrist(const SphericalWrist& arm, const Pose<V>& goal,
                                                const ClosedFormSettings& settings) {
    const Triples<V> first = place_wrist(arm.first, goal.t, settings);
    Branches<V> out;
    out.doubt = first.doubt;
    for (int n = 0; n < 4; ++n) {
        const Turn<V> t[3] = {first.t[0][n], first.t[1][n], first.t[2][n]};
        const WristView<V> view = write_wrist(arm, t, goal.R, settings, out.t[2 * n], out.t[2 * n + 1]);
        out.ok[2 * n] = out.ok[2 * n + 1] = first.ok[n] && view.ok;
        out.doubt = out.doubt || (first.ok[n] && view.doubt);
    }
    return out;
}

// --- one goal: its four triples side by side on lanes ---------------------------------------------------
using Four = Pack<4>;

CSPACE_INLINE Turn<Four> side_by_side(const Turn<double>* t) {
    Turn<Four> out{};
    for (int k = 0; k < 4; ++k) {
        set_lane(out.c, k, t[k].c);
        set_lane(out.s, k, t[k].s);
    }
    return out;
}
CSPACE_INLINE Four side_by_side(const bool* ok) {
    Four out{};
    for (int k = 0; k < 4; ++k) set_lane(out, k, ok[k]);
    return out;
}

CSPACE_INLINE Abreast solve_abreast(const SphericalWrist& arm, const Posed& goal,
                                    const ClosedFormSettings& settings) {
    const Triples<double> first = place_wrist(arm.first, goal.t, settings);
    const Turn<Four> t[3] = {side_by_side(first.t[0]), side_by_side(first.t[1]), side_by_side(first.t[2])};
    Abreast out;
    const WristView<Four> view = write_wrist(arm, t, fill_mat3<Four>(goal.R), settings, out.t[0], out.t[1]);
    out.ok = (side_by_side(first.ok) > 0.0) && view.ok;
    out.doubt = first.doubt || any(out.ok && view.doubt);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
