#include "cspace/navigation/fields/brushfire.hpp"
#include "navigation_fields_state.hpp"

namespace cspace::navigation {

namespace {

enum Word : std::int8_t { burn_word, meet_word, keep_word };

}  // namespace

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
    for (const Diagram::Branch& branch : state_->diagram.branches()) {
        for (const std::uint32_t n : {branch.from, branch.to}) {
            const maps::Cell cell = state_->diagram.grid().cell(n);
            all.ends.insert(all.ends.end(), {cell.row, cell.column});
        }
        all.lengths.push_back(state_->frame.resolution * branch.steps);
        all.least.push_back(state_->width(branch.squared));
    }
    return all;
}

Route BrushfireDiagram::find_route(Point start, Point goal, bool widest, double& least_clearance) const {
    const auto& [diagram, frame] = *state_;
    const maps::Cell from = maps::free_cell(frame, diagram.grid(), start);
    const maps::Cell to = maps::free_cell(frame, diagram.grid(), goal);
    const BrushfireAnswer answer = find_along(diagram, from, to, widest ? Prefer::clearance : Prefer::length);
    Route route;
    draw_route(frame, start, goal, answer.way, route);
    if (answer.way.found) least_clearance = state_->width(answer.squared);
    return route;
}

void BrushfireDiagram::trace_waves(Trace& trace) const {
    const Diagram& diagram = state_->diagram;
    const maps::GridFrame& frame = state_->frame;
    const maps::BitGrid& grid = diagram.grid();
    const double side = frame.resolution;
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < grid.numbers(); ++n)
        if (!grid.blocked(grid.cell(n))) order.push_back(n);
    thinning::sort_by_key(order, diagram.clearance().squared);
    const auto add = [&](std::int8_t word, std::uint32_t n, bool from_wall) {
        const Point at = frame.center(grid.cell(n));
        const auto mark = diagram.pieces().at(diagram.mark(n));
        const Point wall = frame.origin + (0.5 * side) * Point{double(mark.column), double(mark.row)};
        trace.push_back({word, from_wall ? wall : at, at, side * diagram.clearance().of(n)});
    };
    for (const std::uint32_t n : order) add(burn_word, n, true);
    for (const std::uint32_t n : diagram.cells()) add(diagram.is_meet(n) ? meet_word : keep_word, n, false);
}

}  // namespace cspace::navigation
