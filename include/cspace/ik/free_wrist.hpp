// Three parallel axes with axis 6 parallel to them (wrist singularity). The sum t2 + t3 + t4 is then free. It
// moves the point that the planar arm of joints 2 and 3 must reach on a circle. The sums for which the point
// is in reach form arcs. The ends of the arcs solve a linear equation in the cosine and sine of the sum.
#pragma once

#include <initializer_list>

#include "cspace/ik/three_parallel.hpp"

namespace cspace::ik {

// Candidate sums, the best first.
struct FreeSums {
    static constexpr int most = 12;
    int count = 0;
    double sum[most];
    double rank[most];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

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
// First come values slightly to either side of them, where the elbow is bent, those nearest to
// `unconstrained` first; then the sums themselves.
inline void add_ends(FreeSums& out, const ThreeParallel& arm, double x, double y, double reach,
                     double unconstrained, const Care& care) {
    const double a = 2 * (x * arm.x4 + y * arm.y4), b = 2 * (y * arm.x4 - x * arm.y4);
    const double r = x * x + y * y + arm.x4 * arm.x4 + arm.y4 * arm.y4 - reach * reach;
    const TwoAngles<double> ends = linear_equation<double>(a, b, r, arm.length * arm.length, care, {1, 0});
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
                          const Care& care) {
    FreeSums out;
    const Vec3d& p = goal.t;
    const double k = (arm.height - arm.ca1 * p.z) * (1 / arm.sa1);
    const TwoAngles<double> shoulder =
        linear_equation<double>(-p.y, p.x, k, arm.length, care, care.unconstrained[0]);
    const Turn<double>& t1 = shoulder.root[i];
    const bool is_same = i == 1 && std::fabs(angle_of(t1 - shoulder.root[0])) < 1e-4;
    const Vec3d z = undo_joint(t1, arm.ca1, arm.sa1, column(goal.R, 2));
    if (!shoulder.ok || is_same || z.x * z.x + z.y * z.y > care.free * care.free) return out;
    const double x = t1.c * p.x + t1.s * p.y - arm.a1;
    const double y = arm.ca1 * (t1.c * p.y - t1.s * p.x) + arm.sa1 * p.z;
    for (const double reach : {arm.l2 + arm.l3, arm.l2 - arm.l3})
        add_ends(out, arm, x, y, reach, unconstrained, care);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
