// Coverage of a grid: a start and a bar in, the way cell by cell and what it swept out.
#include "library/navigation_coverage.hpp"

#include "maps_grid.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;

namespace {

nb::tuple covered(const GridWorld& world, int row, int column, int half, bool along_rows) {
    CoverageFinding made;
    {
        const nb::gil_scoped_release free;
        made = cover_grid(world, row, column, half, along_rows);
    }
    const std::size_t rows = std::size_t(world.rows()), columns = std::size_t(world.columns());
    const std::size_t steps = made.path.size() / 2, regions = made.order.size();
    return nb::make_tuple(table(std::move(made.path), steps, 2), table(std::move(made.region), rows, columns),
                          table(std::move(made.order), 1, regions),
                          table(std::move(made.passes), rows, columns), made.reached, made.free, made.lanes,
                          made.leftover);
}

}  // namespace

void bind_navigation_coverage(nb::module_& m) {
    m.def("_cover", covered, "grid"_a, "row"_a, "column"_a, "half"_a, "along_rows"_a,
          "Path, regions, their order, passes, cells reached and free, lanes and leftovers.");
}
