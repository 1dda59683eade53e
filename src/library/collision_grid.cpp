#include "collision_grid.hpp"

#include <algorithm>
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

}  // namespace

GridData::GridData(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                   const Bounds& all) {
    if (x.empty()) return;
    const std::array<std::span<const float>, 3> points = {x, y, z};
    choose_cells(x.size(), all);
    mark_points(points);
    spread_steps();
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

void GridData::mark_points(const std::array<std::span<const float>, 3>& points) {
    steps_.assign(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]), most_steps);
    points_.assign(steps_.size(), 0);
    visit_range(0, points[0].size(), [&](std::size_t i) {
        std::size_t cell[3];
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = std::size_t(std::min(int((points[k][i] - low_[k]) * cells_per_metre_), n_[k] - 1));
        const std::size_t at = (cell[2] * std::size_t(n_[1]) + cell[1]) * std::size_t(n_[0]) + cell[0];
        steps_[at] = 0, points_[at] = int(i);
    });
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
