// Four joints that turn and two that slide: the orientation alone leaves one angle free, and given that one
// the other three in two ways; then the slides must make up for what the position lacks.
//
// With the links between one turn and the next as rotations A_i and offsets t_i, hidden angle first,
//   Rz(a0) A0 Rz(a1) A1 Rz(a2) A2 Rz(a3) A3 = I,      p + d1 D1 + d2 D2 = 0,   p = Σ W_i t_i,   D = W_i u,
// W_i the product up to Rz(a_i), u the direction of a slide in its link. The corner of the first equation
// that sees neither a2 nor a3 is a cos a1 + b sin a1 = k: two sheets, cos a1 and sin a1 being even and odd
// parts of √Δ, Δ = a² + b² − k². On both the slides' plane must hold p: g = det(D1, D2, p) vanishes on one
// of them. The product over the sheets, times a² + b², is a trigonometric polynomial of degree 4 in a0.
#pragma once

#include "cspace/ik/general/loop.hpp"
#include "cspace/math/turn.hpp"

namespace cspace::ik {

struct TwoSheets {
    Mat3d A[4];
    Vec3d t[4];
    Vec3d u[2];             // directions of the slides
    int link[2];            // in which link they stand
    int turn[4], slide[2];  // the joints of the chain
    Vec3d end, row;         // A2ᵀ z and A2 z
    double square_end;      // of their part across z
    double square_corner;   // about the largest a² + b²; zero where the axes of a3, a0 and a1 stay parallel
};

// even ± odd √Δ
template <class V>
struct OnSheets {
    Vec3<V> even, odd;
};
template <class V>
struct TurnOnSheets {
    Turn<V> even, odd;
};

// What both sheets have at one hidden angle.
template <class V>
struct AtHiddenAngle {
    Turn<V> a0;
    TurnOnSheets<V> a1, a3;
    V square, inside;  // a² + b² and Δ
    OnSheets<V> p, D[2];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Of a loop that starts with a turn and holds two slides.
inline TwoSheets two_sheets(const Loop& loop) {
    TwoSheets out;
    int turns = 0, slides = 0;
    Posed link = identity_pose();
    for (int j = 0; j < 6; ++j) {
        if (loop.slides[j]) {
            out.u[slides] = matrix_column(link.R, 2);
            out.link[slides] = turns - 1;
            out.slide[slides++] = loop.joint[j];
        } else {
            out.turn[turns++] = loop.joint[j];
            link = identity_pose();
        }
        link = link * loop.M[j];
        out.A[turns - 1] = link.R;
        out.t[turns - 1] = link.t;
    }
    out.row = matrix_column(out.A[2], 2);
    out.end = transpose_times(out.A[2], Vec3d{0, 0, 1});
    const auto square_across = [](const Vec3d& v) { return v.x * v.x + v.y * v.y; };
    out.square_end = square_across(out.end);
    out.square_corner =
        max(square_across(matrix_column(out.A[0], 2)), square_across(matrix_column(transpose(out.A[3]), 2))) *
        square_across(matrix_column(out.A[1], 2));
    return out;
}

template <class V>
CSPACE_INLINE Vec3<V> rotate_about_z(const Turn<V>& t, const Vec3<V>& v) {
    return {t.c * v.x - t.s * v.y, t.s * v.x + t.c * v.y, v.z};
}
// The odd part of a turn moves the parts across z alone.
template <class V>
CSPACE_INLINE OnSheets<V> rotate_about_z(const TurnOnSheets<V>& t, const Vec3<V>& v) {
    Vec3<V> odd = rotate_about_z(t.odd, v);
    odd.z = fill_lanes<V>(0.0);
    return {rotate_about_z(t.even, v), odd};
}
template <class V>
CSPACE_INLINE OnSheets<V> rotate_sheets(const Mat3<V>& R, const OnSheets<V>& v) {
    return {R * v.even, R * v.odd};
}
// The turn that takes w to x, both with the same part across z of squared length n2.
template <class V>
CSPACE_INLINE Turn<V> turn_between(const Vec3<V>& w, const Vec3<V>& x, double n2) {
    const double scale = 1 / n2;
    return {scale * (x.x * w.x + x.y * w.y), scale * (x.y * w.x - x.x * w.y)};
}

// A vector fixed in link i, seen from before a0.
template <class V>
CSPACE_INLINE OnSheets<V> from_link(const TwoSheets& s, const AtHiddenAngle<V>& at, const Mat3<V>& R0A0,
                                    int i, const Vec3d& fixed) {
    const Vec3<V> none = {fill_lanes<V>(0.0), fill_lanes<V>(0.0), fill_lanes<V>(0.0)},
                  v = fill_vec3<V>(fixed);
    if (i == 0) return {rotate_about_z(at.a0, v), none};
    if (i == 1) return rotate_sheets(R0A0, rotate_about_z(at.a1, v));
    if (i == 3) return {fill_vec3<V>(transpose_times(s.A[3], fixed)), none};
    const TurnOnSheets<V> back = {{at.a3.even.c, -at.a3.even.s}, {at.a3.odd.c, -at.a3.odd.s}};
    return rotate_sheets(fill_mat3<V>(transpose(s.A[3])),
                         rotate_about_z(back, fill_vec3<V>(transpose_times(s.A[2], fixed))));
}

template <class V>
CSPACE_INLINE AtHiddenAngle<V> at_hidden_angle(const TwoSheets& s, const Turn<V>& a0) {
    AtHiddenAngle<V> at;
    at.a0 = a0;
    const Vec3<V> end = fill_vec3<V>(matrix_column(s.A[1], 2));
    Mat3<V> R0A0 = fill_mat3<V>(s.A[0]);
    R0A0 =
        from_columns(rotate_about_z(a0, matrix_column(R0A0, 0)), rotate_about_z(a0, matrix_column(R0A0, 1)),
                     rotate_about_z(a0, matrix_column(R0A0, 2)));
    const Mat3<V> B = fill_mat3<V>(s.A[3]) * R0A0;
    const Vec3<V> row = {B.m[2][0], B.m[2][1], B.m[2][2]};
    const V a = row.x * end.x + row.y * end.y, b = row.y * end.x - row.x * end.y;
    const V k = s.row.z - row.z * end.z;
    at.square = a * a + b * b;
    at.inside = at.square - k * k;
    const V scale = 1.0 / at.square;
    at.a1 = {{scale * a * k, scale * b * k}, {-scale * b, scale * a}};
    const OnSheets<V> x = rotate_sheets(B, rotate_about_z(at.a1, end));
    // x = Rz(−a3) A2ᵀ z
    const Vec3<V> w = fill_vec3<V>(s.end);
    at.a3 = {turn_between(x.even, w, s.square_end), turn_between(x.odd, w, s.square_end)};
    at.p = from_link(s, at, R0A0, 0, s.t[0]);
    for (int i = 1; i < 4; ++i) {
        const OnSheets<V> more = from_link(s, at, R0A0, i, s.t[i]);
        at.p = {at.p.even + more.even, at.p.odd + more.odd};
    }
    for (int j = 0; j < 2; ++j) at.D[j] = from_link(s, at, R0A0, s.link[j], s.u[j]);
    return at;
}

// g on both sheets: even ± odd √Δ.
template <class V>
CSPACE_INLINE Turn<V> position_residual(const AtHiddenAngle<V>& at) {
    const OnSheets<V>&D = at.D[0], &E = at.D[1], &p = at.p;
    const Vec3<V> even = cross(E.even, p.even) + at.inside * cross(E.odd, p.odd);
    const Vec3<V> odd = cross(E.even, p.odd) + cross(E.odd, p.even);
    return {dot(D.even, even) + at.inside * dot(D.odd, odd), dot(D.even, odd) + dot(D.odd, even)};
}

// The polynomial at the hidden angle with cosine c and sine s.
template <class V>
CSPACE_NOINLINE V lack_on_both(const TwoSheets& s, V cosine, V sine) {
    const AtHiddenAngle<V> at = at_hidden_angle(s, Turn<V>{cosine, sine});
    const Turn<V> g = position_residual(at);
    return at.square * (g.c * g.c - at.inside * g.s * g.s);
}

// The joints on the sheet of `sign`.
inline void joints_on_sheet(const TwoSheets& s, const AtHiddenAngle<double>& at, double sign, double* q) {
    const double root = sign * std::sqrt(max(at.inside, 0.0));
    const auto turn = [&](const TurnOnSheets<double>& t) {
        return Turn<double>{t.even.c + root * t.odd.c, t.even.s + root * t.odd.s};
    };
    const auto vector = [&](const OnSheets<double>& v) { return v.even + root * v.odd; };
    const Turn<double> a1 = turn(at.a1), a3 = turn(at.a3);
    // z (A3 Rz(a0) A0 Rz(a1) A1) is Rz(a2) A2 z.
    Vec3d x = transpose_times(s.A[3], Vec3d{0, 0, 1});
    x = transpose_times(s.A[0], rotate_about_z(Turn<double>{at.a0.c, -at.a0.s}, x));
    x = transpose_times(s.A[1], rotate_about_z(Turn<double>{a1.c, -a1.s}, x));
    const Turn<double> a2 = turn_between(s.row, x, s.square_end);
    const Turn<double> all[4] = {at.a0, a1, a2, a3};
    for (int i = 0; i < 4; ++i) q[s.turn[i]] = angle_of(all[i]);
    const Vec3d p = vector(at.p), D = vector(at.D[0]), E = vector(at.D[1]), normal = cross(D, E);
    const double scale = 1 / max(dot(normal, normal), tolerance::nonzero);
    q[s.slide[0]] = -scale * dot(cross(p, E), normal);
    q[s.slide[1]] = -scale * dot(cross(D, p), normal);
}

}  // namespace cspace::ik::inline CSPACE_ISA
