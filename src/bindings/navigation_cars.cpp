// Cars on grids: whether one touches something, and hybrid A*. Checked numbers in, pieces of curves out.
#include "library/navigation_curves.hpp"
#include "maps_grid.hpp"
#include "navigation_curves.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;

namespace {

using FootprintRow = Array<const double, nb::shape<4>>;
using Flags = Array<bool, nb::ndim<1>>;

void clear(const GridWorld& world, FootprintRow body, Poses poses, Flags out) {
    if (poses.shape(0) != out.shape(0)) throw nb::value_error("out must have one flag per pose");
    const nb::gil_scoped_release free;
    check_poses(world, body.data(), poses_of(poses), out.data());
}

// settings (7,): turning radius, box, headings, reverse cost, gear cost, most nodes, weight.
nb::tuple find(const GridWorld& world, FootprintRow body, PoseRow start, PoseRow goal, bool reverses,
               Array<const double, nb::shape<7>> settings) {
    const Watch watch;
    CarFinding found;
    {
        const nb::gil_scoped_release free;
        found = find_car_route(world, body.data(), pose_of(start), pose_of(goal), reverses, settings.data());
    }
    const double seconds = watch.seconds();
    nb::list pieces;
    for (const Piece& piece : found.pieces) pieces.append(nb::make_tuple(piece.turn, piece.length));
    return nb::make_tuple(int(found.status), found.reason, pieces, found.stats.nodes, found.stats.edges,
                          seconds);
}

}  // namespace

void bind_navigation_cars(nb::module_& m) {
    m.def("_car_clear", clear, "grid"_a, "footprint"_a, "poses"_a, "out"_a,
          "Whether a vehicle touches no blocked cell at rows of poses.");
    m.def("_hybrid_a_star", find, "grid"_a, "footprint"_a, "start"_a, "goal"_a, "reverses"_a, "settings"_a,
          "Status, reason, pieces (turn, signed length), nodes, edges and seconds.");
}
