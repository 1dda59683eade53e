#include "navigation_cars.hpp"

#include <bit>
#include <stdexcept>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/cars/hybrid_a_star.hpp"
#include "cspace/navigation/curves/dubins.hpp"
#include "cspace/navigation/curves/reeds_shepp.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

namespace {

void require_equal(std::size_t one, std::size_t other) {
    if (one != other) throw std::invalid_argument("the arrays must have equal lengths");
}

}  // namespace

Curve find_shortest_curve(bool reverses, const CarPose& start, const CarPose& goal, double radius) {
    return reverses ? reeds_shepp_curve(start, goal, radius) : dubins_curve(start, goal, radius);
}
double curve_length(bool reverses, const CarPose& start, const CarPose& goal, double radius) {
    return reverses ? reeds_shepp_distance(start, goal, radius) : dubins_distance(start, goal, radius);
}
void list_lengths(bool reverses, std::span<const CarPose> starts, std::span<const CarPose> goals,
                  double radius, std::span<double> lengths) {
    require_equal(starts.size(), lengths.size());
    require_equal(goals.size(), lengths.size());
    visit_range(0, lengths.size(),
                [&](std::size_t k) { lengths[k] = curve_length(reverses, starts[k], goals[k], radius); });
}

void list_poses(const CarPose& start, std::span<const std::array<double, 2>> pieces, double radius,
                std::span<const double> s, std::span<CarPose> poses) {
    require_equal(s.size(), poses.size());
    std::vector<Piece> parts;
    for (const auto& [turn, length] : pieces) parts.push_back({int(turn), length / radius});
    const LaidCurve curve(start, std::move(parts), radius);
    visit_range(0, s.size(), [&](std::size_t k) { poses[k] = curve.at(s[k] / radius); });
}

void check_poses(const maps::GridWorld& world, const BodyNumbers& body, std::span<const CarPose> poses,
                 std::span<bool> is_clear) {
    require_equal(poses.size(), is_clear.size());
    const CarWorld cars(world.state().bits, world.state().frame);
    InterruptPoll poll(64);
    for (std::size_t k = 0; k < poses.size(); ++k) {
        poll.step();
        is_clear[k] = cars.is_clear(std::bit_cast<Footprint>(body), poses[k]);
    }
}

CarRoute find_car_route(const maps::GridWorld& world, const BodyNumbers& body, const CarPose& start,
                        const CarPose& goal, bool reverses, const std::array<double, 7>& s) {
    const HybridSettings how{s[0], reverses, s[1], int(s[2]), s[3], s[4], std::int64_t(s[5]), s[6]};
    const CarWorld cars(world.state().bits, world.state().frame);
    CarRoute route = HybridAStar(cars, std::bit_cast<Footprint>(body), start, goal, how).find();
    for (Piece& piece : route.pieces) piece.length *= how.radius;
    return route;
}

}  // namespace cspace::navigation
