#include "navigation_following.hpp"

#include <bit>

#include "cspace/navigation/cars/car_world.hpp"
#include "cspace/navigation/following/dynamic_window.hpp"
#include "cspace/navigation/following/follow.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

namespace {

Track track_of(std::span<const Point> points, const std::vector<FollowRun>& runs) {
    Track track;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const auto& [first, direction] = runs[k];
        const std::size_t end = k + 1 < runs.size() ? runs[k + 1].first : points.size() - 1;
        if (end <= first || end >= points.size())
            throw std::invalid_argument("every run must have at least two points");
        track.emplace_back(points.data() + first, end - first + 1, direction);
    }
    if (track.empty()) throw std::invalid_argument("the track must have at least one run");
    return track;
}

// The piece of a curve that a step at a speed and a turn rate drives, and its radius.
std::pair<Piece, double> arc_of(double speed, double rate, double time) {
    if (rate == 0) return {{0, speed * time}, 1.0};
    const double way = speed < 0 ? -std::fabs(rate) * time : std::fabs(rate) * time;
    return {{(rate < 0) == (speed < 0) ? 1 : -1, way}, std::fabs(speed / rate)};
}

}  // namespace

std::pair<int, Table<FollowRow>> follow_path(std::span<const Point> points,
                                             const std::vector<FollowRun>& runs,
                                             const std::array<double, 6>& vehicle,
                                             const std::array<double, 5>& start,
                                             const std::array<double, 6>& settings, int controller,
                                             const std::array<double, 7>& n, const maps::GridWorld* world,
                                             const std::array<double, 4>& footprint, const Belief& belief) {
    const Track track = track_of(points, runs);
    const maps::BitGrid* grid = world ? &world->state().bits : nullptr;
    const maps::GridFrame frame = world ? world->state().frame : maps::GridFrame{};
    const auto touches = [&](const CarPose& from, double speed, double rate, double time) {
        const auto [piece, radius] = arc_of(speed, rate, time);
        return grid &&
               !CarWorld(*grid, frame).is_way_clear(std::bit_cast<Footprint>(footprint), from, piece, radius);
    };
    const auto run = [&](auto steering) {
        const auto believe = [&](double time, const CarPose& pose) {
            return belief ? belief(time, pose) : pose;
        };
        return follow_track(std::bit_cast<Vehicle>(vehicle), std::bit_cast<Motion>(start), track, steering,
                            std::bit_cast<FollowSettings>(settings), touches, believe);
    };
    FollowRecord record;
    if (controller == 0) record = run(PurePursuit{n[0], n[1]});
    if (controller == 1) record = run(Stanley{n[0], n[1]});
    if (controller == 2)
        record = run(DynamicWindow(grid, frame, {n[0], n[1], n[2], int(n[3]), n[4], n[5], n[6]}));
    Table<FollowRow> rows;
    for (const FollowStep& step : record.steps) rows.values.push_back(std::bit_cast<FollowRow>(step));
    return {int(record.outcome), std::move(rows)};
}

}  // namespace cspace::navigation
