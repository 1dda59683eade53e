#include "ik_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "ik_arm.hpp"

namespace cspace::ik {

namespace {

bool is_inside(const RowsWithin& rows, const double* q) {
    bool inside = true;
    for (int i = 0; i < rows.n; ++i) inside &= q[i] >= rows.lower[i] && q[i] <= rows.upper[i];
    return inside;
}

// Moves the joints that are outside by the least multiples of 2π; false for one that stays outside.
bool move_inside(const RowsWithin& rows, double* q) {
    for (int i = 0; i < rows.n; ++i) {
        if (q[i] >= rows.lower[i] && q[i] <= rows.upper[i]) continue;
        const double seed = q[i];
        if (turn_to_seed(rows.prismatic + i, 1, rows.lower + i, rows.upper + i, &seed, q + i) > 0)
            return false;
    }
    return true;
}

// How far a joint is from its limits over all multiples of 2π.
double distance_from_limits(const RowsWithin& rows, int i, double q) {
    const double lower = rows.lower[i], upper = rows.upper[i];
    if (rows.prismatic[i]) return std::fmax(0, std::fmax(lower - q, q - upper));
    if (!std::isfinite(upper - lower)) return 0;
    const double above = wrap_above(q, lower);
    return above <= upper ? 0 : std::fmin(above - upper, lower - (above - 2 * pi));
}

// Whether no joint is beyond its limits by more than `close`, and one by more than `same`.
bool is_close(const RowsWithin& rows, const double* q, double same, double close) {
    double most = 0;
    for (int i = 0; i < rows.n && most <= close; ++i)
        most = std::fmax(most, distance_from_limits(rows, i, q[i]));
    return most > same && most <= close;
}

}  // namespace

std::vector<std::int64_t> keep_within(const RowsWithin& rows, double same, double close) {
    constexpr std::size_t goals_worth_a_thread = 1024;
    const std::size_t n = std::size_t(rows.n);
    std::mutex busy;
    std::vector<std::int64_t> doubtful;
    over_rows(rows.goals, 0, 1, goals_worth_a_thread, [&](std::size_t begin, std::size_t end) {
        std::vector<std::int64_t> found;
        for (std::size_t goal = begin; goal < end; ++goal) {
            const std::size_t first = goal * rows.room;
            double* const kept = rows.kept + first * n;
            std::size_t count = 0, others = 0;
            for (std::size_t k = 0; k < rows.room; ++k) {
                const double* const q = rows.q + (first + k) * n;
                double* const to = kept + count * n;
                bool keep = std::isfinite(q[0]);
                if (keep) std::copy_n(q, n, to);
                if (keep && !is_inside(rows, q)) {
                    keep = move_inside(rows, to);
                    if (is_close(rows, q, same, close)) found.push_back(std::int64_t(first + k));
                }
                if (rows.order && !keep) rows.order[first + rows.room - ++others] = std::int64_t(k);
                if (rows.order && keep) rows.order[first + count] = std::int64_t(k);
                count += keep;
            }
            if (rows.order) std::reverse(rows.order + first + count, rows.order + first + rows.room);
            std::fill(kept + count * n, kept + rows.room * n, std::numeric_limits<double>::quiet_NaN());
            rows.count[goal] = std::int64_t(count);
        }
        const std::lock_guard<std::mutex> lock(busy);
        doubtful.insert(doubtful.end(), found.begin(), found.end());
        return true;
    });
    std::sort(doubtful.begin(), doubtful.end());
    return doubtful;
}

}  // namespace cspace::ik
