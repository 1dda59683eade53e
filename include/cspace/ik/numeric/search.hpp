// Multi-start search for a solution of each goal: the first start, then further starts until one reaches the
// goal.
//
// Not for kernels: it uses the standard library and takes the descent kernel as an argument.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "cspace/ik/numeric/descent.hpp"
#include "cspace/ik/numeric/posture.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/wrapping.hpp"

namespace cspace::ik {

using Descend = void (*)(const DescentRows&);

struct Search {
    Path path;
    Task task;
    const double* goals;  // (count, 16)
    std::size_t count;
    const double* starts;  // (count, n), or (1, n) with stride 0
    std::size_t start_stride;
    const double* more;  // (n_more, n): tried in order where the first start failed
    std::size_t n_more;
    const Posture* posture;  // or null
};

// The result for a goal. The configuration is that of the first start that reached the goal, or else of the
// start with the smallest error.
struct Found {
    DescentEnd end;
    std::int32_t start;  // its number, 0 for the first
};

// Working arrays of the descents, one row each.
struct DescentResults {
    std::vector<double> q;
    std::vector<DescentEnd> ends;

    DescentResults(std::size_t rows, int n) : q(rows * std::size_t(n)), ends(rows) {}

    // From row `first` on.
    DescentRows rows_for(const Path& path, const Task& task, std::size_t first = 0) {
        DescentRows rows{};
        rows.path = &path;
        rows.task = &task;
        rows.count = ends.size() - first;
        rows.q = q.data() + std::size_t(path.n) * first;
        rows.ends = ends.data() + first;
        return rows;
    }
};

// Moves revolute coordinates by multiples of 2π to the values nearest to `wanted`, within the limits.
inline void nearest_turns(const Path& path, const Task& task, const double* wanted, double* q) {
    for (int j = 0; j < path.n; ++j) {
        // A coordinate that drives several joints, or one through a ratio, has another period.
        int driven = 0;
        bool plain = !path.slides[j];
        for (int i = 0; i < path.joints; ++i) {
            if (path.joint[i].coordinate != j) continue;
            ++driven;
            plain = plain && std::fabs(path.joint[i].ratio) == 1.0;
        }
        if (!plain || driven != 1) continue;
        double turns = count_turns(wanted[j] - q[j]);
        if (task.limited) turns = turns_within(q[j], q[j], task.lower[j], task.upper[j], turns, 0);
        if (turns != 0) q[j] += 2 * pi * turns;
    }
}

namespace searching {

// The rows of goals begin to end. Each pass tries the next start for the goals that have failed so far.
inline DescentResults run_passes(const Search& search, std::size_t begin, std::size_t end, Descend descend,
                                 std::vector<std::int32_t>& start) {
    const std::size_t n = std::size_t(search.path.n);
    DescentResults results(end - begin, search.path.n);
    DescentRows rows = results.rows_for(search.path, search.task);
    rows.goals = search.goals + 16 * begin;
    rows.goal_stride = 16;
    rows.starts = search.starts + search.start_stride * begin;
    rows.start_stride = search.start_stride;
    descend(rows);
    std::vector<std::int64_t> left;
    std::vector<DescentEnd> before;
    for (std::size_t k = 0; k < search.n_more; ++k) {
        left.clear();
        for (std::size_t row = 0; row < end - begin; ++row)
            if (results.ends[row].ending != Ending::reached) left.push_back(std::int64_t(row));
        if (left.empty()) break;
        before = results.ends;
        rows.pick = left.data();
        rows.count = left.size();
        rows.starts = search.more + n * k;
        rows.start_stride = 0;
        descend(rows);
        for (const std::int64_t row : left) {
            const DescentEnd& now = results.ends[std::size_t(row)];
            if (now.cost != before[std::size_t(row)].cost || now.ending == Ending::reached)
                start[std::size_t(row)] = std::int32_t(k + 1);
        }
    }
    return results;
}

// One goal: all its starts in parallel.
inline DescentResults side_by_side(const Search& search, std::size_t goal, Descend descend,
                                   std::size_t& best) {
    const std::size_t n = std::size_t(search.path.n), count = 1 + search.n_more;
    DescentResults results(count, search.path.n);
    std::vector<double> starts(count * n);
    std::copy_n(search.starts + search.start_stride * goal, n, starts.begin());
    std::copy_n(search.more, search.n_more * n, starts.begin() + std::ptrdiff_t(n));
    DescentRows rows = results.rows_for(search.path, search.task);
    rows.goals = search.goals + 16 * goal;
    rows.starts = starts.data();
    rows.start_stride = n;
    rows.first_only = true;
    descend(rows);
    best = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const DescentEnd& end = results.ends[k];
        if (end.ending == Ending::unknown) continue;
        if (end.ending == Ending::reached || end.cost < results.ends[best].cost) best = k;
        if (end.ending == Ending::reached) break;
    }
    return results;
}

// The result of a goal from the row that a descent wrote.
inline Found finish_goal(const Search& search, std::size_t goal, const DescentResults& results,
                         std::size_t row, std::int32_t start, double* q) {
    const Path& path = search.path;
    std::copy_n(results.q.begin() + std::ptrdiff_t(row) * path.n, path.n, q);
    Found found = {results.ends[row], start};
    const double* wanted = search.posture ? search.posture->rest : search.starts + search.start_stride * goal;
    nearest_turns(path, search.task, wanted, q);
    if (!search.posture || found.end.ending != Ending::reached) return found;
    const Gap<double> left =
        settle_posture(path, search.task, *search.posture, read_goal(search.goals + 16 * goal).T, q);
    found.end.position = left.position;
    found.end.rotation = left.rotation;
    return found;
}

}  // namespace searching

// The goals begin to end: q (count, n) and found (count,) receive the results. The result of a goal does not
// depend on the other goals.
inline void search_goals(const Search& search, std::size_t begin, std::size_t end, Descend descend, double* q,
                         Found* found) {
    const std::size_t n = std::size_t(search.path.n), side_by_side_up_to = 3;
    if (end - begin <= side_by_side_up_to) {
        for (std::size_t goal = begin; goal < end; ++goal) {
            std::size_t best;
            const DescentResults results = searching::side_by_side(search, goal, descend, best);
            found[goal] =
                searching::finish_goal(search, goal, results, best, std::int32_t(best), q + n * goal);
        }
        return;
    }
    std::vector<std::int32_t> start(end - begin);
    const DescentResults results = searching::run_passes(search, begin, end, descend, start);
    for (std::size_t goal = begin; goal < end; ++goal)
        found[goal] =
            searching::finish_goal(search, goal, results, goal - begin, start[goal - begin], q + n * goal);
}

// Distinct solutions among the results of many descents.
//
// Not for kernels: it uses the standard library.

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
        if (apart > close_solution) return false;
        halfway[j] = a[j] + 0.5 * step * unit_of(path, j);
    }
    if (apart <= same_solution) return true;
    Gap<double> gap;
    measure_gap(path, rows, T_goal_first, halfway, gap);
    return std::fmax(gap.position, gap.rotation) <= task.tolerance;
}

// Configurations by the value of one joint, in cells that are wider than close solutions are apart.
class SolutionCells {
  public:
    SolutionCells(const Path& path, const DescentResults& results) : path_(path) {
        constexpr std::size_t looks = 1000;
        std::size_t most = 0;
        for (int j = 0; j < path.n; ++j) {
            std::unordered_set<std::int64_t> different;
            for (std::size_t row = 0; row < std::min(looks, results.ends.size()); ++row)
                if (results.ends[row].ending == Ending::reached)
                    different.insert(cell_of(j, results.q.data() + std::size_t(path.n) * row));
            if (different.size() <= most) continue;
            most = different.size();
            joint_ = j;
        }
    }
    void add_row(const double* q, std::size_t row) { rows_[cell_of(joint_, q)].push_back(row); }

    // The least of the rows near q for which is_wanted(row); `none` without.
    template <class IsWanted>
    std::size_t find_row(const double* q, std::size_t none, const IsWanted& is_wanted) const {
        InterruptPoll poll(1 << 10);
        const std::int64_t cell = cell_of(joint_, q);
        std::size_t least = none;
        for (const std::int64_t step : {-1, 0, 1}) {
            const auto at = rows_.find(wrap_cell(joint_, cell + step));
            if (at == rows_.end()) continue;
            for (const std::size_t row : at->second) {
                poll.step();
                if (row >= least) break;
                if (is_wanted(row)) least = row;
            }
        }
        return least;
    }

  private:
    static constexpr std::int64_t around = std::int64_t(2 * pi / close_solution);

    std::int64_t wrap_cell(int j, std::int64_t cell) const {
        return path_.slides[j] ? cell : (cell + around) % around;
    }
    std::int64_t cell_of(int j, const double* q) const {
        const double unit = path_.slides[j] ? close_solution * path_.length : 2 * pi / double(around);
        const double value = path_.slides[j] ? q[j] : wrap_above(q[j], 0);
        constexpr double farthest = 1e18;  // what an integer holds
        return wrap_cell(j, std::int64_t(std::floor(std::clamp(value / unit, -farthest, farthest))));
    }

    const Path& path_;
    int joint_ = 0;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> rows_;
};

// Selects the rows of results that reach the goal and are distinct, in the order in which they were found.
// Angles are given modulo 2π near `wanted` (n,). Returns their number; q (rows, n) receives them, and hits
// (rows,) the number of descents that found each.
inline std::size_t pick_distinct(const Path& path, const Task& task, const double* goal, const double* wanted,
                                 const DescentResults& results, double* q, double* residual,
                                 std::int64_t* hits) {
    const std::size_t n = std::size_t(path.n);
    const Rows rows = rows_of(task);
    const Posed T_goal_first = inverse(read_goal(goal).T) * path.T_base_first;
    SolutionCells cells(path, results);
    std::size_t count = 0;
    for (std::size_t row = 0; row < results.ends.size(); ++row) {
        const DescentEnd& end = results.ends[row];
        if (end.ending != Ending::reached) continue;
        const double* found = results.q.data() + n * row;
        poll_interrupts();
        const std::size_t k = cells.find_row(found, count, [&](std::size_t at) {
            return is_one_solution(path, task, rows, T_goal_first, q + n * at, found);
        });
        if (k == count) {
            cells.add_row(found, k);
            std::copy_n(found, n, q + n * k);
            nearest_turns(path, task, wanted, q + n * k);
            residual[k] = std::fmax(end.position, end.rotation);
            hits[count++] = 0;
        }
        ++hits[k];
    }
    return count;
}

}  // namespace cspace::ik
