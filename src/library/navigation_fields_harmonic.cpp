#include "cspace/navigation/fields/harmonic.hpp"
#include "navigation_fields_state.hpp"

namespace cspace::navigation {

struct HarmonicPotential::State {
    HarmonicField field;
};

HarmonicPotential::HarmonicPotential(const GridWorld& world, const ClearanceField& clearance, Point goal,
                                     double residual, int most_cycles, Look look)
    : state_(new State{{world.state().bits, clearance.state().clearance, world.state().free_cell(goal),
                        residual, most_cycles, look}}) {}

double HarmonicPotential::residual() const { return state_->field.residual(); }
int HarmonicPotential::cycles() const { return state_->field.cycles(); }
std::size_t HarmonicPotential::cells() const { return state_->field.size(); }
std::int64_t HarmonicPotential::rests() const { return state_->field.rests(); }

std::vector<double> HarmonicPotential::heights(const GridWorld& world) const {
    return map_cells<double>(world.state().bits, [&](maps::Cell c) { return state_->field.height(c); });
}

Route HarmonicPotential::descend(const GridWorld& world, Point start, Point goal) const {
    const GridAnswer answer = state_->field.descend(world.state().free_cell(start));
    Route route;
    draw_route(world.state().frame, start, goal, answer, route);
    if (!answer.found && !answer.cells.empty()) route.status = Status::undetermined;
    return route;
}

void HarmonicPotential::trace_descent(const GridWorld& world, Point start, Trace& trace) const {
    const maps::GridFrame& frame = world.state().frame;
    const auto cells = state_->field.descend(world.state().free_cell(start)).cells;
    for (std::size_t k = 1; k < cells.size(); ++k)
        trace.push_back(
            {0, frame.center(cells[k - 1]), frame.center(cells[k]), state_->field.height(cells[k])});
}

}  // namespace cspace::navigation
