// Robots without a map in a polygon world: what the bindings call.
#pragma once

#include <utility>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::navigation {

// Where the line to an unreachable goal enters the walls that shut it off: the boundary loop, and the point.
using Shut = std::optional<std::pair<int, std::pair<double, double>>>;

// Bug 1 (0), Bug 2 (1) and tangent bug (2), with walls on the left (0), on the right (1) or, for the last,
// either (2). Tables with a row for each stretch along a wall: where it was hit and left, its length [m] and
// its boundary loop.
using WallAnswer = Answer<Table<Point>, Table<Point>, Table<double>, Table<std::int64_t>, Shut>;
bool plan_bug(const Query<PolygonCore>& query, WallAnswer& answer, std::int64_t kind, std::int64_t side,
              double range);

// Voronoi Bug. deviation: of its sensor, 0 for one without noise. Where three walls or more are nearest; the
// numbers of branches and dead ends; the least clearance on the curves that it followed [m]; scans.
using VoronoiBugAnswer = Answer<Table<Point>, std::int64_t, std::int64_t, double, std::int64_t, Shut>;
bool plan_voronoi_bug(const Query<PolygonCore>& query, VoronoiBugAnswer& answer, double range,
                      double deviation, std::uint64_t seed);

}  // namespace cspace::navigation
