// Potentials in polygon worlds and descents in them: what the bindings call.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::navigation {

class NearWalls;
class NavigationFunction;

// k, k_r, rho_0, cone, the longest step, the most evaluations of the potential.
using PotentialSettings = std::array<double, 6>;

// The walls of a world, sorted by where they repel, that is within a reach [m].
struct RepellingWalls {
    RepellingWalls(const PolygonCore& core, double reach);
    double reach;
    std::shared_ptr<const NearWalls> walls;

    // At points of free space; infinite elsewhere.
    Table<double> values(const PolygonCore& core, Point goal, std::span<const Point> points,
                         const PotentialSettings& settings) const;
};
// By descent: the Rest, the force that is left, and places without force that were left again.
bool plan_descent(const Query<PolygonCore>& query, Answer<int, double, int>& answer,
                  const RepellingWalls* near, const PotentialSettings& settings);

// What stands in the way of a star world around a point: 1 for a ring that is no star, 2 for one that touches
// another, and a corner of it.
std::optional<std::tuple<int, double, double>> find_star_fault(const PolygonCore& core, Point goal);

// A navigation function of a star or sphere world. squares, steps: the most that its proof and a descent may
// take.
struct StarFunction {
    using Disc = std::array<double, 3>;  // x, y, radius
    explicit StarFunction(std::shared_ptr<const NavigationFunction> made);
    StarFunction(const PolygonCore& core, Point goal, double kappa, std::int64_t squares, std::int64_t steps);
    // The first disc is the room.
    StarFunction(std::span<const Disc> discs, Point goal, double kappa, std::int64_t squares,
                 std::int64_t steps);

    std::shared_ptr<const NavigationFunction> function;
    double kappa;  // the power; zero where none was proven
    bool is_proven;
    std::size_t obstacles;

    Table<Point> saddles() const;
    // V at points of free space; infinite elsewhere. Without a core all points count as free.
    Table<double> log_odds(const PolygonCore* core, std::span<const Point> points) const;
    Table<double> phi(std::span<const double> log_odds) const;
    // The way down from a free point; nothing where it does not come to the goal.
    std::optional<Table<Point>> find_path(Point start) const;
};

// By the navigation function; how many saddles were left.
bool plan_star(const Query<PolygonCore>& query, Answer<int>& answer, const StarFunction* star, double spent);

}  // namespace cspace::navigation
