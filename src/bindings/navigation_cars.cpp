// Curves for cars, whether a car touches something on a grid, and hybrid A*: checked numbers in, filled
// arrays and pieces of curves out. One curve takes less than a microsecond, so it is a raw entry.
#include "library/navigation_cars.hpp"

#include <cmath>

#include "maps_points.hpp"
#include "navigation_route.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;
using cspace::maps::GridWorld;

namespace {

using PoseRow = Array<const double, nb::shape<3>>;
using Poses = Array<const double, nb::shape<-1, 3>>;
using PosesOut = Array<double, nb::shape<-1, 3>>;
using Pieces = Array<const double, nb::shape<-1, 2>>;
using FootprintRow = Array<const double, nb::shape<4>>;
using Flags = Array<bool, nb::ndim<1>>;

constexpr double largest = 1e12;  // LARGEST_NUMBER of the package

CarPose pose_of(const PoseRow& row) { return {row.data()[0], row.data()[1], row.data()[2]}; }
std::span<const CarPose> poses_of(const Poses& rows) {
    return {reinterpret_cast<const CarPose*>(rows.data()), rows.shape(0)};
}

bool read_pose(PyObject* value, double radius, CarPose& pose) {
    double row[3];
    if (!read_numbers(value, row, 3)) return false;
    pose = {row[0], row[1], row[2]};
    const double most = largest * std::min(radius, 1.0);
    return std::fabs(row[0]) <= most && std::fabs(row[1]) <= most && std::fabs(row[2]) <= largest;
}

struct Question {
    bool reverses;
    CarPose start, goal;
    double radius;

    bool read(PyObject* const* args, Py_ssize_t count) {
        if (count != 4 || !read_number(args[3], radius) || !(0 < radius && radius <= largest)) return false;
        reverses = args[0] == Py_True;
        return read_pose(args[1], radius, start) && read_pose(args[2], radius, goal);
    }
};

// _car_distance(reverses, start, goal, radius) → length [m], or None where they are no plain poses and
// radius.
PyObject* distance(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    if (!q.read(args, count)) Py_RETURN_NONE;
    return PyFloat_FromDouble(curve_length(q.reverses, q.start, q.goal, q.radius));
}

// _car_shortest(reverses, start, goal, radius) → (start, goal, radius, pieces), or None as above.
PyObject* shortest(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    if (!q.read(args, count)) Py_RETURN_NONE;
    const Curve curve = find_shortest_curve(q.reverses, q.start, q.goal, q.radius);
    PyObject* pieces = PyTuple_New(curve.count);
    if (!pieces) return nullptr;
    for (int k = 0; k < curve.count; ++k) {
        PyObject* piece = Py_BuildValue("(id)", curve.piece[k].turn, q.radius * curve.piece[k].length);
        if (!piece) return Py_DECREF(pieces), nullptr;
        PyTuple_SET_ITEM(pieces, k, piece);
    }
    return Py_BuildValue("(NNdN)", number_row(&q.start.x, 3), number_row(&q.goal.x, 3), q.radius, pieces);
}

PyMethodDef methods[] = {{"_car_distance", fast(distance), METH_FASTCALL, nullptr},
                         {"_car_shortest", fast(shortest), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

void distances(bool reverses, Poses starts, Poses goals, double radius, RowOut out) {
    if (starts.shape(0) != out.size() || goals.shape(0) != out.size())
        throw nb::value_error("starts, goals and out must have equal lengths");
    const nb::gil_scoped_release free;
    const auto from = poses_of(starts), to = poses_of(goals);
    for (std::size_t k = 0; k < out.size(); ++k)
        out.data()[k] = curve_length(reverses, from[k], to[k], radius);
}

void poses_along(PoseRow start, Pieces pieces, double radius, Row s, PosesOut out) {
    if (s.size() != out.shape(0)) throw nb::value_error("out must have one pose per length");
    const nb::gil_scoped_release free;
    list_poses(pose_of(start), {pieces.data(), pieces.size()}, radius, {s.data(), s.size()},
               reinterpret_cast<CarPose*>(out.data()));
}

void clear(const GridWorld& world, FootprintRow body, Poses poses, Flags out) {
    if (poses.shape(0) != out.shape(0)) throw nb::value_error("out must have one flag per pose");
    const nb::gil_scoped_release free;
    check_poses(world, body.data(), poses_of(poses), out.data());
}

// settings (7,): turning radius, box, headings, reverse cost, gear cost, most nodes, weight.
nb::tuple find(const GridWorld& world, FootprintRow body, PoseRow start, PoseRow goal, bool reverses,
               Array<const double, nb::shape<7>> settings) {
    const Watch watch;
    CarRoute found;
    {
        const nb::gil_scoped_release free;
        found = find_car_route(world, body.data(), pose_of(start), pose_of(goal), reverses, settings.data());
    }
    const double seconds = watch.seconds();
    nb::list pieces;
    for (const Piece& piece : found.pieces) pieces.append(nb::make_tuple(piece.turn, piece.length));
    return nb::make_tuple(int(found.status), int(found.reason), pieces, found.stats.nodes, found.stats.edges,
                          seconds);
}

}  // namespace

void bind_navigation_cars(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    m.def("_car_distances", distances, "reverses"_a, "starts"_a, "goals"_a, "radius"_a, "out"_a,
          "Lengths of Dubins or Reeds–Shepp curves between rows of poses, written into out.");
    m.def("_car_poses", poses_along, "start"_a, "pieces"_a, "radius"_a, "s"_a, "out"_a,
          "Poses at the lengths s along a curve, written into out.");
    m.def("_car_clear", clear, "grid"_a, "footprint"_a, "poses"_a, "out"_a,
          "Whether a vehicle touches no blocked cell at rows of poses.");
    m.def("_hybrid_a_star", find, "grid"_a, "footprint"_a, "start"_a, "goal"_a, "reverses"_a, "settings"_a,
          "Status, reason, pieces (turn, signed length), nodes, edges and seconds.");
}
