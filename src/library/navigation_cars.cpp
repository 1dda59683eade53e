#include "cspace/navigation/cars/hybrid_a_star.hpp"
#include "maps_grid_state.hpp"
#include "navigation_curves.hpp"

namespace cspace::navigation {

void check_poses(const maps::GridWorld& world, const double* f, std::span<const CarPose> poses,
                 bool* is_clear) {
    const CarWorld cars(world.state().bits, world.state().frame);
    for (const CarPose& pose : poses) *is_clear++ = cars.is_clear({f[0], f[1], f[2], f[3]}, pose);
}

CarFinding find_car_route(const maps::GridWorld& world, const double* f, const CarPose& start,
                          const CarPose& goal, bool reverses, const double* s) {
    const HybridSettings how{s[0], reverses, s[1], int(s[2]), s[3], s[4], std::int64_t(s[5]), s[6]};
    const CarWorld cars(world.state().bits, world.state().frame);
    CarRoute route = HybridAStar(cars, {f[0], f[1], f[2], f[3]}, start, goal, how).find();
    for (Piece& piece : route.pieces) piece.length *= how.radius;
    return {route.status, int(route.reason), std::move(route.pieces), route.stats};
}

}  // namespace cspace::navigation
