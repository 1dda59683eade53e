// A harmonic potential over the cells of a grid (Connolly, Burns & Weiss 1990), 0 at the goal and 1 on walls,
// and the way down it. It is 1 − the chance that a random walk comes to the goal first, and that chance is
// what is kept.
#pragma once

#include "cspace/navigation/fields/hitting.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/navigation/grid/moves.hpp"

namespace cspace::navigation {

struct Undisturbed {
    void operator()() const {}
};

class HarmonicField {
  public:
    // look() is called regularly while the equation is solved; it may throw to stop.
    template <class Look = Undisturbed>
    HarmonicField(const maps::BitGrid& grid, const Clearance& clearance, maps::Cell goal, double residual,
                  int most_cycles, const Look& look = {})
        : grid_(grid), chance_(grid_, clearance, goal) {
        chance_.solve(residual, most_cycles, look);
        for (std::size_t i = 1; i < chance_.size(); ++i) rests_ += uphill(chance_.cell(i)) == chance_.cell(i);
    }
    HarmonicField(const HarmonicField&) = delete;
    HarmonicField& operator=(const HarmonicField&) = delete;

    std::size_t size() const { return chance_.size(); }
    double residual() const { return chance_.residual(); }
    int cycles() const { return chance_.cycles(); }
    // Cells but the goal from which no step leads down: none, where the equation is solved well enough.
    std::int64_t rests() const { return rests_; }
    // Minus the logarithm of the chance: 0 at the goal, infinite on walls and where no path leads to the
    // goal.
    double height(maps::Cell cell) const {
        const std::size_t i = chance_.index(cell);
        return i == chance_.size() ? std::numeric_limits<double>::infinity() : 0.0 - chance_.log_chance(i);
    }
    // From a cell to the goal, or as far as a step leads down.
    GridAnswer descend(maps::Cell start) const {
        GridAnswer answer;
        answer.effort.settled = chance_.size();
        answer.effort.pushed = 4 * chance_.size() * std::size_t(chance_.cycles());
        if (chance_.index(start) == chance_.size()) return answer;
        answer.cells = {start};
        for (maps::Cell next; !((next = uphill(answer.cells.back())) == answer.cells.back());)
            answer.cells.push_back(next);
        answer.found = chance_.index(answer.cells.back()) == 0;
        return answer;
    }

  private:
    maps::BitGrid grid_;
    HittingSolver chance_;
    std::int64_t rests_ = 0;

    // The neighbour towards which the chance grows most, past no blocked corner; the cell itself where none
    // has more.
    maps::Cell uphill(maps::Cell from) const {
        const std::size_t i = chance_.index(from);
        const double here = chance_.log_chance(i);
        maps::Cell best = from;
        double most = 0;
        for (int d = 0; d < 8; ++d) {
            const maps::Cell to{from.row + row_step[d], from.column + column_step[d]};
            if (grid_.blocked(to) || grid_.blocked(from.row, to.column) || grid_.blocked(to.row, from.column))
                continue;
            const std::size_t j = chance_.index(to);
            if (!chance_.is_less(i, j)) continue;
            const double rise = (chance_.log_chance(j) - here) / (is_diagonal(d) ? std::numbers::sqrt2 : 1.0);
            if (best == from || rise > most) best = to, most = rise;
        }
        return best;
    }
};

}  // namespace cspace::navigation
