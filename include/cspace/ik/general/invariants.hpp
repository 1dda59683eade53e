// What a directed line with a point on it turns into under a rigid motion, as a linear map.
//
// From the unit direction l and the point p follow fourteen quantities (Raghavan & Roth 1993):
//   l, p, m = p × l, q = (p·p) l − 2 (p·l) p, p·p, p·l.
// With a one put beside them a displacement acts on the fifteen linearly, and so do they depend on the cosine
// and sine of each angle on the way, and on a slide and its square.
#pragma once

#include "cspace/math/vec.hpp"

namespace cspace::ik {

struct Invariants {
    Vec3d l, p, m, q;
    double pp, pl, one;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The z axis with the origin on it.
inline Invariants axis_invariants() {
    const Vec3d zero = {0, 0, 0};
    return {{0, 0, 1}, zero, zero, zero, 0, 0, 1};
}

inline Invariants operator+(const Invariants& a, const Invariants& b) {
    return {a.l + b.l, a.p + b.p, a.m + b.m, a.q + b.q, a.pp + b.pp, a.pl + b.pl, a.one + b.one};
}
inline Invariants operator*(double s, const Invariants& a) {
    return {s * a.l, s * a.p, s * a.m, s * a.q, s * a.pp, s * a.pl, s * a.one};
}
inline Invariants operator-(const Invariants& a, const Invariants& b) { return a + -1.0 * b; }

inline Invariants moved(const Posed& T, const Invariants& v) {
    const Vec3d &t = T.t, l = T.R * v.l, p = T.R * v.p, m = T.R * v.m, q = T.R * v.q;
    const double tt = dot(t, t), tl = dot(t, l);
    return {l,
            p + v.one * t,
            m + cross(t, l),
            q - 2.0 * cross(t, m) + tt * l - (2 * v.pl + 2 * tl) * t,
            v.pp + 2 * dot(t, p) + tt * v.one,
            v.pl + tl,
            v.one};
}
// The functional v ↦ g(moved(T, v)) for the functional g, given and returned by its coefficients.
inline Invariants pulled_back(const Posed& T, const Invariants& g) {
    const Vec3d& t = T.t;
    const double tt = dot(t, t), qt = dot(g.q, t);
    return {transpose_times(T.R, g.l + cross(g.m, t) + tt * g.q + (g.pl - 2 * qt) * t),
            transpose_times(T.R, g.p + 2 * g.pp * t),
            transpose_times(T.R, g.m - 2.0 * cross(g.q, t)),
            transpose_times(T.R, g.q),
            g.pp,
            g.pl - 2 * qt,
            g.one + dot(g.p, t) + g.pp * tt};
}
inline double apply(const Invariants& g, const Invariants& v) {
    return dot(g.l, v.l) + dot(g.p, v.p) + dot(g.m, v.m) + dot(g.q, v.q) + g.pp * v.pp + g.pl * v.pl +
           g.one * v.one;
}

// Rz(a) v = level + cos a · across + sin a · quarter.
inline Vec3d level(const Vec3d& a) { return {0, 0, a.z}; }
inline Vec3d across(const Vec3d& a) { return {a.x, a.y, 0}; }
inline Vec3d quarter(const Vec3d& a) { return {-a.y, a.x, 0}; }
inline Invariants level(const Invariants& v) {
    return {level(v.l), level(v.p), level(v.m), level(v.q), v.pp, v.pl, v.one};
}
inline Invariants across(const Invariants& v) {
    return {across(v.l), across(v.p), across(v.m), across(v.q), 0, 0, 0};
}
inline Invariants quarter(const Invariants& v) {
    return {quarter(v.l), quarter(v.p), quarter(v.m), quarter(v.q), 0, 0, 0};
}

// Tz(d) v = v + d · once + d² · twice.
inline Invariants once(const Invariants& v) {
    const Vec3d z = {0, 0, 1};
    return {{0, 0, 0}, v.one * z, cross(z, v.l), -2.0 * cross(z, v.m) - (2 * v.pl) * z, 2 * v.p.z, v.l.z, 0};
}
inline Invariants twice(const Invariants& v) {
    return {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {v.l.x, v.l.y, -v.l.z}, v.one, 0, 0};
}

}  // namespace cspace::ik::inline CSPACE_ISA
