// A grid over the coordinates of an arm with few joints: equal cells between the bounds, closed where a joint
// wraps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include "cspace/planning/box.hpp"

namespace cspace::planning {

// A grid of more joints has too many nodes, and so has one of more nodes than that.
inline constexpr int most_grid_joints = 3;
inline constexpr std::size_t most_grid_nodes = std::size_t(1) << 24;

class JointGrid {
  public:
    using Steps = std::array<int, most_grid_joints>;

    // cells: per coordinate, 1 at least. Throws std::invalid_argument for other numbers, and too many.
    JointGrid(const Box& box, std::span<const std::int32_t> cells) : width_(box.width) {
        if (width_ < 1 || width_ > most_grid_joints || cells.size() != std::size_t(width_))
            throw std::invalid_argument("a grid takes one to three joints, and a number of cells for each");
        for (int k = 0; k < width_; ++k) {
            const std::int32_t count = cells[std::size_t(k)];
            if (count < 1) throw std::invalid_argument("a grid has one cell at least per joint");
            Axis& axis = axes_[std::size_t(k)];
            axis.wraps = box.is_wrapping(k);
            axis.lower = box.lower[k], axis.upper = box.upper[k];
            axis.nodes = axis.wraps ? count : count + 1;
            axis.step = (axis.wraps ? 2 * pi : double(axis.upper) - double(axis.lower)) / count;
            if (size_ > most_grid_nodes / std::size_t(axis.nodes))
                throw std::invalid_argument("the grid has too many nodes");
            size_ *= std::size_t(axis.nodes);
        }
    }

    std::size_t size() const { return size_; }
    void write_row(std::uint32_t node, float* q) const {
        const Steps at = steps_of(node);
        for (int k = 0; k < width_; ++k) {
            const Axis& axis = axes_[std::size_t(k)];
            const double x = double(axis.lower) + at[std::size_t(k)] * axis.step;
            q[k] = std::clamp(float(x), axis.lower, axis.upper);
        }
    }
    // The corners of the cell around q.
    template <class Visit>
    void visit_corners(const float* q, const Visit& visit) const {
        Steps low = {};
        for (int k = 0; k < width_; ++k) {
            const Axis& axis = axes_[std::size_t(k)];
            const double steps =
                axis.step > 0 ? std::floor((double(q[k]) - double(axis.lower)) / axis.step) : 0;
            low[std::size_t(k)] = int(std::clamp(steps, 0.0, double(std::max(0, axis.nodes - 1))));
        }
        for (unsigned corner = 0; corner < 1u << width_; ++corner) {
            Steps by = {};
            for (int k = 0; k < width_; ++k) by[std::size_t(k)] = int(corner >> k & 1);
            visit_moved(low, by, visit);
        }
    }
    // The nodes that are so many steps away, those inside the grid.
    template <class Visit>
    void visit_neighbours(std::uint32_t node, std::span<const Steps> moves, const Visit& visit) const {
        const Steps at = steps_of(node);
        for (const Steps& by : moves) visit_moved(at, by, visit);
    }
    // Moves by at most `reach` steps along each joint, one in each direction.
    std::vector<Steps> list_moves(int reach) const {
        std::vector<Steps> moves;
        Steps by;
        const int third = width_ > 2 ? reach : 0, second = width_ > 1 ? reach : 0;
        for (by[0] = -reach; by[0] <= reach; ++by[0])
            for (by[1] = -second; by[1] <= second; ++by[1])
                for (by[2] = -third; by[2] <= third; ++by[2])
                    if (std::gcd(by[0], std::gcd(by[1], by[2])) == 1) moves.push_back(by);
        return moves;
    }

  private:
    struct Axis {
        int nodes = 1;
        bool wraps = false;
        float lower = 0, upper = 0;
        double step = 0;
    };
    int width_;
    std::array<Axis, most_grid_joints> axes_;
    std::size_t size_ = 1;

    Steps steps_of(std::uint32_t node) const {
        Steps at = {};
        for (int k = width_ - 1; k >= 0; --k) {
            const std::uint32_t count = std::uint32_t(axes_[std::size_t(k)].nodes);
            at[std::size_t(k)] = int(node % count);
            node /= count;
        }
        return at;
    }
    template <class Visit>
    void visit_moved(const Steps& at, const Steps& by, const Visit& visit) const {
        std::size_t node = 0;
        for (int k = 0; k < width_; ++k) {
            const Axis& axis = axes_[std::size_t(k)];
            int to = at[std::size_t(k)] + by[std::size_t(k)];
            if (axis.wraps)
                to = ((to % axis.nodes) + axis.nodes) % axis.nodes;
            else if (to < 0 || to >= axis.nodes)
                return;
            node = node * std::size_t(axis.nodes) + std::size_t(to);
        }
        visit(std::uint32_t(node));
    }
};

}  // namespace cspace::planning
