// Results of inverse kinematics for an arm with up to three joints.
#pragma once

#include "cspace/ik/solution.hpp"
#include "cspace/ik/subproblems/least_squares.hpp"
#include "cspace/math/small_svd.hpp"

namespace cspace::ik {

inline constexpr int max_position_joints = 3, max_position_solutions = 8;

// The result for a position or a pose. close: whether solution i belongs to a self-motion, or merges with
// another, but for what rounding leaves.
struct PositionSolutions : Solutions {
    bool close[max_position_solutions];
    // Without a solution: the distance that is missing [m], and the joints that come nearest.
    double out_of_reach = 0;
    double nearest[max_position_joints] = {};
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Solutions of a small system of joints: which are equal, and which belong to a self-motion.
//
// A System is as in least_squares.hpp, over joints as numbers, with `prismatic[i]` and the residual `reached`
// that counts as zero.

// Whether joints a and b are the same configuration, with angles modulo 2π.
template <class System>
bool same_joints(const System& g, const double* a, const double* b) {
    for (int i = 0; i < System::angles; ++i) {
        const double d = a[i] - b[i];
        if (std::fabs(g.prismatic[i] ? d : 2 * std::sin(0.5 * d)) > tolerance::same_turns) return false;
    }
    return true;
}

// Residual (rad, arm's sizes) above which a candidate is no solution if its joints are accurate where it is:
// far more than what rounding of the goal and of double roots leaves.
inline constexpr double missed_by_far = 0.05, any_miss = 1e300;

// Cheap test for regularity: no eigenvalue of a positive matrix is below its determinant divided by the other
// eigenvalues, each at most n times the largest diagonal entry.
template <int n>
bool surely_regular(const double (*a)[n], double largest) {
    double determinant = a[0][0];
    if constexpr (n == 2) determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    if constexpr (n == 3)
        determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                      a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                      a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    double scale = largest;
    for (int i = 1; i < n; ++i) scale *= n * largest;
    return determinant > n * tolerance::degenerate_pair * tolerance::degenerate_pair * scale &&
           largest > tolerance::sure_candidate;
}

// Whether the solution q belongs to a self-motion. Its unit direction is written to `along`. close: whether
// some motion there changes the residual by rounding only. wide: whether the self-motion has more than one
// dimension; where two curves cross, no direction between theirs belongs to one.
template <class System>
bool is_free(const System& g, const double* q, double* along, bool& close, bool& wide) {
    constexpr int n = System::angles;
    constexpr double merged = 1e-7;  // rounding parts a double root by its square root
    Linearised<System> at;
    linearise(g, q, at);
    double normal[n][n], down[n], largest = 0;
    normal_equations(at, normal, down);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j) normal[i][j] = normal[j][i];
    for (int i = 0; i < n; ++i) largest = std::fmax(largest, normal[i][i]);
    close = wide = false;
    if (surely_regular<n>(normal, largest)) return false;
    SmallSvd<System::equations, n> J{System::equations, n, {}, {}, {}};
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < System::equations; ++k) J.us[j][k] = at.slope[k][j];
    decompose_matrix(J);
    largest = largest_of(J.sigma, n);
    const double floor = std::fmax(tolerance::degenerate_pair * largest, tolerance::rounding);
    bool free = false;
    for (int i = 0; i < n && !wide; ++i) {
        if (J.sigma[i] > floor) continue;
        close = close || J.sigma[i] <= merged * largest;
        if (!continues_along(g, q, J.v[i], g.reached)) continue;
        if (free) {
            double between[n];
            for (int j = 0; j < n; ++j) between[j] = std::sqrt(0.5) * (along[j] + J.v[i][j]);
            wide = continues_along(g, q, between, g.reached);
            continue;
        }
        for (int j = 0; j < n; ++j) along[j] = J.v[i][j];
        free = true;
    }
    return free;
}

// Appends the refined solution q of a system if it is new.
template <class System>
void keep_distinct(const System& g, double* q, PositionSolutions& found) {
    constexpr int n = System::angles;
    if (found.count == max_position_solutions) return;
    for (int i = 0; i < n; ++i)
        if (!g.prismatic[i]) q[i] = angle_of(turn_by(q[i]));
    for (int i = 0; i < found.count; ++i)
        if (same_joints(g, q, found.q[i])) return;
    for (int i = 0; i < n; ++i) found.q[found.count][i] = q[i];
    const int k = found.count++;
    found.branch[k] = static_cast<signed char>(k);
    bool wide = false;
    found.self_motion[k] = is_free(g, q, found.direction[k], found.close[k], wide);
    found.complete = found.complete && !wide;
    if (found.self_motion[k] || k == 0)
        found.status = found.self_motion[k] ? Status::singular : Status::exact;
}

}  // namespace cspace::ik::inline CSPACE_ISA
