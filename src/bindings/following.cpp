// The simulator of vehicles that follow paths: plain checked numbers in, a table of what happened out.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/following/follow.hpp"

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

// vehicle (6,) and settings (6,) as in the headers; start (5,): x, y, theta, speed, turn.
nb::tuple run(Points points, std::vector<std::pair<std::size_t, int>> runs, Row vehicle, Row start,
              Row settings, int controller, Row numbers) {
    if (vehicle.size() != 6 || start.size() != 5 || settings.size() != 6 || numbers.size() < 2)
        throw nb::value_error("numbers of a vehicle, a start, settings and a controller");
    const Track track = track_of(points, runs);
    const double* v = vehicle.data();
    const double* s = settings.data();
    const double* b = start.data();
    const Vehicle body{v[0], v[1], v[2], v[3], v[4], v[5]};
    const FollowSettings how{s[0], s[1], s[2], s[3], s[4], s[5]};
    const Motion begin{{b[0], b[1], b[2]}, b[3], b[4]};
    const auto nothing = [](const CarPose&, double, double, double) { return false; };
    FollowRecord record;
    {
        nb::gil_scoped_release free;
        if (controller == 0) {
            PurePursuit pursuit{numbers.data()[0]};
            record = follow(body, begin, track, pursuit, how, nothing);
        } else {
            Stanley stanley{numbers.data()[0], numbers.data()[1]};
            record = follow(body, begin, track, stanley, how, nothing);
        }
    }
    return told(record);
}

}  // namespace

void bind_following(nb::module_& m) {
    m.def("_follow", run, "points"_a, "runs"_a, "vehicle"_a, "start"_a, "settings"_a, "controller"_a,
          "numbers"_a, "Lets a vehicle follow a path; the outcome and a row per step.");
}
