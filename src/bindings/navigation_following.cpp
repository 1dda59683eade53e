// The simulator of vehicles that follow paths: plain checked numbers in, a table of what happened out.
#include "library/navigation_following.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;
using cspace::maps::GridWorld;

namespace {

// vehicle (6,) and settings (6,) as in the headers; start (5,): x, y, theta, speed, turn; footprint (4,).
// numbers: of pure pursuit (lookahead), of Stanley (gain, softening), of the dynamic window (7,) as there.
// Runs: the row at which each begins, and its direction.
nb::tuple run(Points points, std::vector<std::pair<std::size_t, int>> runs, Row vehicle, Row start,
              Row settings, int controller, Row numbers, const GridWorld* world, Row footprint) {
    if (vehicle.size() != 6 || start.size() != 5 || settings.size() != 6 || numbers.size() != 7 ||
        footprint.size() != 4)
        throw nb::value_error(
            "vehicle, start, settings, numbers and footprint need 6, 5, 6, 7 and 4 numbers");
    std::vector<FollowRun> parts;
    for (const auto& [first, direction] : runs) parts.push_back({first, direction});
    const FollowTask task{vehicle.data(), start.data(), settings.data(), controller,
                          numbers.data(), world,        footprint.data()};
    std::vector<double> rows;
    int outcome;
    {
        const nb::gil_scoped_release free;
        outcome = follow_path(points_of(points), parts, task, rows);
    }
    return nb::make_tuple(outcome, table(std::move(rows), follow_width));
}

void ranges(const GridWorld& world, Points from, Row angles, double most, RowOut out) {
    if (from.shape(0) != out.size() || angles.size() != out.size())
        throw nb::value_error("points, angles and ranges must have matching shapes");
    const nb::gil_scoped_release free;
    cast_rays(world, points_of(from), angles.data(), most, out.data());
}

}  // namespace

void bind_navigation_following(nb::module_& m) {
    m.def("_follow", run, "points"_a, "runs"_a, "vehicle"_a, "start"_a, "settings"_a, "controller"_a,
          "numbers"_a, "world"_a.none(), "footprint"_a,
          "Lets a vehicle follow a path; the outcome and a row per step.");
    m.def("_cast_rays", ranges, "grid"_a, "points"_a, "angles"_a, "most"_a, "out"_a,
          "Ranges from rows of points at angles, written into out.");
}
