// The gap between the tip of a short arm and a goal, as a function of its joints.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/ik/subproblems/refine.hpp"

namespace cspace::inline CSPACE_ISA {

// Lengths, and with them prismatic joints, in units of the arm's size.
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
inline Vec3d foot_of_tip(const ik::Chain& chain, int i) {
    if (chain.prismatic[i]) return chain.tip.t;
    const Vec3d r = chain.tip.t - chain.point[i];
    return chain.point[i] + dot(r, chain.axis[i]) * chain.axis[i];
}
// The size of the problem [m], and the gap, relative to it, up to which the goal counts as reached: where
// coordinates are large against the arm, it is their rounding that decides.
struct PositionScale {
    double size, reached;
};
inline PositionScale position_scale(const ik::Chain& chain, const Vec3d& goal) {
    double size = norm(goal - chain.tip.t), far = std::fmax(norm(goal), norm(chain.tip.t));
    for (int i = 0; i < chain.n; ++i) {
        size = std::fmax(size, norm(foot_of_tip(chain, i) - chain.tip.t));
        if (!chain.prismatic[i]) far = std::fmax(far, norm(chain.point[i]));
    }
    if (size <= tolerance::rounding * far) size = far;
    if (size == 0) size = 1;
    return {size, std::fmax(tolerance::exact, tolerance::rounding * far / size)};
}
// The origin is moved to the tip at zero, so that an arm far from its base keeps its digits.
template <int n>
TipGap<n> tip_gap(const ik::Chain& chain, const Vec3d& goal, const PositionScale& scale) {
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

// Whether joints a and b are the same configuration, angles counted modulo a turn.
template <int n>
bool same_joints(const TipGap<n>& g, const double* a, const double* b) {
    for (int i = 0; i < n; ++i) {
        const double d = a[i] - b[i];
        if (std::fabs(g.prismatic[i] ? d : 2 * std::sin(0.5 * d)) > tolerance::same_turns) return false;
    }
    return true;
}

// Eigenvectors of a symmetric matrix as columns of v, eigenvalues on the diagonal of a (Jacobi 1846).
template <int n>
void eigenvectors(double (*a)[n], double (*v)[n]) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) v[i][j] = i == j;
    for (int sweep = 0; sweep < 12; ++sweep)
        for (int i = 0; i < n; ++i)
            for (int j = i + 1; j < n; ++j) {
                if (a[i][j] == 0) continue;
                const double half = 0.5 * std::atan2(2 * a[i][j], a[j][j] - a[i][i]);
                const double c = std::cos(half), s = std::sin(half);
                for (int k = 0; k < n; ++k) {
                    const double x = a[k][i], y = a[k][j];
                    a[k][i] = c * x - s * y, a[k][j] = s * x + c * y;
                }
                for (int k = 0; k < n; ++k) {
                    const double x = a[i][k], y = a[j][k], p = v[k][i], r = v[k][j];
                    a[i][k] = c * x - s * y, a[j][k] = s * x + c * y;
                    v[k][i] = c * p - s * r, v[k][j] = s * p + c * r;
                }
            }
}

// Whether the solution q is one of a family; its direction, of length one, is written to `along`.
template <int n>
bool is_free(const TipGap<n>& g, const double* q, double* along) {
    Linearised<TipGap<n>> at;
    linearise(g, q, at);
    double normal[n][n], down[n], v[n][n], largest = 0;
    normal_equations(at, normal, down);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j) normal[j][i] = normal[i][j];
    eigenvectors<n>(normal, v);
    for (int i = 0; i < n; ++i) largest = std::fmax(largest, normal[i][i]);
    for (int i = 0; i < n; ++i) {
        const double floor = std::fmax(tolerance::degenerate_pair * std::sqrt(largest), tolerance::rounding);
        if (normal[i][i] > floor * floor) continue;
        for (int j = 0; j < n; ++j) along[j] = v[j][i];
        if (continues_along(g, q, along, g.reached)) return true;
    }
    return false;
}

}  // namespace cspace::inline CSPACE_ISA
