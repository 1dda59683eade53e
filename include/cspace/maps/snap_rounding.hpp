// Outlines on a raster so fine that nothing sees it, their crossings among its points: what nearly coincides
// comes to coincide (Hobby 1999, "Practical segment intersection with finite precision output"). Each segment
// is routed through the centres of all cells that it meets and that contain a point of the arrangement.
// Segments then do not cross.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "cspace/maps/outlines.hpp"
#include "cspace/math/predicates.hpp"

namespace cspace::maps {

namespace detail {

// Where two segments cross properly, rounded to whole numbers; false if they do not.
inline bool rounded_crossing(Point a, Point b, Point c, Point d, Point& at) {
    if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
        std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
        return false;
    if (orientation(a, b, c) * orientation(a, b, d) >= 0 || orientation(c, d, a) * orientation(c, d, b) >= 0)
        return false;
    const double part = cross(d - c, c - a) / cross(d - c, b - a);
    at = {std::round(a.x + part * (b.x - a.x)), std::round(a.y + part * (b.y - a.y))};
    return true;
}

// Whether a segment meets the closed unit square around a point.
inline bool meets_cell(Point a, Point b, Point center) {
    const Point low = center - Point{0.5, 0.5}, high = center + Point{0.5, 0.5};
    if (std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x || std::max(a.y, b.y) < low.y ||
        std::min(a.y, b.y) > high.y)
        return false;
    int left = 0, right = 0;
    for (const Point corner : {low, Point{high.x, low.y}, high, Point{low.x, high.y}}) {
        const int side = orientation(a, b, corner);
        left += side >= 0, right += side <= 0;
    }
    return left > 0 && right > 0;
}

}  // namespace detail

inline Outlines snap_rounded(const Outlines& world) {
    double most = 0;
    for (const Point p : {world.low, world.high}) most = std::max({most, std::abs(p.x), std::abs(p.y)});
    for (const Point p : world.points) most = std::max({most, std::abs(p.x), std::abs(p.y)});
    const double cell = std::ldexp(1.0, std::ilogb(most) - 40);
    const auto snapped = [&](Point p) { return Point{std::round(p.x / cell), std::round(p.y / cell)}; };

    Outlines made;
    made.low = cell * snapped(world.low), made.high = cell * snapped(world.high);
    made.obstacles = world.obstacles;
    std::vector<Point> points(world.points.size());
    std::transform(world.points.begin(), world.points.end(), points.begin(), snapped);
    std::map<std::pair<double, double>, Index> cells;
    const auto name = [&](Point p) {
        const auto [place, is_new] = cells.try_emplace({p.x, p.y}, Index(made.points.size()));
        if (is_new) made.points.push_back(p);
        return place->second;
    };
    for (const Point p : points) name(p);
    const auto ends_of = [&](const Outlines::Edge& e) {
        return std::pair{points[std::size_t(e.from)], points[std::size_t(e.to)]};
    };
    for (std::size_t i = 0; i < world.edges.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const auto [a, b] = ends_of(world.edges[i]);
            const auto [c, d] = ends_of(world.edges[k]);
            Point at;
            if (detail::rounded_crossing(a, b, c, d, at)) name(at);
        }
    for (const Outlines::Edge& edge : world.edges) {
        const auto [a, b] = ends_of(edge);
        std::vector<std::pair<double, Index>> met;
        for (Index i = 0; i < Index(made.points.size()); ++i) {
            const Point p = made.points[std::size_t(i)];
            if (detail::meets_cell(a, b, p)) met.push_back({dot(p - a, b - a), i});
        }
        std::sort(met.begin(), met.end());
        for (std::size_t i = 1; i < met.size(); ++i)
            made.edges.push_back({met[i - 1].second, met[i].second, edge.owner});
    }
    for (Point& p : made.points) p = cell * p;
    return made;
}

}  // namespace cspace::maps
