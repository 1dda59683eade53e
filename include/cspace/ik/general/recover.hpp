// From a hidden angle to the other five: the null vector of the twelve equations holds the half angles of a1
// and a2, and the loop closes with a4, a5 and a3.
#pragma once

#include "cspace/ik/general/elimination.hpp"

namespace cspace::ik {

// Sums over neighbouring monomials: the sines and cosines of a1 and a2, from their origins, not normalised.
template <class V>
struct TwoHalfAngles {
    V s1, c1, s2, c2;
};

// The value of a joint, as a turn or as a slide.
template <class V>
struct Step {
    Turn<V> turn;
    V slide;
};

// The transposed equations, reduced: their reflections, their triangle.
template <class V>
struct ReducedEquations {
    V A[12][12], diagonal[12], factor[12];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_NOINLINE void reduce_equations(const Elimination& e, V c, V s, ReducedEquations<V>& out) {
    for (auto& row : out.A)
        for (V& entry : row) entry = fill_lanes<V>(0.0);
    for (int i = 0; i < 6; ++i)
        for (int m = 0; m < 9; ++m) out.A[m][i] = out.A[3 + m][6 + i] = coefficient_at(e, i, m, c, s);
    for (int k = 0; k < 12; ++k)  // the first six columns end at row nine
        linear::reduce_column(out.A, k < 6 ? 9 : 12, 12, k, out.diagonal[k], out.factor[k]);
}
// Q y, for the Q of the reduction.
template <class V>
CSPACE_INLINE void turn_back(const ReducedEquations<V>& r, V (&y)[12]) {
    for (int k = 11; k >= 0; --k) linear::reflect_vector(r.A, 12, k, r.factor[k], y);
}
// The monomials that all equations but the last in line annihilate: products of half angles, x[3 i + j]
// belonging to S1^(3−i) C1^i and S2^(2−j) C2^j.
template <class V>
CSPACE_INLINE void null_vector(const ReducedEquations<V>& r, V (&x)[12]) {
    for (int i = 0; i < 12; ++i) x[i] = fill_lanes<V>(i == 11 ? 1.0 : 0.0);
    turn_back(r, x);
}

// Neighbouring monomials differ by the factor C1/S1 or C2/S2: sums over all neighbours, as sine and cosine of
// the whole angles.
template <class V>
CSPACE_INLINE TwoHalfAngles<V> half_angles(const V (&x)[12]) {
    const V zero = fill_lanes<V>(0.0);
    V aa = zero, ab = zero, bb = zero, cc = zero, cd = zero, dd = zero;
    for (int i = 0; i < 9; ++i) {
        aa = mul_add(x[i], x[i], aa);
        ab = mul_add(x[i], x[i + 3], ab);
        bb = mul_add(x[i + 3], x[i + 3], bb);
    }
    for (int i = 0; i < 12; ++i) {
        if (i % 3 == 2) continue;
        cc = mul_add(x[i], x[i], cc);
        cd = mul_add(x[i], x[i + 1], cd);
        dd = mul_add(x[i + 1], x[i + 1], dd);
    }
    return {2.0 * ab, bb - aa, 2.0 * cd, dd - cc};
}

template <class V>
CSPACE_INLINE Turn<V> unit_turn(V c, V s) {
    const V scale = 1.0 / sqrt(max(c * c + s * s, fill_lanes<V>(tolerance::nonzero)));
    return {scale * c, scale * s};
}
template <class V>
CSPACE_INLINE Pose<V> turned_about_z(const Pose<V>& T, const Turn<V>& t) {
    const Vec3<V> x = matrix_column(T.R, 0), y = matrix_column(T.R, 1);
    return {from_columns(t.c * x + t.s * y, t.c * y - t.s * x, matrix_column(T.R, 2)), T.t};
}
// T Rz(a) or T Tz(a).
template <class V>
CSPACE_INLINE Pose<V> stepped_angle(const Pose<V>& T, bool slides, const Step<V>& a) {
    return slides ? Pose<V>{T.R, T.t + a.slide * matrix_column(T.R, 2)} : turned_about_z(T, a.turn);
}
template <class V>
CSPACE_INLINE Step<V> turn_step(const Turn<V>& t) {
    return {t, fill_lanes<V>(0.0)};
}
template <class V>
CSPACE_INLINE Step<V> slide_step(V d) {
    return {{fill_lanes<V>(1.0), fill_lanes<V>(0.0)}, d};
}

// The six parts of the left side that a5 does not see, less the constant of the right side.
template <class V>
CSPACE_INLINE void parts_without_a5(const Elimination& e, const Pose<V>& X, V (&out)[6]) {
    const Vec3<V> l = matrix_column(X.R, 2), &p = X.t;
    const V pp = dot(p, p), pl = dot(p, l);
    out[0] = l.z;
    out[1] = p.z;
    out[2] = p.x * l.y - p.y * l.x;
    out[3] = pp * l.z - 2.0 * pl * p.z;
    out[4] = pp;
    out[5] = pl;
    for (int i = 0; i < 6; ++i) out[i] = out[i] - e.W[i][2];
}

// a5 and a3 from the two sides of the loop once a4 is known; writes the joints of all six.
template <class V>
CSPACE_INLINE void close_loop(const Loop& loop, const Pose<V>& X, const Turn<V>& a0, const Step<V>& a1,
                              const Step<V>& a2, const Step<V>& a4, V* q) {
    const Pose<V> M3 = fill_pose<V>(inverse(loop.M[3])), M4 = fill_pose<V>(inverse(loop.M[4]));
    const Step<V> back = {{a4.turn.c, -a4.turn.s}, -a4.slide};
    const Pose<V> Y = stepped_angle(M4, loop.slides[4], back) * M3;  // X = Rz(−a5) Y Rz(−a3)
    const Vec3<V> l = matrix_column(X.R, 2), w = matrix_column(Y.R, 2);
    const Turn<V> a5 = unit_turn(w.x * l.x + w.y * l.y + Y.t.x * X.t.x + Y.t.y * X.t.y,
                                 w.y * l.x - w.x * l.y + Y.t.y * X.t.x - Y.t.x * X.t.y);
    // The first column of Yᵀ Rz(a5) X is that of Rz(−a3).
    const Vec3<V> x = matrix_column(X.R, 0);
    const Vec3<V> turned = {a5.c * x.x - a5.s * x.y, a5.s * x.x + a5.c * x.y, x.z};
    const Vec3<V> seen = transpose_times(Y.R, turned);
    const Turn<V> a3 = {seen.x, -seen.y};
    const Step<V> all[6] = {turn_step(a0), a1, a2, turn_step(a3), a4, turn_step(a5)};
    for (int j = 0; j < 6; ++j)
        q[loop.joint[j]] = loop.sign * (loop.slides[j] ? all[j].slide : angle_of(all[j].turn));
}

// Candidates for the joints of one hidden angle (cosine and sine a0) and the half angles found there. Where
// the parts fix a4 by one equation alone there are two; `second` says so.
template <class V>
CSPACE_INLINE void joints_from(const Loop& loop, const Elimination& e, const Turn<V>& a0,
                               const TwoHalfAngles<V>& half, V* q, V* second) {
    const Turn<V> o1 = {fill_lanes<V>(std::cos(a1_origin)), fill_lanes<V>(std::sin(a1_origin))};
    const Turn<V> o2 = {fill_lanes<V>(std::cos(a2_origin)), fill_lanes<V>(std::sin(a2_origin))};
    // The monomials of a slide are those of an angle of which it is the tangent of the half.
    const auto step = [](bool slides, V c, V s, const Turn<V>& origin) {
        if (!slides) return turn_step(unit_turn(c, s) + origin);
        const V size = sqrt(c * c + s * s), upper = size - c, lower = size + c;
        return slide_step(select_lanes(lower > upper, s / max(lower, fill_lanes<V>(tolerance::nonzero)),
                                       upper / select_lanes(s == 0.0, fill_lanes<V>(tolerance::nonzero), s)));
    };
    const Step<V> a1 = step(loop.slides[1], half.c1, half.s1, o1);
    const Step<V> a2 = step(loop.slides[2], half.c2, half.s2, o2);
    Pose<V> X = turned_about_z(fill_pose<V>(loop.M[5]), a0) * fill_pose<V>(loop.M[0]);
    X = stepped_angle(X, loop.slides[1], a1) * fill_pose<V>(loop.M[1]);
    X = stepped_angle(X, loop.slides[2], a2) * fill_pose<V>(loop.M[2]);
    V part[6];
    parts_without_a5(e, X, part);
    if (e.a4_rank > firm_rank) {
        V c = fill_lanes<V>(0.0), s = c;
        for (int i = 0; i < 6; ++i) {
            c = mul_add(fill_lanes<V>(e.inverse_w[0][i]), part[i], c);
            s = mul_add(fill_lanes<V>(e.inverse_w[1][i]), part[i], s);
        }
        close_loop(loop, X, a0, a1, a2, loop.slides[4] ? slide_step(s) : turn_step(unit_turn(c, s)), q);
        return;
    }
    int best = 0;
    double most = -1;
    for (int i = 0; i < 6; ++i) {
        const double size = e.W[i][0] * e.W[i][0] + e.W[i][1] * e.W[i][1];
        if (size > most) most = size, best = i;
    }
    if (loop.slides[4]) {  // w0 a² + w1 a = part
        const double w0 = e.W[best][0], w1 = e.W[best][1];
        const V root = sqrt(max(0.25 * w1 * w1 + w0 * part[best], fill_lanes<V>(0.0)));
        const double scale = w0 != 0 ? 1 / w0 : 0;
        close_loop(loop, X, a0, a1, a2, slide_step(scale * (root - 0.5 * w1)), q);
        close_loop(loop, X, a0, a1, a2, slide_step(scale * (-root - 0.5 * w1)), second);
        return;
    }
    const double length = std::sqrt(max(most, tolerance::nonzero));
    const Turn<V> mean = {fill_lanes<V>(e.W[best][0] / length), fill_lanes<V>(e.W[best][1] / length)};
    const V c = max(min(part[best] * (1 / length), fill_lanes<V>(1.0)), fill_lanes<V>(-1.0));
    const Turn<V> off = {c, sqrt(max(1.0 - c * c, fill_lanes<V>(0.0)))};
    close_loop(loop, X, a0, a1, a2, turn_step(mean + off), q);
    close_loop(loop, X, a0, a1, a2, turn_step(mean - off), second);
}

// Solutions that share the hidden angle or nearly do: there the twelve equations lose two ranks, and the two
// solutions are distinguished inside the plane of the two weakest vectors.

template <class V>
CSPACE_INLINE V dot_12(const V* a, const V* b) {
    V sum = a[0] * b[0];
    for (int i = 1; i < 12; ++i) sum = mul_add(a[i], b[i], sum);
    return sum;
}
template <class V>
CSPACE_INLINE void make_unit(V* y) {
    const V scale = 1.0 / sqrt(max(dot_12(y, y), fill_lanes<V>(tolerance::nonzero)));
    for (int i = 0; i < 12; ++i) y[i] = scale * y[i];
}

// The singular vectors of the two smallest singular values, by subspace iteration with the inverse of R Rᵀ
// (Golub & Van Loan 2013, section 8.2), orthonormal; the triangle is read from a reduction of the transposed
// equations.
template <class V>
CSPACE_NOINLINE void weak_plane(const ReducedEquations<V>& r, V (&y)[2][12]) {
    constexpr int steps = 2;
    V floor = fill_lanes<V>(0.0), inverse[12];
    for (const V& d : r.diagonal) floor = max(floor, abs(d));
    floor = tolerance::last_digits * floor;
    for (int k = 0; k < 12; ++k) {
        inverse[k] = 1.0 / copysign(max(abs(r.diagonal[k]), floor), r.diagonal[k]);
        y[0][k] = fill_lanes<V>(k == 11 ? 1.0 : 0.0);
        y[1][k] = fill_lanes<V>(k == 10 ? 1.0 : 0.0);
    }
    for (int step = 0; step < steps; ++step) {
        for (auto& v : y) {
            for (int k = 11; k >= 0; --k) {  // R w = v
                for (int j = k + 1; j < 12; ++j) v[k] = mul_add(-r.A[k][j], v[j], v[k]);
                v[k] = v[k] * inverse[k];
            }
            make_unit(v);
            for (int k = 0; k < 12; ++k) {  // Rᵀ z = w
                for (int j = 0; j < k; ++j) v[k] = mul_add(-r.A[j][k], v[j], v[k]);
                v[k] = v[k] * inverse[k];
            }
            make_unit(v);
        }
        const V along = dot_12(y[0], y[1]);
        for (int i = 0; i < 12; ++i) y[1][i] = mul_add(-along, y[0][i], y[1][i]);
        make_unit(y[1]);
    }
    for (auto& v : y) turn_back(r, v);
}

// Vectors Z u of the plane with (upper nine) = t (lower nine): t is an eigenvalue of the 2 × 2 pencil that
// the plane makes of the two. Both, one twice where they coincide; true where they are real.
template <class V>
CSPACE_NOINLINE mask_of<V> split_plane(const V (&plane)[2][12], V (&out)[2][12]) {
    // Normal equations of  upper u = t lower u,  the better of the two halves inverted.
    V ll[2][2], lu[2][2], uu[2][2];
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
            ll[a][b] = uu[a][b] = lu[a][b] = fill_lanes<V>(0.0);
            for (int i = 0; i < 9; ++i) {
                ll[a][b] = mul_add(plane[a][i + 3], plane[b][i + 3], ll[a][b]);
                uu[a][b] = mul_add(plane[a][i], plane[b][i], uu[a][b]);
                lu[a][b] = mul_add(plane[a][i + 3], plane[b][i], lu[a][b]);
            }
        }
    constexpr double rounding = 1e-12;  // of entries that cancel
    const V det_l = ll[0][0] * ll[1][1] - ll[0][1] * ll[1][0];
    const V det_u = uu[0][0] * uu[1][1] - uu[0][1] * uu[1][0];
    const mask_of<V> by_lower = det_l >= det_u;
    const V det = max(det_l, det_u), g01 = select_lanes(by_lower, ll[0][1], uu[0][1]);
    const V g00 = select_lanes(by_lower, ll[0][0], uu[0][0]),
            g11 = select_lanes(by_lower, ll[1][1], uu[1][1]);
    const V h01 = select_lanes(by_lower, lu[0][1], lu[1][0]),
            h10 = select_lanes(by_lower, lu[1][0], lu[0][1]);
    const V inverse = 1.0 / max(det, fill_lanes<V>(tolerance::nonzero));
    const V m00 = (g11 * lu[0][0] - g01 * h10) * inverse, m01 = (g11 * h01 - g01 * lu[1][1]) * inverse;
    const V m10 = (g00 * h10 - g01 * lu[0][0]) * inverse, m11 = (g00 * lu[1][1] - g01 * h01) * inverse;
    const V mean = 0.5 * (m00 + m11), half = 0.5 * (m00 - m11);
    const V root = sqrt(max(half * half + m01 * m10, fill_lanes<V>(0.0)));
    for (int k = 0; k < 2; ++k) {
        const V t = k == 0 ? mean + root : mean - root;
        const V a = m00 - t, d = m11 - t;
        const mask_of<V> first = a * a + m01 * m01 > d * d + m10 * m10;
        V u0 = select_lanes(first, -m01, -d), u1 = select_lanes(first, a, m10);
        const V size = sqrt(u0 * u0 + u1 * u1);
        const mask_of<V> any_vector = !(size > rounding);  // a multiple of the unit matrix
        u0 = select_lanes(any_vector, fill_lanes<V>(k == 0 ? 1.0 : 0.0), u0);
        u1 = select_lanes(any_vector, fill_lanes<V>(k == 0 ? 0.0 : 1.0), u1);
        for (int i = 0; i < 12; ++i) out[k][i] = u0 * plane[0][i] + u1 * plane[1][i];
    }
    return det > 0.0;
}

}  // namespace cspace::ik::inline CSPACE_ISA
