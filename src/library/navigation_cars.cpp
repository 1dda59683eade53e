#include "navigation_cars.hpp"

#include <bit>
#include <stdexcept>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/cars/hybrid_a_star.hpp"
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
Table<double> list_lengths(bool reverses, std::span<const CarPose> starts, std::span<const CarPose> goals,
                           double radius) {
    if (starts.size() != goals.size()) throw std::invalid_argument("as many starts as goals are needed");
    Table<double> lengths;
    visit_range(0, starts.size(), [&](std::size_t k) {
        lengths.values.push_back(curve_length(reverses, starts[k], goals[k], radius));
    });
    return lengths;
}

Table<CarPose> list_poses(const CarPose& start, std::span<const std::array<double, 2>> pieces, double radius,
                          std::span<const double> s) {
    std::vector<Piece> parts;
    for (const auto& [turn, length] : pieces) parts.push_back({int(turn), length / radius});
    const LaidCurve curve(start, std::move(parts), radius);
    Table<CarPose> poses;
    visit_range(0, s.size(), [&](std::size_t k) { poses.values.push_back(curve.at(s[k] / radius)); });
    return poses;
}

bool is_pose_clear(const maps::GridWorld& world, const BodyNumbers& body, const CarPose& pose) {
    const CarWorld cars(world.state().bits, world.state().frame);
    return cars.is_clear(std::bit_cast<Footprint>(body), pose);
}

std::tuple<int, int, std::vector<std::pair<int, double>>, std::int64_t, std::int64_t> find_car_route(
    const maps::GridWorld& world, const BodyNumbers& body, const CarPose& start, const CarPose& goal,
    bool reverses, const std::array<double, 7>& s) {
    const HybridSettings how{s[0], reverses, s[1], int(s[2]), s[3], s[4], std::int64_t(s[5]), s[6]};
    const CarWorld cars(world.state().bits, world.state().frame);
    const CarRoute route = HybridAStar(cars, std::bit_cast<Footprint>(body), start, goal, how).find();
    std::vector<std::pair<int, double>> pieces;
    for (const Piece& piece : route.pieces) pieces.emplace_back(piece.turn, how.radius * piece.length);
    return {int(route.status), int(route.reason), std::move(pieces), route.stats.nodes, route.stats.edges};
}

}  // namespace cspace::navigation
