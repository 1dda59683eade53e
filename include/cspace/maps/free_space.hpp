// Free space as a triangulation: the free triangles, the edges that are walls, the components.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/maps/outlines.hpp"
#include "cspace/maps/triangulator.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/predicates.hpp"

namespace cspace::maps {

// Outlines on a raster so fine that nothing sees it, their crossings among its points: what nearly coincides
// comes to coincide (Hobby 1999, "Practical segment intersection with finite precision output"). Each segment
// is routed through the centres of all cells that it meets and that contain a point of the arrangement.
// Segments then do not cross.

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
    InterruptPoll poll(512);
    for (std::size_t i = 0; i < world.edges.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            poll.step();
            const auto [a, b] = ends_of(world.edges[i]);
            const auto [c, d] = ends_of(world.edges[k]);
            Point at;
            if (detail::rounded_crossing(a, b, c, d, at)) name(at);
        }
    for (const Outlines::Edge& edge : world.edges) {
        const auto [a, b] = ends_of(edge);
        const Point half{0.5, 0.5};  // of a cell
        std::vector<std::pair<double, Index>> met;
        for (Index i = 0; i < Index(made.points.size()); ++i) {
            poll.step();
            const Point p = made.points[std::size_t(i)];
            if (met_part(a, b, {p - half, p + half}) != BoxPart::none) met.push_back({dot(p - a, b - a), i});
        }
        std::sort(met.begin(), met.end());
        for (std::size_t i = 1; i < met.size(); ++i)
            made.edges.push_back({met[i - 1].second, met[i].second, edge.owner});
    }
    for (Point& p : made.points) p = cell * p;
    return made;
}

struct FreeSpace {
    Triangulation mesh;
    std::vector<Index> component;  // of each triangle; none where an obstacle is, or outside the bounds
    std::vector<Index> obstacle;   // of each triangle: one that covers it, or none
    Index components = 0;
    std::vector<Triangulator::Crossing> crossings;  // where outlines cross
    std::vector<Triangulator::Owner> owners;        // the lists that edges and crossings name
    bool complete = false;                          // false: the outlines cross too often
    bool is_snapped = false;  // whether outlines that nearly coincide were brought together

    bool is_free(Index t) const { return t != none && component[std::size_t(t)] != none; }
    bool is_wall(Index t, int edge) const { return mesh[t].owners[std::size_t(edge)] != none; }

    // The free triangles whose closure contains a point: one, two at an edge, several at a corner; none
    // inside obstacles.
    void triangles_at(Point p, Index near, std::vector<Index>& out) const {
        out.clear();
        const Place place = mesh.locate(p, near);
        if (place.triangle == none) return;
        const auto add = [&](Index t) {
            if (is_free(t)) out.push_back(t);
        };
        const Triangle& tri = mesh[place.triangle];
        if (place.kind == Place::at_corner) {
            mesh.around(tri.corner[std::size_t(place.index)], [&](Index t, int) { return add(t), true; });
        } else {
            add(place.triangle);
            if (place.kind == Place::on_edge) add(tri.across[std::size_t(place.index)]);
        }
    }
};

namespace detail {

// Walks over all triangles and counts, crossing edges, how often each obstacle's outline was crossed.
inline void find_obstacles(FreeSpace& space, Index obstacles) {
    struct Step {
        Index triangle, crossed;
        int edge;
    };
    const Triangulation& mesh = space.mesh;
    std::vector<std::uint8_t> odd(std::size_t(obstacles) + 1, 0), seen(mesh.triangles.size(), 0);
    std::vector<Index> covering;  // the obstacles crossed an odd number of times
    const auto toggle = [&](Index list) {
        for (Index o = list; o != none; o = space.owners[std::size_t(o)].next) {
            const Index id = space.owners[std::size_t(o)].id;
            odd[std::size_t(id)] ^= 1;
            if (id == obstacles) continue;  // the bounds
            if (odd[std::size_t(id)])
                covering.push_back(id);
            else
                covering.erase(std::find(covering.begin(), covering.end(), id));
        }
    };
    const Index outside = mesh.triangle_at[0];
    std::vector<Step> stack{{outside, none, 0}};
    seen[std::size_t(outside)] = 1;
    InterruptPoll poll(1024);
    while (!stack.empty()) {
        poll.step();
        Step& step = stack.back();
        if (step.edge == 3) {
            toggle(step.crossed);
            stack.pop_back();
            continue;
        }
        const int e = step.edge++;
        const Index t = mesh[step.triangle].across[std::size_t(e)];
        if (t == none || seen[std::size_t(t)]) continue;
        const Index crossed = mesh[step.triangle].owners[std::size_t(e)];
        toggle(crossed);
        seen[std::size_t(t)] = 1;
        const bool is_free = covering.empty() && odd[std::size_t(obstacles)];
        space.component[std::size_t(t)] = is_free ? 0 : none;
        space.obstacle[std::size_t(t)] = covering.empty() ? none : covering.front();
        stack.push_back({t, crossed, 0});
    }
}

// Numbers the components of free space: walls separate them.
inline void find_components(FreeSpace& space) {
    std::vector<Index> stack;
    std::vector<std::uint8_t> seen(space.mesh.triangles.size(), 0);
    InterruptPoll poll(1024);
    for (Index seed = 0; seed < Index(seen.size()); ++seed) {
        if (!space.is_free(seed) || seen[std::size_t(seed)]) continue;
        stack.push_back(seed);
        seen[std::size_t(seed)] = 1;
        while (!stack.empty()) {
            poll.step();
            const Index t = stack.back();
            stack.pop_back();
            space.component[std::size_t(t)] = space.components;
            for (int e = 0; e < 3; ++e) {
                const Index u = space.mesh[t].across[std::size_t(e)];
                if (u == none || space.is_wall(t, e) || seen[std::size_t(u)]) continue;
                seen[std::size_t(u)] = 1;
                stack.push_back(u);
            }
        }
        ++space.components;
    }
}

// The triangulation of outlines, or false as `complete` where bending them to their crossings would not end.
inline FreeSpace triangulate_outlines(const Outlines& world) {
    FreeSpace space;
    Box box{world.low, world.high};
    for (const Point p : world.points) box.include(p);
    const auto [low, high] = box;
    const std::size_t n = world.points.size();
    std::vector<std::pair<std::uint32_t, Index>> order(n);
    const double side = std::max(high.x - low.x, high.y - low.y);
    for (std::size_t i = 0; i < n; ++i) order[i] = {along_hilbert(world.points[i], low, side), Index(i)};
    sort_polled(order);

    Triangulator make(low, high, world.edges.size());
    make.mesh.points.reserve(n + 16);
    make.mesh.triangles.reserve(2 * n + 32);
    std::vector<Index> vertex(n);
    for (const auto& [place, i] : order) vertex[std::size_t(i)] = make.insert(world.points[std::size_t(i)]);
    Index corner[4];
    const Point corners[4] = {
        world.low, {world.high.x, world.low.y}, world.high, {world.low.x, world.high.y}};
    for (int i = 0; i < 4; ++i) corner[i] = make.insert(corners[i]);

    space.complete = true;
    for (int i = 0; i < 4 && space.complete; ++i)
        space.complete = make.insert_segment(corner[i], corner[(i + 1) % 4], world.obstacles);
    for (std::size_t i = 0; i < world.edges.size() && space.complete; ++i) {
        const auto& [from, to, owner] = world.edges[i];
        space.complete = make.insert_segment(vertex[std::size_t(from)], vertex[std::size_t(to)], owner);
    }
    space.mesh = std::move(make.mesh);
    space.owners = std::move(make.owners);
    space.crossings = std::move(make.crossings);
    return space;
}

}  // namespace detail

inline FreeSpace make_free_space(const Outlines& world) {
    FreeSpace space = detail::triangulate_outlines(world);
    Outlines snapped;
    for (int tries = 0; !space.complete && tries < 4; ++tries) {
        snapped = snap_rounded(tries == 0 ? world : snapped);
        space = detail::triangulate_outlines(snapped);
        space.is_snapped = true;
    }
    space.component.assign(space.mesh.triangles.size(), none);
    space.obstacle.assign(space.mesh.triangles.size(), none);
    if (!space.complete) return space;
    detail::find_obstacles(space, world.obstacles);
    detail::find_components(space);
    return space;
}

// The walls of free space as rings, each edge with the free triangle on its left.
inline Boundary boundary_of(const FreeSpace& space) {
    const Triangulation& mesh = space.mesh;
    const std::size_t count = mesh.triangles.size();
    auto number = filled_vector<Index>(3 * count, none);
    Boundary boundary;
    visit_range(0, count, [&](std::size_t t) {
        for (int e = 0; e < 3; ++e)
            if (space.is_free(Index(t)) && space.is_wall(Index(t), e)) {
                number[3 * t + std::size_t(e)] = Index(boundary.points.size());
                boundary.points.push_back(mesh.point(mesh.triangles[t].begin(e)));
            }
    });
    boundary.next.assign(boundary.points.size(), none);
    boundary.ring.assign(boundary.points.size(), none);
    const auto next_wall = [&](Index t, int e) {
        for (e = next_corner(e); !space.is_wall(t, e);) {
            const Index u = mesh[t].across[std::size_t(e)];
            e = next_corner(mesh[u].edge_to(t));
            t = u;
        }
        return 3 * t + e;
    };
    visit_range(0, number.size(), [&](std::size_t half) {
        if (number[half] == none || boundary.ring[std::size_t(number[half])] != none) return;
        const Index ring = Index(boundary.component.size());
        boundary.component.push_back(space.component[half / 3]);
        for (Index h = Index(half);;) {
            const Index edge = number[std::size_t(h)];
            if (boundary.ring[std::size_t(edge)] != none) break;
            boundary.ring[std::size_t(edge)] = ring;
            h = next_wall(h / 3, h % 3);
            boundary.next[std::size_t(edge)] = number[std::size_t(h)];
        }
    });
    return boundary;
}

}  // namespace cspace::maps
