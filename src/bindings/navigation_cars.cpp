// Cars on grids: whether one touches something, and hybrid A*. Checked numbers in, pieces of curves out.
#include <chrono>
#include <memory>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/cars/hybrid_a_star.hpp"
#include "maps_grid.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using PoseRow = Array<const double, nb::shape<3>>;
using Poses = Array<const double, nb::shape<-1, 3>>;
using FootprintRow = Array<const double, nb::shape<4>>;
using Flags = Array<bool, nb::ndim<1>>;

CarPose pose_of(const double* row) { return {row[0], row[1], row[2]}; }
Footprint footprint_of(const FootprintRow& row) {
    return {row.data()[0], row.data()[1], row.data()[2], row.data()[3]};
}

void clear(const GridWorld& world, FootprintRow body, Poses poses, Flags out) {
    if (poses.shape(0) != out.shape(0)) throw nb::value_error("a flag for every pose");
    nb::gil_scoped_release free;
    const CarWorld cars(world.bits, world.frame);
    for (std::size_t k = 0; k < out.shape(0); ++k)
        out.data()[k] = cars.is_clear(footprint_of(body), pose_of(poses.data() + 3 * k));
}

// settings (7,): turning radius, box, headings, reverse cost, gear cost, most nodes, weight.
nb::tuple find(const GridWorld& world, FootprintRow body, PoseRow start, PoseRow goal, bool reverses,
               Array<const double, nb::shape<7>> settings) {
    const double* s = settings.data();
    const HybridSettings how{s[0], reverses, s[1], int(s[2]), s[3], s[4], std::int64_t(s[5]), s[6]};
    const auto began = std::chrono::steady_clock::now();
    CarRoute route;
    {
        nb::gil_scoped_release free;
        const CarWorld cars(world.bits, world.frame);
        route =
            HybridAStar(cars, footprint_of(body), pose_of(start.data()), pose_of(goal.data()), how).find();
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    nb::list pieces;
    for (const Piece& piece : route.pieces)
        pieces.append(nb::make_tuple(piece.turn, how.radius * piece.length));
    return nb::make_tuple(int(route.status), int(route.reason), pieces, route.stats.nodes, route.stats.edges,
                          took.count());
}

}  // namespace

void bind_navigation_cars(nb::module_& m) {
    m.def("_car_clear", clear, "grid"_a, "footprint"_a, "poses"_a, "out"_a,
          "Whether a vehicle touches no blocked cell at rows of poses.");
    m.def("_hybrid_a_star", find, "grid"_a, "footprint"_a, "start"_a, "goal"_a, "reverses"_a, "settings"_a,
          "Status, reason, pieces (turn, signed length), nodes, edges and seconds.");
}
