// Obstacles of the plane as convex pieces with round corners.
//
// A link with a radius touches a piece exactly where its axis, a segment, touches the piece grown by that
// radius. So every question about links is one about segments.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::planning {

// All points within `radius` of the convex hull of corners: of one corner a disc, of two a capsule.
struct Piece {
    std::vector<Point> corners;   // counterclockwise
    std::vector<Point> normals;   // unit, outward, of the side from each corner to the next
    std::vector<double> lengths;  // of the sides
    double radius = 0;
    Point center;       // of the corners
    double extent = 0;  // the farthest corner from the centre
    std::int32_t obstacle = 0;

    std::size_t size() const { return corners.size(); }
    std::size_t next(std::size_t i) const { return i + 1 == size() ? 0 : i + 1; }
    std::size_t previous(std::size_t i) const { return i == 0 ? size() - 1 : i - 1; }
    bool has_sides() const { return size() > 1; }
    // Along the side from corner i to the next.
    Point direction(std::size_t i) const { return {-normals[i].y, normals[i].x}; }
    Piece grown(double by) const {
        Piece larger = *this;
        larger.radius += by;
        return larger;
    }
    Piece moved(Point by) const {
        Piece other = *this;
        for (Point& corner : other.corners) corner = corner + by;
        other.center = center + by;
        return other;
    }
};

// Of corners that are counterclockwise and different from their neighbours.
inline Piece make_piece(std::span<const Point> corners, double radius, std::int32_t obstacle) {
    Piece piece;
    piece.corners.assign(corners.begin(), corners.end());
    piece.radius = radius, piece.obstacle = obstacle;
    piece.center = bounds_of(corners).middle();
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Point side = corners[piece.next(i)] - corners[i];
        const double length = norm(side);
        piece.lengths.push_back(length);
        piece.normals.push_back(length > 0 ? (1 / length) * Point{side.y, -side.x} : Point{});
        piece.extent = std::max(piece.extent, distance(corners[i], piece.center));
    }
    return piece;
}

// The distance from a point to the hull of the corners, zero inside.
inline double distance_to_corners(const Piece& piece, Point p) {
    bool is_inside = piece.size() > 2;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < piece.size(); ++i) {
        if (dot(piece.normals[i], p - piece.corners[i]) > 0) is_inside = false;
        nearest = std::min(
            nearest, squared_norm(p - nearest_on(piece.corners[i], piece.corners[piece.next(i)], p)));
    }
    return is_inside ? 0 : std::sqrt(nearest);
}
inline bool contains(const Piece& piece, Point p) { return distance_to_corners(piece, p) <= piece.radius; }

}  // namespace cspace::planning
