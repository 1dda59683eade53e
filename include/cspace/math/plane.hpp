// Points of the plane.
#pragma once

#include <algorithm>
#include <cmath>

namespace cspace {

struct Point {
    double x = 0, y = 0;
    friend constexpr bool operator==(const Point&, const Point&) = default;
};

constexpr Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
constexpr double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
// The point x with a · x = p and b · x = q, by Cramer's rule; a and b are not parallel.
constexpr Point solve_two(Point a, Point b, double p, double q) {
    const double det = cross(a, b);
    return {(p * b.y - q * a.y) / det, (q * a.x - p * b.x) / det};
}
constexpr double squared_norm(Point a) { return dot(a, a); }
inline double norm(Point a) { return std::sqrt(dot(a, a)); }
inline double distance(Point a, Point b) { return norm(b - a); }

// The point of the segment from a to b that is nearest to p.
inline Point nearest_on(Point a, Point b, Point p) {
    const Point d = b - a;
    const double squared = squared_norm(d), t = squared > 0 ? dot(p - a, d) / squared : 0;
    return t <= 0 ? a : t >= 1 ? b : a + t * d;
}

// A rectangle along the axes.
struct Box {
    Point low, high;

    Point middle() const { return 0.5 * (low + high); }
    void include(Point p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    void include(const Box& box) { include(box.low), include(box.high); }
};
// Of at least one point.
template <class Points>
Box bounds_of(const Points& points) {
    Box box{*std::begin(points), *std::begin(points)};
    for (const Point p : points) box.include(p);
    return box;
}

}  // namespace cspace
