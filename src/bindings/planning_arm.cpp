// The compiled half of cspace.planning: plans of arms.
#include "planning_arm.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::planning;

namespace {

ArmOptions read_options(bool proves_search, bool proves_answer, bool simplify, std::uint64_t seed,
                        std::int64_t edges, std::int64_t improve, double time_limit, double range,
                        double resolution) {
    const auto test = [](bool proves) { return proves ? EdgeTest::proved : EdgeTest::sampled; };
    ArmOptions options;
    options.search = test(proves_search), options.answer = test(proves_answer);
    options.simplify = simplify, options.seed = seed;
    options.edges = edges, options.improve = improve;
    options.time_limit = time_limit;
    options.range = float(range), options.resolution = float(resolution);
    return options;
}

NamedPlan plan_one(const collision::Checker& checker, const ConstDoubles& bounds, const Bytes& wraps,
                   const ConstDoubles& starts, const ConstDoubles& goals, const ArmOptions& options) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    const ArmProblem problem = {read_rows(checker, starts), read_rows(checker, goals)};
    const nb::gil_scoped_release release;
    return {plan_arm(space, problem, options), &checker, checker.dof()};
}

std::vector<NamedPlan> plan_each(const collision::Checker& checker, const ConstDoubles& bounds,
                                 const Bytes& wraps,
                                 const std::vector<std::pair<ConstDoubles, ConstDoubles>>& given,
                                 const ArmOptions& options, int threads) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    std::vector<ArmProblem> problems;
    for (const auto& [starts, goals] : given)
        problems.push_back({read_rows(checker, starts), read_rows(checker, goals)});
    const nb::gil_scoped_release release;
    std::vector<NamedPlan> plans;
    for (ArmPlan& plan : plan_arms(space, problems, options, threads))
        plans.push_back({std::move(plan), &checker, checker.dof()});
    return plans;
}

nb::dict stats_of(const NamedPlan& named) {
    const ArmStats& s = named.plan.stats;
    nb::dict stats;
    stats["samples"] = s.samples, stats["rejected"] = s.rejected, stats["edges"] = s.edges;
    stats["blocked"] = s.blocked, stats["blocks"] = s.blocks, stats["nodes"] = s.nodes;
    stats["removed"] = s.removed, stats["shortcuts"] = s.shortcuts, stats["proofs"] = s.proofs;
    stats["search_seconds"] = s.search_seconds, stats["simplify_seconds"] = s.simplify_seconds;
    stats["proof_seconds"] = s.proof_seconds, stats["improve_seconds"] = s.improve_seconds;
    stats["improvements"] = s.improvements, stats["expansions"] = s.expansions;
    return stats;
}

}  // namespace

void bind_planning_arm(nb::module_& m) {
    nb::class_<ArmOptions>(m, "ArmOptions", "Options of plans of arms.")
        .def(nb::new_(&read_options), "proves_search"_a, "proves_answer"_a, "simplify"_a, "seed"_a, "edges"_a,
             "improve"_a, "time_limit"_a, "range"_a, "resolution"_a);
    nb::class_<NamedPlan>(m, "ArmPlan", "A plan of an arm.")
        .def_prop_ro("status", [](const NamedPlan& p) { return int(p.plan.status); })
        .def_prop_ro("path", &NamedPlan::path, "The configurations (m, dof).")
        .def_prop_ro("cost", [](const NamedPlan& p) { return p.plan.cost; })
        .def_prop_ro("raw_cost", [](const NamedPlan& p) { return p.plan.raw_cost; })
        .def_prop_ro("start", [](const NamedPlan& p) { return p.plan.start; })
        .def_prop_ro("goal", [](const NamedPlan& p) { return p.plan.goal; })
        .def_prop_ro("certified", [](const NamedPlan& p) { return p.plan.certified; })
        .def_prop_ro("starts", [](const NamedPlan& p) { return p.name_rows(p.plan.starts); })
        .def_prop_ro("goals", [](const NamedPlan& p) { return p.name_rows(p.plan.goals); })
        .def_prop_ro("stats", &stats_of)
        .def_prop_ro(
            "approach",
            [](const NamedPlan& p) {
                const Approach& a = p.plan.approach;
                return std::tuple(a.distance, p.rows_of(a.from), p.rows_of(a.to));
            },
            "The least distance of the trees, and its ends (1, dof).")
        .def_prop_ro(
            "blocker",
            [](const NamedPlan& p) {
                return std::tuple(name_contact(*p.checker, p.plan.blocker), p.plan.blocker_edges);
            },
            "What blocked most edges, and how many.");
    m.def("plan_arm", &plan_one, "checker"_a, "bounds"_a, "wraps"_a, "starts"_a, "goals"_a, "options"_a,
          nb::keep_alive<0, 1>(), "From any of the starts (s, dof) to any of the goals (g, dof).");
    m.def("plan_arms", &plan_each, "checker"_a, "bounds"_a, "wraps"_a, "problems"_a, "options"_a, "threads"_a,
          "A plan per pair of starts and goals; the checker must outlive them.");
}
