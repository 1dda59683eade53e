// Position problem of the first three joints: they move a point w, fixed behind joint 3, to p:
//   p = Rz(t1) Tx(a1) Rx(α1) · Rz(t2) Tz(d2) Tx(a2) Rx(α2) · Rz(t3) w        (Pieper 1968)
// Five cases by the geometry of the three axes; each gives up to four triples of angles.
#pragma once

#include "cspace/ik/trig_steps.hpp"

namespace cspace::ik {

enum class FirstThree {
    last_parallel,   // axes 2 ∥ 3
    first_meet,      // axes 1 and 2 meet
    last_meet,       // axes 2 and 3 meet
    first_parallel,  // axes 1 ∥ 2
    general,         // none of these: a quartic
};

struct ThreeJoints {
    FirstThree kind;
    double a1, ca1, sa1, d2, a2, ca2, sa2;
    Vec3d w;
    double length;         // [m], the size of things
    double wrist_reach;    // distance of w from axis 3
    Turn<double> w_angle;  // direction of w about axis 3
};

template <class V>
struct Triples {
    Turn<V> t1[4], t2[4], t3[4];
    mask_of<V> ok[4];
    mask_of<V> doubt;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Axes 2 ∥ 3: the height of p over their plane determines t1, a planar two-link arm t2 and t3.
template <class V>
CSPACE_INLINE Triples<V> last_parallel(const ThreeJoints& g, const Vec3<V>& p, const Care& care) {
    Triples<V> out;
    const V k = ((g.w.z + g.d2) - g.ca1 * p.z) * (1 / g.sa1);
    // s1 px − c1 py = k
    const TwoAngles<V> shoulder = linear_equation<V>(-p.y, p.x, k, g.length, care, care.unconstrained[0]);
    out.doubt = shoulder.doubt;
    for (int i = 0; i < 2; ++i) {
        const Turn<V>& t1 = shoulder.root[i];
        const V x = t1.c * p.x + t1.s * p.y - g.a1;
        const V y = g.ca1 * (t1.c * p.y - t1.s * p.x) + g.sa1 * p.z;
        const TwoLink<V> arm = two_link(x, y, g.a2, g.wrist_reach, g.length, care, care.unconstrained[1]);
        out.doubt = out.doubt || (shoulder.ok && arm.doubt);
        for (int j = 0; j < 2; ++j) {
            const int n = 2 * i + j;
            const Turn<V> elbow = {arm.cos_elbow, j == 0 ? arm.sin_elbow : -arm.sin_elbow};
            const Turn<V> w = {fill<V>(g.w_angle.c), fill<V>(g.w_angle.s)};
            out.t1[n] = t1;
            out.t2[n] = arm.first[j];
            out.t3[n] = elbow - w;
            out.ok[n] = shoulder.ok && arm.ok;
        }
    }
    return out;
}

// w after joint 3, before joint 2: Rz(t3) w, then v = (a2, 0, d2) + Rx(α2) Rz(t3) w.
template <class V>
CSPACE_INLINE Vec3<V> behind_joint_two(const ThreeJoints& g, const Turn<V>& t3) {
    const V x = t3.c * g.w.x - t3.s * g.w.y, y = t3.s * g.w.x + t3.c * g.w.y;
    return {x + g.a2, g.ca2 * y - g.sa2 * g.w.z, g.sa2 * y + (g.ca2 * g.w.z + g.d2)};
}

// Axes 1 and 2 intersect: the distance of p from their intersection determines t3, its height along axis 1
// t2, its bearing t1.
template <class V>
CSPACE_INLINE Triples<V> first_meet(const ThreeJoints& g, const Vec3<V>& p, const Care& care) {
    Triples<V> out;
    const double a = g.a2 * g.w.x + g.d2 * g.sa2 * g.w.y, b = g.d2 * g.sa2 * g.w.x - g.a2 * g.w.y;
    const double fixed = 0.5 * (g.a2 * g.a2 + g.d2 * g.d2 + dot(g.w, g.w)) + g.d2 * g.ca2 * g.w.z;
    const TwoAngles<V> elbow = linear_equation<V>(fill<V>(a), fill<V>(b), 0.5 * dot(p, p) - fixed,
                                                  std::hypot(a, b), care, care.unconstrained[2]);
    out.doubt = elbow.doubt;
    for (int i = 0; i < 2; ++i) {
        const Vec3<V> v = behind_joint_two(g, elbow.root[i]);
        const TwoAngles<V> lift = linear_equation<V>(g.sa1 * v.y, g.sa1 * v.x, p.z - g.ca1 * v.z, g.length,
                                                     care, care.unconstrained[1]);
        out.doubt = out.doubt || (elbow.ok && lift.doubt);
        for (int j = 0; j < 2; ++j) {
            const Turn<V>& t2 = lift.root[j];
            const V x = t2.c * v.x - t2.s * v.y, y = g.ca1 * (t2.s * v.x + t2.c * v.y) - g.sa1 * v.z;
            const Aligned<V> pan = align(x, y, p.x, p.y, g.length, care, care.unconstrained[0]);
            const int n = 2 * i + j;
            out.t1[n] = pan.t;
            out.t2[n] = t2;
            out.t3[n] = elbow.root[i];
            out.ok[n] = elbow.ok && lift.ok;
            out.doubt = out.doubt || (out.ok[n] && pan.doubt);
        }
    }
    return out;
}

// Axes 2 and 3 intersect: the distance of p from their intersection determines t1, then a height along axis 2
// t3, a bearing t2.
template <class V>
CSPACE_INLINE Triples<V> last_meet(const ThreeJoints& g, const Vec3<V>& p, const Care& care) {
    Triples<V> out;
    const double out_of_plane = -g.sa1 * g.d2, height = g.ca1 * g.d2;
    const V r = 0.5 * (dot(p, p) + (g.a1 * g.a1 + g.d2 * g.d2 - dot(g.w, g.w))) - height * p.z;
    const TwoAngles<V> pan =
        linear_equation<V>(g.a1 * p.x + out_of_plane * p.y, g.a1 * p.y - out_of_plane * p.x, r,
                           g.length * std::hypot(g.a1, out_of_plane), care, care.unconstrained[0]);
    out.doubt = pan.doubt;
    for (int i = 0; i < 2; ++i) {
        const Turn<V>& t1 = pan.root[i];
        const V x1 = t1.c * p.x + t1.s * p.y - g.a1, y1 = t1.c * p.y - t1.s * p.x;
        const V y = g.ca1 * y1 + g.sa1 * p.z, z = g.ca1 * p.z - g.sa1 * y1 - g.d2;
        const TwoAngles<V> elbow =
            linear_equation<V>(fill<V>(g.sa2 * g.w.y), fill<V>(g.sa2 * g.w.x), z - g.ca2 * g.w.z,
                               g.sa2 * g.wrist_reach, care, care.unconstrained[2]);
        out.doubt = out.doubt || (pan.ok && elbow.doubt);
        for (int j = 0; j < 2; ++j) {
            const Vec3<V> v = behind_joint_two(g, elbow.root[j]);
            const Aligned<V> lift = align(v.x, v.y, x1, y, g.length, care, care.unconstrained[1]);
            const int n = 2 * i + j;
            out.t1[n] = t1;
            out.t2[n] = lift.t;
            out.t3[n] = elbow.root[j];
            out.ok[n] = pan.ok && elbow.ok;
            out.doubt = out.doubt || (out.ok[n] && lift.doubt);
        }
    }
    return out;
}

// Axes 1 ∥ 2: the height of p determines t3, its distance from axis 1 t2, its bearing t1.
template <class V>
CSPACE_INLINE Triples<V> first_parallel(const ThreeJoints& g, const Vec3<V>& p, const Care& care) {
    Triples<V> out;
    const TwoAngles<V> elbow =
        linear_equation<V>(fill<V>(g.sa2 * g.w.y), fill<V>(g.sa2 * g.w.x), p.z - (g.d2 + g.ca2 * g.w.z),
                           g.sa2 * g.wrist_reach, care, care.unconstrained[2]);
    out.doubt = elbow.doubt;
    for (int i = 0; i < 2; ++i) {
        const Vec3<V> v = behind_joint_two(g, elbow.root[i]);
        const V r = (p.x * p.x + p.y * p.y - (v.x * v.x + v.y * v.y) - g.a1 * g.a1) * (0.5 / g.a1);
        const TwoAngles<V> lift = linear_equation<V>(v.x, -v.y, r, g.length, care, care.unconstrained[1]);
        out.doubt = out.doubt || (elbow.ok && lift.doubt);
        for (int j = 0; j < 2; ++j) {
            const Turn<V>& t2 = lift.root[j];
            const Aligned<V> pan = align(t2.c * v.x - t2.s * v.y + g.a1, t2.s * v.x + t2.c * v.y, p.x, p.y,
                                         g.length, care, care.unconstrained[0]);
            const int n = 2 * i + j;
            out.t1[n] = pan.t;
            out.t2[n] = t2;
            out.t3[n] = elbow.root[i];
            out.ok[n] = elbow.ok && lift.ok;
            out.doubt = out.doubt || (out.ok[n] && pan.doubt);
        }
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
