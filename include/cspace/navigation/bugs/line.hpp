// Decisions of a robot on a straight line about the walls it crosses. A contact is a rounded point; these
// decisions use the corners of the walls and the ends of the line, and so are exact.
#pragma once

#include <algorithm>
#include <limits>

#include "cspace/math/crossing.hpp"

namespace cspace::navigation {

// A straight piece of wall, the free space on the left of begin → end. The name identifies the piece.
struct Wall {
    Point begin, end;
    int name = -1;
};

// Where a robot touches: inside a piece (then in and out are that piece) or at the corner between two.
struct Touch {
    Point at;
    Wall in, out;

    bool is_corner() const { return in.name != out.name; }
    bool is_place_of(const Touch& other) const {
        return in.name == other.in.name && out.name == other.out.name;
    }
};

// By how much points computed in a world of this size may be off.
inline double rounding_of(double size) { return 8 * std::numeric_limits<double>::epsilon() * size; }

// So near to a corner that rounding decides on which side of its other wall the point lies.
inline bool is_next_to(Point p, Point corner) {
    const double off = std::max(std::abs(p.x - corner.x), std::abs(p.y - corner.y));
    return off <= rounding_of(std::max(std::abs(corner.x), std::abs(corner.y)));
}

inline int side_of(const Line& line, Point p) { return orientation(line.from, line.to, p); }

// Whether two points on one line with v, neither of them v, lie in the same direction from it.
inline bool same_direction(Point v, Point a, Point b) {
    return a.x != v.x ? (a.x > v.x) == (b.x > v.x) && b.x != v.x : b.x == v.x && (a.y > v.y) == (b.y > v.y);
}

// Of two points on the line: whether b comes after a.
inline bool comes_after(const Line& line, Point a, Point b) {
    const double ahead = line.to.x - line.from.x, by = b.x - a.x;
    return ahead != 0 ? by != 0 && (by > 0) == (ahead > 0)
                      : b.y != a.y && (b.y > a.y) == (line.to.y > line.from.y);
}

// How a direction lies at a corner: in the open sector of free space, along one of its sides, or in the wall.
enum class Way { free, along_out, along_in, blocked };

inline Way way_towards(Point before, Point corner, Point after, Point target) {
    const int out = orientation(corner, after, target), in = orientation(corner, before, target);
    if (out == 0 && same_direction(corner, after, target)) return Way::along_out;
    if (in == 0 && same_direction(corner, before, target)) return Way::along_in;
    const int turn = orientation(corner, after, before);
    bool free = false;
    if (turn > 0) free = out > 0 && in < 0;
    if (turn < 0) free = !(in > 0 && out < 0);
    if (turn == 0)
        free = out > 0 || same_direction(corner, before, after);  // straight on, or the end of a thin wall
    return free ? Way::free : Way::blocked;
}
inline Way way_towards(const Touch& corner, Point target) {
    return way_towards(corner.in.begin, corner.at, corner.out.end, target);
}

// +1 where the line crosses the wall out of free space, −1 where it comes out into it, 0 where it only
// touches or misses. Of a wall that is crossed, its left is what the line meets first if +1, last if −1.
inline int crossing_sign(const Line& line, const Wall& wall) {
    const int a = side_of(line, wall.begin), b = side_of(line, wall.end);
    return a < 0 && b > 0 ? 1 : a > 0 && b < 0 ? -1 : 0;
}

// Where a line from → to crosses a wall. Where rounding hides that (they lie almost on each other), the point
// of the wall nearest to the end that the crossing must not lie beyond.
inline Point crossing_point(const Line& line, const Wall& wall) {
    const Point d = line.to - line.from;
    const double a = cross(d, wall.begin - line.from), b = cross(d, wall.end - line.from);
    const double size =
        std::max({std::abs(line.to.x), std::abs(line.to.y), std::abs(wall.end.x), std::abs(wall.end.y)});
    if (std::max(std::abs(a), std::abs(b)) <= rounding_of(size) * (std::abs(d.x) + std::abs(d.y)))
        return nearest_on(wall.begin, wall.end, line.to);
    const Point p = wall.begin + std::clamp(a / (a - b), 0.0, 1.0) * (wall.end - wall.begin);
    if (dot(d, line.to - p) < 0) return nearest_on(wall.begin, wall.end, line.to);
    return dot(d, p - line.from) < 0 ? nearest_on(wall.begin, wall.end, line.from) : p;
}

// Of a point on the line and a wall that it crosses: −1 if the point comes first, 1 if the wall does.
inline int order_on_line(int crossing, Point p, const Wall& wall) {
    return -crossing * orientation(wall.begin, wall.end, p);
}

// On which side of one wall the whole of another lies, 0 if both lie on one line, 2 if it lies on both.
inline int side_of(const Wall& wall, const Wall& other) {
    const int a = orientation(wall.begin, wall.end, other.begin);
    const int b = orientation(wall.begin, wall.end, other.end);
    return a * b < 0 ? 2 : (a + b > 0) - (a + b < 0);
}

// Of two walls that the line crosses: −1 if the first comes first, 1 if the second does, 0 if they are two
// sides of one. Walls do not cross each other, so the whole of one lies on one side of the other.
inline int order_on_line(const Line& line, const Wall& first, const Wall& second) {
    if (const int side = side_of(first, second); side != 2) return crossing_sign(line, first) * side;
    if (const int side = side_of(second, first); side != 2) return -crossing_sign(line, second) * side;
    const double a = dot(line.to - line.from, crossing_point(line, first));
    const double b = dot(line.to - line.from, crossing_point(line, second));
    return (a > b) - (a < b);
}

}  // namespace cspace::navigation
