#include "cspace/navigation/sampling/prm.hpp"
#include "cspace/navigation/sampling/rrt.hpp"
#include "maps_polygon_state.hpp"
#include "navigation_ends.hpp"
#include "navigation_polygons.hpp"

namespace cspace::navigation {

namespace {

sampling::Answer on_roadmap(PolygonCore::State& core, const sampling::Problem& problem,
                            const SamplingSettings& s, Trace* trace) {
    const sampling::RoadmapKey key{problem.component, s.samples, s.neighbours, s.seed};
    const auto make = [&] { return std::make_shared<const sampling::Roadmap>(core.world, key); };
    const auto roadmap = core.samples.get<sampling::KeptRoadmap>().of(key, make, search::most_kept_bytes);
    return sampling::RoadmapSearch(problem, *roadmap).solve(trace);
}
sampling::Answer by_tree(const sampling::Problem& problem, const SamplingSettings& s, Trace* trace) {
    const sampling::Growth growth{s.samples, s.step, s.goal_bias, s.planner == s.rrt_star, s.seed};
    return sampling::Tree(problem, growth, trace).solve();
}

}  // namespace

bool find_sampled_route(const PolygonCore& core, const SamplingSettings& settings, Point start, Point goal,
                        SamplingFinding& finding, Trace* trace) {
    PolygonCore::State& state = core.state();
    const maps::Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    const maps::Index component = state.world.shared_component(from, to);
    finding.route.status = Status::unreachable;
    if (component == maps::none) return true;
    const sampling::Problem problem = sampling::problem_of(state.world, component, from, to);
    sampling::Answer answer = settings.planner == settings.prm ? on_roadmap(state, problem, settings, trace)
                                                               : by_tree(problem, settings, trace);
    finding = {std::move(answer.route), answer.samples};
    restore_ends(finding.route, start, goal);
    return true;
}

}  // namespace cspace::navigation
