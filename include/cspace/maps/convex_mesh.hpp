// Free space as convex polygons: triangles joined across their edges as long as what they form stays convex
// (after Hertel & Mehlhorn 1983, "Fast triangulation of simple polygons"), the longest edges first.
#pragma once

#include "cspace/maps/sectors.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

// A point at which several parts of free space touch is listed once for each of them (a part between two
// walls is a sector), so what meets in a point of the mesh is connected there. Edges are numbered through:
// those of polygon p are first[p] … first[p + 1] − 1, counterclockwise.
struct ConvexMesh {
    std::vector<Point> points;
    std::vector<Index> first;
    std::vector<Index> corner;        // where each edge begins
    std::vector<Index> twin;          // the same edge seen from the polygon across, or none at a wall
    std::vector<Index> polygon;       // the polygon of each edge
    std::vector<std::uint8_t> doors;  // of each polygon: how many edges lead on, at most 255
    std::vector<std::uint8_t>
        turns;  // of each point: whether a shortest path may turn there: the sector is reflex
    std::vector<Index> of_triangle;  // the polygon of each triangle of the free space

    Index size() const { return Index(first.size()) - 1; }
    Index begin(Index p) const { return first[std::size_t(p)]; }
    Index end(Index p) const { return first[std::size_t(p) + 1]; }
    Index next(Index edge) const {
        const Index p = polygon[std::size_t(edge)];
        return edge + 1 == end(p) ? begin(p) : edge + 1;
    }
    Point point(Index v) const { return points[std::size_t(v)]; }

    // The interface of a mesh for a search: the ends of an edge, the same edge seen from across, whether the
    // polygon of an edge has others that lead on.
    using Edge = Index;
    using Polygon = Index;
    static constexpr bool is_vast = false;  // every vertex has its place in memory
    Index tail(Index edge) const { return corner[std::size_t(edge)]; }
    Index head(Index edge) const { return corner[std::size_t(next(edge))]; }
    Index across(Index edge) const { return twin[std::size_t(edge)]; }
    bool may_turn(Index v) const { return turns[std::size_t(v)]; }
    bool is_side(Index edge, Index p) const { return polygon[std::size_t(edge)] == p; }
    Index name(Index edge) const { return edge; }  // distinguishes edges with a corner on the same side
    bool leads_on(Index edge) const { return doors[std::size_t(polygon[std::size_t(edge)])] > 1; }
    // Visits the edges of a polygon that lead on; all, or those other than the one it was entered by,
    // counterclockwise from there.
    template <class Visit>
    void visit_doors(Index p, Visit visit) const {
        for (Index e = begin(p); e < end(p); ++e)
            if (twin[std::size_t(e)] != none) visit(e);
    }
    template <class View, class Visit>
    void visit_doors_beyond(Index entry, const View&, Visit visit) const {
        for (Index e = next(entry); e != entry; e = next(e))
            if (twin[std::size_t(e)] != none) visit(e);
    }
};

namespace detail {

// The edges of the free triangles, edge e of triangle t being 3t + e, linked around polygons that grow.
class Merger {
  public:
    explicit Merger(const FreeSpace& space) : space_(space) {
        const std::size_t count = 3 * space.mesh.triangles.size();
        next.resize(count);
        previous.resize(count);
        gone.assign(count, 0);
        for (Index h = 0; h < Index(count); ++h) {
            next[std::size_t(h)] = 3 * (h / 3) + next_corner(h % 3);
            previous[std::size_t(h)] = 3 * (h / 3) + previous_corner(h % 3);
        }
        merge();
    }
    std::vector<Index> next, previous;
    std::vector<std::uint8_t> gone;

    Index begin(Index h) const { return space_.mesh[h / 3].begin(h % 3); }
    Index twin(Index h) const {
        if (space_.is_wall(h / 3, h % 3)) return none;
        const Index u = space_.mesh[h / 3].across[std::size_t(h % 3)];
        return 3 * u + space_.mesh[u].edge_to(h / 3);
    }

  private:
    const FreeSpace& space_;

    void merge() {
        std::vector<std::pair<double, Index>> order;
        visit_range(0, next.size(), [&](std::size_t i) {
            const Index h = Index(i);
            if (!space_.is_free(h / 3)) return;
            const Index other = twin(h);
            if (other > h) order.push_back({-squared_norm(point(next[i]) - point(h)), h});
        });
        sort_polled(order);
        InterruptPoll poll(256);
        for (const auto& [length, h] : order) {
            poll.step();
            const Index other = twin(h);
            if (!stays_convex(h, other) || !stays_convex(other, h)) continue;
            gone[std::size_t(h)] = gone[std::size_t(other)] = 1;
            link(previous[std::size_t(h)], next[std::size_t(other)]);
            link(previous[std::size_t(other)], next[std::size_t(h)]);
        }
    }
    Point point(Index h) const { return space_.mesh.point(begin(h)); }
    void link(Index h, Index then) {
        next[std::size_t(h)] = then;
        previous[std::size_t(then)] = h;
    }
    // Whether the corner where h begins stays convex without h and its twin.
    bool stays_convex(Index h, Index other) const {
        const Index leaving = next[std::size_t(other)];
        const Point a = point(previous[std::size_t(h)]), b = point(h), c = point(next[std::size_t(leaving)]);
        const int turn = orientation(a, b, c);
        return turn > 0 || (turn == 0 && is_between(a, b, c) && !(a == c));
    }
};

}  // namespace detail

inline ConvexMesh make_convex_mesh(const FreeSpace& space) {
    const detail::Merger merged(space);
    const Sectors sectors = find_sectors(space);
    ConvexMesh mesh;
    for (const Sector& s : sectors.all) mesh.points.push_back(s.at), mesh.turns.push_back(s.turns);
    mesh.of_triangle.assign(space.mesh.triangles.size(), none);
    mesh.first.push_back(0);
    std::vector<Index> number(merged.next.size(), none), half;
    InterruptPoll poll(1024);
    for (Index seed = 0; seed < Index(merged.next.size()); ++seed) {
        poll.step();
        if (!space.is_free(seed / 3) || merged.gone[std::size_t(seed)] || number[std::size_t(seed)] != none)
            continue;
        const Index p = mesh.size();
        for (Index h = seed; number[std::size_t(h)] == none; h = merged.next[std::size_t(h)]) {
            number[std::size_t(h)] = Index(half.size());
            half.push_back(h);
            mesh.corner.push_back(sectors.of[std::size_t(3 * (h / 3) + next_corner(h % 3))]);
            mesh.polygon.push_back(p);
            mesh.of_triangle[std::size_t(h / 3)] = p;
        }
        mesh.first.push_back(Index(half.size()));
    }
    mesh.twin.resize(half.size());
    mesh.doors.assign(mesh.first.size() - 1, 0);
    visit_range(0, half.size(), [&](std::size_t i) {
        const Index other = merged.twin(half[i]);
        mesh.twin[i] = other == none ? none : number[std::size_t(other)];
        std::uint8_t& doors = mesh.doors[std::size_t(mesh.polygon[i])];
        if (other != none && doors < 255) ++doors;
    });
    // Triangles without an edge of their polygon's outline lie inside it: they take the number from a
    // neighbour.
    for (bool again = true; again;) {
        again = false;
        poll_interrupts();
        for (Index t = 0; t < Index(mesh.of_triangle.size()); ++t)
            for (int e = 0; e < 3 && space.is_free(t) && mesh.of_triangle[std::size_t(t)] == none; ++e) {
                if (!merged.gone[std::size_t(3 * t + e)]) continue;
                const Index p = mesh.of_triangle[std::size_t(space.mesh[t].across[std::size_t(e)])];
                if (p != none) mesh.of_triangle[std::size_t(t)] = p, again = true;
            }
    }
    return mesh;
}

}  // namespace cspace::maps
