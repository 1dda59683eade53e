#include <limits>
#include <optional>

#include "cspace/navigation/fields/navigation_function.hpp"
#include "maps_polygon_state.hpp"
#include "navigation_fields_polygons.hpp"

namespace cspace::navigation {

namespace {

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

NavigationFunction::Descent descend(const NavigationFunction& function, const PolygonCore& core,
                                    Point start) {
    NavigationFunction::Descent made = function.descend(core.state().settle(start).at);
    made.route.path.front() = start;
    return made;
}

}  // namespace

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
        found.push_back(!core || core->state().settle(p).is_free() ? state_->function.log_odds(p)
                                                                   : std::numeric_limits<double>::infinity());
    return found;
}

Route StarFunction::find_route(const PolygonCore& core, Point start, Point goal,
                               std::int64_t& saddles) const {
    const PolygonCore::State& state = core.state();
    NavigationFunction::Descent made;
    if (state.world.shared_component(state.settle(start), state.settle(goal)) == maps::none) {
        made.route.status = Status::unreachable;
    } else if (kappa() > 0) {
        made = descend(state_->function, core, start);
        if (made.route.status == Status::found) made.route.path.back() = goal;
    }
    made.route.stats.edges += state_->function.proof().squares;
    saddles = made.saddles;
    return std::move(made.route);
}

void StarFunction::trace_descent(const PolygonCore& core, Point start, Trace& trace) const {
    const NavigationFunction::Descent made = descend(state_->function, core, start);
    const std::vector<Point>& path = made.route.path;
    for (std::size_t k = 1; k < path.size(); ++k)
        trace.push_back({0, path[k - 1], path[k], phi(made.values[k])});
}

std::vector<Point> StarFunction::find_path(Point start) const {
    NavigationFunction::Descent made = state_->function.descend(start);
    if (made.route.status != Status::found) return {};
    return std::move(made.route.path);
}

}  // namespace cspace::navigation
