// The compiled half of cspace.planning: plans of arms.
#include "planning_arm.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "library/planning_arm_roadmap.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::planning;

namespace {

// Numbers of a list or tuple of rows of equal length, one below the other; an array of no size for others.
Doubles read_nested_rows(PyObject* value, npy_intp width) {
    const bool is_sequence = PyList_CheckExact(value) || PyTuple_CheckExact(value);
    const Py_ssize_t n = is_sequence ? PySequence_Fast_GET_SIZE(value) : 0;
    Doubles rows({n, width});
    for (Py_ssize_t i = 0; i < n; ++i) {
        double* const row = rows.data + i * width;
        const double* numbers = read_in_place(PySequence_Fast_ITEMS(value)[i], 0, width, row);
        if (!numbers) return Doubles({0, width});
        if (numbers != row) std::copy_n(numbers, width, row);
    }
    return rows;
}
// One configuration (dof,) or several (n, dof) as rows, n > 0, of numbers that are finite and not beyond
// ±largest. None for everything else, which Python converts or names.
std::optional<ConstDoubles> as_rows(nb::handle value, int dof, double largest) {
    ConstDoubles rows;
    const npy_intp width = dof;
    if (PyArray_CheckExact(value.ptr())) {
        if (!rows.read(value.ptr()) || rows.ndim() < 1 || rows.ndim() > 2 ||
            rows.shape(rows.ndim() - 1) != width)
            return std::nullopt;
        if (rows.ndim() == 1) rows.read(Doubles({1, width}, rows.data).array.ptr());
    } else {
        Doubles one({1, width});
        const bool is_one = read_sequence(value.ptr(), width, one.data);
        rows.read((is_one ? one : read_nested_rows(value.ptr(), width)).array.ptr());
    }
    const bool all_fit = std::all_of(rows.data, rows.data + rows.size,
                                     [&](double number) { return std::fabs(number) <= largest; });
    return all_fit && rows.size > 0 ? std::optional(rows) : std::nullopt;
}

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

// More: options of the planner itself.
template <class... More>
NamedPlan plan_one(const collision::Checker& checker, const ConstDoubles& bounds, const Bytes& wraps,
                   const ConstDoubles& starts, const ConstDoubles& goals, const ArmOptions& options,
                   const More&... more) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    const ArmProblem problem = {read_rows(checker, starts), read_rows(checker, goals)};
    const nb::gil_scoped_release release;
    return {plan_arm(space, problem, options, more...), &checker, checker.dof()};
}

template <class... More>
NamedPlans plan_each(const collision::Checker& checker, const ConstDoubles& bounds, const Bytes& wraps,
                     const GivenProblems& given, const ArmOptions& options, int threads,
                     const More&... more) {
    const ArmSpace space = read_space(checker, bounds, wraps);
    const auto problems = given.read(checker);
    const nb::gil_scoped_release release;
    return {plan_arms(space, problems, options, threads, more...), &checker, checker.dof()};
}

std::shared_ptr<ArmRoadmap> make_roadmap(const collision::Checker& checker, const ConstDoubles& bounds,
                                         const Bytes& wraps, std::int64_t samples, int neighbours,
                                         std::uint64_t seed, const ArmRoadmap* part, int threads) {
    const ArmSpace robot = read_space(checker, bounds, wraps);
    const nb::gil_scoped_release release;
    return std::make_shared<ArmRoadmap>(robot, RoadmapRule{samples, neighbours, seed}, part, threads);
}
std::shared_ptr<ArmRoadmap> restore_roadmap(const collision::Checker& checker, const ConstDoubles& bounds,
                                            const Bytes& wraps, std::int64_t samples, int neighbours,
                                            std::uint64_t seed, const ConstDoubles& nodes,
                                            const Plain<const std::int32_t>& edges) {
    const ArmSpace robot = read_space(checker, bounds, wraps);
    const std::span<const double> rows = read_rows(checker, nodes);
    require(edges.ndim() == 2 && edges.shape(1) == 2, "edges must be an array (e, 2)");
    const std::span<const std::int32_t> pairs = {edges.data, std::size_t(edges.size)};
    const nb::gil_scoped_release release;
    return std::make_shared<ArmRoadmap>(robot, RoadmapRule{samples, neighbours, seed}, rows, pairs);
}
NamedPlan plan_one_on_roadmap(const RoadmapWorld& world, const ConstDoubles& bounds, const Bytes& wraps,
                              const ConstDoubles& starts, const ConstDoubles& goals,
                              const ArmOptions& options, bool is_lazy) {
    const collision::Checker& checker = world.checker();
    const ArmSpace space = read_space(checker, bounds, wraps);
    const ArmProblem problem = {read_rows(checker, starts), read_rows(checker, goals)};
    const nb::gil_scoped_release release;
    return {plan_on_roadmap(space, problem, options, world, is_lazy), &checker, checker.dof()};
}
NamedPlans plan_all_on_roadmap(const RoadmapWorld& world, const ConstDoubles& bounds, const Bytes& wraps,
                               const GivenProblems& given, const ArmOptions& options, bool is_lazy,
                               int threads) {
    const collision::Checker& checker = world.checker();
    const ArmSpace space = read_space(checker, bounds, wraps);
    const auto problems = given.read(checker);
    const nb::gil_scoped_release release;
    return {plan_each_on_roadmap(space, problems, options, world, is_lazy, threads), &checker, checker.dof()};
}

// Writes numbers to a dict under names that are made once.
template <class... Values>
void set_named(nb::dict& dict, PyObject* const* names, const Values&... values) {
    std::size_t k = 0;
    (PyDict_SetItem(dict.ptr(), names[k++], nb::cast(values).ptr()), ...);
}
template <std::size_t n>
std::array<PyObject*, n> intern_names(const char* const (&names)[n]) {
    std::array<PyObject*, n> made;
    std::transform(names, names + n, made.begin(), PyUnicode_InternFromString);
    return made;
}

nb::dict stats_of(const NamedPlan& named) {
    static const auto names =
        intern_names({"samples", "rejected", "edges", "blocked", "blocks", "nodes", "removed", "shortcuts",
                      "proofs", "search_seconds", "simplify_seconds", "proof_seconds", "improve_seconds",
                      "improvements", "expansions"});
    const ArmStats& s = named.plan.stats;
    nb::dict stats;
    set_named(stats, names.data(), s.samples, s.rejected, s.edges, s.blocked, s.blocks, s.nodes, s.removed,
              s.shortcuts, s.proofs, s.search_seconds, s.simplify_seconds, s.proof_seconds, s.improve_seconds,
              s.improvements, s.expansions);
    if (named.plan.status == PlanStatus::disconnected)
        stats["start_nodes"] = s.start_nodes, stats["goal_nodes"] = s.goal_nodes;
    return stats;
}

// Rows of one problem each, one below the other, as spans.
std::vector<std::span<const double>> split_rows(const std::vector<double>& rows, npy_intp width,
                                                const std::optional<Integers>& counts) {
    const std::size_t n = std::size_t(width);
    std::vector<std::span<const double>> parts;
    if (!counts) {
        for (std::size_t at = 0; at < rows.size(); at += n) parts.push_back({&rows[at], n});
        return parts;
    }
    std::size_t at = 0;
    for (npy_intp k = 0; k < counts->size; ++k) {
        const std::int64_t count = counts->data[k];
        require(count > 0 && std::size_t(count) <= (rows.size() - at) / n,
                "each problem has one row at least, and all together as many as there are");
        parts.push_back({&rows[at], n * std::size_t(count)});
        at += parts.back().size();
    }
    require(at == rows.size(), "each row is that of a problem");
    return parts;
}

}  // namespace

GivenProblems::GivenProblems(const ConstDoubles& starts, const std::optional<Integers>& start_counts,
                             const ConstDoubles& goals, const std::optional<Integers>& goal_counts,
                             const std::optional<ConstDoubles>& time_limits) {
    require(
        starts.ndim() == 2 && goals.ndim() == 2 && starts.shape(1) > 0 && starts.shape(1) == goals.shape(1),
        "starts and goals must be arrays (n, dof)");
    width_ = starts.shape(1);
    starts_.assign(starts.data, starts.data + starts.size);
    goals_.assign(goals.data, goals.data + goals.size);
    const auto from = split_rows(starts_, width_, start_counts), to = split_rows(goals_, width_, goal_counts);
    require(from.size() == to.size(), "there must be as many starts as goals");
    require(!time_limits || std::size_t(time_limits->size) == from.size(), "each problem has a time limit");
    for (std::size_t k = 0; k < from.size(); ++k) {
        problems_.push_back({from[k], to[k]});
        if (!time_limits) continue;
        require(time_limits->data[k] >= 0, "a time limit must not be negative");
        problems_.back().time_limit = time_limits->data[k];
    }
}
std::pair<Doubles, Doubles> GivenProblems::rows(std::size_t k) const {
    if (k >= problems_.size()) throw nb::index_error("there is no problem of that number");
    const auto copy = [&](std::span<const double> rows) {
        return Doubles({npy_intp(rows.size()) / width_, width_}, rows.data());
    };
    return {copy(problems_[k].starts), copy(problems_[k].goals)};
}
std::span<const ArmProblem> GivenProblems::read(const collision::Checker& checker) const {
    require(width_ == checker.dof(), "the problems are those of another robot");
    return problems_;
}

void bind_planning_arm(nb::module_& m) {
    nb::class_<ArmOptions>(m, "ArmOptions", "Options of plans of arms.")
        .def(nb::new_(&read_options), "proves_search"_a, "proves_answer"_a, "simplify"_a, "seed"_a, "edges"_a,
             "improve"_a, "time_limit"_a, "range"_a, "resolution"_a);
    nb::class_<TreeOptions>(m, "TreeOptions", "Options of plans by a tree from the starts.")
        .def(nb::new_([](bool is_optimal, bool is_informed, double goal_bias) {
                 return TreeOptions{is_optimal, is_informed, goal_bias};
             }),
             "is_optimal"_a, "is_informed"_a, "goal_bias"_a);
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
    nb::class_<GivenProblems>(m, "ArmProblems", "Pairs of starts and goals of an arm.")
        .def(nb::init<const ConstDoubles&, const std::optional<Integers>&, const ConstDoubles&,
                      const std::optional<Integers>&, const std::optional<ConstDoubles>&>(),
             "starts"_a, "start_counts"_a.none(), "goals"_a, "goal_counts"_a.none(),
             "time_limits"_a.none() = nb::none(),
             "Rows (s, dof) and (g, dof), how many of them each problem has (n,), one if None, and its time "
             "limit [s].")
        .def("__len__", &GivenProblems::size)
        .def("__getitem__", &GivenProblems::rows, "k"_a,
             "The starts (s, dof) and goals (g, dof) of a problem.");
    nb::class_<NamedPlans>(m, "ArmPlans", "The plans of many problems.")
        .def("__len__", [](const NamedPlans& p) { return p.plans.size(); })
        .def("plan", &NamedPlans::plan, "k"_a, nb::keep_alive<0, 1>(), "One of them.")
        .def_prop_ro("status",
                     [](const NamedPlans& p) {
                         return p.list<std::uint8_t>([&](std::size_t k) { return p.plans[k].status; });
                     })
        .def_prop_ro("cost",
                     [](const NamedPlans& p) {
                         return p.list<double>([&](std::size_t k) { return p.plans[k].cost; });
                     })
        .def_prop_ro("corners", [](const NamedPlans& p) {
            return p.list<std::int64_t>([&](std::size_t k) { return p.corners(k); });
        });
    m.def("as_rows", &as_rows, "value"_a, "dof"_a, "largest"_a,
          "Configurations (dof,) or (n, dof) of numbers up to ±largest as rows; None for anything else.");
    m.def("plan_arm", &plan_one<>, "checker"_a, "bounds"_a, "wraps"_a, "starts"_a, "goals"_a, "options"_a,
          nb::keep_alive<0, 1>(), "From any of the starts (s, dof) to any of the goals (g, dof).");
    m.def("plan_arms", &plan_each<>, "checker"_a, "bounds"_a, "wraps"_a, "problems"_a, "options"_a,
          "threads"_a, nb::keep_alive<0, 1>(), "A plan per pair of starts and goals.");
    m.def("plan_arm", &plan_one<TreeOptions>, "checker"_a, "bounds"_a, "wraps"_a, "starts"_a, "goals"_a,
          "options"_a, "tree"_a, nb::keep_alive<0, 1>(), "The same by a tree from the starts.");
    m.def("plan_arms", &plan_each<TreeOptions>, "checker"_a, "bounds"_a, "wraps"_a, "problems"_a, "options"_a,
          "threads"_a, "tree"_a, nb::keep_alive<0, 1>(), "The same by a tree from the starts.");
    nb::class_<ArmRoadmap>(m, "ArmRoadmap", "A roadmap of an arm.")
        .def("__len__", &ArmRoadmap::size)
        .def_prop_ro("edge_count", &ArmRoadmap::edge_count)
        .def_prop_ro("neighbours", &ArmRoadmap::neighbours)
        .def_prop_ro("components", &ArmRoadmap::components)
        .def_prop_ro(
            "nodes",
            [](const ArmRoadmap& map) {
                const std::vector<double> nodes = map.nodes();
                const npy_intp width = std::max(map.width(), 1);
                return Doubles({npy_intp(nodes.size()) / width, map.width()}, nodes.data());
            },
            "The configurations (n, dof).")
        .def_prop_ro(
            "edges",
            [](const ArmRoadmap& map) {
                const std::vector<std::int32_t> edges = map.edges();
                return Plain<std::int32_t>({npy_intp(edges.size() / 2), 2}, edges.data());
            },
            "The pairs of nodes (e, 2) that are joined.");
    nb::class_<RoadmapWorld>(m, "RoadmapWorld", "What is known of a roadmap in a scene.")
        .def(nb::new_([](std::shared_ptr<ArmRoadmap> roadmap, std::shared_ptr<collision::Checker> checker,
                         bool is_self_free, bool proves_search, double resolution) {
                 const EdgeTest search = proves_search ? EdgeTest::proved : EdgeTest::sampled;
                 return std::make_shared<RoadmapWorld>(roadmap, checker, is_self_free, search,
                                                       float(resolution));
             }),
             "roadmap"_a, "checker"_a, "is_self_free"_a, "proves_search"_a, "resolution"_a)
        .def_prop_ro("known", &RoadmapWorld::count_known, "How many nodes and edges were checked.");
    m.def("make_roadmap", &make_roadmap, "checker"_a, "bounds"_a, "wraps"_a, "samples"_a, "neighbours"_a,
          "seed"_a, "part"_a.none(), "threads"_a, "A roadmap of a robot alone.");
    m.def("restore_roadmap", &restore_roadmap, "checker"_a, "bounds"_a, "wraps"_a, "samples"_a,
          "neighbours"_a, "seed"_a, "nodes"_a, "edges"_a, "A roadmap that was made before.");
    m.def("plan_on_roadmap", &plan_one_on_roadmap, "world"_a, "bounds"_a, "wraps"_a, "starts"_a, "goals"_a,
          "options"_a, "is_lazy"_a, nb::keep_alive<0, 1>(), "See plan_arm.");
    m.def("plan_each_on_roadmap", &plan_all_on_roadmap, "world"_a, "bounds"_a, "wraps"_a, "problems"_a,
          "options"_a, "is_lazy"_a, "threads"_a, nb::keep_alive<0, 1>(), "See plan_arms.");
}
