// Arms whose axes 2, 3 and 4 are parallel and whose axes 5 and 6 intersect (the UR class, its reverse, and
// others; Hawkins 2013). The height of the wrist over the plane normal to the parallel axes determines t1.
// The orientation then determines the angles (t2 + t3 + t4, t5, t6), as in a wrist. A planar two-link arm
// determines the rest. Up to 2 × 2 × 2 solutions.
#pragma once

#include <initializer_list>

#include "cspace/ik/dh_form.hpp"
#include "cspace/ik/solution.hpp"
#include "cspace/ik/spherical_wrist.hpp"
#include "cspace/math/wrapping.hpp"

namespace cspace::ik {

struct ThreeParallel {
    double a1, ca1, sa1;
    double height;  // of the wrist over joint 1's normal, along the parallel axes [m]
    double l2, l3;  // the links of the planar arm [m]
    double x4, y4;  // from joint 4 to the wrist, in the plane [m]
    Wrist last;
    double length;
};

// What one shoulder solution leaves: the wrist, and the place that it has in the plane of the parallel axes.
template <class V>
struct BehindShoulder {
    Turn<V> t1;
    WristView<V> wrist;
    V x, y;
};

// Values of a free joint 1 at which a side of the wrist may come into reach or leave it: how far behind a
// first value, the nearest first.
struct ShoulderEnds {
    static constexpr int most = 12;
    int count = 0;
    double angle[most];
};

// Candidate sums, the best first.
struct FreeSums {
    static constexpr int most = 12;
    int count = 0;
    double sum[most];
    double rank[most];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline ThreeParallel make_three_parallel(const DhForm& f) {
    return {f.a[0], f.ca[0], f.sa[0],           f.d[1] + f.d[2] + f.d[3] + f.ca[3] * f.d[4],    f.a[1],
            f.a[2], f.a[3],  -f.sa[3] * f.d[4], make_wrist(f.ca[3], f.sa[3], f.ca[4], f.sa[4]), f.length};
}

// The height of p over the plane of the three joints determines t1.
template <class V>
CSPACE_INLINE TwoAngles<V> shoulder_angles(const ThreeParallel& arm, const Vec3<V>& p,
                                           const ClosedFormSettings& settings) {
    return shoulder_angles(arm.height, arm.ca1, arm.sa1, p, arm.length, settings);
}

template <class V>
CSPACE_INLINE BehindShoulder<V> look_behind_shoulder(const ThreeParallel& arm, const Turn<V>& t1,
                                                     const Pose<V>& goal,
                                                     const ClosedFormSettings& settings) {
    const auto seen = [&](const Vec3<V>& v) { return undo_joint(t1, arm.ca1, arm.sa1, v); };
    const Vec3<V> p = seen(goal.t);
    return {t1,
            look_at_wrist(arm.last, seen(matrix_column(goal.R, 2)), seen(matrix_column(goal.R, 0)), settings),
            p.x - arm.a1, p.y};
}

// Completes one shoulder and one wrist solution, that with sin t5 = s5, by the planar arm: both elbow
// solutions, in two rows.
template <class V>
CSPACE_INLINE void write_elbows(const ThreeParallel& arm, const BehindShoulder<V>& at, V s5,
                                const ClosedFormSettings& settings, V* const rows[2], mask_of<V>& ok,
                                mask_of<V>& doubt) {
    const WristSide<V> wrist = wrist_side(arm.last, at.wrist, s5, settings.unconstrained[3]);
    const Turn<V>& t234 = wrist.t4;
    const V u = at.x - (t234.c * arm.x4 - t234.s * arm.y4), v = at.y - (t234.s * arm.x4 + t234.c * arm.y4);
    const TwoLink<V> links = two_link(u, v, arm.l2, arm.l3, arm.length, settings, settings.unconstrained[1]);
    doubt = doubt || (ok && links.doubt);
    ok = ok && links.ok;
    const V angle1 = angle_of(at.t1), angle3 = atan2(links.elbow[0].s, links.elbow[0].c);
    const V angle5 = atan2(wrist.t5.s, wrist.t5.c), angle6 = angle_of(wrist.t6);
    for (int j = 0; j < 2; ++j) {
        rows[j][0] = angle1;
        rows[j][1] = angle_of(links.first[j]);
        rows[j][2] = j == 0 ? angle3 : -angle3;
        rows[j][3] = angle_of(t234 - (links.first[j] + links.elbow[j]));
        rows[j][4] = angle5;
        rows[j][5] = angle6;
    }
}

template <class V>
CSPACE_INLINE Branches<V> solve_three_parallel(const ThreeParallel& arm, const Pose<V>& goal,
                                               const ClosedFormSettings& settings) {
    Branches<V> out;
    const TwoAngles<V> shoulder = shoulder_angles(arm, goal.t, settings);
    out.doubt = shoulder.doubt;
    for (int i = 0; i < 2; ++i) {
        const BehindShoulder<V> at = look_behind_shoulder(arm, shoulder.root[i], goal, settings);
        out.doubt = out.doubt || (shoulder.ok && at.wrist.doubt);
        for (int j = 0; j < 2; ++j) {
            const int n = 4 * i + 2 * j;
            V* const rows[2] = {out.t[n], out.t[n + 1]};
            mask_of<V> ok = shoulder.ok && at.wrist.ok;
            write_elbows(arm, at, j == 0 ? at.wrist.s5 : -at.wrist.s5, settings, rows, ok, out.doubt);
            out.ok[n] = out.ok[n + 1] = ok;
        }
    }
    return out;
}

// One goal: the lanes are (shoulder, wrist) = (0, 0), (0, 1), (1, 0), (1, 1); t[0] and t[1] differ in the
// elbow.
CSPACE_INLINE Abreast solve_abreast(const ThreeParallel& arm, const Posed& goal,
                                    const ClosedFormSettings& settings) {
    const TwoAngles<double> shoulder = shoulder_angles(arm, goal.t, settings);
    const Turn<double> each[4] = {shoulder.root[0], shoulder.root[0], shoulder.root[1], shoulder.root[1]};
    const BehindShoulder<Four> at =
        look_behind_shoulder(arm, side_by_side(each), fill_pose<Four>(goal), settings);
    Four side = fill_lanes<Four>(1.0);
    set_lane(side, 1, -1.0);
    set_lane(side, 3, -1.0);
    Abreast out;
    out.ok = shoulder.ok ? at.wrist.ok : fill_lanes<Four>(0.0) > 1.0;
    Mask<4> doubt = out.ok && at.wrist.doubt;
    Four* const rows[2] = {out.t[0], out.t[1]};
    write_elbows(arm, at, side * at.wrist.s5, settings, rows, out.ok, doubt);
    out.doubt = shoulder.doubt || any(doubt);
    return out;
}

// Three parallel axes with axis 6 parallel to them (wrist singularity). The sum t2 + t3 + t4 is then free. It
// moves the point that the planar arm of joints 2 and 3 must reach on a circle. The sums for which the point
// is in reach form arcs. The ends of the arcs solve a linear equation in the cosine and sine of the sum.

inline void insert_sorted(FreeSums& out, double sum, double rank) {
    if (out.count == FreeSums::most) return;
    int at = out.count++;
    for (; at > 0 && out.rank[at - 1] > rank; --at) {
        out.sum[at] = out.sum[at - 1];
        out.rank[at] = out.rank[at - 1];
    }
    out.sum[at] = sum;
    out.rank[at] = rank;
}

// The sums at which the target, seen from joint 2 at (x, y) less Rz(sum) (x4, y4), is at distance `reach`.
inline TwoAngles<double> solve_reach(const ThreeParallel& arm, double x, double y, double reach,
                                     const ClosedFormSettings& settings) {
    const double a = 2 * (x * arm.x4 + y * arm.y4), b = 2 * (y * arm.x4 - x * arm.y4);
    const double r = x * x + y * y + arm.x4 * arm.x4 + arm.y4 * arm.y4 - reach * reach;
    return linear_equation<double>(a, b, r, arm.length * arm.length, settings, {1, 0});
}

// First come values slightly to either side of these sums, where the elbow is bent, those nearest to
// `unconstrained` first; then the sums themselves.
inline void add_ends(FreeSums& out, const ThreeParallel& arm, double x, double y, double reach,
                     double unconstrained, const ClosedFormSettings& settings) {
    const TwoAngles<double> ends = solve_reach(arm, x, y, reach, settings);
    if (!ends.ok) return;
    const double one = angle_of(ends.root[0]), other = angle_of(ends.root[1]);
    const double gap = std::fabs(short_way(other - one));
    const double inside = min(0.02, 0.1 * min(gap, 2 * pi - gap));
    for (const double end : {one, other}) {
        for (const double sum : {end - inside, end + inside})
            insert_sorted(out, sum, std::fabs(short_way(sum - unconstrained)));
        insert_sorted(out, end, 4 + std::fabs(short_way(end - unconstrained)));
    }
}

// For shoulder solution i. The list is empty where nothing is free, or where the other shoulder solution is
// the same.
inline FreeSums free_sums(const ThreeParallel& arm, const Posed& goal, int i, double unconstrained,
                          const ClosedFormSettings& settings) {
    constexpr double merged = 1e-4;  // [rad] both solutions of a double root give the same sums
    FreeSums out;
    const TwoAngles<double> shoulder = shoulder_angles(arm, goal.t, settings);
    const Turn<double>& t1 = shoulder.root[i];
    const bool is_same = i == 1 && std::fabs(angle_of(t1 - shoulder.root[0])) < merged;
    const Vec3d z = undo_joint(t1, arm.ca1, arm.sa1, matrix_column(goal.R, 2));
    if (!shoulder.ok || is_same || z.x * z.x + z.y * z.y > settings.free * settings.free) return out;
    const Vec3d p = undo_joint(t1, arm.ca1, arm.sa1, goal.t);
    for (const double reach : {arm.l2 + arm.l3, arm.l2 - arm.l3})
        add_ends(out, arm, p.x - arm.a1, p.y, reach, unconstrained, settings);
    return out;
}

// For a wrist on the first axis, which joint 1 does not move. The planar arm reaches it for sums t2 + t3 + t4
// between those of solve_reach. Joint 1 turns the last axis z, and z · (axis 5) = cos α5 where the sum is one
// of these; the angle t5 exists while z · (axis 4) is within the cosines of α4 ± α5. Each is a linear
// equation in the cosine and sine of t1.
inline ShoulderEnds shoulder_ends(const ThreeParallel& arm, const Posed& goal,
                                  const ClosedFormSettings& settings, double first) {
    const Vec3d z = matrix_column(goal.R, 2), p = undo_joint<double>({1, 0}, arm.ca1, arm.sa1, goal.t);
    const Vec3d of_cosine = {z.x, arm.ca1 * z.y, -arm.sa1 * z.y},
                of_sine = {z.y, -arm.ca1 * z.x, arm.sa1 * z.x}, constant = {0, arm.sa1 * z.z, arm.ca1 * z.z};
    ShoulderEnds out;
    const auto add_where = [&](const Vec3d& axis, double cosine) {
        const TwoAngles<double> found = linear_equation<double>(
            dot(axis, of_cosine), dot(axis, of_sine), cosine - dot(axis, constant), 1, settings, {1, 0});
        if (!found.ok) return;
        for (const Turn<double>& t1 : found.root) {
            const double angle = wrap_above(angle_of(t1) - first, 0);
            int at = out.count++;
            for (; at > 0 && out.angle[at - 1] > angle; --at) out.angle[at] = out.angle[at - 1];
            out.angle[at] = angle;
        }
    };
    for (const double reach : {arm.l2 + arm.l3, arm.l2 - arm.l3}) {
        const TwoAngles<double> sums = solve_reach(arm, p.x - arm.a1, p.y, reach, settings);
        if (!sums.ok) continue;
        for (const Turn<double>& sum : sums.root)
            add_where({arm.last.sa4 * sum.s, -arm.last.sa4 * sum.c, arm.last.ca4}, arm.last.ca5);
    }
    for (const double cosine : {arm.last.c_sum, arm.last.c_diff}) add_where({0, 0, 1}, cosine);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
