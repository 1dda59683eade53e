#include "navigation_fields_grid.hpp"

#include "cspace/maps/clearance.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/brushfire.hpp"
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
    : cells(std::make_shared<maps::Clearance>(make_clearance(world.state().bits))) {}

bool plan_by_potential(const Query<GridWorld>& query, Route& route, const ClearanceField* field,
                       const std::array<double, 7>& s) {
    const auto& [bits, frame, parts] = query.world.state();
    maps::Cell from, to;
    if (!query.world.state().find_cells(query.start, query.goal, from, to)) return false;
    GridAnswer answer;
    answer.is_traced = query.trace;
    find_by_potential(bits, *field->cells, {s[0], s[1], s[2], s[3], s[4], s[5] != 0},
                      static_cast<Corners>(s[6]), from, to, answer);
    if (query.trace) list_settled(frame, answer.settled, *query.trace);
    draw_route(frame, query.start, query.goal, answer, route);
    return true;
}

bool plan_march(const Query<GridWorld>& query, Answer<double>& answer, const ClearanceField* field,
                double slow_within) {
    const auto& [bits, frame, parts] = query.world.state();
    maps::Cell from, to;
    if (!query.world.state().find_cells(query.start, query.goal, from, to)) return false;
    MarchAnswer made = march_front(bits, frame, field->cells.get(), slow_within, query.start, from,
                                   query.goal, to, query.trace);
    answer.route = std::move(made.route);
    if (answer.route.status == Status::found) answer.evidence = {frame.resolution * made.time};
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

bool plan_harmonic(const Query<GridWorld>& query, Answer<>& answer, const HarmonicPotential* potential,
                   double spent) {
    const maps::GridFrame& frame = query.world.state().frame;
    const HarmonicField& field = *potential->field;
    maps::Cell from, to;
    if (!query.world.state().find_cells(query.start, query.goal, from, to)) return false;
    const GridAnswer way = field.descend(from);
    const auto& cells = way.cells;
    for (std::size_t k = 1; query.trace && k < cells.size(); ++k)
        query.trace->push_back(
            {0, frame.center(cells[k - 1]), frame.center(cells[k]), field.height(cells[k])});
    draw_route(frame, query.start, query.goal, way, answer.route);
    if (!way.found && !cells.empty()) answer.route.status = Status::undetermined;
    answer.evidence.emplace();
    answer.spent = spent;
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

bool plan_brushfire(const Query<GridWorld>& query, Answer<double>& answer, const BrushfireDiagram* diagram,
                    bool is_widest) {
    const auto& [searched, frame] = diagram->state();
    maps::Cell from, to;
    if (!query.world.state().find_cells(query.start, query.goal, from, to)) return false;
    if (query.trace) list_waves(searched, frame, *query.trace);
    const BrushfireAnswer found =
        find_along(searched, from, to, is_widest ? Prefer::clearance : Prefer::length);
    draw_route(frame, query.start, query.goal, found.way, answer.route);
    if (found.way.found) answer.evidence = {diagram->state().width(found.squared)};
    return true;
}

}  // namespace cspace::navigation
