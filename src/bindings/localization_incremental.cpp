// Pose graphs that grow, for cspace.localization.
#include "library/localization_incremental.hpp"

#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <span>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;

namespace {

using Doubles = Array<const double>;
using DoublesOut = Array<double>;
using Ids = Array<const std::int64_t, nb::shape<-1, 2>>;
using Flags = Array<const std::uint8_t, nb::ndim<1>>;

template <class Given>
auto read(const Given& given) {
    return std::span(given.data(), given.size());
}

nb::tuple list_arrays(const IncrementalSolver& solver) {
    const IncrementalArrays found = solver.arrays();
    return nb::make_tuple(found.edges, found.motions, found.information, found.sightings, found.points,
                          found.point_information, found.has_bearing);
}

}  // namespace

void bind_localization_incremental(nb::module_& m) {
    nb::class_<IncrementalSolver>(m, "IncrementalSolver", "A pose graph that grows, and its estimate.")
        .def(nb::new_(&make_incremental_solver), "is_spatial"_a, "relinearize"_a, "substitute"_a)
        .def_prop_ro("is_spatial", &IncrementalSolver::is_spatial)
        .def(
            "hold_pose",
            [](IncrementalSolver& solver, std::int64_t id, const Doubles& pose) {
                solver.hold_pose(id, read(pose));
            },
            "id"_a, "pose"_a)
        .def(
            "add_edges",
            [](IncrementalSolver& solver, const Ids& ids, const Doubles& motions, const Doubles& information) {
                solver.add_edges(read(ids), read(motions), read(information));
            },
            "ids"_a, "motions"_a, "information"_a)
        .def(
            "add_sightings",
            [](IncrementalSolver& solver, const Ids& ids, const Doubles& points, const Doubles& information,
               const Flags& has_bearing) {
                solver.add_sightings(read(ids), read(points), read(information), read(has_bearing));
            },
            "ids"_a, "points"_a, "information"_a, "has_bearing"_a)
        .def("step", &IncrementalSolver::step, WithoutLock(), "False where the equations are singular.")
        .def(
            "restart",
            [](IncrementalSolver& solver, const Doubles& poses, const Doubles& landmarks) {
                return solver.restart(read(poses), read(landmarks));
            },
            "poses"_a, "landmarks"_a, WithoutLock(), "False where the equations are singular.")
        .def_prop_ro("pose_ids", &IncrementalSolver::pose_ids)
        .def_prop_ro("landmark_ids", &IncrementalSolver::landmark_ids)
        .def("find_pose", &IncrementalSolver::find_pose, "id"_a, "Its row; -1: none of this id.")
        .def("find_landmark", &IncrementalSolver::find_landmark, "id"_a, "Its row; -1: none of this id.")
        .def(
            "write_pose",
            [](const IncrementalSolver& solver, int row, const DoublesOut& out) {
                solver.write_pose(row, out.data());
            },
            "row"_a, "out"_a)
        .def(
            "write_state",
            [](const IncrementalSolver& solver, const DoublesOut& poses, const DoublesOut& landmarks) {
                solver.write_state(poses.data(), landmarks.data());
            },
            "poses"_a, "landmarks"_a)
        .def_prop_ro("waiting", &IncrementalSolver::waiting)
        .def_prop_ro("eliminated", &IncrementalSolver::eliminated)
        .def("cost", &IncrementalSolver::cost, WithoutLock())
        .def("arrays", &list_arrays,
             "Edges, motions, information, sightings, points, their information, and has_bearing, flat.")
        .def(
            "write_covariance",
            [](IncrementalSolver& solver, bool is_pose, int first, int second, const DoublesOut& out) {
                return solver.write_covariance(is_pose, first, second, out.data());
            },
            "is_pose"_a, "first"_a, "second"_a, "out"_a, WithoutLock(), "False where singular.");
    m.def(
        "are_clearly_positive",
        [](const Doubles& matrices, int size) { return are_clearly_positive(read(matrices), size); },
        "matrices"_a, "size"_a,
        "Whether square matrices are symmetric and far from singular; where not, they need a closer look.");
}
