#include "navigation_fields_polygons.hpp"

#include <limits>
#include <optional>

#include "cspace/navigation/fields/descent.hpp"
#include "cspace/navigation/fields/navigation_function.hpp"
#include "maps_polygon_state.hpp"

namespace cspace::navigation {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void list_steps(const DescentRoute& made, Trace& trace) {
    const std::vector<Point>& path = made.route.path;
    for (std::size_t k = 1; k < path.size(); ++k) trace.push_back({0, path[k - 1], path[k], made.values[k]});
}

StarWorld stars_around(const PolygonCore::State& core, const maps::Settled& goal) {
    return StarWorld(core.world.walls, core.world.space.component[std::size_t(goal.triangles.at(0))]);
}
std::shared_ptr<const NavigationFunction> function_of(const PolygonCore::State& core, Point goal,
                                                      double kappa, NavigationFunction::Limits limits) {
    const maps::Settled at = core.settle(goal);
    const StarWorld stars = stars_around(core, at);
    return std::make_shared<const NavigationFunction>(stars.model(), stars, at.at, kappa, limits);
}
SphereWorld spheres_of(std::span<const StarFunction::Disc> discs) {
    SphereWorld world{{{discs[0][0], discs[0][1]}, discs[0][2]}, {}};
    for (const auto& [x, y, radius] : discs.subspan(1)) world.obstacles.push_back({{x, y}, radius});
    return world;
}

}  // namespace

RepellingWalls::RepellingWalls(const PolygonCore& core, double far)
    : reach(far), walls(std::make_shared<NearWalls>(core.state().world.walls, far)) {}

Table<double> RepellingWalls::values(const PolygonCore& core, Point goal, std::span<const Point> points,
                                     const PotentialSettings& s) const {
    const Potential potential(*walls, {s[0], s[1], s[2], s[3]}, goal);
    Table<double> made;
    for (const Point p : points)
        made.values.push_back(core.state().settle(p).is_free() ? potential.value(p) : infinite);
    return made;
}

bool plan_descent(const Query<PolygonCore>& query, Answer<int, double, int>& answer,
                  const RepellingWalls* near, const PotentialSettings& s) {
    const PolygonCore::State& state = query.world.state();
    const NearWalls& walls = *near->walls;
    const Gains gains{s[0], s[1], s[2], s[3]};
    maps::Settled from, to;
    if (!state.settle(query.start, query.goal, from, to)) return false;
    const Potential potential(walls, gains, query.start == query.goal ? from.at : query.goal);
    const double closest = std::max(2 * state.tolerance, DescentRun::least_step * gains.rho_0);
    const std::vector<Point> inward = find_start_directions(state.world.space, from, walls, closest);
    DescentRoute found = DescentRun(walls, potential, s[4], std::int64_t(s[5])).run(from.at, inward);
    std::vector<Point>& path = found.route.path;
    path.front() = query.start;
    if (query.trace) {
        list_steps(found, *query.trace);
        if (found.rest != Rest::goal)
            query.trace->push_back({1, path.back(), path.back(), found.values.back()});
    }
    answer.route = std::move(found.route);
    answer.evidence = {int(found.rest), found.force, found.saddles};
    return true;
}

std::optional<std::tuple<int, double, double>> find_star_fault(const PolygonCore& core, Point goal) {
    const StarWorld stars = stars_around(core.state(), core.state().settle(goal));
    if (stars.fault == StarWorld::none) return std::nullopt;
    return std::tuple(int(stars.fault), stars.where.x, stars.where.y);
}

StarFunction::StarFunction(std::shared_ptr<const NavigationFunction> made)
    : function(std::move(made)),
      kappa(function->kappa()),
      is_proven(function->is_proven()),
      obstacles(function->discs().obstacles.size()) {}
StarFunction::StarFunction(const PolygonCore& core, Point goal, double power, std::int64_t squares,
                           std::int64_t steps)
    : StarFunction(function_of(core.state(), goal, power, {squares, steps})) {}
StarFunction::StarFunction(std::span<const Disc> discs, Point goal, double power, std::int64_t squares,
                           std::int64_t steps)
    : StarFunction(std::make_shared<const NavigationFunction>(spheres_of(discs), std::nullopt, goal, power,
                                                              NavigationFunction::Limits{squares, steps})) {}

Table<Point> StarFunction::saddles() const {
    Table<Point> made;
    for (const Point p : function->proof().saddles) made.values.push_back(function->from_model(p));
    return made;
}

Table<double> StarFunction::log_odds(const PolygonCore* core, std::span<const Point> points) const {
    Table<double> made;
    for (const Point p : points)
        made.values.push_back(!core || core->state().settle(p).is_free() ? function->log_odds(p) : infinite);
    return made;
}

Table<double> StarFunction::phi(std::span<const double> log_odds) const {
    Table<double> made;
    for (const double v : log_odds) made.values.push_back(function->phi(v));
    return made;
}

std::optional<Table<Point>> StarFunction::find_path(Point start) const {
    DescentRoute made = function->descend(start);
    if (made.route.status != Status::found) return std::nullopt;
    return Table<Point>{std::move(made.route.path)};
}

bool plan_star(const Query<PolygonCore>& query, Answer<int>& answer, const StarFunction* star, double spent) {
    const PolygonCore::State& state = query.world.state();
    const NavigationFunction& function = *star->function;
    maps::Settled from, to;
    if (!state.settle(query.start, query.goal, from, to)) return false;
    DescentRoute found;
    if (state.world.shared_component(from, to) == maps::none) {
        found.route.status = Status::unreachable;
    } else if (star->kappa > 0) {
        found = function.descend(from.at);
        found.route.path.front() = query.start;
        if (query.trace) {
            for (double& value : found.values) value = function.phi(value);
            list_steps(found, *query.trace);
        }
        if (found.route.status == Status::found) found.route.path.back() = query.goal;
    }
    answer.route = std::move(found.route);
    answer.route.stats.edges += function.proof().squares;
    answer.evidence = {found.saddles};
    answer.spent = spent;
    return true;
}

}  // namespace cspace::navigation
