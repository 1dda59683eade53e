// The visibility graph: the corners that free space bends around, and which of them see each other so that a
// taut string may run from one to the other (Lozano-Pérez & Wesley 1979; only bitangents are kept: Latombe
// 1991, section 4.1).
#pragma once

#include "cspace/maps/sectors.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::navigation {

// What a point sees: the triangles of free space are crossed one by one, each through the edge that the point
// sees, narrowed by the corners passed (Bungiu, Hemmer, Hershberger, Huang & Kröller 2014, "Efficient
// computation of visibility polygons"). Whether a corner narrows the view is an exact orientation of three
// given points.

using maps::FreeSpace;
using maps::Index;
using maps::none;
using maps::Sector;

// The line from one point to another; what lies beyond the second is seen along it.
struct Ray {
    Point from, to;
    int side(Point p) const { return orientation(from, to, p); }
};

// A part of the view: between two rays from the viewer.
struct Cone {
    Ray right, left;
};

class View {
  public:
    explicit View(const FreeSpace& space) : space_(space) {}

    // Looks from v, a point of the closed triangle t, through its edge e inside a cone. Calls enter(triangle,
    // cone) for every triangle that is looked into, and see(corner) for every corner that is seen, as 3t + i.
    // Corners behind one another on a line are all seen.
    template <class Enter, class See>
    void look(Point v, Index t, int e, Cone cone, Enter enter, See see) {
        stack_.push_back({t, e, cone});
        while (!stack_.empty()) {
            const Step step = stack_.back();
            stack_.pop_back();
            if (space_.is_wall(step.triangle, step.edge)) continue;
            ++triangles;
            enter(space_.mesh[step.triangle].across[std::size_t(step.edge)], step.cone);
            cross(v, step, see);
        }
    }
    std::int64_t triangles = 0;  // looked into so far

  private:
    struct Step {
        Index triangle;
        int edge;
        Cone cone;
    };
    const FreeSpace& space_;
    std::vector<Step> stack_;

    template <class See>
    void cross(Point v, const Step& step, See& see) {
        const maps::Triangulation& mesh = space_.mesh;
        const Index u = mesh[step.triangle].across[std::size_t(step.edge)];
        const int apex = mesh[u].edge_to(step.triangle);
        const Point w = mesh.point(mesh[u].corner[std::size_t(apex)]);
        const int of_right = step.cone.right.side(w), of_left = step.cone.left.side(w);
        if (of_right >= 0 && of_left <= 0) see(3 * u + apex);
        // In u the edge runs from the left of the view to its right; the apex divides what lies behind.
        const Ray through{v, w};
        if (of_right > 0) {
            const Cone part{step.cone.right, of_left < 0 ? through : step.cone.left};
            stack_.push_back({u, maps::next_corner(apex), part});
        }
        if (of_left < 0) {
            const Cone part{of_right > 0 ? through : step.cone.right, step.cone.left};
            stack_.push_back({u, maps::previous_corner(apex), part});
        }
    }
};

class VisibilityGraph {
  public:
    struct Edge {
        Index to;
        double length;
    };

    explicit VisibilityGraph(const FreeSpace& space) : space_(space) {
        const maps::Sectors sectors = maps::find_sectors(space);
        std::vector<Index> node_of;
        for (const Sector& s : sectors.all) {
            node_of.push_back(s.turns ? size() : none);
            if (s.turns) nodes_.push_back(s);
        }
        for (const Index s : sectors.of) node_at_.push_back(s == none ? none : node_of[std::size_t(s)]);
        seen_by_.assign(nodes_.size(), none);
        first_.push_back(0);
        View view(space_);
        for (Index n = 0; n < size(); ++n) {
            poll_interrupts();
            connect(view, n);
            first_.push_back(Index(edges_.size()));
        }
    }

    Index size() const { return Index(nodes_.size()); }
    std::size_t edges() const { return edges_.size(); }
    Point point(Index n) const { return nodes_[std::size_t(n)].at; }
    std::span<const Edge> edges_of(Index n) const {
        return {edges_.data() + first_[std::size_t(n)], edges_.data() + first_[std::size_t(n) + 1]};
    }

    // The nodes that a point of free space sees and a taut string from it may turn at; `triangles` hold the
    // point. `enter` is called as by View.
    template <class Enter>
    void see_from(View& view, Point p, const std::vector<Index>& triangles, std::vector<Edge>& out,
                  Enter enter) const {
        const auto note = [&](Index corner) {
            const Index n = node_at_[std::size_t(corner)];
            if (n == none || point(n) == p || !is_tangent(p, n)) return;
            for (const Edge& known : out)
                if (known.to == n) return;
            out.push_back({n, distance(p, point(n))});
        };
        for (const Index t : triangles) {
            const maps::Triangle& tri = space_.mesh[t];
            for (int i = 0; i < 3; ++i) {
                note(3 * t + i);
                const Point a = space_.mesh.point(tri.begin(i)), b = space_.mesh.point(tri.end(i));
                if (orientation(p, a, b) > 0) view.look(p, t, i, {{p, a}, {p, b}}, enter, note);
            }
        }
    }

  private:
    const FreeSpace& space_;
    std::vector<Sector> nodes_;
    std::vector<Index> node_at_;  // at corner i of triangle t, as 3t + i; or none
    std::vector<Index> first_;
    std::vector<Edge> edges_;
    std::vector<Index> seen_by_;

    // Whether the walls that meet at a node lie on one side of the line to it.
    bool is_tangent(Point from, Index n) const {
        const Sector& s = nodes_[std::size_t(n)];
        return orientation(from, s.at, s.begin) * orientation(from, s.at, s.end) >= 0;
    }

    // The edges of a node. Seen from it, a taut string comes in or leaves along its walls' sides alone:
    // counterclockwise from its first wall to the line of the last, or from the line of the first to the
    // last.
    void connect(View& view, Index n) {
        const Sector& s = nodes_[std::size_t(n)];
        const Point v = s.at;
        const maps::Triangulation& mesh = space_.mesh;
        const Ray past_last{s.end, v}, past_first{s.begin, v};
        const auto note = [&](Index corner) {
            const Index m = node_at_[std::size_t(corner)];
            if (m == none || m == n || seen_by_[std::size_t(m)] == n) return;
            const Point w = point(m);
            if ((past_last.side(w) > 0 && past_first.side(w) < 0) || !is_tangent(v, m)) return;
            seen_by_[std::size_t(m)] = n;
            edges_.push_back({m, distance(v, w)});
        };
        const auto enter = [](Index, const Cone&) {};
        const bool is_tip = s.begin == s.end;  // of a wall without thickness
        Index t = s.first / 3;
        for (int i = int(s.first % 3);;) {
            const maps::Triangle& tri = mesh[t];
            const Point a = mesh.point(tri.begin(i)), b = mesh.point(tri.end(i));
            note(3 * t + maps::next_corner(i));
            note(3 * t + maps::previous_corner(i));
            const Ray right{v, a}, left{v, b};
            if (past_last.side(a) < 0 || (is_tip && a == s.end))
                view.look(v, t, i, {right, past_last.side(b) <= 0 ? left : past_last}, enter, note);
            if (past_first.side(b) > 0 || (is_tip && b == s.begin))
                view.look(v, t, i, {past_first.side(a) >= 0 ? right : past_first, left}, enter, note);
            if (space_.is_wall(t, maps::next_corner(i))) return;
            const Index u = tri.across[std::size_t(maps::next_corner(i))];
            i = mesh[u].place_of(tri.corner[std::size_t(i)]);
            t = u;
        }
    }
};

}  // namespace cspace::navigation
