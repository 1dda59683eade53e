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
    ThreeJoints& g = arm.first;
    g = {FirstThree::general,
         f.a[0],
         f.ca[0],
         f.sa[0],
         f.d[1],
         f.a[1],
         f.ca[1],
         f.sa[1],
         w,
         f.length,
         reach,
         w_angle};
    // A planar pair of links first: it is the cheapest and the best conditioned.
    if (f.parallel[1])
        g.kind = FirstThree::last_parallel;
    else if (f.parallel[0])
        g.kind = FirstThree::first_parallel;
    else if (f.meeting[0])
        g.kind = FirstThree::first_meet;
    else if (f.meeting[1])
        g.kind = FirstThree::last_meet;
    arm.last = make_wrist(f.ca[3], f.sa[3], f.ca[4], f.sa[4]);
    arm.ca3 = f.ca[2];
    arm.sa3 = f.sa[2];
    return arm;
}

template <FirstThree kind, class V>
CSPACE_INLINE Triples<V> place_wrist(const ThreeJoints& g, const Vec3<V>& p, const Care& care) {
    if constexpr (kind == FirstThree::last_parallel) return last_parallel(g, p, care);
    if constexpr (kind == FirstThree::first_parallel) return first_parallel(g, p, care);
    if constexpr (kind == FirstThree::first_meet) return first_meet(g, p, care);
    if constexpr (kind == FirstThree::last_meet) return last_meet(g, p, care);
    if constexpr (kind == FirstThree::general) return any_three(g, p, care);
}

// The orientation behind the first three joints, in the frame of the wrist.
template <class V>
CSPACE_INLINE WristAngles<V> turn_wrist(const SphericalWrist& arm, const Turn<V>& t1, const Turn<V>& t2,
                                        const Turn<V>& t3, const Mat3<V>& R, const Care& care) {
    Vec3<V> seen[2];
    for (int k = 0; k < 2; ++k) {
        Vec3<V> v = column(R, k == 0 ? 2 : 0);
        v = undo_joint(t1, arm.first.ca1, arm.first.sa1, v);
        v = undo_joint(t2, arm.first.ca2, arm.first.sa2, v);
        seen[k] = undo_joint(t3, arm.ca3, arm.sa3, v);
    }
    return wrist(arm.last, seen[0], seen[1], care, care.unconstrained[3]);
}

// The angles of both wrist solutions for one triple of the first three joints.
template <class V>
CSPACE_INLINE void write_wrist(const Wrist& w, const WristAngles<V>& r, V* flip_up, V* flip_down) {
    flip_up[3] = angle_of(r.t4[0]);
    flip_up[4] = atan2(r.t5[0].s, r.t5[0].c);
    flip_up[5] = angle_of(r.t6[0]);
    flip_down[4] = -flip_up[4];
    if (w.right_angled) {
        flip_down[3] = flip_up[3] - copysign(fill<V>(pi), flip_up[3]);
        flip_down[5] = flip_up[5] - copysign(fill<V>(pi), flip_up[5]);
    } else {
        flip_down[3] = angle_of(r.t4[1]);
        flip_down[5] = angle_of(r.t6[1]);
    }
}

template <class V>
CSPACE_INLINE Branches<V> finish_with_wrist(const SphericalWrist& arm, const Triples<V>& first,
                                            const Mat3<V>& R, const Care& care) {
    Branches<V> out;
    out.doubt = first.doubt;
    for (int n = 0; n < 4; ++n) {
        const WristAngles<V> r = turn_wrist(arm, first.t1[n], first.t2[n], first.t3[n], R, care);
        V* up = out.t[2 * n];
        V* down = out.t[2 * n + 1];
        up[0] = down[0] = angle_of(first.t1[n]);
        up[1] = down[1] = angle_of(first.t2[n]);
        up[2] = down[2] = angle_of(first.t3[n]);
        write_wrist(arm.last, r, up, down);
        out.ok[2 * n] = out.ok[2 * n + 1] = first.ok[n] && r.ok;
        out.doubt = out.doubt || (first.ok[n] && r.doubt);
    }
    return out;
}

// goal: in the base frame of the form, up to its tool frame.
template <FirstThree kind, class V>
CSPACE_INLINE Branches<V> solve_spherical_wrist(const SphericalWrist& arm, const Pose<V>& goal,
                                                const Care& care) {
    return finish_with_wrist(arm, place_wrist<kind>(arm.first, goal.t, care), goal.R, care);
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

template <FirstThree kind>
CSPACE_INLINE Abreast solve_abreast(const SphericalWrist& arm, const Posed& goal, const Care& care) {
    const Triples<double> first = place_wrist<kind>(arm.first, goal.t, care);
    const Turn<Four> t1 = side_by_side(first.t1), t2 = side_by_side(first.t2), t3 = side_by_side(first.t3);
    const WristAngles<Four> r = turn_wrist(arm, t1, t2, t3, fill33<Four>(goal.R), care);
    Abreast out;
    out.t[0][0] = out.t[1][0] = angle_of(t1);
    out.t[0][1] = out.t[1][1] = angle_of(t2);
    out.t[0][2] = out.t[1][2] = angle_of(t3);
    write_wrist(arm.last, r, out.t[0], out.t[1]);
    const Mask<4> ok = (side_by_side(first.ok) > 0.0) && r.ok;
    out.ok[0] = out.ok[1] = ok;
    out.doubt = first.doubt || any(ok && r.doubt);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
