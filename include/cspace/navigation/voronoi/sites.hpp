// What a Voronoi diagram of free space is the diagram of: the walls, and the points where they bend away.
//
// A boundary loop is a chain of sites. Edge i comes after the point that it begins at; where free space bends
// around that point (more than half a turn), the point is a site of its own, nearest to what lies between the
// normals of the two edges. At corners into which free space tapers, and on straight lines, it is none.
#pragma once

#include <algorithm>
#include <limits>

#include "cspace/maps/boundary.hpp"
#include "cspace/math/predicates.hpp"
#include "cspace/navigation/voronoi/edge_tree.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation::voronoi {

enum class Turn : std::int8_t { corner, straight, around };

// Turns of less than this (sine) count as straight: what they do to the diagram is below rounding.
inline constexpr double straight_turn = 1e-8;

inline Turn turn_between(Point a, Point b, Point c, Point in, Point out) {
    if (std::abs(cross(in, out)) < straight_turn && dot(in, out) > 0) return Turn::straight;
    return orientation(a, b, c) > 0 ? Turn::corner : Turn::around;
}

struct Sites {
    Point origin;               // what has been taken from all coordinates, so that they are small
    double extent = 0;          // the largest coordinate that is left
    double spacing = 0;         // of the doubles at the largest coordinate as given
    std::vector<Point> points;  // where each edge begins
    std::vector<Point> along;   // its direction, of length one; free space lies on the left
    std::vector<double> length;
    std::vector<Index> next, before;
    std::vector<Turn> turn;  // at the point where it begins
    std::vector<Index> component;
    EdgeTree tree;

    Sites() = default;
    Sites(const maps::Boundary& walls, Point from) : origin(from), next(walls.next), before(walls.size()) {
        const Index n = Index(walls.size());
        std::vector<Box> boxes;
        for (Index i = 0; i < n; ++i) {
            const Point p = walls.begin(i) - origin;
            points.push_back(p);
            before[std::size_t(after(i))] = i;
            component.push_back(walls.component[std::size_t(walls.ring[std::size_t(i)])]);
            extent = std::max({extent, std::abs(p.x), std::abs(p.y)});
            const Point given = walls.begin(i);
            spacing = std::max({spacing, std::abs(given.x), std::abs(given.y)});
        }
        spacing *= std::numeric_limits<double>::epsilon();
        for (Index i = 0; i < n; ++i) {
            const Point way = end(i) - begin(i);
            length.push_back(norm(way));
            along.push_back((1 / norm(way)) * way);
            boxes.push_back(bounds_of(std::array{begin(i), end(i)}));
        }
        for (Index i = 0; i < n; ++i)
            turn.push_back(turn_between(walls.begin(previous(i)), walls.begin(i), walls.end(i),
                                        direction(previous(i)), direction(i)));
        tree = EdgeTree(boxes);
    }
    explicit Sites(const maps::Boundary& walls)
        : Sites(walls, walls.size() == 0 ? Point{} : bounds_of(walls.points).middle()) {}

    Index size() const { return Index(points.size()); }
    // What a distance may be off: coordinates lose some 1e-16 of the extent, a foot ten times that; far from
    // the origin they are given less finely.
    double rounding() const { return std::max(tolerance::exact * extent, 2 * spacing); }

    // Site i < size() is an edge, site size() + i the point where edge i begins.
    bool is_edge(Index site) const { return site < size(); }
    Index edge_of(Index site) const { return is_edge(site) ? site : site - size(); }
    Point begin(Index edge) const { return points[std::size_t(edge)]; }
    Point end(Index edge) const { return points[std::size_t(next[std::size_t(edge)])]; }
    Point direction(Index edge) const { return along[std::size_t(edge)]; }
    Point normal(Index edge) const { return {-direction(edge).y, direction(edge).x}; }
    double height(Index edge, Point p) const { return dot(normal(edge), p - begin(edge)); }
    double advance(Index edge, Point p) const { return dot(direction(edge), p - begin(edge)); }
    Index after(Index edge) const { return next[std::size_t(edge)]; }
    Index previous(Index edge) const { return before[std::size_t(edge)]; }
    Turn turn_at(Index edge) const { return turn[std::size_t(edge)]; }

    // Whether an edge is a site, or goes on from it without a corner.
    bool belongs(Index edge, Index site) const {
        const Index own = edge_of(site);
        if (edge == own) return true;
        if (edge == previous(own)) return !is_edge(site) || turn_at(own) != Turn::corner;
        return is_edge(site) && edge == after(own) && turn_at(edge) != Turn::corner;
    }
    // Whether the foot of a point on the line of an edge lies on the edge.
    bool is_beside(Index edge, Point p, double slack) const {
        const double s = advance(edge, p);
        return s >= -slack && s <= length[std::size_t(edge)] + slack;
    }
    // Whether a point is an end of a site.
    bool ends(Point q, Index site) const {
        const Index own = edge_of(site);
        return q == begin(own) || (is_edge(site) && q == end(own));
    }
    // Whether the point where an edge begins is the nearest of its ring to what lies around p.
    bool is_in_cone(Index edge, Point p, double slack) const {
        const Point from = p - begin(edge);
        return dot(from, direction(previous(edge))) >= -slack && dot(from, direction(edge)) <= slack;
    }
    // The unit vector from p to the nearest point of a site.
    Point towards(Index site, Point p) const {
        if (is_edge(site)) return -1.0 * normal(site);
        const Point to = begin(edge_of(site)) - p;
        const double far = norm(to);
        return far > 0 ? (1 / far) * to : Point{};
    }
    double distance_to(Index site, Point p) const {
        return is_edge(site) ? height(site, p) : distance(p, begin(edge_of(site)));
    }
};

}  // namespace cspace::navigation::voronoi
