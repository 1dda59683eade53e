// What range sensors measure on maps, for cspace.maps.
#include "library/maps_sensing.hpp"

#include <nanobind/stl/tuple.h>

#include <tuple>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::maps;

static std::tuple<double, double, double, double> reach(std::span<const LaserRow> lasers,
                                                        std::span<const float> ranges,
                                                        std::span<const double> angles, double most,
                                                        const EvidenceNumbers& numbers) {
    return std::tuple_cat(reached_cells({lasers, ranges, angles, most}, numbers));
}
static void add(std::span<std::int32_t> sums, int columns, int row, int column,
                std::span<const LaserRow> lasers, std::span<const float> ranges,
                std::span<const double> angles, double most, const EvidenceNumbers& numbers, int threads) {
    add_evidence(sums, columns, {row, column}, {lasers, ranges, angles, most}, numbers, threads);
}

void bind_maps_sensing(nb::module_& m) {
    m.def("_cast_rays", cast_rays, "grid"_a, "points"_a, "angles"_a, "most"_a, WithoutLock(),
          "Ranges from rows of points at angles.");
    m.def("_likelihood_field", likelihood_field, "grid"_a, "sigma"_a, "floor"_a, WithoutLock(),
          "Scores (rows, columns) by the distance to the nearest blocked cell.");
    m.def("_likelihood_field", likelihood_field_of_known, "blocked"_a, "known"_a, "resolution"_a, "sigma"_a,
          "floor"_a, WithoutLock(), "The same of cells given as bytes, and 0 where they are not known.");
    m.def("_reached_cells", reach, "lasers"_a, "ranges"_a, "angles"_a, "most"_a, "numbers"_a, WithoutLock(),
          "The lowest row and column that scans reach, and the highest.");
    m.def("_add_evidence", add, "sums"_a, "columns"_a, "row"_a, "column"_a, "lasers"_a, "ranges"_a,
          "angles"_a, "most"_a, "numbers"_a, "threads"_a, WithoutLock(),
          "Adds scans to sums of evidence, in place.");
}
