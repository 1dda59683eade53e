// Fewer points of a scan, as evenly spread along the walls as possible: near walls give many points and far
// ones few, and it is the far ones that measure the heading.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::localization {

// Points in the order of their beams, each at least `spacing` from the last one that was kept.
inline std::size_t space_points(std::span<const Point> points, double spacing, std::vector<Point>* kept) {
    std::size_t count = 0;
    Point last;
    for (const Point p : points) {
        if (count && squared_norm(p - last) < spacing * spacing) continue;
        ++count, last = p;
        if (kept) kept->push_back(p);
    }
    return count;
}

// At most so many points, with the least spacing that leaves no more.
inline void thin_points(std::span<const Point> points, std::size_t most, std::vector<Point>& kept) {
    kept.clear();
    double low = 0, high = 0.01;  // [m]
    if (points.size() <= most) {
        kept.assign(points.begin(), points.end());
        return;
    }
    constexpr int halvings = 10;  // to a thousandth of the spacing
    while (space_points(points, high, nullptr) > most) low = high, high *= 2;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (space_points(points, middle, nullptr) > most ? low : high) = middle;
    }
    space_points(points, high, &kept);
}

}  // namespace cspace::localization
