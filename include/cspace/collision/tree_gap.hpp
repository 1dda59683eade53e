// Squared distances of eight places from a mesh, from its nearest triangle and 0 inside the solid, and from a
// cloud of points.
//
// A closed surface encloses the places that a ray leaves more often than it enters: where it winds around
// them. The ray runs along z. Each edge lies on one side of it for both triangles that share the edge, since
// the same numbers are compared, so no ray passes between two triangles or counts an edge twice, whatever the
// rounding.
#pragma once

#include "cspace/collision/placement.hpp"
#include "cspace/collision/scene.hpp"
#include "cspace/math/lanes.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// From a box along the axes.
CSPACE_INLINE Floats square_gap(const float* low, const float* high, const Place& at) {
    const auto beyond = [](float from, Floats x, float to) {
        return max(max(from - x, x - to), fill_floats(0.0f));
    };
    return square(beyond(low[0], at.x, high[0])) +
           (square(beyond(low[1], at.y, high[1])) + square(beyond(low[2], at.z, high[2])));
}

// In the plane of the triangle a foot inside counts the height alone; others are nearest to a side.
CSPACE_INLINE Floats square_gap(const Triangle& triangle, const Place& at) {
    const Floats zero = fill_floats(0.0f), one = fill_floats(1.0f);
    const Floats dx = at.x - triangle.corner[0], dy = at.y - triangle.corner[1],
                 dz = at.z - triangle.corner[2];
    const auto along = [&](const float* axis) { return dx * axis[0] + (dy * axis[1] + dz * axis[2]); };
    const Floats x = along(triangle.axes), y = along(triangle.axes + 3), z = along(triangle.axes + 6);
    const float c_x = triangle.apex[0], c_y = triangle.apex[1], v = c_x - triangle.side;
    const Floats u = x - triangle.side;  // from corner b
    const auto from_side = [&](Floats from, float run, float inverse) {
        const Floats t = min(max((from * run + y * c_y) * inverse, zero), one);
        return square(from - t * run) + square(y - t * c_y);
    };
    const Floats a_b = square(x - min(max(x, zero), fill_floats(triangle.side))) + square(y);
    const Floats b_c = from_side(u, v, triangle.inverse_b_c), a_c = from_side(x, c_x, triangle.inverse_a_c);
    const FloatMask inside = (y > 0.0f) & (y * v > u * c_y) & (x * c_y > y * c_x);
    return select_lanes(inside, zero, min(a_b, min(b_c, a_c))) + square(z);
}

CSPACE_INLINE double fill_as(double, double value) { return value; }
CSPACE_INLINE Floats fill_as(const Floats&, float value) { return fill_floats(value); }

// How often a ray along z that begins at a place leaves the solid through a facet, less how often it enters
// it: 1, 0 or −1. In doubles, or for eight places at once.
template <class V, class S>
CSPACE_INLINE V count_exits(const Facet<S>& f, const V& x, const V& y, const V& z) {
    const V zero = fill_as(x, 0), one = fill_as(x, 1);
    const auto is_left_of = [&](const auto& a_x, const auto& a_y, const auto& b_x, const auto& b_y) {
        return (y - a_y) * (b_x - a_x) > (x - a_x) * (b_y - a_y);
    };
    const auto is_lower = y < f.middle[1];
    const auto choose = [&](S lower, S upper) {
        return select_lanes(is_lower, fill_as(x, lower), fill_as(x, upper));
    };
    const V a_x = choose(f.low[0], f.middle[0]), a_y = choose(f.low[1], f.middle[1]);
    const V b_x = choose(f.middle[0], f.high[0]), b_y = choose(f.middle[1], f.high[1]);
    const V left_of_long = select_lanes(is_left_of(f.low[0], f.low[1], f.high[0], f.high[1]), one, zero);
    const V left_of_short = select_lanes(is_left_of(a_x, a_y, b_x, b_y), one, zero);
    const V crossing = left_of_short - left_of_long;  // 1 where the normal points up, −1 where it points down
    const V height =
        (x - f.low[0]) * f.normal[0] + ((y - f.low[1]) * f.normal[1] + (z - f.low[2]) * f.normal[2]);
    const auto is_below = (z < f.bottom) | ((z < f.top) & (crossing * height < S(0)));
    const V exits = select_lanes(is_below, crossing * f.turn, zero);
    return select_lanes(y < f.low[1], zero, select_lanes(y < f.high[1], exits, zero));
}

// The lanes whose places are inside a solid.
inline FloatMask find_inside(const Mesh& mesh, const Place& at) {
    const TreeNode& all = mesh.nodes[0];
    Floats exits = fill_floats(0.0f);
    const auto is_under = [&](const TreeNode& node) {
        return (at.x > node.low[0]) & (at.x < node.high[0]) & (at.y > node.low[1]) & (at.y < node.high[1]) &
               (at.z < node.high[2]);
    };
    const FloatMask within = is_under(all) & (at.z > all.low[2]);
    if (!bits_of(within)) return within;
    for (int i = 0; i < mesh.n_nodes;) {
        const TreeNode& node = mesh.nodes[i];
        if (!bits_of(is_under(node))) {
            i = node.next;
            continue;
        }
        for (int k = node.first; k < node.first + node.count; ++k)
            exits = exits + count_exits(mesh.facets[k], at.x, at.y, at.z);
        ++i;
    }
    return within & (exits > 0.5f);
}

// What is looked for in a tree: squares of distances below `enough`, and else below `limit`, in the lanes
// `wanted`. The search ends once all of these are below `enough`, or one of them if `any`.
struct Sought {
    Floats limit, enough;
    unsigned wanted;
    bool any;
    CSPACE_INLINE bool is_met(Floats squares) const {
        const unsigned found = bits_of(squares < enough) & wanted;
        return found == wanted || (any && found);
    }
    // A lane that is below `enough` needs no more items, one below the limit only those below `enough`.
    CSPACE_INLINE Floats settle(Floats squares) const {
        const Floats rest = select_lanes(squares < limit, enough, limit);
        return select_lanes(squares < enough, fill_floats(0.0f), rest);
    }
};

// Of squares of distances from the items of a tree: 0 where the least is below `enough`, `enough` where it is
// below the limit, and the limit elsewhere, also in a lane that the search has left open. `measure` finds the
// squares of an item. inner: nodes that are no leaves have an item too, one of those below them.
template <bool inner, class Measure>
CSPACE_INLINE Floats find_least(const TreeNode* nodes, int n_nodes, const Place& at, const Sought& sought,
                                const Measure& measure) {
    Floats least = sought.limit;
    for (int i = 0; i < n_nodes;) {
        const TreeNode& node = nodes[i];
        if (!(bits_of(square_gap(node.low, node.high, at) < least) & sought.wanted)) {
            i = node.next;
            continue;
        }
        ++i;
        const int count = inner && node.count == 0 ? 1 : node.count;
        if (count == 0) continue;
        for (int k = node.first; k < node.first + count; ++k) least = min(least, measure(k));
        least = sought.settle(least);
        if (sought.is_met(least)) break;
    }
    return least;
}

// Less than the limit, or than `enough`, where the square of the distance is, in the lanes wanted.
inline Floats square_gap(const Mesh& mesh, const Place& at, const Sought& sought) {
    const Floats least = find_least<false>(mesh.nodes, mesh.n_nodes, at, sought,
                                           [&](int k) { return square_gap(mesh.triangles[k], at); });
    if (!mesh.facets || sought.is_met(least)) return least;
    return select_lanes(find_inside(mesh, at), fill_floats(0.0f), least);
}

// The cells of places, and in which lanes the points may be nearer than the root of a limit.
CSPACE_INLINE unsigned find_cells(const DistanceGrid& grid, const Place& at, Floats limit,
                                  int (&cells)[float_lanes]) {
    alignas(32) float cell[3][float_lanes], bound[float_lanes];
    const Floats place[] = {at.x, at.y, at.z};
    for (int k = 0; k < 3; ++k) {
        const Floats from_low = (place[k] - grid.low[k]) * grid.cells_per_metre;
        const Floats last = fill_floats(float(grid.n[k] - 1));
        store_floats(cell[k], min(max(from_low, fill_floats(0.0f)), last));
    }
    for (int i = 0; i < float_lanes; ++i) {
        const int x = int(cell[0][i]), y = int(cell[1][i]), z = int(cell[2][i]);
        cells[i] = (z * grid.n[1] + y) * grid.n[0] + x;
        bound[i] = grid.least[grid.steps[cells[i]]];
    }
    return bits_of(load_floats(bound) < limit);
}
// Whether one of eight points in and around the cell to which the steps lead is nearer than the root of a
// limit.
CSPACE_INLINE bool is_near_points(const Cloud& cloud, int cell, float x, float y, float z, float limit) {
    const DistanceGrid& grid = cloud.grid;
    cell += grid.ways[2][cell] * grid.n[0] * grid.n[1];
    cell += grid.ways[1][cell] * grid.n[0];
    cell += grid.ways[0][cell];
    const int k = grid.points[cell];
    const Floats gap = square(x - load_floats(cloud.x + k)) +
                       (square(y - load_floats(cloud.y + k)) + square(z - load_floats(cloud.z + k)));
    return bits_of(gap < limit) != 0;
}
// As of a mesh. The cells settle most lanes, the tree the others.
inline Floats square_gap(const Cloud& cloud, const Place& at, const Sought& sought) {
    if (cloud.n_nodes == 0) return sought.limit;
    int cells[float_lanes];
    alignas(32) float x[float_lanes], y[float_lanes], z[float_lanes], squares[float_lanes],
        enough[float_lanes];
    Sought rest = sought;
    rest.wanted &= find_cells(cloud.grid, at, sought.limit, cells);
    if (!rest.wanted) return sought.limit;
    store_floats(x, at.x), store_floats(y, at.y), store_floats(z, at.z);
    store_floats(squares, sought.limit), store_floats(enough, sought.enough);
    for (unsigned lanes = rest.wanted; lanes; lanes &= lanes - 1) {
        const int i = lowest_lane(lanes);
        if (!is_near_points(cloud, cells[i], x[i], y[i], z[i], enough[i])) continue;
        squares[i] = 0;
        rest.wanted &= ~(1u << i);
        if (sought.any) return load_floats(squares);
    }
    const Floats found = load_floats(squares);
    if (!rest.wanted) return found;
    const Floats least = find_least<true>(cloud.nodes, cloud.n_nodes, at, rest, [&](int k) {
        return square(at.x - cloud.x[k]) + (square(at.y - cloud.y[k]) + square(at.z - cloud.z[k]));
    });
    return min(least, found);
}

}  // namespace cspace::collision::inline CSPACE_ISA
