// The gap between the tip of an arm with up to three joints and a goal, as a function of its joints.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/ik/subproblems/least_squares.hpp"
#include "cspace/ik/subproblems/sp1.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// Lengths, and with them prismatic joints, are in units of the size of the arm.
template <int n>
struct TipGap {
    static constexpr int angles = n, equations = 3;
    Vec3d axis[n], point[n], tip, goal;
    bool prismatic[n];
    double reached;

    // Columns from the base outward: the gap turned and moved by joint n − 1 first, by joint 0 last.
    void operator()(const double* q, double* value, double (*slope)[n]) const {
        Vec3d x = tip, columns[n];
        for (int i = n - 1; i >= 0; --i) {
            if (prismatic[i]) {
                columns[i] = axis[i];
                x = x + q[i] * axis[i];
                continue;
            }
            const Turn<double> t = turn_by(q[i]);
            for (int j = i + 1; j < n; ++j) columns[j] = rotate_about(axis[i], t, columns[j]);
            const Vec3d r = rotate_about(axis[i], t, x - point[i]);
            columns[i] = cross(axis[i], r);
            x = point[i] + r;
        }
        const Vec3d gap = x - goal;
        value[0] = gap.x, value[1] = gap.y, value[2] = gap.z;
        for (int j = 0; j < n; ++j)
            slope[0][j] = columns[j].x, slope[1][j] = columns[j].y, slope[2][j] = columns[j].z;
    }
};

// The point of axis i nearest to the tip, at zero.
inline Vec3d foot_of_tip(const Chain& chain, int i) {
    if (chain.prismatic[i]) return chain.tip.t;
    const Vec3d r = chain.tip.t - chain.point[i];
    return chain.point[i] + dot(r, chain.axis[i]) * chain.axis[i];
}
// The size of the problem [m], and the relative gap up to which the goal counts as reached. Where coordinates
// are large compared with the arm, their rounding determines it.
struct PositionScale {
    double size, reached;
};
inline PositionScale position_scale(const Chain& chain, const Vec3d& goal) {
    double size = norm(goal - chain.tip.t), far = std::fmax(norm(goal), norm(chain.tip.t));
    for (int i = 0; i < chain.n; ++i) {
        size = std::fmax(size, norm(foot_of_tip(chain, i) - chain.tip.t));
        if (!chain.prismatic[i]) far = std::fmax(far, norm(chain.point[i]));
    }
    if (size <= tolerance::rounding * far) size = far;
    if (size == 0) size = 1;
    return {size, std::fmax(tolerance::exact, tolerance::rounding * far / size)};
}
// Moves the origin to the tip at zero, so that an arm far from its base loses no digits.
template <int n>
TipGap<n> tip_gap(const Chain& chain, const Vec3d& goal, const PositionScale& scale) {
    TipGap<n> g;
    const double f = 1 / scale.size;
    g.reached = scale.reached;
    for (int i = 0; i < n; ++i) {
        g.axis[i] = chain.axis[i];
        g.point[i] = f * (foot_of_tip(chain, i) - chain.tip.t);
        g.prismatic[i] = chain.prismatic[i];
    }
    g.tip = {0, 0, 0};
    g.goal = f * (goal - chain.tip.t);
    return g;
}

// The configuration of an arm with up to three joints whose tip is nearest to a point out of reach.
//
// The gradient of the distance vanishes there. A sweep over two joints locates the valleys, and Newton's
// method finds their minima. The revolute joints are swept, and the prismatic joints follow by linear least
// squares. Of three revolute joints the outer two are swept, and the middle one follows by subproblem 1.

// The value of a joint that moves `from` to `to`, or as near to it as possible.
template <int n>
double joint_between(const TipGap<n>& g, int joint, const Vec3d& from, const Vec3d& to) {
    if (g.prismatic[joint]) return dot(g.axis[joint], to - from);
    const Vec3d& o = g.point[joint];
    return angle_of(subproblem_1(g.axis[joint], from - o, to - o).theta);
}
// x moved by joint i, or by its inverse for −q.
template <int n>
Vec3d move_point(const TipGap<n>& g, int i, double q, const Vec3d& x) {
    if (g.prismatic[i]) return x + q * g.axis[i];
    return g.point[i] + rotate_about(g.axis[i], turn_by(q), x - g.point[i]);
}

namespace nearest {

// The joints that are swept: all revolute joints, except the middle one of three.
template <int n>
int swept_joints(const TipGap<n>& g, int* swept) {
    int revolute = 0, count = 0;
    for (int i = 0; i < n; ++i) revolute += !g.prismatic[i];
    for (int i = 0; i < n; ++i)
        if (!g.prismatic[i] && (revolute < 3 || i != 1)) swept[count++] = i;
    return count;
}
// The prismatic joints minimise the gap while the others are fixed: one linear least-squares step is exact.
template <int n>
void slide(const TipGap<n>& g, double* q) {
    Linearised<TipGap<n>> at;
    double gap[3], loose[n], step[n];
    linearise(g, q, at);
    for (int i = 0; i < 3; ++i) gap[i] = -at.value[i];
    for (int j = 0; j < n; ++j) loose[j] = g.prismatic[j];
    damped_step(3, n, at.slope, gap, loose, tolerance::exact, step);
    for (int j = 0; j < n; ++j) q[j] += step[j];
}
// Computes the joints that are not swept; returns the remaining gap.
template <int n>
double follow(const TipGap<n>& g, int dimension, double* q) {
    bool slides = false;
    for (int i = 0; i < n; ++i) slides = slides || g.prismatic[i];
    if (slides)
        slide(g, q);
    else if (n == 3 && dimension == 2)
        q[1] = joint_between(g, 1, move_point(g, 2, q[2], g.tip), move_point(g, 0, -q[0], g.goal));
    Linearised<TipGap<n>> at;
    return linearise(g, q, at);
}

}  // namespace nearest

template <int n>
double minimize_tip_gap(const TipGap<n>& g, double* q) {
    int swept[2];
    const int dimension = nearest::swept_joints(g, swept);
    const auto angle = [](int step) { return 2 * pi * (step + 0.37) / sweep_steps - pi; };
    const auto start = [&](int i, int j, double* t) {
        for (int k = 0; k < n; ++k) t[k] = 0;
        if (dimension > 0) t[swept[0]] = angle(i);
        if (dimension > 1) t[swept[1]] = angle(j);
        return nearest::follow(g, dimension, t);
    };
    return minimise_from_sweep<10>(g, dimension > 0 ? sweep_steps : 1, dimension > 1 ? sweep_steps : 1, start,
                                   q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
