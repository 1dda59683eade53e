// A constrained Delaunay triangulation, built point by point and segment by segment.
//
// Points are inserted along a space-filling curve and made Delaunay by flips (Lawson 1977); a segment is
// forced by flipping the edges that cross it (Sloan 1993, "A fast algorithm for generating constrained
// Delaunay triangulations"). Every decision that the validity of the triangles depends on is exact. Segments
// that cross each other meet in a new vertex: the crossing of the two lines as they were given, rounded to
// the nearest doubles, or an end of one of them within rounding of it. Both are bent to that vertex, and what
// the bent parts cross is found like any other crossing. A segment is divided at the vertices on it before it
// is bent, because afterwards they no longer lie on it.
#pragma once

#include <algorithm>
#include <utility>

#include "cspace/maps/triangulation.hpp"
#include "cspace/math/crossing.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::maps {

class Triangulator {
  public:
    // What a segment is part of, as a list: segments that lie on one another share an edge.
    struct Owner {
        Index id, next;
        Index from, to;  // the segment as it was given
    };
    struct Crossing {
        Point at;
        Index one, other;  // lists of owners
    };

    Triangulation mesh;
    std::vector<Owner> owners;
    std::vector<Crossing> crossings;

    // Everything that will be inserted lies between low and high; `segments` is their number.
    Triangulator(Point low, Point high, std::size_t segments)
        : most_bends_(std::min<std::size_t>(200'000 + 50 * segments, 64 + 4 * segments * segments)),
          most_of_one_(64 + 4 * segments) {
        const double reach = std::max({high.x - low.x, high.y - low.y, tolerance::nonzero});
        low = low - Point{reach, reach};
        high = high + Point{reach, reach};
        constexpr double roundings = 0x1p-50;  // eight of them, relative
        rounding_ =
            roundings * std::max({std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y)});
        mesh.points = {low, {high.x, low.y}, high, {low.x, high.y}};
        mesh.triangles = {{{0, 1, 2}, {none, 1, none}, {none, none, none}},
                          {{0, 2, 3}, {none, none, 0}, {none, none, none}}};
        mesh.triangle_at = {0, 0, 0, 1};
    }

    // The vertex at p, made if there is none.
    Index insert(Point p) {
        poll_.step();
        const Place place = mesh.locate(p, last_);
        const Index v = place.kind == Place::at_corner ? mesh[place.triangle].corner[std::size_t(place.index)]
                                                       : add_point(p, place.triangle);
        if (place.kind == Place::inside) split_triangle(place.triangle, v);
        if (place.kind == Place::on_edge) split_edge(place.triangle, place.index, v);
        legalize();
        last_ = mesh.triangle_at[std::size_t(v)];
        return v;
    }

    // Makes the segment between two vertices an edge, or several, of the owner; false if that would not end.
    bool insert_segment(Index a, Index b, Index owner) {
        const std::size_t most = std::min(most_bends_, bends_ + most_of_one_);
        owners.push_back({owner, none, a, b});
        pending_.push_back({a, b, Index(owners.size() - 1), true});
        while (!pending_.empty()) {
            poll_.step();
            const Segment s = pending_.back();
            pending_.pop_back();
            if (s.a != s.b) advance(s);
            if (bends_ > most) return false;
        }
        return true;
    }

  private:
    struct Segment {
        Index a, b, owners;
        bool is_straight;  // not bent yet: vertices may lie on it
    };
    using Edge = std::pair<Index, Index>;

    InterruptPoll poll_{64};
    Index last_ = 0;
    std::size_t bends_ = 0, most_bends_, most_of_one_;  // in all, and while one segment is inserted
    double rounding_;                                   // how far a crossing may be moved by rounding
    std::vector<Segment> pending_;
    std::vector<std::pair<Index, Index>>
        suspects_;  // (triangle, vertex): the edge opposite it may need a flip
    std::vector<Edge> crossed_, made_;

    Point at(Index v) const { return mesh.point(v); }

    Index add_point(Point p, Index triangle) {
        mesh.points.push_back(p);
        mesh.triangle_at.push_back(triangle);
        return Index(mesh.points.size() - 1);
    }
    Index add_triangle() {
        mesh.triangles.push_back({});
        return Index(mesh.triangles.size() - 1);
    }

    // Gives edge `e` of `t` what lies across edge `from` of the old triangle, and updates the neighbour.
    void adopt(Index t, int e, Index across, Index owners_of_edge, Index old) {
        mesh[t].across[std::size_t(e)] = across;
        mesh[t].owners[std::size_t(e)] = owners_of_edge;
        if (across != none) {
            Triangle& other = mesh[across];
            other.across[std::size_t(other.edge_to(old))] = t;
        }
    }
    void join(Index t, int e, Index u, int f, Index owners_of_edge) {
        mesh[t].across[std::size_t(e)] = u;
        mesh[t].owners[std::size_t(e)] = owners_of_edge;
        if (u == none) return;
        mesh[u].across[std::size_t(f)] = t;
        mesh[u].owners[std::size_t(f)] = owners_of_edge;
    }

    // Triangle t becomes three around v.
    void split_triangle(Index t, Index v) {
        const Triangle old = mesh[t];
        const Index part[3] = {t, add_triangle(), add_triangle()};
        for (int i = 0; i < 3; ++i) {
            const Index u = part[i];
            mesh[u].corner = {v, old.begin(i), old.end(i)};
            adopt(u, 0, old.across[std::size_t(i)], old.owners[std::size_t(i)], t);
            mesh.triangle_at[std::size_t(old.begin(i))] = u;
            suspects_.push_back({u, v});
        }
        for (int i = 0; i < 3; ++i) join(part[i], 1, part[next_corner(i)], 2, none);
        mesh.triangle_at[std::size_t(v)] = t;
    }

    // The edge e of t is divided at v, and with it the triangles on both sides.
    void split_edge(Index t, int e, Index v) {
        const Triangle old = mesh[t];
        const Index u = old.across[std::size_t(e)], chain = old.owners[std::size_t(e)];
        const auto [t0, t1] = split_side(t, e, v);
        if (u == none) return;
        const auto [u0, u1] = split_side(u, mesh[u].edge_to(t), v);
        join(t0, 0, u1, 0, chain);
        join(t1, 0, u0, 0, chain);
    }
    // Divides one triangle at v on its edge e: the part that keeps the edge's beginning, then the other; in
    // both the piece of the edge is edge 0 and v is corner 2, or 1. The pieces keep the owners of the edge.
    std::pair<Index, Index> split_side(Index t, int e, Index v) {
        const Triangle old = mesh[t];
        const Index apex = old.corner[std::size_t(e)], u = add_triangle(), chain = old.owners[std::size_t(e)];
        const int to_begin = previous_corner(e),
                  to_end = next_corner(e);  // the edges from the apex to begin, from end to the apex
        mesh[t].corner = {apex, old.begin(e), v};
        mesh[u].corner = {apex, v, old.end(e)};
        const Index begin_side = old.across[std::size_t(to_begin)],
                    begin_owners = old.owners[std::size_t(to_begin)];
        const Index end_side = old.across[std::size_t(to_end)], end_owners = old.owners[std::size_t(to_end)];
        mesh[t].across = {none, none, none};
        adopt(u, 1, end_side, end_owners, t);
        mesh[t].across[2] = begin_side, mesh[t].owners[2] = begin_owners;
        join(t, 1, u, 2, none);
        mesh[t].owners[0] = mesh[u].owners[0] = chain;
        mesh[u].across[0] = none;
        mesh.triangle_at[std::size_t(old.begin(e))] = t;
        mesh.triangle_at[std::size_t(old.end(e))] = u;
        mesh.triangle_at[std::size_t(apex)] = t;
        mesh.triangle_at[std::size_t(v)] = t;
        suspects_.push_back({t, v});
        suspects_.push_back({u, v});
        return {t, u};
    }

    // The edge e of t becomes the other diagonal of its two triangles.
    void flip(Index t, int e) {
        const Index u = mesh[t].across[std::size_t(e)];
        const Triangle a = mesh[t], b = mesh[u];
        const int f = b.edge_to(t);
        const Index r = a.corner[std::size_t(e)], s = b.corner[std::size_t(f)], p = a.begin(e), q = a.end(e);
        const int rp = previous_corner(e), qr = next_corner(e), sq = previous_corner(f), ps = next_corner(f);
        mesh[t].corner = {r, p, s};
        mesh[u].corner = {s, q, r};
        const Index t_old[2] = {a.across[std::size_t(rp)], a.owners[std::size_t(rp)]};
        const Index u_old[2] = {b.across[std::size_t(sq)], b.owners[std::size_t(sq)]};
        adopt(t, 0, b.across[std::size_t(ps)], b.owners[std::size_t(ps)], u);
        adopt(u, 0, a.across[std::size_t(qr)], a.owners[std::size_t(qr)], t);
        mesh[t].across[2] = t_old[0], mesh[t].owners[2] = t_old[1];
        mesh[u].across[2] = u_old[0], mesh[u].owners[2] = u_old[1];
        join(t, 1, u, 1, none);
        mesh.triangle_at[std::size_t(r)] = mesh.triangle_at[std::size_t(p)] =
            mesh.triangle_at[std::size_t(s)] = t;
        mesh.triangle_at[std::size_t(q)] = u;
    }

    // Flips free edges until none surely violates the circle test.
    void legalize() {
        while (!suspects_.empty()) {
            const auto [t, v] = suspects_.back();
            suspects_.pop_back();
            const int e = mesh[t].place_of(v);
            if (mesh[t].corner[std::size_t(e)] != v) continue;  // flipped away since
            const Index u = mesh[t].across[std::size_t(e)];
            if (u == none || mesh[t].owners[std::size_t(e)] != none || !should_flip(t, e)) continue;
            flip(t, e);
            suspects_.push_back({t, v});
            suspects_.push_back({u, v});
        }
    }
    bool should_flip(Index t, int e) const {
        const Triangle &a = mesh[t], &b = mesh[a.across[std::size_t(e)]];
        const Index s = b.corner[std::size_t(b.edge_to(t))];
        return surely_in_circle(at(a.corner[0]), at(a.corner[1]), at(a.corner[2]), at(s)) && is_convex(t, e);
    }
    // Whether the two triangles of an edge form a strictly convex quadrilateral.
    bool is_convex(Index t, int e) const {
        const Triangle &a = mesh[t], &b = mesh[a.across[std::size_t(e)]];
        const Point r = at(a.corner[std::size_t(e)]), s = at(b.corner[std::size_t(b.edge_to(t))]);
        return orientation(r, s, at(a.begin(e))) < 0 && orientation(r, s, at(a.end(e))) > 0;
    }

    // The triangle and edge from p to q: they are neighbours.
    std::pair<Index, int> edge_between(Index p, Index q) const {
        std::pair<Index, int> found{none, 0};
        mesh.around(p, [&](Index t, int i) {
            if (mesh[t].corner[std::size_t(next_corner(i))] != q) return true;
            found = {t, previous_corner(i)};
            return false;
        });
        return found;
    }

    // Makes the edge from p to q part of one more list of owners.
    void mark(Index p, Index q, Index list) {
        const auto [t, e] = edge_between(p, q);
        Index chain = mesh[t].owners[std::size_t(e)];
        if (chain == none) {
            chain = list;
        } else {
            for (Index o = list; o != none; o = owners[std::size_t(o)].next) {
                Owner copy = owners[std::size_t(o)];
                copy.next = chain;
                owners.push_back(copy);
                chain = Index(owners.size() - 1);
            }
        }
        set_owners(t, e, chain);
    }
    void set_owners(Index t, int e, Index list) {
        mesh[t].owners[std::size_t(e)] = list;
        Triangle& other = mesh[mesh[t].across[std::size_t(e)]];
        other.owners[std::size_t(other.edge_to(t))] = list;
    }

    // Makes the first part of a segment an edge, up to the next vertex on it or to where it crosses another
    // segment; what is left is pending.
    void advance(const Segment& s) {
        const auto [first, i] = leave(s);
        if (first == none) return;
        crossed_.clear();
        std::pair<Index, int> met{none, 0};  // the first edge on the way that is part of a segment
        Index t = first, p = mesh[t].corner[std::size_t(next_corner(i))],
              q = mesh[t].corner[std::size_t(previous_corner(i))];
        for (int e = i;;) {  // p lies to the right of the segment, q to the left, the edge between crosses it
            if (met.first == none && mesh[t].owners[std::size_t(e)] != none) {
                met = {t, e};
                if (!s.is_straight) return cross(s, t, e);
            }
            crossed_.push_back({p, q});
            const Index u = mesh[t].across[std::size_t(e)];
            const int opposite = mesh[u].edge_to(t);
            const Index w = mesh[u].corner[std::size_t(opposite)];
            const int side = w == s.b ? 0 : orientation(at(s.a), at(s.b), at(w));
            if (side == 0) return reach(s, w, met);
            e = mesh[u].place_of(side > 0 ? q : p);  // the next edge is (p, w), or (w, q)
            (side > 0 ? q : p) = w;
            t = u;
        }
    }
    // The next vertex on a segment is w: the part up to it crosses `met`, or becomes an edge.
    void reach(const Segment& s, Index w, std::pair<Index, int> met) {
        if (w != s.b) pending_.push_back({w, s.b, s.owners, s.is_straight});
        if (met.first != none) return cross({s.a, w, s.owners, false}, met.first, met.second);
        force({s.a, w, s.owners, s.is_straight});
    }

    // The triangle around a through which the segment leaves it, and the place of a in it; none if it leaves
    // along an edge, which is then marked.
    std::pair<Index, int> leave(const Segment& s) {
        Index along = none;
        std::pair<Index, int> through{none, 0};
        const Point a = at(s.a), b = at(s.b);
        mesh.around(s.a, [&](Index t, int i) {
            const Index u = mesh[t].corner[std::size_t(next_corner(i))],
                        v = mesh[t].corner[std::size_t(previous_corner(i))];
            const int right = u == s.b ? 0 : orientation(a, b, at(u));
            if (right == 0 && is_between(a, at(u), b)) {
                along = u;
                return false;
            }
            if (right >= 0 || v == s.b || orientation(a, b, at(v)) <= 0) return true;
            through = {t, i};
            return false;
        });
        if (along != none) {
            mark(s.a, along, s.owners);
            pending_.push_back({along, s.b, s.owners, s.is_straight});
        }
        return through;
    }

    // The segment crosses the edge e of t, which is part of another: both get the vertex where they cross.
    void cross(const Segment& s, Index t, int e) {
        const Index p = mesh[t].begin(e), q = mesh[t].end(e), list = mesh[t].owners[std::size_t(e)];
        const Owner &one = owners[std::size_t(s.owners)], &other = owners[std::size_t(list)];
        const Line a{at(one.from), at(one.to)}, b{at(other.from), at(other.to)};
        const bool is_given = do_cross(a, b);
        Point x = is_given ? line_crossing(a, b) : Point{};
        if (!is_given || !is_near(x, s.a, s.b) || !is_near(x, p, q))
            x = line_crossing({at(s.a), at(s.b)}, {at(p), at(q)});
        if (is_given) crossings.push_back({x, s.owners, list});
        ++bends_;
        set_owners(t, e, none);
        Index v = none;
        for (const Index end : {s.a, s.b, p, q})
            if (distance(at(end), x) <= rounding_) v = end;
        if (v == none) {
            last_ = t;
            v = insert(x);
        }
        for (const Segment& piece : {Segment{s.a, v, s.owners, false}, Segment{v, s.b, s.owners, false},
                                     Segment{p, v, list, false}, Segment{v, q, list, false}})
            pending_.push_back(piece);
    }
    // Whether x lies in the box of two vertices, up to rounding.
    bool is_near(Point x, Index v, Index w) const {
        const Point p = at(v), q = at(w);
        return x.x >= std::min(p.x, q.x) - rounding_ && x.x <= std::max(p.x, q.x) + rounding_ &&
               x.y >= std::min(p.y, q.y) - rounding_ && x.y <= std::max(p.y, q.y) + rounding_;
    }

    // Flips the edges in crossed_ until the segment is an edge.
    void force(const Segment& s) {
        made_.clear();
        for (std::size_t i = 0; i < crossed_.size(); ++i) {
            const auto [p, q] = crossed_[i];
            const auto [t, e] = edge_between(p, q);
            if (!is_convex(t, e)) {
                crossed_.push_back({p, q});
                continue;
            }
            const Index u = mesh[t].across[std::size_t(e)];
            const Index r = mesh[t].corner[std::size_t(e)],
                        w = mesh[u].corner[std::size_t(mesh[u].edge_to(t))];
            flip(t, e);
            const bool ends_here = r == s.a || r == s.b || w == s.a || w == s.b;
            const bool still =
                !ends_here && orientation(at(s.a), at(s.b), at(r)) != orientation(at(s.a), at(s.b), at(w));
            (still ? crossed_ : made_).push_back({r, w});
        }
        mark(s.a, s.b, s.owners);
        smooth();
    }

    // Makes the edges that a segment left behind Delaunay again.
    void smooth() {
        for (bool again = true; again;) {
            again = false;
            for (Edge& edge : made_) {
                const auto [t, e] = edge_between(edge.first, edge.second);
                if (mesh[t].owners[std::size_t(e)] != none || !should_flip(t, e)) continue;
                const Index u = mesh[t].across[std::size_t(e)];
                edge = {mesh[t].corner[std::size_t(e)], mesh[u].corner[std::size_t(mesh[u].edge_to(t))]};
                flip(t, e);
                again = true;
            }
        }
    }
};

// The place of a point along a curve that fills the square (Hilbert): neighbours on it are neighbours in the
// plane.
inline std::uint32_t along_hilbert(Point p, Point low, double side) {
    auto x = std::uint32_t(65535 * std::clamp((p.x - low.x) / side, 0.0, 1.0));
    auto y = std::uint32_t(65535 * std::clamp((p.y - low.y) / side, 0.0, 1.0));
    std::uint32_t place = 0;
    for (std::uint32_t s = 32768; s > 0; s /= 2) {
        const std::uint32_t rx = (x & s) > 0, ry = (y & s) > 0;
        place += s * s * ((3 * rx) ^ ry);
        if (ry == 0) {
            if (rx == 1) x = 65535 - x, y = 65535 - y;
            std::swap(x, y);
        }
    }
    return place;
}

}  // namespace cspace::maps
