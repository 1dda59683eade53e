// The first three joints with axes in general position: Pieper's quartic (1968).
//
// With v = (a2, 0, d2) + Rx(α2) Rz(t3) w, the distance of p from joint 1 and its height along axis 1 give
//     X = c2 vx − s2 vy = (|p|² − a1² − |v|²) / (2 a1),   Y = s2 vx + c2 vy = (pz − cos α1 vz) / sin α1,
// both linear in cos t3 and sin t3. X² + Y² = vx² + vy² is a trigonometric polynomial of degree two in t3.
#pragma once

#include "cspace/ik/pieper_position.hpp"
#include "cspace/math/trig_polynomial.hpp"

namespace cspace::ik {

// k + c cos t + s sin t
struct LinearInTurn {
    double k, c, s;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline TrigPolynomial square(const LinearInTurn& f) { return product(f.k, f.c, f.s, f.k, f.c, f.s); }
inline TrigPolynomial negative(const TrigPolynomial& f) { return {-f.a0, -f.a1, -f.b1, -f.a2, -f.b2}; }

// The part of X and Y that does not depend on the pose; p adds |p|²/(2 a1) to X.k and pz/sin α1 to Y.k.
inline LinearInTurn pieper_x(const ThreeJoints& g) {
    const double fixed = g.a2 * g.a2 + g.d2 * g.d2 + dot(g.w, g.w) + 2 * g.d2 * g.ca2 * g.w.z;
    return {-(g.a1 * g.a1 + fixed) / (2 * g.a1), -(g.a2 * g.w.x + g.d2 * g.sa2 * g.w.y) / g.a1,
            -(g.d2 * g.sa2 * g.w.x - g.a2 * g.w.y) / g.a1};
}
inline LinearInTurn pieper_y(const ThreeJoints& g) {
    const double cot = g.ca1 / g.sa1;
    return {-cot * (g.ca2 * g.w.z + g.d2), -cot * g.sa2 * g.w.y, -cot * g.sa2 * g.w.x};
}
template <class V>
CSPACE_INLINE V at(const LinearInTurn& f, const Turn<V>& t) {
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
    const TrigPolynomial f = square(X) + square(Y) + negative(square(vx) + square(vy));
    PieperRoots out{trig_roots(f), false};
    const double size =
        std::fabs(f.a0) + std::fabs(f.a1) + std::fabs(f.b1) + std::fabs(f.a2) + std::fabs(f.b2);
    for (int i = 0; i < out.roots.count; ++i) {
        const double rise = slope(f, out.roots.theta[i]) / size;
        out.close = out.close || out.roots.multiplicity[i] > 1 || rise * rise < band;
    }
    // A minimum that just misses zero has no roots to show: ask the value where the slope vanishes.
    if (out.roots.count < 4) {
        const TrigPolynomial df = {0, f.b1, -f.a1, 2 * f.b2, -2 * f.a2};
        const TrigRoots flat = trig_roots(df);
        for (int i = 0; i < flat.count; ++i)
            out.close = out.close || std::fabs(evaluate(f, flat.theta[i])) < band * size;
    }
    return out;
}

template <class V>
CSPACE_INLINE Triples<V> any_three(const ThreeJoints& g, const Vec3<V>& p, const Care& care) {
    Triples<V> out;
    const V p2 = dot(p, p);
    V count = fill<V>(0.0), close = fill<V>(0.0);
    for (auto& t : out.t3) t = no_turn<V>();
    for (int l = 0; l < Lanes<V>::count; ++l) {
        const PieperRoots found = pieper_roots(g, lane(p2, l), lane(p.z, l), care.band);
        set_lane(count, l, found.roots.count);
        set_lane(close, l, found.close);
        for (int i = 0; i < found.roots.count; ++i) {
            set_lane(out.t3[i].c, l, found.roots.theta[i].c);
            set_lane(out.t3[i].s, l, found.roots.theta[i].s);
        }
    }
    out.doubt = close > 0.0;
    const LinearInTurn fx = pieper_x(g), fy = pieper_y(g);
    for (int i = 0; i < 4; ++i) {
        const V X = at(fx, out.t3[i]) + p2 * (0.5 / g.a1), Y = at(fy, out.t3[i]) + p.z * (1 / g.sa1);
        const Vec3<V> v = behind_joint_two(g, out.t3[i]);
        const Aligned<V> lift = align(v.x, v.y, X, Y, g.length, care, care.unconstrained[1]);
        const V x = X + g.a1, y = g.ca1 * Y - g.sa1 * v.z;
        const Aligned<V> pan = align(x, y, p.x, p.y, g.length, care, care.unconstrained[0]);
        out.ok[i] = count > double(i);
        out.t1[i] = pan.t;
        out.t2[i] = lift.t;
        out.doubt = out.doubt || (out.ok[i] && (lift.doubt || pan.doubt));
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
