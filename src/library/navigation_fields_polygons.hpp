// Potentials in polygon worlds and descents in them: what the bindings call. A search returns false where an
// end lies in an obstacle, and writes its events into a trace that is not null.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::navigation {

using maps::PolygonCore;

// k, k_r, rho_0, cone, the longest step, the most evaluations of the potential.
using PotentialSettings = const double*;

// The walls of a world, sorted by where they repel, that is within a reach [m].
class RepellingWalls {
  public:
    RepellingWalls(const PolygonCore& core, double reach);

    double reach() const;
    bool descend(const PolygonCore& core, Point start, Point goal, PotentialSettings settings,
                 DescentRoute& found, Trace* trace) const;
    // At points of free space; infinite elsewhere.
    std::vector<double> values(const PolygonCore& core, Point goal, std::span<const Point> points,
                               PotentialSettings settings) const;

  private:
    struct State;
    std::shared_ptr<const State> state_;
};

// What stands in the way of a star world around a point: kind 1 for a ring that is no star, 2 for one that
// touches another, 0 for nothing.
struct StarFault {
    int kind;
    Point where;
};
StarFault find_star_fault(const PolygonCore& core, Point goal);

// A navigation function of a star or sphere world. squares, steps: the most that its proof and a descent may
// take.
class StarFunction {
  public:
    struct Disc {
        double x, y, radius;
    };
    StarFunction(const PolygonCore& core, Point goal, double kappa, std::int64_t squares, std::int64_t steps);
    // The first disc is the room.
    StarFunction(std::span<const Disc> discs, Point goal, double kappa, std::int64_t squares,
                 std::int64_t steps);

    double kappa() const;  // the power; zero where none was proven
    bool is_proven() const;
    std::size_t obstacles() const;
    std::vector<Point> saddles() const;
    // V at points of free space; infinite elsewhere. Without a core all points count as free.
    std::vector<double> log_odds(const PolygonCore* core, std::span<const Point> points) const;
    double phi(double log_odds) const;

    bool find_route(const PolygonCore& core, Point start, Point goal, DescentRoute& found,
                    Trace* trace) const;
    // The way down from a free point; empty where it does not come to the goal.
    std::vector<Point> find_path(Point start) const;

  private:
    struct State;
    std::shared_ptr<const State> state_;
};

}  // namespace cspace::navigation
