// The histogram filter: what the bindings call.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "cspace/math/plane.hpp"
#include "maps_grid.hpp"

namespace cspace::localization {

// The scores of all cells x, y, θ whose centres lie on a lattice of whole cells of a field.
class LatticeScores {
  public:
    // step: cells of the field from a centre to the next; first: the centre of row 0, column 0, in cells from
    // the corner of the field. headings: cos θ, sin θ of each sector.
    LatticeScores(maps::CellBytes scores, int outside, int step, Point first, int rows, int columns,
                  std::span<const Point> headings);
    ~LatticeScores();
    // The sums of the bytes at the ends of at most 257 beams, given in base [cells of the field], by sector,
    // row and column, into `sums`. Throws std::invalid_argument for more.
    void sum(std::span<const Point> ends, int threads, std::span<std::int32_t> sums) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Numbers by sector, row and column.
struct CellShape {
    int sectors, rows, columns;
};

// The belief moved: each sector by its shift (y, x) and blurred by its deviations (y, x), then turned and
// blurred over the sectors, which close; all in cells. Nothing comes in at the border.
// The result has the sum 1, unless nothing is left; returns whether something is.
bool move_belief(std::span<const double> belief, const CellShape& shape,
                 std::span<const std::array<double, 4>> steps, double turn, double turn_sigma, int threads,
                 std::span<double> moved);

// The belief mixed with a share that is spread over the free cells (of a plane), times exp(unit · sum), and
// times the share where it is not free, of sum 1. Returns the largest sum of a free cell.
std::int32_t weigh_belief(std::span<const double> belief, const CellShape& shape,
                          std::span<const std::int32_t> sums, std::span<const std::uint8_t> free, double unit,
                          double share, int threads, std::span<double> weighed);

}  // namespace cspace::localization
