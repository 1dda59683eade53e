// Fields over grids and the planners that use them: what the bindings call. Functions that take a point but
// no trace throw std::invalid_argument unless it lies in a free cell. The functions of a field take the world
// that it was made for.
#pragma once

#include <array>
#include <memory>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::maps {
struct Clearance;
}

namespace cspace::navigation {

class HarmonicField;

// Whether start and goal certainly lie in different parts of the free cells; not told of small parts.
bool walls_divide(const GridWorld& world, Point start, Point goal);

// The distance of every cell to the nearest wall.
struct ClearanceField {
    explicit ClearanceField(const GridWorld& world);
    std::shared_ptr<const maps::Clearance> cells;
};

// By a potential. numbers: gain, rho_0, cap, all in cells; scale, weight, whether greedy, Corners.
bool plan_by_potential(const Query<GridWorld>& query, Route& route, const ClearanceField* field,
                       const std::array<double, 7>& numbers);
// By fast marching, slower within a distance of walls [cells]; the time that the way takes [m, over the
// speed].
bool plan_march(const Query<GridWorld>& query, Answer<double>& answer, const ClearanceField* field,
                double slow_within);
// The times at which a front from the goal arrives.
Table<double> march_times(const ClearanceField& field, const GridWorld& world, Point goal,
                          double slow_within);

// A harmonic potential, solved until every cell is the mean of those beside it but for a share, the residual.
struct HarmonicPotential {
    HarmonicPotential(const GridWorld& world, const ClearanceField& clearance, Point goal, double residual,
                      int most_cycles);
    std::shared_ptr<const HarmonicField> field;
    double residual;
    int cycles;
    std::int64_t rests;  // cells but the goal from which no step leads down
};
// Minus the logarithm of the chance.
Table<double> list_heights(const HarmonicPotential& potential, const GridWorld& world);

bool plan_harmonic(const Query<GridWorld>& query, Answer<>& answer, const HarmonicPotential* potential,
                   double spent);

// The diagram of a grid by brushfire, and ways along it.
class BrushfireDiagram {
  public:
    explicit BrushfireDiagram(const GridWorld& world);

    Table<double> clearance() const;     // of each cell [m]
    Table<std::int32_t> labels() const;  // the nearest piece of boundary of each cell, or −1
    Table<std::uint8_t> cells() const;   // 1 in the diagram
    // Cells (row, column, row, column) where branches end, their lengths and least clearances [m].
    std::tuple<Table<std::int32_t>, Table<double>, Table<double>> branches() const;

    struct State;
    const State& state() const { return *state_; }

  private:
    std::shared_ptr<const State> state_;
};

// Along it; the least clearance [m]. The events are the waves as they burn, outwards from walls, and the
// diagram that they leave.
bool plan_brushfire(const Query<GridWorld>& query, Answer<double>& answer, const BrushfireDiagram* diagram,
                    bool is_widest);

}  // namespace cspace::navigation
