#include "navigation_fields_grid.hpp"

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/brushfire.hpp"
#include "cspace/navigation/fields/clearance.hpp"
#include "cspace/navigation/fields/fast_marching.hpp"
#include "cspace/navigation/fields/harmonic.hpp"
#include "cspace/navigation/fields/potential_search.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

namespace {

// One number per cell, by rows.
template <class T, class Of>
std::vector<T> map_cells(const maps::BitGrid& grid, const Of& of) {
    std::vector<T> values;
    values.reserve(std::size_t(grid.rows()) * std::size_t(grid.columns()));
    InterruptPoll poll(4);
    for (int row = 0; row < grid.rows(); ++row) {
        poll.step();
        for (int column = 0; column < grid.columns(); ++column) values.push_back(of(maps::Cell{row, column}));
    }
    return values;
}

enum Fire : std::int8_t { burn, meet, keep };

void list_waves(const Diagram& diagram, const maps::GridFrame& frame, Trace& trace) {
    const maps::BitGrid& grid = diagram.grid();
    const double side = frame.resolution;
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < grid.numbers(); ++n)
        if (!grid.blocked(grid.cell(n))) order.push_back(n);
    thinning::sort_by_key(order, diagram.clearance().squared);
    const auto add = [&](Fire fire, std::uint32_t n) {
        const Point at = frame.center(grid.cell(n));
        const auto mark = diagram.pieces().at(diagram.mark(n));
        const Point wall = frame.origin + (0.5 * side) * Point{double(mark.column), double(mark.row)};
        trace.push_back({fire, fire == burn ? wall : at, at, side * diagram.clearance().of(n)});
    };
    for (const std::uint32_t n : order) add(burn, n);
    for (const std::uint32_t n : diagram.cells()) add(diagram.is_meet(n) ? meet : keep, n);
}

}  // namespace

bool walls_divide(const GridWorld& world, Point start, Point goal) {
    auto& [bits, frame, parts] = world.state();
    const maps::Cell from = world.state().free_cell(start), to = world.state().free_cell(goal);
    return parts.of(bits, false).divide(from, to);
}

struct ClearanceField::State {
    Clearance clearance;
};

ClearanceField::ClearanceField(const GridWorld& world)
    : state_(new State{make_clearance(world.state().bits)}) {}

bool ClearanceField::find_potential_route(const GridWorld& world, Point start, Point goal, const double* s,
                                          Route& route, Trace* trace) const {
    const auto& [bits, frame, parts] = world.state();
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    GridAnswer answer;
    std::vector<Settled> settled;
    if (trace) answer.settled = &settled;
    find_by_potential(bits, state_->clearance, {s[0], s[1], s[2], s[3], s[4], s[5] != 0},
                      static_cast<Corners>(s[6]), from, to, answer);
    if (trace) list_settled(frame, settled, *trace);
    draw_route(frame, start, goal, answer, route);
    return true;
}

bool ClearanceField::find_march_route(const GridWorld& world, Point start, Point goal, double slow_within,
                                      Route& route, double& time, Trace* trace) const {
    const auto& [bits, frame, parts] = world.state();
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    MarchAnswer answer =
        march_front(bits, frame, &state_->clearance, slow_within, start, from, goal, to, trace);
    route = std::move(answer.route), time = frame.resolution * answer.time;
    return true;
}

std::vector<double> ClearanceField::march_times(const GridWorld& world, Point goal,
                                                double slow_within) const {
    const maps::BitGrid& bits = world.state().bits;
    Front front(bits, &state_->clearance, slow_within, search::no_node);
    search::PriorityQueue queue;
    search::Effort effort;
    front.start(world.state().free_cell(goal), queue);
    search::best_first(front, queue, effort);
    return map_cells<double>(bits,
                             [&](maps::Cell c) { return world.resolution() * front.time(bits.number(c)); });
}

struct HarmonicPotential::State {
    HarmonicField field;
};

HarmonicPotential::HarmonicPotential(const GridWorld& world, const ClearanceField& clearance, Point goal,
                                     double residual, int most_cycles)
    : state_(new State{{world.state().bits, clearance.state().clearance, world.state().free_cell(goal),
                        residual, most_cycles}}) {}

double HarmonicPotential::residual() const { return state_->field.residual(); }
int HarmonicPotential::cycles() const { return state_->field.cycles(); }
std::size_t HarmonicPotential::cells() const { return state_->field.size(); }
std::int64_t HarmonicPotential::rests() const { return state_->field.rests(); }

std::vector<double> HarmonicPotential::heights(const GridWorld& world) const {
    return map_cells<double>(world.state().bits, [&](maps::Cell c) { return state_->field.height(c); });
}

bool HarmonicPotential::descend(const GridWorld& world, Point start, Point goal, Route& route,
                                Trace* trace) const {
    const maps::GridFrame& frame = world.state().frame;
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    const GridAnswer answer = state_->field.descend(from);
    const auto& cells = answer.cells;
    for (std::size_t k = 1; trace && k < cells.size(); ++k)
        trace->push_back(
            {0, frame.center(cells[k - 1]), frame.center(cells[k]), state_->field.height(cells[k])});
    draw_route(frame, start, goal, answer, route);
    if (!answer.found && !cells.empty()) route.status = Status::undetermined;
    return true;
}

struct BrushfireDiagram::State {
    Diagram diagram;
    maps::GridFrame frame;

    double width(std::uint32_t squared) const { return 0.5 * frame.resolution * std::sqrt(double(squared)); }
};

BrushfireDiagram::BrushfireDiagram(const GridWorld& world)
    : state_(new State{Diagram(world.state().bits), world.state().frame}) {}

int BrushfireDiagram::rows() const { return state_->diagram.grid().rows(); }
int BrushfireDiagram::columns() const { return state_->diagram.grid().columns(); }
int BrushfireDiagram::pieces() const { return int(state_->diagram.pieces().count()); }

std::vector<double> BrushfireDiagram::clearance() const {
    const Diagram& diagram = state_->diagram;
    const double side = state_->frame.resolution;
    return map_cells<double>(diagram.grid(), [&](maps::Cell c) {
        return side * diagram.clearance().of(diagram.grid().number(c));
    });
}
std::vector<std::int32_t> BrushfireDiagram::labels() const {
    const Diagram& diagram = state_->diagram;
    const maps::BitGrid& grid = diagram.grid();
    return map_cells<std::int32_t>(grid, [&](maps::Cell c) {
        return grid.blocked(c) ? -1 : diagram.pieces().piece(diagram.mark(grid.number(c)));
    });
}
std::vector<std::uint8_t> BrushfireDiagram::cells() const {
    const Diagram& diagram = state_->diagram;
    return map_cells<std::uint8_t>(diagram.grid(), [&](maps::Cell c) {
        return diagram.place(diagram.grid().number(c)) != Diagram::none;
    });
}

BrushfireDiagram::Branches BrushfireDiagram::branches() const {
    Branches all;
    InterruptPoll poll(1024);
    for (const Diagram::Branch& branch : state_->diagram.branches()) {
        poll.step();
        for (const std::uint32_t n : {branch.from, branch.to}) {
            const maps::Cell cell = state_->diagram.grid().cell(n);
            all.ends.insert(all.ends.end(), {cell.row, cell.column});
        }
        all.lengths.push_back(state_->frame.resolution * branch.steps);
        all.least.push_back(state_->width(branch.squared));
    }
    return all;
}

bool BrushfireDiagram::find_route(const GridWorld& world, Point start, Point goal, bool widest, Route& route,
                                  double& least_clearance, Trace* trace) const {
    const auto& [diagram, frame] = *state_;
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    if (trace) list_waves(diagram, frame, *trace);
    const BrushfireAnswer answer = find_along(diagram, from, to, widest ? Prefer::clearance : Prefer::length);
    draw_route(frame, start, goal, answer.way, route);
    if (answer.way.found) least_clearance = state_->width(answer.squared);
    return true;
}

}  // namespace cspace::navigation
