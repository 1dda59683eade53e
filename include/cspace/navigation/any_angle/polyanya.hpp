// The shortest path through convex polygons (Cui, Harabor & Grastien 2017, "Compromise-free pathfinding on a
// navigation mesh").
//
// A node is an interval of an edge that the root, the last corner of the path, sees: the search runs from
// edge to edge and a path turns at corners of obstacles alone. Here what a root sees is bounded by two lines
// through given points (the root and a corner, or the two last corners) and each decision is an exact
// orientation of three such points; the ends of intervals are computed for the estimates only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "cspace/maps/convex_mesh.hpp"
#include "cspace/math/isa.hpp"
#include "cspace/math/predicates.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/search/best_first.hpp"
#include "cspace/search/node_tables.hpp"

namespace cspace::navigation {

using maps::ConvexMesh;
using maps::Index;
using maps::none;

// Mesh: convex polygons, corners on one line allowed, with the words of maps::ConvexMesh or maps::RunMesh.
template <class Mesh>
class IntervalSearch {
  public:
    using Edge = typename Mesh::Edge;
    using Polygon = typename Mesh::Polygon;

    explicit IntervalSearch(const Mesh& mesh) : mesh_(mesh) {}

    static constexpr auto never = [] { return std::numeric_limits<std::uint64_t>::max(); };

    // starts, goals: the polygons whose closures contain the start and the goal. After `pause` nodes look()
    // is asked, which says after how many it is to be asked again; 0: there is no path.
    template <class Look = decltype(never)>
    Route solve(Point start, const std::vector<Polygon>& starts, Point goal,
                const std::vector<Polygon>& goals, Trace* trace = nullptr, std::uint64_t pause = never(),
                Look look = never) {
        begin(start, goal, goals, trace);
        for (const Polygon& p : starts)
            for (const Polygon& q : goals)
                if (p == q) return straight();
        for (const Polygon& p : starts) expand_start(p);
        Open open{*this};
        search::Effort effort;
        for (effort.pause = pause; effort.pause > 0; effort.pause = look()) {
            const std::uint32_t last = search::best_first(open, queue_, effort);
            if (last != search::no_node) return finish(nodes_[last]);
            if (queue_.empty()) break;
        }
        Route route;
        route.status = Status::unreachable;
        route.stats = stats_;
        return route;
    }

    std::size_t bytes() const {
        return best_.bytes() + nodes_.capacity() * sizeof(Node) + free_.capacity() * sizeof(Index) +
               queue_.bytes();
    }

  private:
    struct Line {  // the line from one point to another, or none
        Index from = none, to = none;
    };
    struct Node {
        double g;
        Line on_left, on_right;  // what bounds the interval, seen from the root
        Index root;
        Edge edge;  // as the polygon has it that is entered
    };

    enum Hand { to_the_right, to_the_left };
    static constexpr int sign_of[2] = {1, -1};
    struct Arrival {  // the shortest way found to a corner
        double g = 0;
        std::uint32_t query = 0;          // in which it was found
        Index before = none;              // the corner, or the start, that it comes from
        Index from[2] = {none, none};     // the corner before, of the way that has to turn least, by hand
        Index through[2] = {none, none};  // and the passage by which it arrived
    };

    const Mesh& mesh_;
    std::conditional_t<Mesh::is_vast, search::SparseTable<Arrival>, search::DenseTable<Arrival>> best_;
    std::uint32_t query_ = 0;
    std::vector<Node> nodes_;  // open nodes, and free places of expanded ones
    std::vector<Index> free_;
    struct Waits {  // without a tie to look at: a twentieth of a search
        double priority;
        std::uint32_t node;
        friend bool operator<(const Waits& x, const Waits& y) { return x.priority < y.priority; }
    };
    search::Heap<Waits> queue_;
    std::vector<Polygon> goals_;
    Point start_, goal_;
    bool is_inside_ = false;  // whether the start itself looks around, in a polygon that holds it
    Stats stats_;
    Trace* trace_ = nullptr;

    static constexpr Index at_start = -2;
    static constexpr double same_length = 1e-13;  // lengths of sums of some hundred chords differ by less

    Point at(Index v) const { return v == at_start ? start_ : mesh_.point(v); }
    bool turns(Index v) const { return v != at_start && mesh_.may_turn(v); }
    bool is_goal(const Edge& entered) const {
        for (const Polygon& p : goals_)
            if (mesh_.is_side(entered, p)) return true;
        return false;
    }

    void begin(Point start, Point goal, const std::vector<Polygon>& goals, Trace* trace) {
        if (++query_ == 0) query_ = 1, best_.forget();
        if constexpr (Mesh::is_vast)
            best_.begin();
        else
            best_.begin(mesh_.points.size());
        nodes_.clear();
        free_.clear();
        queue_.clear();
        start_ = start, goal_ = goal, goals_ = goals, stats_ = {}, trace_ = trace;
    }
    Route straight() const {
        Route route;
        route.status = Status::found;
        route.path = {start_, goal_};
        if (start_ == goal_) route.path.pop_back();
        route.length = distance(start_, goal_);
        route.stats = stats_;
        return route;
    }

    // Intervals as nodes of best_first. A place that has been expanded serves another interval.
    struct Open {
        IntervalSearch& search;

        bool settle(std::uint32_t n) {
            if (!search.is_stale(search.nodes_[n])) return true;
            search.free_.push_back(Index(n));
            return false;
        }
        bool is_goal(std::uint32_t n) const { return search.is_goal(search.nodes_[n].edge); }
        void expand(std::uint32_t n, search::Heap<Waits>&) {
            const Node from = search.nodes_[n];
            search.free_.push_back(Index(n));
            search.expand(from);
        }
    };
    // Whether a shorter way to the root of a node is known by now.
    bool is_stale(const Node& n) {
        return n.root != at_start && n.g > best_[std::uint32_t(n.root)].g * (1 + same_length);
    }
    // Notes a way of length g to a corner, coming from another one to turn by `hand` there; false if a
    // shorter way is known, or one as long that has to turn less for all that this one reaches, or the same
    // through the same passage. (Grids have many ways of one length, and the intervals that they lead to
    // overlap: following each of them takes time without end.)
    bool reach(Index v, double g, Index from, Hand hand, Index through) {
        Arrival& best = best_[std::uint32_t(v)];
        const bool is_first = best.query != query_;
        if (!is_first && g > best.g * (1 + same_length)) return false;
        if (is_first || g < best.g * (1 - same_length)) best.from[0] = best.from[1] = none;
        if (is_first || g < best.g) best.g = g, best.before = from;
        best.query = query_;
        const Index known = best.from[hand];
        if (known == from) {
            if (best.through[hand] == through) return false;
        } else if (known != none && sign_of[hand] * orientation(at(known), at(v), at(from)) >= 0) {
            return false;
        }
        best.from[hand] = from;
        best.through[hand] = through;
        return true;
    }

    // Where a line meets the edge from a to b.
    Point meet(Line line, Index a, Index b, Index fallback) const {
        if (line.to == a || line.from == a) return at(a);
        if (line.to == b || line.from == b) return at(b);
        if (line.to == none) return at(fallback);
        const Point p = at(line.from), d = at(line.to) - p, u = at(a), e = at(b) - u;
        const double along = cross(e, d);
        if (along == 0) return at(fallback);
        return u + std::clamp(cross(p - u, d) / cross(e, d), 0.0, 1.0) * e;
    }

    // The least length from r through the interval to the goal.
    CSPACE_INLINE double estimate(Point r, Point left, Point right) const {
        Point t = goal_;
        const Point along = left - right;
        const double t_side = cross(along, t - right);
        // The goal, mirrored at the edge: the interval is crossed from its left to its right side.
        if (t_side > 0) {
            const double s = 2 * t_side / squared_norm(along);
            t = {t.x + s * along.y, t.y - s * along.x};
        }
        if (cross(left - r, t - r) > 0) return distance(r, left) + distance(left, t);
        if (cross(right - r, t - r) < 0) return distance(r, right) + distance(right, t);
        return distance(r, t);
    }

    // The interval of the edge from a to b (a on the right) that the root sees between two lines becomes a
    // node.
    void push(Index root, double g, Line on_left, Line on_right, const Edge& edge) {
        ++stats_.edges;
        const Edge entered = mesh_.across(edge);
        if (!mesh_.leads_on(entered) && !is_goal(entered)) return;
        const Index a = mesh_.tail(edge), b = mesh_.head(edge);
        const double f = g + estimate(at(root), meet(on_left, a, b, b), meet(on_right, a, b, a));
        if (free_.empty()) {
            free_.push_back(Index(nodes_.size()));
            nodes_.emplace_back();
        }
        const std::uint32_t place = std::uint32_t(free_.back());
        free_.pop_back();
        nodes_[place] = {g, on_left, on_right, root, entered};
        queue_.push({f, place});
    }

    // All of an edge is reached from its nearer end v, to which a path leads along the line of the edge.
    void push_along(Index from, double g, Index v, Index far, Hand hand, const Edge& edge) {
        g += distance(at(from), at(v));
        if (!turns(v) || !reach(v, g, from, hand, 2 * mesh_.name(edge) + 1)) return;
        const Line along{v, far};
        push(v, g, hand == to_the_right ? along : Line{}, hand == to_the_right ? Line{} : along, edge);
    }

    // The ends of a node's interval, left and right of who enters.
    std::pair<Point, Point> interval(const Node& n) const {
        const Index left = mesh_.tail(n.edge), right = mesh_.head(n.edge);
        return {meet(n.on_left, right, left, left), meet(n.on_right, right, left, right)};
    }

    // What can be reached from the root of a node inside the polygon that it enters.
    void expand(const Node& from) {
        ++stats_.nodes;
        if (trace_) {
            const auto [left, right] = interval(from);
            trace_->push_back({0, right, left, from.g + estimate(at(from.root), left, right)});
        }
        // The edge as the polygon sees it begins on the left of who enters.
        const Index left_end = mesh_.tail(from.edge), right_end = mesh_.head(from.edge);
        const bool may_turn_right =
            from.on_right.to == right_end && turns(right_end) && from.root != right_end;
        const bool may_turn_left = from.on_left.to == left_end && turns(left_end) && from.root != left_end;
        const double g_right = may_turn_right ? from.g + distance(at(from.root), at(right_end)) : 0;
        const double g_left = may_turn_left ? from.g + distance(at(from.root), at(left_end)) : 0;
        const bool right_open =
            may_turn_right && reach(right_end, g_right, from.root, to_the_right, 2 * mesh_.name(from.edge));
        const bool left_open =
            may_turn_left && reach(left_end, g_left, from.root, to_the_left, 2 * mesh_.name(from.edge));
        const View view{*this, from, left_open, right_open};
        mesh_.visit_doors_beyond(from.edge, view, [&](const Edge& e) {
            see(from, e);
            if (right_open) turn_right(from.on_right, right_end, g_right, e);
            if (left_open) turn_left(from.on_left, left_end, g_left, e);
        });
    }
    void expand_start(const Polygon& p) {
        ++stats_.nodes;
        Node from{};
        from.root = at_start;
        is_inside_ = true;
        mesh_.visit_doors(p, [&](const Edge& e) { see(from, e); });
        is_inside_ = false;
    }

    // What a node may reach, for meshes that would look at fewer doors: on either side all up to a line, or,
    // where that is none, everything.
    struct View {
        const IntervalSearch& search;
        const Node& from;
        bool left_open, right_open;

        Point root() const { return search.at(from.root); }
        bool is_bounded_left() const { return !left_open && from.on_left.to != none; }
        bool is_bounded_right() const { return !right_open && from.on_right.to != none; }
        std::pair<Point, Point> left() const {
            return {search.at(from.on_left.from), search.at(from.on_left.to)};
        }
        std::pair<Point, Point> right() const {
            return {search.at(from.on_right.from), search.at(from.on_right.to)};
        }
    };

    // The part of an edge that a root sees between the lines of a node.
    void see(const Node& from, const Edge& edge) {
        const Index a = mesh_.tail(edge), b = mesh_.head(edge);
        const Point r = at(from.root);
        const int facing = a == from.root || b == from.root ? 0 : orientation(r, at(a), at(b));
        if (facing < 0) return;
        if (facing == 0) return see_along(from, edge, a, b);
        if (is_past(from.on_right, -1, r, b) || is_past(from.on_left, 1, r, a)) return;
        push(from.root, from.g, side(from.on_left, b) > 0 ? from.on_left : Line{from.root, b},
             side(from.on_right, a) < 0 ? from.on_right : Line{from.root, a}, edge);
    }
    // An edge on one line with the root: it is entered from the root itself, or from its nearer end. Where
    // the start lies on the edge, the polygon across holds it too; at an end of the edge that was entered it
    // is reached by a turn.
    void see_along(const Node& from, const Edge& edge, Index a, Index b) {
        const Point r = at(from.root);
        if (a == from.root) return push(from.root, from.g, {from.root, b}, {}, edge);
        if (b == from.root) return push(from.root, from.g, {}, {from.root, a}, edge);
        if (from.root == at_start && is_between(at(a), r, at(b))) return;
        if (hidden(from, a) || hidden(from, b)) return;
        const bool a_is_near = is_between(r, at(a), at(b));
        if (!is_inside_ && is_end_of(from.edge, a_is_near ? a : b)) return;
        if (a_is_near)
            push_along(from.root, from.g, a, b, to_the_right, edge);
        else
            push_along(from.root, from.g, b, a, to_the_left, edge);
    }
    bool is_end_of(const Edge& edge, Index v) const { return mesh_.tail(edge) == v || mesh_.head(edge) == v; }
    bool hidden(const Node& from, Index v) const {
        return side(from.on_right, v) < 0 || side(from.on_left, v) > 0;
    }
    // Whether a point lies on a side of a line (1: left) or, ahead of the root, on the line. Behind the root
    // the line bounds nothing: that far a path turns around the end of a wall.
    bool is_past(Line line, int hand, Point root, Index v) const {
        if (line.to == none) return false;
        const int where = side(line, v) * hand;
        return where > 0 || (where == 0 && dot(at(line.to) - at(line.from), at(v) - root) > 0);
    }
    int side(Line line, Index v) const {
        if (line.to == none || line.to == v || line.from == v) return 0;
        return orientation(at(line.from), at(line.to), at(v));
    }

    // What lies to the right of the right line, reached by turning at the corner v on it.
    void turn_right(Line line, Index v, double g, const Edge& edge) {
        const Index a = mesh_.tail(edge), b = mesh_.head(edge);
        if (a == v) {
            if (side(line, b) <= 0) push(v, g, {v, b}, {}, edge);
            return;
        }
        if (b == v || side(line, a) >= 0) return;
        if (orientation(at(v), at(a), at(b)) == 0) return push_along(v, g, a, b, to_the_right, edge);
        push(v, g, side(line, b) <= 0 ? Line{v, b} : line, {v, a}, edge);
    }
    void turn_left(Line line, Index v, double g, const Edge& edge) {
        const Index a = mesh_.tail(edge), b = mesh_.head(edge);
        if (b == v) {
            if (side(line, a) >= 0) push(v, g, {}, {v, a}, edge);
            return;
        }
        if (a == v || side(line, b) <= 0) return;
        if (orientation(at(v), at(a), at(b)) == 0) return push_along(v, g, b, a, to_the_left, edge);
        push(v, g, {v, b}, side(line, a) >= 0 ? Line{v, a} : line, edge);
    }

    Route finish(const Node& end) {
        Route route;
        route.stats = stats_;
        const Point r = at(end.root);
        const auto [left, right] = interval(end);
        route.path.push_back(goal_);
        if (cross(left - r, goal_ - r) > 0)
            route.path.push_back(left);
        else if (cross(right - r, goal_ - r) < 0)
            route.path.push_back(right);
        for (Index v = end.root; v != at_start; v = best_[std::uint32_t(v)].before)
            if (!(route.path.back() == at(v))) route.path.push_back(at(v));
        if (!(route.path.back() == start_)) route.path.push_back(start_);
        finish_reversed(route);
        return route;
    }
};

using Polyanya = IntervalSearch<ConvexMesh>;

}  // namespace cspace::navigation
