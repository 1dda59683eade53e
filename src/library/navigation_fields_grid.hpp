// Fields over grids and the planners that use them: what the bindings call. A search returns false where an
// end lies in no free cell, and writes its events into a trace that is not null.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

using maps::GridWorld;

// Whether start and goal certainly lie in different parts of the free cells; not told of small parts. Throws
// std::invalid_argument, as all here do that take a point but no trace, unless they lie in free cells.
bool walls_divide(const GridWorld& world, Point start, Point goal);

// The distance of every cell to the nearest wall. Its functions take the world that it was made for.
class ClearanceField {
  public:
    struct State;
    explicit ClearanceField(const GridWorld& world);

    // By a potential. settings: gain, rho_0, cap, all in cells; scale, weight, whether greedy, the number of
    // Corners.
    bool find_potential_route(const GridWorld& world, Point start, Point goal, const double* settings,
                              Route& route, Trace* trace) const;
    // By fast marching, slower within a distance of walls; and the time that the way takes [m, over the
    // speed].
    bool find_march_route(const GridWorld& world, Point start, Point goal, double slow_within, Route& route,
                          double& time, Trace* trace) const;
    // The times at which a front from the goal arrives, by rows.
    std::vector<double> march_times(const GridWorld& world, Point goal, double slow_within) const;

    const State& state() const { return *state_; }

  private:
    std::shared_ptr<const State> state_;
};

// A harmonic potential, solved until every cell is the mean of those beside it but for a share, the residual.
class HarmonicPotential {
  public:
    HarmonicPotential(const GridWorld& world, const ClearanceField& clearance, Point goal, double residual,
                      int most_cycles);

    double residual() const;
    int cycles() const;
    std::size_t cells() const;   // from which a way leads to the goal
    std::int64_t rests() const;  // cells but the goal from which no step leads down
    // Minus the logarithm of the chance, by rows.
    std::vector<double> heights(const GridWorld& world) const;
    bool descend(const GridWorld& world, Point start, Point goal, Route& route, Trace* trace) const;

  private:
    struct State;
    std::shared_ptr<const State> state_;
};

// The diagram of a grid by brushfire, and ways along it.
class BrushfireDiagram {
  public:
    explicit BrushfireDiagram(const GridWorld& world);

    int rows() const;
    int columns() const;
    int pieces() const;                        // of the boundary
    std::vector<double> clearance() const;     // of each cell, by rows [m]
    std::vector<std::int32_t> labels() const;  // the nearest piece of boundary of each cell, or −1
    std::vector<std::uint8_t> cells() const;   // 1 in the diagram
    // Cells (row, column, row, column) where branches end, their lengths and least clearances [m].
    struct Branches {
        std::vector<std::int32_t> ends;
        std::vector<double> lengths, least;
    };
    Branches branches() const;
    // The least clearance [m] is written where a way is found. The events are the waves as they burn,
    // outwards from walls, and the diagram that they leave.
    bool find_route(const GridWorld& world, Point start, Point goal, bool widest, Route& route,
                    double& least_clearance, Trace* trace) const;

  private:
    struct State;
    std::shared_ptr<const State> state_;
};

}  // namespace cspace::navigation
