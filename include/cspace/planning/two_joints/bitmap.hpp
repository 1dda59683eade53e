// Pictures of the configuration space of two joints: its arcs, row by row, as runs of cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cspace/math/interrupts.hpp"
#include "cspace/planning/two_joints/space.hpp"

namespace cspace::planning::two_joints {

// The centres of equal cells from lower to upper.
class Cells {
  public:
    Cells(const Joint& joint, int count)
        : count_(count), side_(joint.width() / count), first_(joint.lower + 0.5 * side_) {}
    double center(int i) const { return first_ + i * side_; }
    // Calls visit(begin, end) for the cells whose centres lie in an interval or a multiple of 2π beside it.
    template <class Visit>
    void visit_runs(double low, double high, const Visit& visit) const {
        const double period = turn / side_, from = (low - first_) / side_, length = (high - low) / side_;
        for (double k = std::ceil((-from - length) / period); from + k * period <= count_ - 1; ++k) {
            const double begin = std::max(std::ceil(from + k * period), 0.0);
            const double end = std::min(std::floor(from + k * period + length), count_ - 1.0);
            if (begin <= end) visit(int(begin), int(end) + 1);
        }
    }

  private:
    int count_;
    double side_, first_;
};

// Fills cells (rows, columns) of one value with the mark of a piece wherever the arm touches it at the centre
// of the cell: rows are cells of joint 1, columns of joint 2. mark(piece) is called for each run.
template <class Cell, class Mark>
void draw_bitmap(const Space& space, int rows, int columns, Cell* cells, const Mark& mark) {
    const Cells row_centers(space.arm().joint_1, rows), column_centers(space.arm().joint_2, columns);
    InterruptPoll poll(64);
    for (int i = 0; i < rows; ++i, cells += columns) {
        poll.step();
        const double q_1 = row_centers.center(i);
        if (const std::int32_t piece = space.blocks_link_1(q_1); piece != no_obstacle) {
            std::fill(cells, cells + columns, mark(piece));
            continue;
        }
        space.visit_link_2(q_1, [&](const BlockedInterval& blocked) {
            column_centers.visit_runs(blocked.low, blocked.high, [&](int begin, int end) {
                std::fill(cells + begin, cells + end, mark(blocked.piece));
            });
        });
    }
}

}  // namespace cspace::planning::two_joints
