// Pose graphs, for cspace.localization.
#include "library/localization_graph.hpp"

#include <nanobind/stl/tuple.h>
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
using Flags = Array<const std::uint8_t, nb::ndim<1>>;
using Pairs = Array<const std::int32_t, nb::shape<-1, 2>>;
using DoublesOut = Array<double>;

template <class Given>
auto read(const Given& given) {
    return std::span(given.data(), given.size());
}
std::unique_ptr<GraphSolver> make_solver(bool is_spatial, const Doubles& poses, const Doubles& landmarks,
                                         const Pairs& edges, const Doubles& motions,
                                         const Doubles& information, const Pairs& sightings,
                                         const Doubles& points, const Doubles& point_information,
                                         const Flags& has_bearing, const Flags& is_held,
                                         const Flags& is_landmark_held, const Flags& is_trusted,
                                         const Flags& is_sighting_trusted) {
    return make_graph_solver({is_spatial, read(poses), read(landmarks), read(edges), read(motions),
                              read(information), read(sightings), read(points), read(point_information),
                              read(has_bearing), read(is_held), read(is_landmark_held), read(is_trusted),
                              read(is_sighting_trusted)});
}

int optimize(GraphSolver& solver, int method, int residual, int start, int false_loops, int kernel,
             double width, int most_iterations, double least_step, double least_decrease) {
    SolveRule rule;
    rule.options = {GraphMethod(method), ResidualKind(residual), most_iterations, least_step, least_decrease};
    rule.start = GraphStart(start), rule.false_loops = FalseLoops(false_loops);
    rule.kernel = RobustKernel(kernel), rule.width = width;
    return int(solver.optimize(rule));
}

}  // namespace

void bind_localization_graph(nb::module_& m) {
    nb::class_<GraphSolver>(m, "GraphSolver", "A pose graph and the state of least cost found so far.")
        .def(nb::new_(&make_solver), "is_spatial"_a, "poses"_a, "landmarks"_a, "edges"_a, "motions"_a,
             "information"_a, "sightings"_a, "points"_a, "point_information"_a, "has_bearing"_a, "is_held"_a,
             "is_landmark_held"_a, "is_trusted"_a, "is_sighting_trusted"_a)
        .def("optimize", &optimize, "method"_a, "residual"_a, "start"_a, "false_loops"_a, "kernel"_a,
             "width"_a, "most_iterations"_a, "least_step"_a, "least_decrease"_a, WithoutLock(),
             "0: converged, 1: stopped, 2: singular.")
        .def(
            "write_state",
            [](const GraphSolver& solver, const DoublesOut& poses, const DoublesOut& landmarks) {
                solver.write_poses(poses.data());
                solver.write_landmarks(landmarks.data());
            },
            "poses"_a, "landmarks"_a, "Writes the state of least cost.")
        .def_prop_ro("found_start", &GraphSolver::found_start)
        .def_prop_ro("squares", &GraphSolver::squares)
        .def_prop_ro("used",
                     [](const GraphSolver& solver) {
                         const auto used = solver.used();
                         return std::vector<bool>(used.begin(), used.end());
                     })
        .def_prop_ro("limit_scale", &GraphSolver::limit_scale)
        .def_prop_ro("singular_variable", &GraphSolver::singular_variable)
        .def_prop_ro("stats",
                     [](const GraphSolver& solver) {
                         const GraphStats& stats = solver.stats();
                         return std::make_tuple(stats.iterations, stats.factorizations, stats.analyses,
                                                stats.costs);
                     })
        .def(
            "write_covariances",
            [](GraphSolver& solver, const Pairs& pairs, const DoublesOut& out) {
                return solver.write_covariances(read(pairs), out.data());
            },
            "pairs"_a, "out"_a, WithoutLock(),
            "Writes the blocks of pairs of variables; False where singular.")
        .def_prop_ro("anisotropic_measurement", &GraphSolver::anisotropic_measurement)
        .def(
            "certify",
            [](const GraphSolver& solver) {
                const CertificateResult found = solver.certify();
                return std::make_tuple(found.is_proved, found.bound, found.cost);
            },
            WithoutLock(), "Whether the dual has a proof, the bound of chi2, and the cost of the optimum next to that proved.");
    m.def(
        "find_graph_parts",
        [](std::size_t poses, std::size_t landmarks, const Pairs& edges, const Pairs& sightings) {
            return find_graph_parts(poses, landmarks, read(edges), read(sightings));
        },
        "poses"_a, "landmarks"_a, "edges"_a, "sightings"_a, WithoutLock(),
        "The connected part of each pose, then of each landmark.");
}
