// Which solutions of many goals keep limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cspace::ik {

// q (goals, room, n), padded with rows of NaN. kept (goals, room, n): the rows inside the limits, each
// revolute joint moved by the least multiple of 2π, and NaN behind them. count (goals,): how many. order
// (goals, room), or null: the numbers of the rows kept, and of the others behind them.
struct RowsWithin {
    std::size_t goals, room;
    int n;
    const bool* prismatic;
    const double *lower, *upper, *q;
    double* kept;
    std::int64_t *count, *order;
};
// Returns the numbers of the rows, ascending, that are beyond a limit by more than `same` and by at most
// `close` [rad, m]: those of double solutions, whose true place may be on the limit.
std::vector<std::int64_t> keep_within(const RowsWithin& rows, double same, double close);

}  // namespace cspace::ik
