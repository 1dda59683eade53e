// The gap between the tip of an arm with up to three joints and a goal, as a function of its joints.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/ik/subproblems/refine.hpp"

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
            for (int j = i + 1; j < n; ++j) columns[j] = rotate(axis[i], t, columns[j]);
            const Vec3d r = rotate(axis[i], t, x - point[i]);
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

}  // namespace cspace::ik::inline CSPACE_ISA
