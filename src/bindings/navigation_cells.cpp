// Approximate cells: a quadtree that is kept with its world.
#include "library/navigation_polygons.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// depth, most_depth, refine, uniform, manhattan, most_cells
using SettingRow = Array<const std::int64_t, nb::shape<6>>;

// The evidence is what evidence(free, mixed, full, depth) makes of the leaves.
nb::object route(const PolygonCore& core, nb::handle world, nb::handle planner, nb::handle options,
                 PointRow start, PointRow goal, SettingRow settings, nb::handle evidence) {
    const Watch watch;
    CellFinding found;
    {
        const nb::gil_scoped_release free;
        found = find_cell_route(core, point_of(start), point_of(goal), settings.data(), nullptr);
    }
    nb::object made = fields::made_route(world, planner, options, start, goal, found.route, watch.seconds());
    fields::set_evidence(made, evidence(found.free, found.mixed, found.full, found.depth));
    return made;
}

nb::object trace(const PolygonCore& core, PointRow start, PointRow goal, SettingRow settings) {
    Trace events;
    find_cell_route(core, point_of(start), point_of(goal), settings.data(), &events);
    return fields::arrays_of(events);
}

// (squares (k, 4), kinds (k,)) of the leaves
nb::object leaves(const PolygonCore& core, SettingRow settings) {
    std::vector<double> squares;
    std::vector<std::int8_t> kinds;
    {
        const nb::gil_scoped_release free;
        list_cell_leaves(core, settings.data(), squares, kinds);
    }
    const std::size_t count = kinds.size();
    return nb::make_tuple(table(std::move(squares), count, 4), table(std::move(kinds)));
}

}  // namespace

void bind_navigation_cells(nb::module_& m) {
    m.def("_approximate_cells", route, "core"_a, "world"_a, "planner"_a, "options"_a, "start"_a, "goal"_a,
          "settings"_a, "evidence"_a);
    m.def("_approximate_cells_trace", trace, "core"_a, "start"_a, "goal"_a, "settings"_a);
    m.def("_approximate_cells_all", leaves, "core"_a, "settings"_a);
}
