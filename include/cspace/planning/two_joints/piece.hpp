// Obstacles of the plane as convex pieces with round corners.
//
// A link with a radius touches a piece exactly where its axis, a segment, touches the piece grown by that
// radius. So every question about links is one about segments.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::planning::two_joints {

// All points within `radius` of the convex hull of corners: of one corner a disc, of two a capsule.
struct Piece {
    std::vector<Point> corners;   // counterclockwise
    std::vector<Point> normals;   // unit, outward, of the side from each corner to the next
    std::vector<double> lengths;  // of the sides
    // What tells corners from each other, and sides: pieces may share them.
    std::vector<std::int32_t> corner_names, side_names;
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
    piece.corner_names.assign(piece.size(), 0), piece.side_names = piece.corner_names;
    return piece;
}

// Numbers the corners and sides of pieces. Corners at one place share a name.
inline void name_corners(std::span<Piece> pieces) {
    std::map<std::tuple<double, double, double>, std::int32_t> corners;
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> sides;
    for (Piece& piece : pieces) {
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::tuple corner{piece.corners[i].x, piece.corners[i].y, piece.radius};
            piece.corner_names[i] = corners.try_emplace(corner, std::int32_t(corners.size())).first->second;
        }
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::pair side{piece.corner_names[i], piece.corner_names[piece.next(i)]};
            piece.side_names[i] = sides.try_emplace(side, std::int32_t(sides.size())).first->second;
        }
    }
}

// The distance from a point to the hull of the corners, zero inside.
inline double distance_to_corners(const Piece& piece, Point p) {
    bool is_inside = piece.size() > 2;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < piece.size(); ++i) {
        if (dot(piece.normals[i], p - piece.corners[i]) > 0) is_inside = false;
        nearest = std::min(nearest,
                           squared_norm(p - nearest_on(piece.corners[i], piece.corners[piece.next(i)], p)));
    }
    return is_inside ? 0 : std::sqrt(nearest);
}
inline bool contains_point(const Piece& piece, Point p) {
    return distance_to_corners(piece, p) <= piece.radius;
}

}  // namespace cspace::planning::two_joints
