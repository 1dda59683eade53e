// Grids whose intervals are halved, and what it would still gain to halve them further.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/trajectory/speed_bounds.hpp"
#include "trajectory_timing.hpp"

namespace cspace::trajectory {

// The seconds of every interval; those in which the motion stands have none.
struct Passing {
    std::vector<double> seconds;
    double total = 0.0;
    bool stands = false;
};

// A motion on a grid: squared speeds at its places and how they depend on each other, seconds of its
// intervals.
struct GridMotion {
    std::vector<double> squared_speed, seconds;
    std::vector<Carry> carry;
};

// A grid in which some intervals are halved, and of every part the interval that it is from.
struct Halved {
    TimingGrid grid;
    std::vector<std::uint32_t> parent;
};

inline constexpr double least_part = 0x1p-18;  // of a piece: beyond it rounding shows in the accelerations

template <class Splits>
Halved halve(const TimingGrid& grid, const Splits& splits) {
    std::vector<char> is_split(grid.size());
    std::size_t count = grid.size();
    visit_range(0, grid.size(), [&](std::size_t i) {
        is_split[i] = grid.to[i] - grid.from[i] > least_part && splits(i);
        count += std::size_t(is_split[i]);
    });
    Halved made;
    made.grid.piece.reserve(count);
    made.grid.from.reserve(count);
    made.grid.to.reserve(count);
    made.parent.reserve(count);
    const auto add = [&](std::size_t i, double from, double to) {
        made.grid.piece.push_back(grid.piece[i]);
        made.grid.from.push_back(from);
        made.grid.to.push_back(to);
        made.parent.push_back(std::uint32_t(i));
    };
    visit_range(0, grid.size(), [&](std::size_t i) {
        const double from = grid.from[i], to = grid.to[i], middle = 0.5 * (from + to);
        if (!is_split[i]) return add(i, from, to);
        add(i, from, middle);
        add(i, middle, to);
    });
    return made;
}

// The rises of parts of intervals with these rises.
std::vector<double> halve_rises(const std::vector<double>& rises, const std::vector<std::uint32_t>& parent);

// The seconds that each interval of a grid costs beyond what any finer grid could give, from the motion on
// the grid before and that on the parts of its intervals. losses: those of the grid before, or none.
std::vector<double> estimate_losses(GridMotion before, const std::vector<double>& squared_speed,
                                    const std::vector<double>& seconds,
                                    const std::vector<std::uint32_t>& parent,
                                    const std::vector<double>& losses);

}  // namespace cspace::trajectory
