// Coverage of a grid: a start and a bar in, the way cell by cell and what it swept out.
#include <memory>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/coverage/cover.hpp"
#include "maps_grid.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

template <class T>
nb::object table(std::vector<T>&& values, std::size_t rows, std::size_t columns) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    T* data = kept->data();
    nb::capsule owner(kept.release(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<2>, nb::c_contig>(data, {rows, columns}, owner));
}

nb::tuple covered(const GridWorld& world, int row, int column, int half, bool along_rows) {
    const maps::BitGrid& grid = world.bits;
    if (grid.blocked(row, column) || !grid.contains({row, column}) || half < 0)
        throw nb::value_error("a free cell, and a bar");
    Coverage made;
    std::vector<std::int32_t> path;
    {
        nb::gil_scoped_release free;
        made = cover(grid, {row, column}, half, along_rows);
        path.reserve(2 * made.path.size());
        for (const maps::Cell cell : made.path) path.push_back(cell.row), path.push_back(cell.column);
    }
    const std::size_t rows = std::size_t(grid.rows()), columns = std::size_t(grid.columns());
    const std::size_t steps = made.path.size(), regions = made.order.size();
    return nb::make_tuple(table(std::move(path), steps, 2), table(std::move(made.region), rows, columns),
                          table(std::move(made.order), 1, regions),
                          table(std::move(made.passes), rows, columns), made.reached, made.free, made.lanes,
                          made.leftover);
}

}  // namespace

void bind_navigation_coverage(nb::module_& m) {
    m.def("_cover", covered, "grid"_a, "row"_a, "column"_a, "half"_a, "along_rows"_a,
          "Path, regions, their order, passes, cells reached and free, lanes and leftovers.");
}
