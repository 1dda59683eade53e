// Trigonometric equations shared by the closed forms, over a scalar V: one angle from a linear equation, two
// from a planar two-link arm, three from an orientation. Each reports where it has a solution (`ok`) and
// where the result needs a check (`doubt`): two solutions are about to merge, or the pose leaves an angle
// free.
#pragma once

#include "cspace/math/turn.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

// Settings of the careful solver: the width of the band in which two solutions may merge, the distance kept
// between merging solutions, the size below which a lever arm counts as zero and its joint as free, and the
// angles t_i (as cosine and sine) of joints that the pose leaves free.
struct ClosedFormSettings {
    double band = tolerance::fold_band;
    double spread = 0;
    double free = tolerance::free_joint;
    Turn<double> unconstrained[6] = {{1, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 0}};
};

template <class V>
struct TwoAngles {
    Turn<V> root[2];
    mask_of<V> ok, doubt;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Turn<V> choose_turn(mask_of<V> m, const Turn<double>& yes, const Turn<V>& no) {
    return {select_lanes(m, fill_lanes<V>(yes.c), no.c), select_lanes(m, fill_lanes<V>(yes.s), no.s)};
}
// Rᵀ v for R = Rz(t) Rx(α).
template <class V>
CSPACE_INLINE Vec3<V> undo_joint(const Turn<V>& t, double ca, double sa, const Vec3<V>& v) {
    const V x = t.c * v.x + t.s * v.y, y = t.c * v.y - t.s * v.x;
    return {x, ca * y + sa * v.z, ca * v.z - sa * y};
}
// The rotation that takes the plane vector (x, y) to (u, v), both of squared length n2.
template <class V>
struct Aligned {
    Turn<V> t;
    mask_of<V> doubt;
};
template <class V>
CSPACE_INLINE Aligned<V> align_turn(V x, V y, V u, V v, double unit, const ClosedFormSettings& settings,
                                    const Turn<double>& unconstrained) {
    const V n2 = u * u + v * v;
    const mask_of<V> is_free = n2 <= settings.free * settings.free * unit * unit;
    const V scale = 1.0 / select_lanes(is_free, fill_lanes<V>(1.0), n2);
    const Turn<V> t = {(x * u + y * v) * scale, (x * v - y * u) * scale};
    return {choose_turn(is_free, unconstrained, t), n2 <= settings.band * unit * unit};
}
// The turn about the unit axis h that takes v to u, both at one angle from h; none where they lie on it.
template <class V>
CSPACE_INLINE Turn<V> turn_onto(const Vec3<V>& h, const Vec3<V>& v, const Vec3<V>& u, double free) {
    const Vec3<V> a = v - dot(v, h) * h, b = u - dot(u, h) * h;
    const V size2 = max(dot(a, a), fill_lanes<V>(tolerance::nonzero));
    const V inverse = 1.0 / size2;
    return choose_turn(size2 <= free * free, {1, 0},
                       Turn<V>{dot(a, b) * inverse, dot(h, cross(a, b)) * inverse});
}
// The first and the last turn of R = e^{h1 t1} e^{h2 t2} e^{h3 t3} about three axes, given the middle one.
template <class V>
CSPACE_INLINE void outer_turns(const Vec3d* axis, const Turn<V>& middle, const Mat3<V>& R, double free,
                               Turn<V>& first, Turn<V>& last) {
    const Vec3<V> h1 = fill_vec3<V>(axis[0]), h2 = fill_vec3<V>(axis[1]), h3 = fill_vec3<V>(axis[2]);
    first = turn_onto(h1, rotate_about(h2, middle, h3), R * h3, free);
    const Vec3<V> across = fill_vec3<V>(any_perpendicular(axis[2]));
    const Vec3<V> x = rotate_about(h2, Turn<V>{middle.c, -middle.s},
                                   rotate_about(h1, Turn<V>{first.c, -first.s}, R * across));
    last = {dot(x, across), dot(x, cross(h3, across))};
}
// sqrt(x) with x clipped below at floor ≥ 0.
template <class V>
CSPACE_INLINE V root_above(V x, V floor) {
    return sqrt(max(x, floor));
}

// a cos t + b sin t = r: none, one (doubt) or two angles. `unit` is the typical size of a and b.
template <class V>
CSPACE_INLINE TwoAngles<V> linear_equation(V a, V b, V r, double unit, const ClosedFormSettings& settings,
                                           const Turn<double>& unconstrained) {
    const V n2 = a * a + b * b;
    const V room = n2 - r * r;
    const double unit2 = unit * unit;
    const mask_of<V> is_free = n2 <= settings.free * settings.free * unit2;
    const V scale = 1.0 / select_lanes(is_free, fill_lanes<V>(1.0), n2);
    const V h = root_above(room, settings.spread * n2);
    TwoAngles<V> out;
    out.root[0] = {(a * r - b * h) * scale, (b * r + a * h) * scale};
    out.root[1] = {(a * r + b * h) * scale, (b * r - a * h) * scale};
    for (auto& t : out.root) t = choose_turn(is_free, unconstrained, t);
    // A short lever feels an error of r more: the band is one of lengths of the arm, not of the lever.
    const V band = settings.band * (n2 + unit2);
    out.ok = (room >= -band) || (is_free && (abs(r) <= tolerance::reached * unit));
    out.doubt = (out.ok && (room <= band)) || (n2 <= band);
    return out;
}

// Where a joint and a link of twist α keep a height along the axis behind them: the angle t of the joint from
// sin t px − cos t py = (height − cos α pz) / sin α.
template <class V>
CSPACE_INLINE TwoAngles<V> shoulder_angles(double height, double ca, double sa, const Vec3<V>& p, double unit,
                                           const ClosedFormSettings& settings) {
    const V k = (height - ca * p.z) * (1 / sa);
    return linear_equation<V>(-p.y, p.x, k, unit, settings, settings.unconstrained[0]);
}

// A planar arm of links l1, l2 reaching (x, y): γ is the angle at the elbow, ± for its two sides.
template <class V>
struct TwoLink {
    Turn<V> elbow[2], first[2];  // ±γ, and the first joint for both
    mask_of<V> ok, doubt;
};
template <class V>
CSPACE_INLINE TwoLink<V> two_link(V x, V y, double l1, double l2, double unit,
                                  const ClosedFormSettings& settings, const Turn<double>& unconstrained) {
    const V r2 = x * x + y * y;
    const double product = 2 * l1 * l2, size2 = (l1 + l2) * (l1 + l2);
    const V room_out = (size2 - r2) * (1 / product);                 // 1 − cos γ
    const V room_in = (r2 - (l1 - l2) * (l1 - l2)) * (1 / product);  // 1 + cos γ
    TwoLink<V> out;
    const V cosine = 0.5 * (room_in - room_out);
    const V sine = root_above(room_out * room_in, fill_lanes<V>(settings.spread));
    out.elbow[0] = {cosine, sine};
    out.elbow[1] = {cosine, -sine};
    const V along = l1 + l2 * cosine, across = l2 * sine;
    const mask_of<V> is_free = r2 <= settings.free * settings.free * size2;
    const V scale = 1.0 / select_lanes(is_free, fill_lanes<V>(1.0), r2);
    out.first[0] = {(x * along + y * across) * scale, (y * along - x * across) * scale};
    out.first[1] = {(x * along - y * across) * scale, (y * along + x * across) * scale};
    for (auto& t : out.first) t = choose_turn(is_free, unconstrained, t);
    const V least = min(room_out, room_in);
    const double band = settings.band * (size2 + unit * unit) / product;
    out.ok = least >= -band;
    out.doubt = out.ok && ((least <= band) || (r2 <= band * size2));
    return out;
}

// M = Rz(t4) Rx(α4) Rz(t5) Rx(α5) Rz(t6), given the last and first column of M: two solutions, ±t5.
struct Wrist {
    double ca4, sa4, ca5, sa5;
    double c_sum, s_sum, c_diff, s_diff;  // of α4 + α5 and α4 − α5
    double inv;                           // 1 / (sin α4 sin α5)
    bool right_angled;                    // both twists ±90°: the second solution is (t4 + π, −t5, t6 + π)
};
inline Wrist make_wrist(double ca4, double sa4, double ca5, double sa5) {
    const bool square = std::fabs(ca4) < tolerance::last_digits && std::fabs(ca5) < tolerance::last_digits;
    return {ca4,
            sa4,
            ca5,
            sa5,
            ca4 * ca5 - sa4 * sa5,
            sa4 * ca5 + ca4 * sa5,
            ca4 * ca5 + sa4 * sa5,
            sa4 * ca5 - ca4 * sa5,
            1 / (sa4 * sa5),
            square};
}
// cos a − cos b from the cosines, or from the sines where both are small and the cosines would cancel.
template <class V>
CSPACE_INLINE V cosine_gap(V ca, V sa2, double cb, double sb) {
    const V total = ca + cb;
    const V by_sines = (sb * sb - sa2) / select_lanes(abs(total) > 0.5, total, fill_lanes<V>(1.0));
    return select_lanes(abs(total) > 0.5, by_sines, ca - cb);
}

// Quantities common to both solutions: cos t5 and |sin t5|, and the third and first column of M.
template <class V>
struct WristView {
    Vec3<V> z, x;
    V c5, s5, inverse_rho2;
    mask_of<V> ok, doubt, t4_is_free;
};
template <class V>
CSPACE_INLINE WristView<V> look_at_wrist(const Wrist& w, const Vec3<V>& z, const Vec3<V>& x,
                                         const ClosedFormSettings& settings) {
    WristView<V> view;
    view.z = z;
    view.x = x;
    const V rho2 = z.x * z.x + z.y * z.y;
    // 1 − cos t5 and 1 + cos t5, each without cancellation near zero (spherical law of cosines).
    const V low = cosine_gap(z.z, rho2, w.c_sum, w.s_sum) * w.inv;
    const V high = -cosine_gap(z.z, rho2, w.c_diff, w.s_diff) * w.inv;
    const V least = min(low, high);
    view.c5 = 0.5 * (high - low);
    view.s5 = root_above(low * high, fill_lanes<V>(settings.spread));
    view.t4_is_free = rho2 <= settings.free * settings.free;
    view.inverse_rho2 = 1.0 / select_lanes(view.t4_is_free, fill_lanes<V>(1.0), rho2);
    const double band = settings.band * (1 + std::fabs(w.inv));
    view.ok = least >= -band;
    view.doubt = view.ok && ((least <= band) || (rho2 <= band));
    return view;
}

template <class V>
struct WristSide {
    Turn<V> t4, t5, t6;
};
// The solution with sin t5 = s.
template <class V>
CSPACE_INLINE WristSide<V> wrist_side(const Wrist& w, const WristView<V>& view, V s,
                                      const Turn<double>& unconstrained) {
    const Vec3<V>&z = view.z, &x = view.x;
    // z = Rz(t4) (p, q, ·) fixes t4.
    const V p = w.sa5 * s, q = -w.ca4 * w.sa5 * view.c5 - w.sa4 * w.ca5;
    const Turn<V> turned = {(z.x * p + z.y * q) * view.inverse_rho2, (z.y * p - z.x * q) * view.inverse_rho2};
    const Turn<V> t4 = choose_turn(view.t4_is_free, unconstrained, turned);
    // The first column of Rz(t4) Rx(α4) Rz(t5) Rx(α5) and the second, against x, fix t6.
    const V y1 = t4.c * x.x + t4.s * x.y, y2 = t4.c * x.y - t4.s * x.x;
    const V along = w.ca4 * y2 + w.sa4 * x.z, across = w.ca4 * x.z - w.sa4 * y2;
    return {
        t4, {view.c5, s}, {view.c5 * y1 + s * along, w.ca5 * (view.c5 * along - s * y1) + w.sa5 * across}};
}

}  // namespace cspace::ik::inline CSPACE_ISA
