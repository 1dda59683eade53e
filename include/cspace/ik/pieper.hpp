// Position problem of the first three joints: they move a point w, fixed behind joint 3, to p:
//   p = Rz(t1) Tx(a1) Rx(α1) · Rz(t2) Tz(d2) Tx(a2) Rx(α2) · Rz(t3) w        (Pieper 1968)
// Five cases by the geometry of the three axes; each gives up to four triples of angles.
#pragma once

#include "cspace/ik/trig_steps.hpp"
#include "cspace/math/trig_polynomial.hpp"

namespace cspace::ik {

enum class PieperCase {
    last_parallel,   // axes 2 ∥ 3
    first_meet,      // axes 1 and 2 meet
    last_meet,       // axes 2 and 3 meet
    first_parallel,  // axes 1 ∥ 2
    general,         // none of these: a quartic
};

struct ThreeJoints {
    PieperCase kind;
    double a1, ca1, sa1, d2, a2, ca2, sa2;
    Vec3d w;
    double length;         // [m], the size of things
    double wrist_reach;    // distance of w from axis 3
    Turn<double> w_angle;  // direction of w about axis 3
};

template <class V>
struct Triples {
    Turn<V> t[3][4];  // of each joint
    mask_of<V> ok[4];
    mask_of<V> doubt;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Axes 2 ∥ 3: the height of p over their plane determines t1, a planar two-link arm t2 and t3.
template <class V>
CSPACE_INLINE Triples<V> last_parallel(const ThreeJoints& g, const Vec3<V>& p,
                                       const ClosedFormSettings& settings) {
    Triples<V> out;
    const TwoAngles<V> shoulder = shoulder_angles(g.w.z + g.d2, g.ca1, g.sa1, p, g.length, settings);
    out.doubt = shoulder.doubt;
    for (int i = 0; i < 2; ++i) {
        const Vec3<V> q = undo_joint(shoulder.root[i], g.ca1, g.sa1, p);
        const TwoLink<V> arm =
            two_link(q.x - g.a1, q.y, g.a2, g.wrist_reach, g.length, settings, settings.unconstrained[1]);
        out.doubt = out.doubt || (shoulder.ok && arm.doubt);
        for (int j = 0; j < 2; ++j) {
            const int n = 2 * i + j;
            const Turn<V> w = {fill_lanes<V>(g.w_angle.c), fill_lanes<V>(g.w_angle.s)};
            out.t[0][n] = shoulder.root[i];
            out.t[1][n] = arm.first[j];
            out.t[2][n] = arm.elbow[j] - w;
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

// Half the square of the distance of w from joint 2, as a function of t3.
inline LinearInTurn half_square_behind(const ThreeJoints& g) {
    return {0.5 * (g.a2 * g.a2 + g.d2 * g.d2 + dot(g.w, g.w)) + g.d2 * g.ca2 * g.w.z,
            g.a2 * g.w.x + g.d2 * g.sa2 * g.w.y, g.d2 * g.sa2 * g.w.x - g.a2 * g.w.y};
}

// The triples of two angles of joint `outer`, two of `inner` for each, and one of the third joint for both:
// visit(t, add) of an outer angle t calls add(inner, third_of), third_of(t) being the third angle.
template <int outer, int inner, class V, class Visit>
CSPACE_INLINE Triples<V> nested_triples(const TwoAngles<V>& first, const Visit& visit) {
    Triples<V> out;
    out.doubt = first.doubt;
    for (int i = 0; i < 2; ++i)
        visit(first.root[i], [&](const TwoAngles<V>& second, const auto& third_of) {
            out.doubt = out.doubt || (first.ok && second.doubt);
            for (int j = 0; j < 2; ++j) {
                const Aligned<V> third = third_of(second.root[j]);
                const int n = 2 * i + j;
                out.t[outer][n] = first.root[i];
                out.t[inner][n] = second.root[j];
                out.t[3 - outer - inner][n] = third.t;
                out.ok[n] = first.ok && second.ok;
                out.doubt = out.doubt || (out.ok[n] && third.doubt);
            }
        });
    return out;
}

// Axes 1 and 2 intersect: the distance of p from their intersection determines t3, its height along axis 1
// t2, its bearing t1.
template <class V>
CSPACE_INLINE Triples<V> first_meet(const ThreeJoints& g, const Vec3<V>& p,
                                    const ClosedFormSettings& settings) {
    const auto [fixed, a, b] = half_square_behind(g);
    const TwoAngles<V> elbow = linear_equation<V>(fill_lanes<V>(a), fill_lanes<V>(b), 0.5 * dot(p, p) - fixed,
                                                  std::hypot(a, b), settings, settings.unconstrained[2]);
    return nested_triples<2, 1>(elbow, [&](const Turn<V>& t3, const auto& add) {
        const Vec3<V> v = behind_joint_two(g, t3);
        const TwoAngles<V> lift = linear_equation<V>(g.sa1 * v.y, g.sa1 * v.x, p.z - g.ca1 * v.z, g.length,
                                                     settings, settings.unconstrained[1]);
        add(lift, [&](const Turn<V>& t2) {
            const V x = t2.c * v.x - t2.s * v.y, y = g.ca1 * (t2.s * v.x + t2.c * v.y) - g.sa1 * v.z;
            return align_turn(x, y, p.x, p.y, g.length, settings, settings.unconstrained[0]);
        });
    });
}

// The height of w along axis 2 determines t3 where axis 2 meets or is parallel to its neighbour.
template <class V>
CSPACE_INLINE TwoAngles<V> elbow_angles(const ThreeJoints& g, V height, const ClosedFormSettings& settings) {
    return linear_equation<V>(fill_lanes<V>(g.sa2 * g.w.y), fill_lanes<V>(g.sa2 * g.w.x),
                              height - g.ca2 * g.w.z, g.sa2 * g.wrist_reach, settings,
                              settings.unconstrained[2]);
}

// Axes 2 and 3 intersect: the distance of p from their intersection determines t1, then a height along axis 2
// t3, a bearing t2.
template <class V>
CSPACE_INLINE Triples<V> last_meet(const ThreeJoints& g, const Vec3<V>& p,
                                   const ClosedFormSettings& settings) {
    const double out_of_plane = -g.sa1 * g.d2, height = g.ca1 * g.d2;
    const V r = 0.5 * (dot(p, p) + (g.a1 * g.a1 + g.d2 * g.d2 - dot(g.w, g.w))) - height * p.z;
    const TwoAngles<V> pan =
        linear_equation<V>(g.a1 * p.x + out_of_plane * p.y, g.a1 * p.y - out_of_plane * p.x, r,
                           g.length * std::hypot(g.a1, out_of_plane), settings, settings.unconstrained[0]);
    return nested_triples<0, 2>(pan, [&](const Turn<V>& t1, const auto& add) {
        const Vec3<V> q = undo_joint(t1, g.ca1, g.sa1, p);
        add(elbow_angles(g, q.z - g.d2, settings), [&](const Turn<V>& t3) {
            const Vec3<V> v = behind_joint_two(g, t3);
            return align_turn(v.x, v.y, q.x - g.a1, q.y, g.length, settings, settings.unconstrained[1]);
        });
    });
}

// Axes 1 ∥ 2: the height of p determines t3, its distance from axis 1 t2, its bearing t1.
template <class V>
CSPACE_INLINE Triples<V> first_parallel(const ThreeJoints& g, const Vec3<V>& p,
                                        const ClosedFormSettings& settings) {
    return nested_triples<2, 1>(
        elbow_angles(g, p.z - g.d2, settings), [&](const Turn<V>& t3, const auto& add) {
            const Vec3<V> v = behind_joint_two(g, t3);
            const V r = (p.x * p.x + p.y * p.y - (v.x * v.x + v.y * v.y) - g.a1 * g.a1) * (0.5 / g.a1);
            add(linear_equation<V>(v.x, -v.y, r, g.length, settings, settings.unconstrained[1]),
                [&](const Turn<V>& t2) {
                    return align_turn(t2.c * v.x - t2.s * v.y + g.a1, t2.s * v.x + t2.c * v.y, p.x, p.y,
                                      g.length, settings, settings.unconstrained[0]);
                });
        });
}

// The first three joints with axes in general position: Pieper's quartic (1968).
//
// With v = (a2, 0, d2) + Rx(α2) Rz(t3) w, the distance of p from joint 1 and its height along axis 1 give
//     X = c2 vx − s2 vy = (|p|² − a1² − |v|²) / (2 a1),   Y = s2 vx + c2 vy = (pz − cos α1 vz) / sin α1,
// both linear in cos t3 and sin t3. X² + Y² = vx² + vy² is a trigonometric polynomial of degree two in t3.

// The part of X and Y that does not depend on the pose; p adds |p|²/(2 a1) to X.k and pz/sin α1 to Y.k.
inline LinearInTurn pieper_x(const ThreeJoints& g) {
    const auto [fixed, c, s] = half_square_behind(g);
    return {-(0.5 * g.a1 * g.a1 + fixed) / g.a1, -c / g.a1, -s / g.a1};
}
inline LinearInTurn pieper_y(const ThreeJoints& g) {
    return -g.ca1 / g.sa1 * LinearInTurn{g.ca2 * g.w.z + g.d2, g.sa2 * g.w.y, g.sa2 * g.w.x};
}
template <class V>
CSPACE_INLINE V value_at(const LinearInTurn& f, const Turn<V>& t) {
    return f.k + t.c * f.c + t.s * f.s;
}

struct PieperRoots {
    TrigRoots roots;
    bool close;  // two of them are about to merge
};
inline PieperRoots pieper_roots(const ThreeJoints& g, double p2, double pz, double band) {
    LinearInTurn X = pieper_x(g), Y = pieper_y(g);
    X.k += p2 / (2 * g.a1);
    Y.k += pz / g.sa1;
    const LinearInTurn vx = {g.a2, g.w.x, -g.w.y}, vy = {-g.sa2 * g.w.z, g.ca2 * g.w.y, g.ca2 * g.w.x};
    const TrigPolynomial f = product(X, X) + product(Y, Y) + product(-1.0 * vx, vx) + product(-1.0 * vy, vy);
    PieperRoots out{trig_roots(f), false};
    const double size =
        std::fabs(f.a0) + std::fabs(f.a1) + std::fabs(f.b1) + std::fabs(f.a2) + std::fabs(f.b2);
    for (int i = 0; i < out.roots.count; ++i) {
        const double rise = slope_at(f, out.roots.theta[i]) / size;
        out.close = out.close || out.roots.multiplicity[i] > 1 || rise * rise < band;
    }
    // A minimum that just misses zero has no roots to show: ask the value where the slope vanishes.
    if (out.roots.count < 4) {
        const TrigPolynomial df = {0, f.b1, -f.a1, 2 * f.b2, -2 * f.a2};
        const TrigRoots flat = trig_roots(df);
        for (int i = 0; i < flat.count; ++i)
            out.close = out.close || std::fabs(evaluate_polynomial(f, flat.theta[i])) < band * size;
    }
    return out;
}

template <class V>
CSPACE_INLINE Triples<V> pieper_quartic(const ThreeJoints& g, const Vec3<V>& p,
                                        const ClosedFormSettings& settings) {
    Triples<V> out;
    const V p2 = dot(p, p);
    V count = fill_lanes<V>(0.0), close = fill_lanes<V>(0.0);
    for (auto& t : out.t[2]) t = no_turn<V>();
    for (int l = 0; l < Lanes<V>::count; ++l) {
        const PieperRoots found = pieper_roots(g, get_lane(p2, l), get_lane(p.z, l), settings.band);
        set_lane(count, l, found.roots.count);
        set_lane(close, l, found.close);
        for (int i = 0; i < found.roots.count; ++i) {
            set_lane(out.t[2][i].c, l, found.roots.theta[i].c);
            set_lane(out.t[2][i].s, l, found.roots.theta[i].s);
        }
    }
    out.doubt = close > 0.0;
    const LinearInTurn fx = pieper_x(g), fy = pieper_y(g);
    for (int i = 0; i < 4; ++i) {
        const Turn<V>& t3 = out.t[2][i];
        const V X = value_at(fx, t3) + p2 * (0.5 / g.a1), Y = value_at(fy, t3) + p.z * (1 / g.sa1);
        const Vec3<V> v = behind_joint_two(g, t3);
        const Aligned<V> lift = align_turn(v.x, v.y, X, Y, g.length, settings, settings.unconstrained[1]);
        const V x = X + g.a1, y = g.ca1 * Y - g.sa1 * v.z;
        const Aligned<V> pan = align_turn(x, y, p.x, p.y, g.length, settings, settings.unconstrained[0]);
        out.ok[i] = count > double(i);
        out.t[0][i] = pan.t;
        out.t[1][i] = lift.t;
        out.doubt = out.doubt || (out.ok[i] && (lift.doubt || pan.doubt));
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
