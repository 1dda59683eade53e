// Approximate cells: a quadtree that is kept with its world.
#include "cspace/navigation/cells/approximate_cells.hpp"
#include "maps_polygon_world.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// depth, most_depth, refine, uniform, manhattan, most_cells
using SettingRow = Array<const std::int64_t, nb::shape<6>>;

CellOptions options_of(const SettingRow& row) {
    const std::int64_t* s = row.data();
    return {int(s[0]), int(s[1]), s[2] != 0, s[3] != 0, s[4] != 0, std::size_t(s[5])};
}

CellAnswer solve(PolygonCore& core, const fields::PointRow& start, const fields::PointRow& goal,
                 const SettingRow& row, Trace* trace) {
    const Point from{start.data()[0], start.data()[1]}, to{goal.data()[0], goal.data()[1]};
    const Point at_start = core.world.settle(from, core.tolerance).at;
    const Point at_goal = core.world.settle(to, core.tolerance).at;
    CellAnswer answer =
        ApproximateCells(core.world, options_of(row), trace, &core.quadtree).solve(at_start, at_goal);
    std::vector<Point>& path = answer.route.path;
    if (path.empty() || (at_start == from && at_goal == to)) return answer;
    path.front() = from, path.back() = to;  // they were taken off a wall
    answer.route.length = length_of(path);
    return answer;
}

// The evidence is what evidence(free, mixed, full, depth) makes of the leaves.
nb::object route(PolygonCore& core, nb::handle world, nb::handle planner, nb::handle options,
                 fields::PointRow start, fields::PointRow goal, SettingRow row, nb::handle evidence) {
    const fields::Watch watch;
    CellAnswer answer;
    {
        nb::gil_scoped_release free;
        answer = solve(core, start, goal, row, nullptr);
    }
    nb::object made = fields::made_route(world, planner, options, start, goal, answer.route, watch.seconds());
    fields::set_evidence(made, evidence(answer.leaves[0], answer.leaves[1], answer.leaves[2], answer.depth));
    return made;
}

nb::object trace(PolygonCore& core, fields::PointRow start, fields::PointRow goal, SettingRow row) {
    Trace events;
    solve(core, start, goal, row, &events);
    return fields::arrays_of(events);
}

// (squares (k, 4), kinds (k,)) of the leaves
nb::object leaves(PolygonCore& core, SettingRow row) {
    std::vector<double> squares;
    std::vector<std::int8_t> kinds;
    {
        nb::gil_scoped_release free;
        const ApproximateCells cells(core.world, options_of(row), nullptr, &core.quadtree);
        const Quadtree& tree = cells.tree();
        for (maps::Index c = 0; c < maps::Index(tree.cells().size()); ++c) {
            if (!tree.is_leaf(c)) continue;
            const Point low = tree.low(tree[c]), high = tree.high(tree[c]);
            squares.insert(squares.end(), {low.x, low.y, high.x, high.y});
            kinds.push_back(tree[c].kind);
        }
    }
    const std::size_t count = kinds.size();
    return nb::make_tuple(fields::table(std::move(squares), count, 4),
                          fields::table(std::move(kinds), count, 0));
}

}  // namespace

void bind_navigation_cells(nb::module_& m) {
    m.def("_approximate_cells", route, "core"_a, "world"_a, "planner"_a, "options"_a, "start"_a, "goal"_a,
          "settings"_a, "evidence"_a);
    m.def("_approximate_cells_trace", trace, "core"_a, "start"_a, "goal"_a, "settings"_a);
    m.def("_approximate_cells_all", leaves, "core"_a, "settings"_a);
}
