#include "navigation_following.hpp"

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/cars/car_world.hpp"
#include "cspace/navigation/following/dynamic_window.hpp"
#include "cspace/navigation/following/follow.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

namespace {

Track track_of(std::span<const Point> points, std::span<const FollowRun> runs) {
    Track track;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const std::size_t first = runs[k].first,
                          end = k + 1 < runs.size() ? runs[k + 1].first : points.size() - 1;
        if (end <= first || end >= points.size())
            throw std::invalid_argument("every run must have at least two points");
        track.emplace_back(points.data() + first, end - first + 1, runs[k].direction);
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

// What every controller is let loose on.
struct Course {
    Vehicle vehicle;
    Motion start;
    Track track;
    FollowSettings settings;
    const maps::GridWorld* world;
    Footprint footprint;

    template <class Controller>
    FollowRecord run(Controller controller) const {
        if (world == nullptr)
            return follow_track(vehicle, start, track, controller, settings,
                                [](const CarPose&, double, double, double) { return false; });
        const CarWorld cars(world->state().bits, world->state().frame);
        return follow_track(vehicle, start, track, controller, settings,
                            [&](const CarPose& from, double speed, double rate, double time) {
                                const auto [piece, radius] = arc_of(speed, rate, time);
                                return !cars.is_way_clear(footprint, from, piece, radius);
                            });
    }
};

}  // namespace

int follow_path(std::span<const Point> points, std::span<const FollowRun> runs, const FollowTask& task,
                std::vector<double>& rows) {
    const double *v = task.vehicle, *s = task.settings, *b = task.start, *f = task.footprint;
    const double* n = task.numbers;
    const Course course{{v[0], v[1], v[2], v[3], v[4], v[5]},
                        {{b[0], b[1], b[2]}, b[3], b[4]},
                        track_of(points, runs),
                        {s[0], s[1], s[2], s[3], s[4], s[5]},
                        task.world,
                        {f[0], f[1], f[2], f[3]}};
    const maps::BitGrid* grid = task.world ? &task.world->state().bits : nullptr;
    const maps::GridFrame frame = task.world ? task.world->state().frame : maps::GridFrame{};
    FollowRecord record;
    if (task.controller == 0) record = course.run(PurePursuit{n[0]});
    if (task.controller == 1) record = course.run(Stanley{n[0], n[1]});
    if (task.controller == 2)
        record = course.run(DynamicWindow(grid, frame, {n[0], n[1], n[2], int(n[3]), n[4], n[5], n[6]}));
    rows.reserve(follow_width * record.motion.size());
    for (std::size_t k = 0; k < record.motion.size(); ++k) {
        const Motion& m = record.motion[k];
        rows.insert(rows.end(), {m.pose.x, m.pose.y, m.pose.theta, m.speed, m.turn, record.offset[k],
                                 record.progress[k]});
    }
    return int(record.outcome);
}

void cast_rays(const maps::GridWorld& world, std::span<const Point> from, const double* angles, double most,
               double* ranges) {
    const auto& [bits, frame, parts] = world.state();
    InterruptPoll poll(64);
    for (const Point point : from) {
        poll.step();
        const double angle = *angles++;
        *ranges++ = cast_ray(bits, frame, point, {std::cos(angle), std::sin(angle)}, most);
    }
}

}  // namespace cspace::navigation
