// The search of a whole map for the poses of a scan, for cspace.localization.
#include "library/localization_search.hpp"

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;
using cspace::Point;
using cspace::Table;

static Table<ModeRow> search(cspace::maps::CellBytes scores, double resolution, Point origin, int outside,
                             std::span<const std::uint8_t> allowed, std::span<const Point> points,
                             const std::array<double, 5>& rule) {
    return search_map({scores, resolution, origin, outside}, allowed, points, rule);
}

void bind_localization_search(nb::module_& m) {
    m.def("_search_map", search, "scores"_a, "resolution"_a, "origin"_a, "outside"_a, "allowed"_a, "points"_a,
          "rule"_a, WithoutLock(), "The best separate poses of points: rows x, y, theta, score.");
}
