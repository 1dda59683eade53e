#include <limits>

#include "cspace/navigation/fields/descent.hpp"
#include "cspace/navigation/fields/start_directions.hpp"
#include "maps_polygon_state.hpp"
#include "navigation_fields_polygons.hpp"

namespace cspace::navigation {

struct RepellingWalls::State {
    NearWalls walls;
};

RepellingWalls::RepellingWalls(const PolygonCore& core, double reach)
    : state_(new State{NearWalls(core.state().world.walls, reach)}) {}

double RepellingWalls::reach() const { return state_->walls.reach(); }

DescentFinding RepellingWalls::descend(const PolygonCore& core, Point start, Point goal, PotentialSettings s,
                                       Trace* trace) const {
    const PolygonCore::State& state = core.state();
    const NearWalls& walls = state_->walls;
    const Gains gains{s[0], s[1], s[2], s[3]};
    const maps::Settled from = state.settle(start);
    const Potential potential(walls, gains, start == goal ? from.at : goal);
    const double near = std::max(2 * state.tolerance, 1e-7 * gains.rho_0);
    const std::vector<Point> inward = find_start_directions(state.world.space, from, walls, near);
    Descent made = DescentRun(walls, potential, s[4], std::int64_t(s[5])).run(from.at, inward);
    std::vector<Point>& path = made.route.path;
    path.front() = start;
    if (trace) {
        for (std::size_t k = 1; k < path.size(); ++k)
            trace->push_back({0, path[k - 1], path[k], made.values[k]});
        if (made.rest != Rest::goal) trace->push_back({1, path.back(), path.back(), made.values.back()});
    }
    return {std::move(made.route), int(made.rest), made.force, made.saddles};
}

std::vector<double> RepellingWalls::values(const PolygonCore& core, Point goal, std::span<const Point> points,
                                           PotentialSettings s) const {
    const Potential potential(state_->walls, {s[0], s[1], s[2], s[3]}, goal);
    std::vector<double> found;
    for (const Point p : points)
        found.push_back(core.state().settle(p).is_free() ? potential.value(p)
                                                         : std::numeric_limits<double>::infinity());
    return found;
}

}  // namespace cspace::navigation
