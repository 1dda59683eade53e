// Curves for cars, hybrid A*, and the simulator of vehicles that follow paths. One curve takes less than a
// microsecond, so it is a raw entry.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>

#include "library/navigation_cars.hpp"
#include "library/navigation_following.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;
using cspace::maps::GridWorld;

template <>
struct nb::detail::type_caster<CarPose> : nb::detail::RowCaster<CarPose> {};

namespace {

constexpr double largest = 1e12;  // LARGEST_NUMBER of the package

bool read_pose(PyObject* value, double radius, CarPose& pose) {
    const double most = largest * std::min(radius, 1.0);
    return read_numbers(value, &pose.x, 3) && std::fabs(pose.x) <= most && std::fabs(pose.y) <= most &&
           std::fabs(pose.theta) <= largest;
}

struct CurveTask {
    CarPose start, goal;
    double radius;

    // False, without an error, for what is no plain pose or radius.
    bool read(PyObject* const* args) {
        return read_number(args[2], radius) && 0 < radius && radius <= largest &&
               read_pose(args[0], radius, start) && read_pose(args[1], radius, goal);
    }
};

bool has_arguments(Py_ssize_t count) {
    if (count != 5) PyErr_SetString(PyExc_TypeError, "reverses, start, goal, radius and a function");
    return count == 5;
}

// _car_distance(reverses, start, goal, radius, otherwise) → length [m], or what otherwise returns of the
// other arguments where they are no plain poses and radius.
PyObject* find_distance(PyObject*, PyObject* const* args, Py_ssize_t count) {
    CurveTask task;
    if (!has_arguments(count)) return nullptr;
    if (!task.read(args + 1)) return PyObject_Vectorcall(args[4], args, 4, nullptr);
    return PyFloat_FromDouble(curve_length(args[0] == Py_True, task.start, task.goal, task.radius));
}

// _car_shortest(reverses, start, goal, radius, check) → (start, goal, radius, pieces). check makes a tuple of
// plain ones from start, goal and radius, or raises.
PyObject* find_shortest(PyObject*, PyObject* const* args, Py_ssize_t count) {
    CurveTask task;
    if (!has_arguments(count)) return nullptr;
    if (!task.read(args + 1)) {
        const nb::object plain = nb::steal(PyObject_Vectorcall(args[4], args + 1, 3, nullptr));
        if (!plain) return nullptr;
        if (!PyTuple_Check(plain.ptr()) || nb::len(plain) != 3 ||
            !task.read(reinterpret_cast<PyTupleObject*>(plain.ptr())->ob_item))
            return PyErr_Format(PyExc_TypeError, "_car_shortest: the check must return plain poses");
    }
    const Curve curve = find_shortest_curve(args[0] == Py_True, task.start, task.goal, task.radius);
    PyObject* pieces = PyTuple_New(curve.count);
    if (!pieces) return nullptr;
    for (int k = 0; k < curve.count; ++k) {
        PyObject* piece = Py_BuildValue("(id)", curve.piece[k].turn, task.radius * curve.piece[k].length);
        if (!piece) return Py_DECREF(pieces), nullptr;
        PyTuple_SET_ITEM(pieces, k, piece);
    }
    return Py_BuildValue("(NNdN)", new_array({3}, &task.start.x), new_array({3}, &task.goal.x), task.radius,
                         pieces);
}

PyMethodDef methods[] = {{"_car_distance", as_method(find_distance), METH_FASTCALL, nullptr},
                         {"_car_shortest", as_method(find_shortest), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

std::pair<int, cspace::Table<FollowRow>> follow(
    std::span<const cspace::Point> points, const std::vector<FollowRun>& runs,
    const std::array<double, 6>& vehicle, const std::array<double, 5>& start,
    const std::array<double, 6>& settings, int controller, const std::array<double, 7>& numbers,
    const GridWorld* world, const std::array<double, 4>& footprint, const nb::object& belief) {
    Belief believe;
    if (!belief.is_none())
        believe = [&](double time, const CarPose& pose) {
            const nb::gil_scoped_acquire held;
            const auto [x, y, theta] =
                nb::cast<std::tuple<double, double, double>>(belief(time, pose.x, pose.y, pose.theta));
            return CarPose{x, y, theta};
        };
    const nb::gil_scoped_release release;
    return follow_path(points, runs, vehicle, start, settings, controller, numbers, world, footprint,
                       believe);
}

}  // namespace

void bind_navigation_vehicles(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    m.def("_car_distances", list_lengths, "reverses"_a, "starts"_a, "goals"_a, "radius"_a, WithoutLock(),
          "Lengths of Dubins or Reeds–Shepp curves between rows of poses.");
    m.def("_car_poses", list_poses, "start"_a, "pieces"_a, "radius"_a, "s"_a, WithoutLock(),
          "Poses at the lengths s along a curve.");
    m.def("_car_clear", is_pose_clear, "grid"_a, "footprint"_a, "pose"_a,
          "Whether a vehicle touches no blocked cell.");
    m.def("_hybrid_a_star", find_car_route, "grid"_a, "footprint"_a, "start"_a, "goal"_a, "reverses"_a,
          "settings"_a, WithoutLock(), "Status, reason, pieces (turn, signed length), nodes and edges.");
    m.def("_follow", follow, "points"_a, "runs"_a, "vehicle"_a, "start"_a, "settings"_a, "controller"_a,
          "numbers"_a, "world"_a.none(), "footprint"_a, "belief"_a.none(),
          "Lets a vehicle follow a path; the outcome and a row per step. belief(t, x, y, theta): where it "
          "takes "
          "itself to be, three numbers.");
}
