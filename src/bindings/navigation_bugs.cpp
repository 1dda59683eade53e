// Robots in a polygon world that follow walls, as raw entries.
#include "navigation_bugs.hpp"

#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

enum Kind { bug_1_kind, bug_2_kind, tangent_bug_kind };
enum Word : std::int8_t { go_word, hit_word, follow_word, leave_word };

// Options: kind, hand (0 left, 1 right, 2 either), range.
struct WallFollower {
    using Answer = Trip;
    static constexpr int options = 3;
    int kind, hand;
    double range;

    bool read(PyObject* const* args) {
        kind = int(PyLong_AsLong(args[0]));
        hand = int(PyLong_AsLong(args[1]));
        range = PyFloat_AsDouble(args[2]);
        return !PyErr_Occurred();
    }

    Trip answer(const PolygonCore& core, Point start, Point goal) const {
        const nanobind::gil_scoped_release free;
        const Hand side = hand == 0 ? Hand::left : Hand::right;
        if (kind == tangent_bug_kind) {
            RangeRobot robot(*core.felt, start, range);
            return tangent_bug(robot, goal, hand == 2 ? std::optional<Hand>() : side);
        }
        ContactRobot robot(*core.felt, start);
        return kind == bug_1_kind ? bug_1(robot, goal, side) : bug_2(robot, goal, side);
    }

    // What the walk was made of, in its order: straight ways between stretches along walls.
    static Trace trace(const Trip& trip, Point goal) {
        Trace events;
        const std::vector<Point>& path = trip.route.path;
        std::size_t at = 0;
        const auto steps = [&](std::int8_t word, std::size_t end) {
            for (double walked = 0; at < end; ++at) {
                walked += distance(path[at], path[at + 1]);
                events.push_back({word, path[at], path[at + 1],
                                  word == follow_word ? walked : distance(path[at + 1], goal)});
            }
        };
        const auto point = [&](std::int8_t word) {
            events.push_back({word, path[at], path[at], distance(path[at], goal)});
        };
        for (const Follow& follow : trip.follows) {
            steps(go_word, follow.first);
            point(hit_word);
            steps(follow_word, follow.last);
            point(leave_word);
        }
        steps(go_word, path.size() - 1);
        return events;
    }

    // hits, leaves, walked, rings, shut
    static PyObject* evidence(const Trip& trip, const Walls& walls) {
        std::vector<double> hits, leaves, walked;
        std::vector<std::int64_t> rings;
        for (const Follow& f : trip.follows) {
            const Point hit = trip.route.path[f.first], leave = trip.route.path[f.last];
            hits.insert(hits.end(), {hit.x, hit.y});
            leaves.insert(leaves.end(), {leave.x, leave.y});
            walked.push_back(f.walked);
            rings.push_back(walls.ring(f.hit.in.name));
        }
        return Py_BuildValue("(NNNNN)", rows(hits, 2, NPY_DOUBLE), rows(leaves, 2, NPY_DOUBLE),
                             rows(walked, 1, NPY_DOUBLE), rows(rings, 1, NPY_INT64), shut_of(trip, walls));
    }
};

// _bug(world, planner, options, evidence, core, kind, hand, range, start, goal)
PyMethodDef methods[] = {{"_bug", fast(Walk<WallFollower>::route), METH_FASTCALL, nullptr},
                         {"_bug_trace", fast(Walk<WallFollower>::trace), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_bugs(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
