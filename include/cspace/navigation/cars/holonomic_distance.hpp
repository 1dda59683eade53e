// How far a disc would have to go that covers no more than the vehicle does: a bound from below for the
// vehicle with its turning circle, and where even the disc cannot pass, a proof.
#pragma once

#include <limits>
#include <numbers>
#include <vector>

#include "cspace/maps/grid_inflation.hpp"
#include "cspace/navigation/cars/car_world.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

class HolonomicDistance {
  public:
    // The disc is the largest in the vehicle; its centre passes through cells alone of which some part is far
    // enough from everything blocked, from a cell to one of the eight around it. turn: of the vehicle's
    // circle [m].
    HolonomicDistance(const CarWorld& world, const Footprint& body, double turn, const CarPose& goal)
        : grid_(closed(world, body)),
          frame_(world.frame()),
          middle_(body.middle()),
          farther_(std::hypot(1.0, body.middle() / turn)),
          length_(grid_.numbers(), none) {
        search::Heap<search::Waiting> queue;
        const maps::Cell from = cell_of(goal);
        if (grid_.blocked(from)) return;
        length_[grid_.number(from)] = 0;
        queue.push({0, 0, grid_.number(from)});
        while (!queue.empty()) {
            const search::Waiting next = queue.pop();
            if (float(next.priority) > length_[next.node]) continue;
            spread(next.node, queue);
        }
    }

    bool reaches(const CarPose& pose) const { return length_[grid_.number(cell_of(pose))] < none; }

    // No path of the disc from here is shorter [m]: one that is straight within each cell is at most 8 %
    // longer than the free one, and at most two cells are lost at its ends.
    double at_least(const CarPose& pose) const {
        const float cells = length_[grid_.number(cell_of(pose))];
        return cells < none ? frame_.resolution * std::max(0.0, (double(cells) - 2 * std::numbers::sqrt2) /
                                                                    (detour * farther_))
                            : std::numeric_limits<double>::infinity();
    }

  private:
    static constexpr std::size_t most_parts = std::size_t(1) << 24;
    static constexpr float none = std::numeric_limits<float>::infinity();
    static constexpr double detour = 1.0823922002923938;  // 1 / cos(π / 8)

    // Cells are cut into k × k parts, as many as a limit on their number allows; all points of a part lie
    // within half a diagonal of its centre.
    static maps::BitGrid closed(const CarWorld& world, const Footprint& body) {
        const maps::BitGrid& grid = world.grid();
        const std::size_t cells = std::size_t(grid.rows()) * std::size_t(grid.columns());
        const int k = cells * 16 <= most_parts ? 4 : cells * 4 <= most_parts ? 2 : 1;
        const double radius = k * body.inner_radius() / world.frame().resolution - 0.5 * std::numbers::sqrt2;
        if (radius <= 0) return grid;
        const maps::BitGrid parts = maps::inflated(cut(grid, k), radius, true);
        maps::BitGrid open(grid.rows(), grid.columns());
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column)
                if (grid.blocked(row, column) || !has_open_part(parts, k, row, column))
                    open.set(row, column, true);
        return open;
    }
    static maps::BitGrid cut(const maps::BitGrid& grid, int k) {
        maps::BitGrid parts(k * grid.rows(), k * grid.columns());
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column) {
                if (!grid.blocked(row, column)) continue;
                for (int i = 0; i < k; ++i)
                    for (int j = 0; j < k; ++j) parts.set(k * row + i, k * column + j, true);
            }
        return parts;
    }
    static bool has_open_part(const maps::BitGrid& parts, int k, int row, int column) {
        for (int i = 0; i < k; ++i)
            for (int j = 0; j < k; ++j)
                if (!parts.blocked(k * row + i, k * column + j)) return true;
        return false;
    }
    maps::Cell cell_of(const CarPose& pose) const {
        const auto index = [&](double at, double origin, int count) {
            return std::clamp(int(std::floor((at - origin) / frame_.resolution)), 0, count - 1);
        };
        const double x = pose.x + middle_ * std::cos(pose.theta), y = pose.y + middle_ * std::sin(pose.theta);
        return {index(y, frame_.origin.y, grid_.rows()), index(x, frame_.origin.x, grid_.columns())};
    }
    void spread(std::uint32_t node, search::Heap<search::Waiting>& queue) {
        const maps::Cell at = grid_.cell(node);
        for (int dr = -1; dr <= 1; ++dr)
            for (int dc = -1; dc <= 1; ++dc) {
                const maps::Cell next{at.row + dr, at.column + dc};
                if ((dr == 0 && dc == 0) || grid_.blocked(next)) continue;
                const float length = length_[node] + (dr && dc ? std::numbers::sqrt2_v<float> : 1.0f);
                float& known = length_[grid_.number(next)];
                if (length < known) known = length, queue.push({length, 0, grid_.number(next)});
            }
    }

    maps::BitGrid grid_;
    maps::GridFrame frame_;
    double middle_, farther_;
    std::vector<float> length_;
};

}  // namespace cspace::navigation
