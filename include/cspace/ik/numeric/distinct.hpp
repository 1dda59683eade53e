// Distinct solutions among the results of many descents.
//
// Not for kernels: it uses the standard library.
#pragma once

#include "cspace/ik/numeric/search.hpp"

namespace cspace::ik {
// Two results are the same solution if no coordinate differs by more than `same_solution` [rad, lengths of
// the path]. They are also the same if none differs by more than `close_solution` and their midpoint reaches
// the goal. At a double root, results scatter by the square root of the remaining error.
inline constexpr double same_solution = 1e-6, close_solution = 1e-3;

inline bool is_one_solution(const Path& path, const Task& task, const Rows& rows, const Posed& T_goal_first,
                            const double* a, const double* b) {
    double apart = 0, halfway[max_joints];
    for (int j = 0; j < path.n; ++j) {
        const double step = path.slides[j] ? (b[j] - a[j]) / path.length : short_way(b[j] - a[j]);
        apart = std::fmax(apart, std::fabs(step));
        halfway[j] = a[j] + 0.5 * step * unit_of(path, j);
    }
    if (apart <= same_solution) return true;
    if (apart > close_solution) return false;
    Gap<double> gap;
    measure_gap(path, rows, T_goal_first, halfway, gap);
    return std::fmax(gap.position, gap.rotation) <= task.tolerance;
}

// Selects the rows of results that reach the goal and are distinct, in the order in which they were found.
// Angles are given modulo 2π near `wanted` (n,). Returns their number; q (rows, n) receives them, and hits
// (rows,) the number of descents that found each.
inline std::size_t pick_distinct(const Path& path, const Task& task, const double* goal, const double* wanted,
                                 const DescentResults& results, double* q, double* residual,
                                 std::int64_t* hits) {
    const std::size_t n = std::size_t(path.n);
    const Rows rows = rows_of(task);
    const Posed T_goal_first = inverse(read_goal(goal).T) * path.T_base_first;
    std::size_t count = 0;
    for (std::size_t row = 0; row < results.ending.size(); ++row) {
        if (results.ending[row] != Ending::reached) continue;
        const double* found = results.q.data() + n * row;
        std::size_t k = 0;
        while (k < count && !is_one_solution(path, task, rows, T_goal_first, q + n * k, found)) ++k;
        if (k == count) {
            std::copy_n(found, n, q + n * k);
            nearest_turns(path, task, wanted, q + n * k);
            residual[k] = std::fmax(results.position[row], results.rotation[row]);
            hits[count++] = 0;
        }
        ++hits[k];
    }
    return count;
}

}  // namespace cspace::ik
