#include "collision_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cspace/math/interrupts.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::collision {

namespace {

// Places in cells that are d cells apart along an axis are at least max(|d| − 1, 0) of their sides apart
// there. Steps are sums of the squares of that, up to:
constexpr unsigned char most_steps = 64;
constexpr int window = 8;  // cells apart that steps below the most come from

constexpr unsigned char steps_of(int apart) {
    const int between = apart > 0 ? apart - 1 : 0;
    return static_cast<unsigned char>(between * between);
}

// to[i] = min(to[i], from[i] + step), with the way where that is less: no sum is beyond a byte.
void lower_steps(unsigned char* to, signed char* ways, const unsigned char* from, std::size_t n,
                 unsigned char step, signed char way) {
    for (std::size_t i = 0; i < n; ++i) {
        const auto sum = static_cast<unsigned char>(from[i] + step);
        const bool is_less = sum < to[i];
        to[i] = is_less ? sum : to[i];
        ways[i] = is_less ? way : ways[i];
    }
}

// Along an axis of n cells that are `stride` apart, in blocks of n · stride.
std::vector<signed char> spread_along(std::vector<unsigned char>& steps, std::size_t n, std::size_t stride) {
    std::vector<unsigned char> spread = steps;
    std::vector<signed char> ways(steps.size(), 0);
    InterruptPoll poll(64);
    for (std::size_t block = 0; block < steps.size(); block += n * stride) {
        poll.step();
        for (int apart = 1; apart <= window && std::size_t(apart) < n; ++apart) {
            const std::size_t shift = std::size_t(apart) * stride, count = n * stride - shift,
                              end = block + shift;
            const auto way = static_cast<signed char>(apart);
            lower_steps(&spread[block], &ways[block], &steps[end], count, steps_of(apart), way);
            lower_steps(&spread[end], &ways[end], &steps[block], count, steps_of(apart),
                        static_cast<signed char>(-way));
        }
    }
    steps.swap(spread);
    return ways;
}

// Calls visit(cell) for the cells of a block of so many cells a side, a power of two, that are among n: those
// of one eighth after the other.
template <class Visit>
void visit_block(const std::array<int, 3>& low, int side, const std::array<int, 3>& n, const Visit& visit) {
    if (low[0] >= n[0] || low[1] >= n[1] || low[2] >= n[2]) return;
    if (side == 1) return visit(std::size_t((low[2] * n[1] + low[1]) * n[0] + low[0]));
    const int half = side / 2;
    for (int part = 0; part < 8; ++part)
        visit_block(
            {low[0] + (part & 1) * half, low[1] + (part >> 1 & 1) * half, low[2] + (part >> 2) * half}, half,
            n, visit);
}

// Puts the points of the lower half of the widest extent first, and so on in either half.
constexpr int most_unsorted = 256;  // points
void halve_points(std::span<Vec3d> points) {
    if (points.size() <= std::size_t(most_unsorted)) return;
    const Bounds box = bound_points(points);
    const auto extent = [&](std::size_t k) { return box.high[k] - box.low[k]; };
    const std::size_t k = extent(0) >= std::max(extent(1), extent(2)) ? 0 : extent(1) >= extent(2) ? 1 : 2;
    const double middle = box.low[k] + extent(k) / 2;
    if (!(middle < box.high[k])) return;
    constexpr double Vec3d::* axes[] = {&Vec3d::x, &Vec3d::y, &Vec3d::z};
    const auto high = std::partition(points.begin(), points.end(),
                                     [=, axis = axes[k]](const Vec3d& p) { return p.*axis <= middle; });
    const std::size_t n_low = std::size_t(high - points.begin());
    halve_points(points.first(n_low));
    halve_points(points.subspan(n_low));
}

}  // namespace

GridData::GridData(std::size_t count, const Bounds& all) {
    if (count > 0) choose_cells(count, all);
}

void GridData::choose_cells(std::size_t count, const Bounds& all) {
    constexpr double side = 0.03, cells_per_point = 20, most_cells = 300000, growth = 1.1;
    const double cells = std::min(cells_per_point * double(count), most_cells);
    std::array<double, 3> extent;
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        low_[k] = round_low(all.low[k]);
        extent[k] = double(round_high(all.high[k])) - double(low_[k]);
        largest = std::max({largest, std::fabs(all.low[k]), std::fabs(all.high[k])});
    }
    const auto cells_of = [&](double a, std::size_t k) { return std::floor(extent[k] / a) + 1; };
    double a = side;
    while (cells_of(a, 0) * cells_of(a, 1) * cells_of(a, 2) > cells) a *= growth;
    cells_per_metre_ = float(1 / a);
    for (std::size_t k = 0; k < 3; ++k) n_[k] = int(cells_of(a, k));
    measure_steps(float(largest));
}

// Numbers of cells are rounded, by some units in the last place of coordinates and of the number itself.
void GridData::measure_steps(float largest) {
    constexpr double roundings = 8;
    const double side = 1 / double(cells_per_metre_);
    const int most = *std::max_element(n_.begin(), n_.end());
    const double slack = roundings * tolerance::float_rounding * (double(largest) + side * most);
    least_.resize(std::size_t(most_steps) + 1);
    for (std::size_t s = 0; s < least_.size(); ++s) {
        const double distance = std::max(side * std::sqrt(double(s)) - slack, 0.0);
        least_[s] = float(distance * distance * (1 - tolerance::float_rounding));
    }
}

int GridData::find_cell(const Vec3d& point) const {
    const float at[] = {float(point.x), float(point.y), float(point.z)};
    int cell[3];
    for (std::size_t k = 0; k < 3; ++k)
        cell[k] = std::min(int((at[k] - low_[k]) * cells_per_metre_), n_[k] - 1);
    return (cell[2] * n_[1] + cell[1]) * n_[0] + cell[0];
}

// How many points each cell has, and the cell of each point.
std::vector<int> GridData::count_points(std::span<const Vec3d> points, std::vector<int>& cells) const {
    std::vector<int> counts(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]), 0);
    visit_range(0, cells.size(), [&](std::size_t i) {
        cells[i] = find_cell(points[i]);
        ++counts[std::size_t(cells[i])];
    });
    return counts;
}

// Each cell gets the place behind its last point.
void GridData::mark_cells(const std::vector<int>& counts) {
    steps_.assign(counts.size(), most_steps);
    points_.resize(counts.size());
    InterruptPoll poll(1 << 12);
    int end = 0;
    const int side = int(std::bit_ceil(unsigned(*std::max_element(n_.begin(), n_.end()))));
    visit_block({0, 0, 0}, side, n_, [&](std::size_t cell) {
        poll.step();
        if (counts[cell] > 0) steps_[cell] = 0;
        points_[cell] = end += counts[cell];
    });
}

std::vector<Vec3d> GridData::sort_points(std::span<const Vec3d> points) {
    std::vector<Vec3d> sorted;
    if (points.empty()) return sorted;
    std::vector<int> cells(points.size()), order(points.size());
    const std::vector<int> counts = count_points(points, cells);
    mark_cells(counts);
    visit_range(0, points.size(),
                [&](std::size_t i) { order[std::size_t(--points_[std::size_t(cells[i])])] = int(i); });
    sorted.reserve(points.size());
    visit_range(0, points.size(), [&](std::size_t i) { sorted.push_back(points[std::size_t(order[i])]); });
    visit_range(0, counts.size(), [&](std::size_t cell) {
        if (counts[cell] > most_unsorted)
            halve_points(std::span(sorted).subspan(std::size_t(points_[cell]), std::size_t(counts[cell])));
    });
    spread_steps();
    return sorted;
}

void GridData::spread_steps() {
    std::size_t stride = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        ways_[k] = spread_along(steps_, std::size_t(n_[k]), stride);
        stride *= std::size_t(n_[k]);
    }
}

DistanceGrid GridData::view() const {
    return {steps_.data(),
            {ways_[0].data(), ways_[1].data(), ways_[2].data()},
            points_.data(),
            least_.data(),
            {low_[0], low_[1], low_[2]},
            cells_per_metre_,
            {n_[0], n_[1], n_[2]}};
}

}  // namespace cspace::collision
