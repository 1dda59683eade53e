// The simulator of vehicles that follow paths: plain checked numbers in, a table of what happened out.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/cars/car_world.hpp"
#include "cspace/navigation/following/dynamic_window.hpp"
#include "cspace/navigation/following/follow.hpp"
#include "maps_grid.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

constexpr std::size_t width = 7;  // x, y, theta, speed, turn, offset, progress
using Points = Array<const double, nb::shape<-1, 2>>;
using Table = nb::ndarray<nb::numpy, double, nb::shape<-1, width>, nb::c_contig>;

// Runs end where the next begins: first holds the row at which each begins.
Track track_of(const Points& points, const std::vector<std::pair<std::size_t, int>>& runs) {
    std::vector<Point> rows(points.shape(0));
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = {points.data()[2 * k], points.data()[2 * k + 1]};
    Track track;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const std::size_t first = runs[k].first,
                          end = k + 1 < runs.size() ? runs[k + 1].first : rows.size() - 1;
        if (end <= first || end >= rows.size()) throw nb::value_error("runs of two points or more");
        track.emplace_back(rows.data() + first, end - first + 1, runs[k].second);
    }
    if (track.empty()) throw nb::value_error("a run or more");
    return track;
}

nb::tuple told(const FollowRecord& record) {
    auto table = std::make_unique<std::vector<double>>();
    table->reserve(width * record.motion.size());
    for (std::size_t k = 0; k < record.motion.size(); ++k) {
        const Motion& m = record.motion[k];
        for (const double value :
             {m.pose.x, m.pose.y, m.pose.theta, m.speed, m.turn, record.offset[k], record.progress[k]})
            table->push_back(value);
    }
    double* data = table->data();
    nb::capsule owner(table.release(), [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return nb::make_tuple(int(record.outcome), Table(data, {record.motion.size(), width}, owner));
}

// The piece of a curve that a step at a speed and a turn rate drives, and its radius.
std::pair<Piece, double> arc_of(double speed, double rate, double time) {
    if (rate == 0) return {{0, speed * time}, 1.0};
    const double way = speed < 0 ? -std::fabs(rate) * time : std::fabs(rate) * time;
    return {{(rate < 0) == (speed < 0) ? 1 : -1, way}, std::fabs(speed / rate)};
}

// What every controller is let loose on.
struct Task {
    Vehicle vehicle;
    Motion start;
    Track track;
    FollowSettings settings;
    const GridWorld* world;
    Footprint footprint;

    template <class Controller>
    FollowRecord run(Controller controller) const {
        if (world == nullptr)
            return follow(vehicle, start, track, controller, settings,
                          [](const CarPose&, double, double, double) { return false; });
        const CarWorld cars(world->bits, world->frame);
        return follow(vehicle, start, track, controller, settings,
                      [&](const CarPose& from, double speed, double rate, double time) {
                          const auto [piece, radius] = arc_of(speed, rate, time);
                          return !cars.is_way_clear(footprint, from, piece, radius);
                      });
    }
};

// vehicle (6,) and settings (6,) as in the headers; start (5,): x, y, theta, speed, turn; footprint (4,).
// numbers: of pure pursuit (lookahead), of Stanley (gain, softening), of the dynamic window (7,) as there.
nb::tuple run(Points points, std::vector<std::pair<std::size_t, int>> runs, Row vehicle, Row start,
              Row settings, int controller, Row numbers, const GridWorld* world, Row footprint) {
    if (vehicle.size() != 6 || start.size() != 5 || settings.size() != 6 || numbers.size() != 7 ||
        footprint.size() != 4)
        throw nb::value_error("numbers of a vehicle, a start, settings, a controller and a footprint");
    const double *v = vehicle.data(), *s = settings.data(), *b = start.data(), *f = footprint.data();
    const double* n = numbers.data();
    const Task task{{v[0], v[1], v[2], v[3], v[4], v[5]},
                    {{b[0], b[1], b[2]}, b[3], b[4]},
                    track_of(points, runs),
                    {s[0], s[1], s[2], s[3], s[4], s[5]},
                    world,
                    {f[0], f[1], f[2], f[3]}};
    FollowRecord record;
    {
        nb::gil_scoped_release free;
        if (controller == 0) record = task.run(PurePursuit{n[0]});
        if (controller == 1) record = task.run(Stanley{n[0], n[1]});
        if (controller == 2)
            record = task.run(DynamicWindow(world ? &world->bits : nullptr,
                                            world ? world->frame : maps::GridFrame{},
                                            {n[0], n[1], n[2], int(n[3]), n[4], n[5], n[6]}));
    }
    return told(record);
}

void ranges(const GridWorld& world, Points from, Row angles, double most, RowOut out) {
    if (from.shape(0) != out.size() || angles.size() != out.size())
        throw nb::value_error("as many points, angles and ranges");
    nb::gil_scoped_release free;
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double angle = angles.data()[k];
        const Point point{from.data()[2 * k], from.data()[2 * k + 1]};
        out.data()[k] = cast_ray(world.bits, world.frame, point, {std::cos(angle), std::sin(angle)}, most);
    }
}

}  // namespace

void bind_navigation_following(nb::module_& m) {
    m.def("_follow", run, "points"_a, "runs"_a, "vehicle"_a, "start"_a, "settings"_a, "controller"_a,
          "numbers"_a, "world"_a.none(), "footprint"_a,
          "Lets a vehicle follow a path; the outcome and a row per step.");
    m.def("_cast_rays", ranges, "grid"_a, "points"_a, "angles"_a, "most"_a, "out"_a,
          "Ranges from rows of points at angles, written into out.");
}
