// Pose graphs that grow, for cspace.localization.
#include "library/localization_incremental.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <span>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;

namespace {

using Values = Array<const double>;
using ValuesOut = Array<double>;
using IdsIn = Array<const std::int64_t, nb::shape<-1, 2>>;
using FlagsIn = Array<const std::uint8_t, nb::ndim<1>>;

template <class Given>
auto read(const Given& given) {
    return std::span(given.data(), given.size());
}

auto list_arrays(const IncrementalSolver& solver) {
    IncrementalArrays found = solver.arrays();
    const auto table = [](auto& values) { return cspace::Table{std::move(values)}; };
    return std::make_tuple(table(found.edges), table(found.motions), table(found.information),
                           table(found.sightings), table(found.points), table(found.point_information),
                           table(found.has_bearing));
}

}  // namespace

void bind_localization_incremental(nb::module_& m) {
    nb::class_<IncrementalSolver>(m, "IncrementalSolver", "A pose graph that grows, and its estimate.")
        .def(nb::new_(&make_incremental_solver), "is_spatial"_a, "relinearize"_a, "substitute"_a)
        .def_prop_ro("is_spatial", &IncrementalSolver::is_spatial)
        .def(
            "hold_pose",
            [](IncrementalSolver& solver, std::int64_t id, const Values& pose) {
                solver.hold_pose(id, read(pose));
            },
            "id"_a, "pose"_a)
        .def(
            "add_edges",
            [](IncrementalSolver& solver, const IdsIn& ids, const Values& motions,
               const Values& information) { solver.add_edges(read(ids), read(motions), read(information)); },
            "ids"_a, "motions"_a, "information"_a)
        .def(
            "add_sightings",
            [](IncrementalSolver& solver, const IdsIn& ids, const Values& points, const Values& information,
               const FlagsIn& has_bearing) {
                solver.add_sightings(read(ids), read(points), read(information), read(has_bearing));
            },
            "ids"_a, "points"_a, "information"_a, "has_bearing"_a)
        .def("step", &IncrementalSolver::step, WithoutLock(), "False where the equations are singular.")
        .def(
            "restart",
            [](IncrementalSolver& solver, const Values& poses, const Values& landmarks) {
                return solver.restart(read(poses), read(landmarks));
            },
            "poses"_a, "landmarks"_a, WithoutLock(), "False where the equations are singular.")
        .def_prop_ro("pose_ids", &IncrementalSolver::pose_ids)
        .def_prop_ro("landmark_ids", &IncrementalSolver::landmark_ids)
        .def("find_pose", &IncrementalSolver::find_pose, "id"_a, "Its row; -1: none of this id.")
        .def("find_landmark", &IncrementalSolver::find_landmark, "id"_a, "Its row; -1: none of this id.")
        .def(
            "write_pose",
            [](const IncrementalSolver& solver, int row, const ValuesOut& out) {
                solver.write_pose(row, out.data());
            },
            "row"_a, "out"_a)
        .def(
            "write_state",
            [](const IncrementalSolver& solver, const ValuesOut& poses, const ValuesOut& landmarks) {
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
            [](IncrementalSolver& solver, bool is_pose, int first, int second, const ValuesOut& out) {
                return solver.write_covariance(is_pose, first, second, out.data());
            },
            "is_pose"_a, "first"_a, "second"_a, "out"_a, WithoutLock(), "False where singular.");
    m.def(
        "are_clearly_positive",
        [](const Values& matrices, int size) { return are_clearly_positive(read(matrices), size); },
        "matrices"_a, "size"_a,
        "Whether square matrices are symmetric and far from singular; where not, they need a closer look.");
}
