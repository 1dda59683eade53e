// Three of the six angles eliminated from the loop (Raghavan & Roth 1993, without their 14 × 8 matrix).
//
// Both sides of
//   M5 Rz(a0) M0 Rz(a1) M1 Rz(a2) M2 = Rz(−a5) M4⁻¹ Rz(−a4) M3⁻¹ Rz(−a3)
// move the z axis and the origin alike, which are invariant under a3: their invariants agree.
// Of the right side, the parts along z and the two scalars do not see a5, and four combinations of them do
// not see a4 either; the parts across z, as complex numbers, turn with a5, and one combination of them
// vanishes. That is six equations in the nine products of (S1², S1C1, C1²) and (S2²,
// S2C2, C2²), the sines and cosines of half the angles a1 and a2, which no angle makes infinite:
//   E(a0) = level + cos a0 · across + sin a0 · quarter.
// A prismatic joint has (a², a, 1) where a revolute one has (S², SC, C²), and (a², a) for (cos, sin): any
// of a1, a2, a4 may.
#pragma once

#include <cstring>

#include "cspace/ik/general/loop.hpp"
#include "cspace/math/linear.hpp"
#include "cspace/math/rows.hpp"
#include "cspace/math/vec.hpp"

namespace cspace::ik {

struct Invariants {
    Vec3d l, p, m, q;
    double pp, pl, one;
};

struct Elimination {
    static constexpr int lanes = 8;  // six equations and two zeros, by their nine monomials
    double level[9][lanes], across[9][lanes], quarter[9][lanes];
    double W[6][3];          // the six parts that do not see a5: W (cos a4, sin a4, 1) or W (a4², a4, 1)
    double inverse_w[2][6];  // of the first two columns of W, in the least-squares sense
    double a4_rank;          // ratio of their two singular sizes; 0 where they fix only one of the two
    double a5_rank;          // the same of the four complex parts, of rank three
    double faintest;         // size of an equation, before all are made of one size
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// What a directed line with a point on it turns into under a rigid motion, as a linear map.
//
// From the unit direction l and the point p follow fourteen quantities (Raghavan & Roth 1993):
//   l, p, m = p × l, q = (p·p) l − 2 (p·l) p, p·p, p·l.
// With a one put beside them a displacement acts on the fifteen linearly, and so do they depend on the cosine
// and sine of each angle on the way, and on a slide and its square.

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

inline Invariants move_invariants(const Posed& T, const Invariants& v) {
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
// The functional v ↦ g(move_invariants(T, v)) for the functional g, given and returned by its coefficients.
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

// Rz(a) v = level_part + cos a · across_part + sin a · quarter_part.
inline Vec3d across_part(const Vec3d& a) { return {a.x, a.y, 0}; }
inline Vec3d quarter_part(const Vec3d& a) { return {-a.y, a.x, 0}; }
inline Invariants across_part(const Invariants& v) {
    return {across_part(v.l), across_part(v.p), across_part(v.m), across_part(v.q), 0, 0, 0};
}
inline Invariants level_part(const Invariants& v) { return v - across_part(v); }
inline Invariants quarter_part(const Invariants& v) {
    return {quarter_part(v.l), quarter_part(v.p), quarter_part(v.m), quarter_part(v.q), 0, 0, 0};
}

// Tz(d) v = v + d · first_order_part + d² · second_order_part.
inline Invariants first_order_part(const Invariants& v) {
    const Vec3d z = {0, 0, 1};
    return {{0, 0, 0}, v.one * z, cross(z, v.l), -2.0 * cross(z, v.m) - (2 * v.pl) * z, 2 * v.p.z, v.l.z, 0};
}
inline Invariants second_order_part(const Invariants& v) {
    return {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {v.l.x, v.l.y, -v.l.z}, v.one, 0, 0};
}

// Angles at which the half angles of a1 and a2 are zero: away from what arms are fond of.
inline constexpr double a1_origin = 0.7, a2_origin = 2.1;

// An equation of this size is nothing but rounding: at some goals of special arms one vanishes.
inline constexpr double vanished_equation = 1e-11;

// The second of two columns, relative to the first, below which rounding decides its direction.
inline constexpr double vanished_column = 1e-9;

// Below this the second of the two equations for a4 fixes it less well than the first with both its signs.
inline constexpr double firm_rank = 1e-6;

// A row of four equations, relative to the first, that rounding alone leaves.
inline constexpr double vanished_row = 1e-14;

struct Complex {
    double re, im;
};

// The orthogonal complement of two columns of six, and their least-squares inverse, by reflections.
inline void eliminate_a4(Elimination& e, double (&N)[4][6]) {
    double A[6][8] = {}, diagonal[2], factor[2], size[2] = {};  // [W, I]
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 2; ++j) size[j] += e.W[i][j] * e.W[i][j];
    const int large = size[1] > size[0];
    for (int i = 0; i < 6; ++i) {
        A[i][0] = e.W[i][large];
        A[i][1] = e.W[i][1 - large];
        A[i][2 + i] = 1;
    }
    linear::factor_qr(A, diagonal, factor);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 6; ++j) N[i][j] = A[2 + i][2 + j];
    e.a4_rank = diagonal[0] != 0 ? std::fabs(diagonal[1] / diagonal[0]) : 0;
    const bool full = e.a4_rank > vanished_column;
    for (int j = 0; j < 6; ++j) {
        const double y = full ? A[1][2 + j] / diagonal[1] : 0;
        const double x = diagonal[0] != 0 ? (A[0][2 + j] - A[0][1] * y) / diagonal[0] : 0;
        e.inverse_w[large][j] = x;
        e.inverse_w[1 - large][j] = y;
    }
}

inline Complex operator*(Complex a, Complex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
inline Complex conjugate(Complex a) { return {a.re, -a.im}; }
inline double square_of(Complex a) { return a.re * a.re + a.im * a.im; }

// The row n with n W = 0 for three complex columns of four (n̄ spans their complement), by reflections with
// the largest column first. Returns how the last column's size compares with the first's.
inline double find_annihilator(Complex (&A)[4][3], Complex (&n)[4]) {
    Complex H[4][4] = {};
    for (int i = 0; i < 4; ++i) H[i][i] = {1, 0};
    double first = 0, last = 0;
    for (int k = 0; k < 3; ++k) {
        int largest = k;
        double most = -1;
        for (int j = k; j < 3; ++j) {
            double size = 0;
            for (int i = k; i < 4; ++i) size += square_of(A[i][j]);
            if (size > most) most = size, largest = j;
        }
        for (int i = 0; i < 4; ++i) {
            const Complex kept = A[i][k];
            A[i][k] = A[i][largest];
            A[i][largest] = kept;
        }
        const double length = std::sqrt(most);
        last = length;
        if (k == 0) first = length;
        if (!(length > vanished_row * first)) break;
        const double corner = std::sqrt(square_of(A[k][k]));
        const Complex phase = corner > 0 ? Complex{A[k][k].re / corner, A[k][k].im / corner} : Complex{1, 0};
        Complex v[4] = {};
        for (int i = k; i < 4; ++i) v[i] = A[i][k];
        v[k] = {v[k].re + length * phase.re, v[k].im + length * phase.im};
        const double factor = 1 / (length * (length + corner));
        const auto reflect_column = [&](Complex* top, int stride) {
            Complex along = {0, 0};
            for (int i = k; i < 4; ++i) {
                const Complex part = conjugate(v[i]) * top[i * stride];
                along = {along.re + part.re, along.im + part.im};
            }
            along = {factor * along.re, factor * along.im};
            for (int i = k; i < 4; ++i) top[i * stride] = top[i * stride] - along * v[i];
        };
        for (int j = k; j < 3; ++j) reflect_column(&A[0][j], 3);
        for (int j = 0; j < 4; ++j) reflect_column(&H[0][j], 4);
    }
    for (int j = 0; j < 4; ++j) n[j] = H[3][j];
    return first > 0 ? last / first : 0;
}

// The six equations as functionals of the left side's invariants behind M5.
inline void right_side(const Loop& loop, Elimination& e, Invariants (&g)[6]) {
    const Invariants behind = move_invariants(inverse(loop.M[3]), axis_invariants());
    const Posed M4 = inverse(loop.M[4]);
    // Rz(−a4): the sine counts backwards; Tz(−a4): so does the slide.
    const bool slides = loop.slides[4];
    const Invariants part[3] = {
        move_invariants(M4, slides ? second_order_part(behind) : across_part(behind)),
        move_invariants(M4, -1.0 * (slides ? first_order_part(behind) : quarter_part(behind))),
        move_invariants(M4, slides ? behind : level_part(behind))};
    Complex W[4][3];
    for (int j = 0; j < 3; ++j) {
        const Invariants& w = part[j];
        const double seen[6] = {w.l.z, w.p.z, w.m.z, w.q.z, w.pp, w.pl};
        for (int i = 0; i < 6; ++i) e.W[i][j] = seen[i];
        const Vec3d turned[4] = {w.l, w.p, w.m, w.q};
        for (int i = 0; i < 4; ++i) W[i][j] = {turned[i].x, turned[i].y};
    }
    double N[4][6];
    eliminate_a4(e, N);
    for (int i = 0; i < 4; ++i) {
        double constant = 0;
        for (int j = 0; j < 6; ++j) constant += N[i][j] * e.W[j][2];
        g[i] = {{0, 0, N[i][0]}, {0, 0, N[i][1]}, {0, 0, N[i][2]}, {0, 0, N[i][3]},
                N[i][4],         N[i][5],         -constant};
    }
    Complex n[4];
    e.a5_rank = find_annihilator(W, n);
    const auto rows = [&](double sx, double sy, auto pick_x, auto pick_y) {
        const auto half = [&](int i) { return Vec3d{sx * pick_x(n[i]), sy * pick_y(n[i]), 0}; };
        return Invariants{half(0), half(1), half(2), half(3), 0, 0, 0};
    };
    const auto re = [](Complex a) { return a.re; };
    const auto im = [](Complex a) { return a.im; };
    g[4] = rows(1, -1, re, im);
    g[5] = rows(1, 1, im, re);
}

// The invariants behind M0, as coefficients of the nine monomials.
inline void left_side(const Loop& loop, Invariants (&B)[9]) {
    const auto from = [&](int link, double angle) {
        if (loop.slides[link + 1]) return loop.M[link];
        const double c = std::cos(angle), s = std::sin(angle);
        return loop.M[link] * Posed{{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}, {0, 0, 0}};
    };
    const Posed M0 = from(0, a1_origin), M1 = from(1, a2_origin);
    const auto monomials = [](const Invariants& v, bool slides, Invariants* out) {
        if (slides) {
            out[0] = second_order_part(v);
            out[1] = first_order_part(v);
            out[2] = v;
            return;
        }
        const Invariants up = level_part(v), side = across_part(v);
        out[0] = up - side;
        out[1] = 2.0 * quarter_part(v);
        out[2] = up + side;
    };
    Invariants by_a2[3];
    monomials(move_invariants(loop.M[2], axis_invariants()), loop.slides[2], by_a2);
    for (int k = 0; k < 3; ++k) {
        Invariants by_a1[3];
        monomials(move_invariants(M1, by_a2[k]), loop.slides[1], by_a1);
        for (int i = 0; i < 3; ++i) B[3 * i + k] = move_invariants(M0, by_a1[i]);
    }
}

// The functionals of six equations, one on each lane.
template <class V>
struct Functionals {
    V part[4][3];  // of l, p, m and q
    V pp, pl, one;
};

inline Functionals<Pack<Elimination::lanes>> functionals_behind(const Posed& T, const Invariants (&g)[6]) {
    constexpr int parts = 15;
    double rows[Elimination::lanes][parts] = {};
    static_assert(sizeof(Invariants) == sizeof rows[0]);
    for (int i = 0; i < 6; ++i) {
        const Invariants behind = pulled_back(T, g[i]);
        std::memcpy(rows[i], &behind, sizeof behind);
    }
    Pack<Elimination::lanes> v[parts];
    load_rows(rows[0], parts, Elimination::lanes, parts, v);
    return {{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, {v[9], v[10], v[11]}},
            v[12],
            v[13],
            v[14]};
}

inline Elimination eliminate_angles(const Loop& loop) {
    using V = Pack<Elimination::lanes>;
    Elimination e;
    Invariants g[6], B[9];
    right_side(loop, e, g);
    left_side(loop, B);
    const Functionals<V> f = functionals_behind(loop.M[5], g);
    V level[9], across[9], quarter[9], square = fill_lanes<V>(0.0);  // Rz(a0) v, as in invariants.hpp
    for (int m = 0; m < 9; ++m) {
        const Vec3d part[4] = {B[m].l, B[m].p, B[m].m, B[m].q};
        level[m] = B[m].pp * f.pp + B[m].pl * f.pl + B[m].one * f.one;
        across[m] = quarter[m] = fill_lanes<V>(0.0);
        for (int k = 0; k < 4; ++k) {
            const V x = fill_lanes<V>(part[k].x), y = fill_lanes<V>(part[k].y), z = fill_lanes<V>(part[k].z);
            const auto& [fx, fy, fz] = f.part[k];
            level[m] = mul_add(fz, z, level[m]);
            across[m] = mul_add(fx, x, mul_add(fy, y, across[m]));
            quarter[m] = mul_add(fy, x, mul_add(-fx, y, quarter[m]));
        }
        for (const V& v : {level[m], across[m], quarter[m]}) square = mul_add(v, v, square);
    }
    const V size = sqrt(square),
            scale = keep_lanes(size > vanished_equation, 1.0 / max(size, fill_lanes<V>(vanished_equation)));
    e.faintest = 1e300;
    for (int i = 0; i < 6; ++i) e.faintest = min(e.faintest, get_lane(size, i));
    for (int m = 0; m < 9; ++m) {
        store_lanes(e.level[m], scale * level[m]);
        store_lanes(e.across[m], scale * across[m]);
        store_lanes(e.quarter[m], scale * quarter[m]);
    }
    return e;
}

// The determinant that vanishes where the hidden angle a0 belongs to a solution, and its null vector there.
//
// The six equations of the elimination, each times S1 and times C1, are twelve linear ones in the twelve
// products of (S1³, S1²C1, S1C1², C1³) and (S2², S2C2, C2²) (Raghavan & Roth 1993):
//   [E2 E1 E0  0 ]
//   [ 0 E2 E1 E0],  E2, E1, E0 the 6 × 3 blocks of S1², S1C1, C1².
// Reflections first take E0 out of the last block column, then what is left of it; no pivoting, no branches.

template <class V>
CSPACE_INLINE V coefficient_at(const Elimination& e, int i, int monomial, V c, V s) {
    return mul_add(s, fill_lanes<V>(e.quarter[monomial][i]),
                   mul_add(c, fill_lanes<V>(e.across[monomial][i]), fill_lanes<V>(e.level[monomial][i])));
}

template <int reduced, class V>
CSPACE_INLINE V product_of(const V (&diagonal)[reduced]) {
    V out = diagonal[0];
    for (int k = 1; k < reduced; ++k) out = out * diagonal[k];
    return out;
}

// The determinant at the hidden angle with cosine c and sine s, up to a constant factor.
template <class V>
CSPACE_NOINLINE V determinant(const Elimination& e, V c, V s) {
    V A[6][9];  // [E0 E1 E2]
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 3; ++j)
            for (int block = 0; block < 3; ++block)
                A[i][3 * block + j] = coefficient_at(e, i, 3 * (2 - block) + j, c, s);
    V d3[3], d6[6], factor3[3], factor6[6];
    linear::factor_qr(A, d3, factor3);  // [R0 b1 b2; 0 a1 a2]
    const V zero = fill_lanes<V>(0.0);
    V out = product_of(d3);
    V B[6][9];  // [R0 b2 b1; a1 0 a2]
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            B[i][j] = j > i ? A[i][j] : j == i ? d3[i] : zero;
            B[i][3 + j] = A[i][6 + j];
            B[i][6 + j] = A[i][3 + j];
            B[3 + i][j] = A[3 + i][3 + j];
            B[3 + i][3 + j] = zero;
            B[3 + i][6 + j] = A[3 + i][6 + j];
        }
    linear::factor_qr(B, d3, factor3);
    out = out * product_of(d3);
    V D[6][6];  // [a2 a1; d2 d1]
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            D[i][j] = A[3 + i][6 + j];
            D[i][3 + j] = A[3 + i][3 + j];
            D[3 + i][j] = B[3 + i][3 + j];
            D[3 + i][3 + j] = B[3 + i][6 + j];
        }
    linear::factor_qr(D, d6, factor6);
    return out * product_of(d6);
}

}  // namespace cspace::ik::inline CSPACE_ISA
