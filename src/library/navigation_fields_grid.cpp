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

// One number per cell.
template <class T, class Of>
Table<T> map_cells(const maps::BitGrid& grid, const Of& of) {
    Table<T> made{{}, std::size_t(grid.columns())};
    made.values.reserve(std::size_t(grid.rows()) * made.columns);
    InterruptPoll poll(4);
    for (int row = 0; row < grid.rows(); ++row) {
        poll.step();
        for (int column = 0; column < grid.columns(); ++column)
            made.values.push_back(of(maps::Cell{row, column}));
    }
    return made;
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

ClearanceField::ClearanceField(const GridWorld& world)
    : cells(std::make_shared<Clearance>(make_clearance(world.state().bits))) {}

bool PotentialQuery::find(const GridWorld& world, Point start, Point goal, Trace* trace) {
    const auto& [bits, frame, parts] = world.state();
    const auto& s = numbers;
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    GridAnswer answer;
    answer.is_traced = trace;
    find_by_potential(bits, *field->cells, {s[0], s[1], s[2], s[3], s[4], s[5] != 0},
                      static_cast<Corners>(s[6]), from, to, answer);
    if (trace) list_settled(frame, answer.settled, *trace);
    draw_route(frame, start, goal, answer, found);
    return true;
}

bool MarchQuery::find(const GridWorld& world, Point start, Point goal, Trace* trace) {
    const auto& [bits, frame, parts] = world.state();
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    MarchAnswer answer =
        march_front(bits, frame, field->cells.get(), slow_within, start, from, goal, to, trace);
    found = std::move(answer.route), time = frame.resolution * answer.time;
    return true;
}

Table<double> march_times(const ClearanceField& field, const GridWorld& world, Point goal,
                          double slow_within) {
    const auto& [bits, frame, parts] = world.state();
    Front front(bits, field.cells.get(), slow_within, search::no_node);
    search::PriorityQueue queue;
    search::Effort effort;
    front.start(world.state().free_cell(goal), queue);
    search::best_first(front, queue, effort);
    return map_cells<double>(bits,
                             [&](maps::Cell c) { return frame.resolution * front.time(bits.number(c)); });
}

HarmonicPotential::HarmonicPotential(const GridWorld& world, const ClearanceField& clearance, Point goal,
                                     double most_residual, int most_cycles)
    : field(std::make_shared<HarmonicField>(world.state().bits, *clearance.cells,
                                            world.state().free_cell(goal), most_residual, most_cycles)),
      residual(field->residual()),
      cycles(field->cycles()),
      rests(field->rests()) {}

Table<double> list_heights(const HarmonicPotential& potential, const GridWorld& world) {
    return map_cells<double>(world.state().bits, [&](maps::Cell c) { return potential.field->height(c); });
}

bool HarmonicQuery::find(const GridWorld& world, Point start, Point goal, Trace* trace) {
    const maps::GridFrame& frame = world.state().frame;
    const HarmonicField& field = *potential->field;
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    const GridAnswer answer = field.descend(from);
    const auto& cells = answer.cells;
    for (std::size_t k = 1; trace && k < cells.size(); ++k)
        trace->push_back({0, frame.center(cells[k - 1]), frame.center(cells[k]), field.height(cells[k])});
    draw_route(frame, start, goal, answer, found);
    if (!answer.found && !cells.empty()) found.status = Status::undetermined;
    return true;
}

struct BrushfireDiagram::State {
    Diagram diagram;
    maps::GridFrame frame;

    double width(std::uint32_t squared) const { return 0.5 * frame.resolution * std::sqrt(double(squared)); }
};

BrushfireDiagram::BrushfireDiagram(const GridWorld& world)
    : state_(new State{Diagram(world.state().bits), world.state().frame}) {}

Table<double> BrushfireDiagram::clearance() const {
    const auto& [diagram, frame] = *state_;
    return map_cells<double>(diagram.grid(), [&](maps::Cell c) {
        return frame.resolution * diagram.clearance().of(diagram.grid().number(c));
    });
}
Table<std::int32_t> BrushfireDiagram::labels() const {
    const Diagram& diagram = state_->diagram;
    const maps::BitGrid& grid = diagram.grid();
    return map_cells<std::int32_t>(grid, [&](maps::Cell c) {
        return grid.blocked(c) ? -1 : diagram.pieces().piece(diagram.mark(grid.number(c)));
    });
}
Table<std::uint8_t> BrushfireDiagram::cells() const {
    const Diagram& diagram = state_->diagram;
    return map_cells<std::uint8_t>(diagram.grid(), [&](maps::Cell c) {
        return diagram.place(diagram.grid().number(c)) != Diagram::none;
    });
}

std::tuple<Table<std::int32_t>, Table<double>, Table<double>> BrushfireDiagram::branches() const {
    Table<std::int32_t> ends{{}, 4};
    Table<double> lengths, least;
    InterruptPoll poll(1024);
    for (const Diagram::Branch& branch : state_->diagram.branches()) {
        poll.step();
        for (const std::uint32_t n : {branch.from, branch.to}) {
            const maps::Cell cell = state_->diagram.grid().cell(n);
            ends.values.insert(ends.values.end(), {cell.row, cell.column});
        }
        lengths.values.push_back(state_->frame.resolution * branch.steps);
        least.values.push_back(state_->width(branch.squared));
    }
    return {std::move(ends), std::move(lengths), std::move(least)};
}

bool BrushfireQuery::find(const GridWorld& world, Point start, Point goal, Trace* trace) {
    const auto& [searched, frame] = *diagram->state_;
    maps::Cell from, to;
    if (!world.state().find_cells(start, goal, from, to)) return false;
    if (trace) list_waves(searched, frame, *trace);
    const BrushfireAnswer answer =
        find_along(searched, from, to, is_widest ? Prefer::clearance : Prefer::length);
    draw_route(frame, start, goal, answer.way, found);
    least_clearance = diagram->state_->width(answer.squared);
    return true;
}

}  // namespace cspace::navigation
