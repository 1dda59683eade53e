// The compiled half of cspace.planning: grids and artificial potentials of arms.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "library/planning_arm_field.hpp"
#include "library/planning_arm_grid.hpp"
#include "planning_arm.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::planning;

namespace {

using collision::Checker;

// The descent of a plan, and the checker whose numbers its contacts have.
struct NamedRest {
    FieldRest rest;
    const Checker* checker;
    int dof;

    Doubles rows() const { return Doubles({npy_intp(rest.values.size()), dof}, rest.rows.data()); }
    Doubles values() const { return Doubles({npy_intp(rest.values.size())}, rest.values.data()); }
    std::vector<std::tuple<std::optional<NamedContact>, double, double>> pushes() const {
        std::vector<std::tuple<std::optional<NamedContact>, double, double>> named;
        for (const Push& each : rest.pushes)
            named.emplace_back(name_contact(*checker, each.contact), each.force, each.rho);
        return named;
    }
};
using NamedFieldPlan = std::pair<NamedPlan, NamedRest>;

NamedPlan name_plan(ArmPlan&& plan, const Checker& checker) {
    return {std::move(plan), &checker, checker.dof()};
}
NamedFieldPlan name_plan(FieldPlan&& plan, const Checker& checker) {
    return {{std::move(plan.plan), &checker, checker.dof()}, {std::move(plan.rest), &checker, checker.dof()}};
}

// plan(space, problem) without the lock of the interpreter.
template <class Plan>
auto plan_one(const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps,
              const ConstDoubles& starts, const ConstDoubles& goals, const Plan& plan) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    const ArmProblem problem = {read_rows(checker, starts), read_rows(checker, goals)};
    const nb::gil_scoped_release release;
    return name_plan(plan(space, problem), checker);
}
// plan(space, problems) without the lock of the interpreter.
template <class Plan>
auto plan_each(const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps,
               const GivenProblems& given, const Plan& plan) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    const auto problems = given.read(checker);
    const nb::gil_scoped_release release;
    return plan(space, problems);
}
std::pair<NamedPlans, std::vector<NamedRest>> split_plans(std::vector<FieldPlan> plans,
                                                          const Checker& checker) {
    std::pair<NamedPlans, std::vector<NamedRest>> named;
    named.first.checker = &checker, named.first.dof = checker.dof();
    for (FieldPlan& each : plans) {
        named.first.plans.push_back(std::move(each.plan));
        named.second.push_back({std::move(each.rest), &checker, checker.dof()});
    }
    return named;
}

GridRule read_grid_rule(const Plain<const std::int32_t>& cells, int order, int reach, double weight,
                        bool has_potential, double scale, double k_r, double rho_0, double cap) {
    GridRule rule;
    rule.cells.assign(cells.data, cells.data + cells.size);
    rule.order = order, rule.reach = reach, rule.weight = weight, rule.has_potential = has_potential;
    rule.scale = scale, rule.k_r = k_r, rule.rho_0 = rho_0, rule.cap = cap;
    return rule;
}
FieldRule read_field_rule(double k, double k_r, double rho_0, double cone, double rho_links, double step,
                          std::int64_t looks) {
    return {k, k_r, rho_0, rho_links, cone, step, looks};
}

std::pair<Doubles, Doubles> evaluate(const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps,
                                     const ConstDoubles& goals, const FieldRule& rule,
                                     const ConstDoubles& q) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    const auto rows = read_rows(checker, q), targets = read_rows(checker, goals);
    Doubles values({q.shape(0)}), gradients({q.shape(0), q.shape(1)});
    const nb::gil_scoped_release release;
    evaluate_potential(space, targets, rule, rows, values.data, gradients.data);
    return {values, gradients};
}

}  // namespace

void bind_planning_fields(nb::module_& m) {
    nb::class_<GridRule>(m, "GridRule", "Options of a search over a grid of configurations.")
        .def(nb::new_(&read_grid_rule), "cells"_a, "order"_a, "reach"_a, "weight"_a, "has_potential"_a,
             "scale"_a, "k_r"_a, "rho_0"_a, "cap"_a);
    nb::class_<FieldRule>(m, "FieldRule", "Options of a descent of a potential.")
        .def(nb::new_(&read_field_rule), "k"_a, "k_r"_a, "rho_0"_a, "cone"_a, "rho_links"_a, "step"_a,
             "looks"_a);
    nb::class_<NamedRest>(m, "FieldRest", "How a descent ended.")
        .def_prop_ro("kind", [](const NamedRest& r) { return r.rest.kind; })
        .def_prop_ro("rows", &NamedRest::rows, "The configurations of the descent (m, dof).")
        .def_prop_ro("values", &NamedRest::values, "Their potentials (m,).")
        .def_prop_ro("force", [](const NamedRest& r) { return r.rest.force; })
        .def_prop_ro("distance", [](const NamedRest& r) { return r.rest.distance; })
        .def_prop_ro("saddles", [](const NamedRest& r) { return r.rest.saddles; })
        .def_prop_ro("pushes", &NamedRest::pushes, "What repels: the contact, the force, the distance.");
    m.def(
        "plan_on_grid",
        [](const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps, const ConstDoubles& starts,
           const ConstDoubles& goals, const ArmOptions& options, const GridRule& rule) {
            return plan_one(checker, bounds, wraps, starts, goals,
                            [&](const ArmSpace& space, const ArmProblem& problem) {
                                return plan_on_grid(space, problem, options, rule);
                            });
        },
        "checker"_a, "bounds"_a, "wraps"_a, "starts"_a, "goals"_a, "options"_a, "rule"_a,
        nb::keep_alive<0, 1>(), "See plan_arm.");
    m.def(
        "plan_each_on_grid",
        [](const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps, const GivenProblems& given,
           const ArmOptions& options, const GridRule& rule, int threads) {
            auto plans =
                plan_each(checker, bounds, wraps, given, [&](const ArmSpace& space, const auto& problems) {
                    return plan_each_on_grid(space, problems, options, rule, threads);
                });
            return NamedPlans{std::move(plans), &checker, checker.dof()};
        },
        "checker"_a, "bounds"_a, "wraps"_a, "problems"_a, "options"_a, "rule"_a, "threads"_a,
        nb::keep_alive<0, 1>(), "See plan_arms.");
    m.def(
        "plan_by_field",
        [](const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps, const ConstDoubles& starts,
           const ConstDoubles& goals, const ArmOptions& options, const FieldRule& rule) {
            return plan_one(checker, bounds, wraps, starts, goals,
                            [&](const ArmSpace& space, const ArmProblem& problem) {
                                return plan_by_field(space, problem, options, rule);
                            });
        },
        "checker"_a, "bounds"_a, "wraps"_a, "starts"_a, "goals"_a, "options"_a, "rule"_a,
        "A plan and how the descent ended; the checker must outlive them.");
    m.def(
        "plan_each_by_field",
        [](const Checker& checker, const ConstDoubles& bounds, const Bytes& wraps, const GivenProblems& given,
           const ArmOptions& options, const FieldRule& rule, int threads) {
            return split_plans(plan_each(checker, bounds, wraps, given,
                                         [&](const ArmSpace& space, const auto& problems) {
                                             return plan_each_by_field(space, problems, options, rule,
                                                                       threads);
                                         }),
                               checker);
        },
        "checker"_a, "bounds"_a, "wraps"_a, "problems"_a, "options"_a, "rule"_a, "threads"_a,
        "The plans, and how the descent of each ended; the checker must outlive them.");
    m.def("evaluate_potential", &evaluate, "checker"_a, "bounds"_a, "wraps"_a, "goals"_a, "rule"_a, "q"_a,
          "The potentials (n,) of goals (g, dof) at q (n, dof), and their gradients (n, dof).");
    m.def("find_reach", &find_reach, "checker"_a,
          "The farthest that a sphere may be from the axis of a joint that moves it [m].");
}
