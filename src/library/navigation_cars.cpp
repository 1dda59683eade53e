#include "navigation_cars.hpp"

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/cars/hybrid_a_star.hpp"
#include "cspace/navigation/curves/curve.hpp"
#include "cspace/navigation/curves/dubins.hpp"
#include "cspace/navigation/curves/reeds_shepp.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

Curve find_shortest_curve(bool reverses, const CarPose& start, const CarPose& goal, double radius) {
    return reverses ? reeds_shepp_curve(start, goal, radius) : dubins_curve(start, goal, radius);
}
double curve_length(bool reverses, const CarPose& start, const CarPose& goal, double radius) {
    return reverses ? reeds_shepp_distance(start, goal, radius) : dubins_distance(start, goal, radius);
}

void list_poses(const CarPose& start, std::span<const double> pieces, double radius,
                std::span<const double> s, CarPose* out) {
    std::vector<Piece> parts(pieces.size() / 2);
    for (std::size_t i = 0; i < parts.size(); ++i)
        parts[i] = {int(pieces[2 * i]), pieces[2 * i + 1] / radius};
    const LaidCurve curve(start, std::move(parts), radius);
    visit_range(0, s.size(), [&](std::size_t k) { out[k] = curve.at(s[k] / radius); });
}

void check_poses(const maps::GridWorld& world, const double* f, std::span<const CarPose> poses,
                 bool* is_clear) {
    const CarWorld cars(world.state().bits, world.state().frame);
    InterruptPoll poll(64);
    for (const CarPose& pose : poses) {
        poll.step();
        *is_clear++ = cars.is_clear({f[0], f[1], f[2], f[3]}, pose);
    }
}

CarRoute find_car_route(const maps::GridWorld& world, const double* f, const CarPose& start,
                        const CarPose& goal, bool reverses, const double* s) {
    const HybridSettings how{s[0], reverses, s[1], int(s[2]), s[3], s[4], std::int64_t(s[5]), s[6]};
    const CarWorld cars(world.state().bits, world.state().frame);
    CarRoute route = HybridAStar(cars, {f[0], f[1], f[2], f[3]}, start, goal, how).find();
    for (Piece& piece : route.pieces) piece.length *= how.radius;
    return route;
}

}  // namespace cspace::navigation
