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
NavigationFunction::Limits limits_of(std::int64_t squares, std::int64_t steps) {
    NavigationFunction::Limits limits;
    limits.squares = squares, limits.steps = steps;
    return limits;
}
NavigationFunction function_of(const PolygonCore::State& core, Point goal, double kappa,
                               const NavigationFunction::Limits& limits) {
    const maps::Settled at = core.settle(goal);
    StarWorld stars = stars_around(core, at);
    SphereWorld model = stars.model();
    return NavigationFunction(std::move(model), std::move(stars), at.at, kappa, limits);
}
SphereWorld spheres_of(std::span<const StarFunction::Disc> discs) {
    SphereWorld world{{{discs[0].x, discs[0].y}, discs[0].radius}, {}};
    for (const auto& [x, y, radius] : discs.subspan(1)) world.obstacles.push_back({{x, y}, radius});
    return world;
}

}  // namespace

struct RepellingWalls::State {
    NearWalls walls;
};

RepellingWalls::RepellingWalls(const PolygonCore& core, double reach)
    : state_(new State{NearWalls(core.state().world.walls, reach)}) {}

double RepellingWalls::reach() const { return state_->walls.reach(); }

bool RepellingWalls::descend(const PolygonCore& core, Point start, Point goal, PotentialSettings s,
                             DescentRoute& found, Trace* trace) const {
    const PolygonCore::State& state = core.state();
    const NearWalls& walls = state_->walls;
    const Gains gains{s[0], s[1], s[2], s[3]};
    const maps::Settled from = state.settle(start);
    if (!from.is_free() || !state.settle(goal).is_free()) return false;
    const Potential potential(walls, gains, start == goal ? from.at : goal);
    const double near = std::max(2 * state.tolerance, DescentRun::least_step * gains.rho_0);
    const std::vector<Point> inward = find_start_directions(state.world.space, from, walls, near);
    found = DescentRun(walls, potential, s[4], std::int64_t(s[5])).run(from.at, inward);
    std::vector<Point>& path = found.route.path;
    path.front() = start;
    if (!trace) return true;
    list_steps(found, *trace);
    if (found.rest != Rest::goal) trace->push_back({1, path.back(), path.back(), found.values.back()});
    return true;
}

std::vector<double> RepellingWalls::values(const PolygonCore& core, Point goal, std::span<const Point> points,
                                           PotentialSettings s) const {
    const Potential potential(state_->walls, {s[0], s[1], s[2], s[3]}, goal);
    std::vector<double> found;
    for (const Point p : points)
        found.push_back(core.state().settle(p).is_free() ? potential.value(p) : infinite);
    return found;
}

StarFault find_star_fault(const PolygonCore& core, Point goal) {
    const StarWorld stars = stars_around(core.state(), core.state().settle(goal));
    static_assert(int(StarWorld::none) == 0);
    return {int(stars.fault), stars.where};
}

struct StarFunction::State {
    NavigationFunction function;
};

StarFunction::StarFunction(const PolygonCore& core, Point goal, double kappa, std::int64_t squares,
                           std::int64_t steps)
    : state_(new State{function_of(core.state(), goal, kappa, limits_of(squares, steps))}) {}
StarFunction::StarFunction(std::span<const Disc> discs, Point goal, double kappa, std::int64_t squares,
                           std::int64_t steps)
    : state_(new State{
          NavigationFunction(spheres_of(discs), std::nullopt, goal, kappa, limits_of(squares, steps))}) {}

double StarFunction::kappa() const { return state_->function.kappa(); }
bool StarFunction::is_proven() const { return state_->function.is_proven(); }
std::size_t StarFunction::obstacles() const { return state_->function.discs().obstacles.size(); }
double StarFunction::phi(double log_odds) const { return state_->function.phi(log_odds); }

std::vector<Point> StarFunction::saddles() const {
    std::vector<Point> found;
    for (const Point p : state_->function.proof().saddles) found.push_back(state_->function.from_model(p));
    return found;
}

std::vector<double> StarFunction::log_odds(const PolygonCore* core, std::span<const Point> points) const {
    std::vector<double> found;
    for (const Point p : points)
        found.push_back(!core || core->state().settle(p).is_free() ? state_->function.log_odds(p) : infinite);
    return found;
}

bool StarFunction::find_route(const PolygonCore& core, Point start, Point goal, DescentRoute& found,
                              Trace* trace) const {
    const PolygonCore::State& state = core.state();
    const maps::Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    if (state.world.shared_component(from, to) == maps::none) {
        found.route.status = Status::unreachable;
    } else if (kappa() > 0) {
        found = state_->function.descend(from.at);
        found.route.path.front() = start;
        if (trace) {
            for (double& value : found.values) value = phi(value);
            list_steps(found, *trace);
        }
        if (found.route.status == Status::found) found.route.path.back() = goal;
    }
    found.route.stats.edges += state_->function.proof().squares;
    return true;
}

std::vector<Point> StarFunction::find_path(Point start) const {
    DescentRoute made = state_->function.descend(start);
    if (made.route.status != Status::found) return {};
    return std::move(made.route.path);
}

}  // namespace cspace::navigation
