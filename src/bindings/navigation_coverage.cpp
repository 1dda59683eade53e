// Coverage of a grid: a start and a bar in, the way cell by cell and what it swept out.
#include "library/navigation_coverage.hpp"

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;
using cspace::maps::GridWorld;

namespace {

nb::tuple covered(const GridWorld& world, int row, int column, int half, bool along_rows) {
    CoverageFinding made;
    {
        const nb::gil_scoped_release free;
        made = cover_grid(world, row, column, half, along_rows);
    }
    const auto columns = std::size_t(world.columns());
    return nb::make_tuple(table(std::move(made.path), 2), table(std::move(made.region), columns),
                          table(std::move(made.order)), table(std::move(made.passes), columns), made.reached,
                          made.free, made.lanes, made.leftover);
}

}  // namespace

void bind_navigation_coverage(nb::module_& m) {
    m.def("_cover", covered, "grid"_a, "row"_a, "column"_a, "half"_a, "along_rows"_a,
          "Path, regions, their order, passes, cells reached and free, lanes and leftovers.");
}
