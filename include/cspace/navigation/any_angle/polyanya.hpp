// The shortest path through convex polygons (Cui, Harabor & Grastien 2017, "Compromise-free pathfinding on a
// navigation mesh").
//
// A node is an interval of an edge that the root, the last corner of the path, sees: the search runs from
// edge to edge and a path turns at corners of obstacles alone. Here what a root sees is bounded by two lines
// through given points (the root and a corner, or the two last corners) and each decision is an exact
// orientation of three such points; the ends of intervals are computed for the estimates only.
#pragma once

#include <cmath>

#include "cspace/maps/convex_mesh.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

using maps::ConvexMesh;
using maps::Index;
using maps::none;

class Polyanya {
  public:
    explicit Polyanya(const ConvexMesh& mesh) : mesh_(mesh), best_(mesh.points.size()) {}

    // starts, goals: the polygons whose closures hold the start and the goal, all of one component.
    Route solve(Point start, const std::vector<Index>& starts, Point goal, const std::vector<Index>& goals,
                Trace* trace = nullptr) {
        begin(start, goal, goals, trace);
        for (const Index p : starts)
            for (const Index q : goals)
                if (p == q) return straight();
        for (const Index p : starts) expand_start(p);
        while (!heap_.empty()) {
            const Index n = pop();
            if (is_goal(mesh_.polygon[std::size_t(node(n).edge)])) return finish(n);
            if (!is_stale(node(n))) expand(n);
        }
        Route route;
        route.status = Status::unreachable;
        route.price = price_;
        return route;
    }

  private:
    struct Line {  // the line from one point to another, or none
        Index from = none, to = none;
    };
    struct Node {
        double f, g;
        Point left, right;  // the ends of the interval, seen from the root
        Line on_left, on_right;
        Index root, edge, parent;  // the edge belongs to the polygon that is entered
        Index via = none;          // a corner between the parent's root and this one
    };

    enum Hand { to_the_right, to_the_left };
    static constexpr int sign_of[2] = {1, -1};
    struct Arrival {  // the shortest way found to a corner
        double g = 0;
        std::uint32_t query = 0;       // in which it was found
        Index from[2] = {none, none};  // the corner before, of the way that has to turn least, by hand
    };

    const ConvexMesh& mesh_;
    std::vector<Arrival> best_;
    std::uint32_t query_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::pair<double, Index>> heap_;
    std::vector<Index> goals_;
    Point start_, goal_;
    Price price_;
    Trace* trace_ = nullptr;

    static constexpr Index at_start = -2;

    const Node& node(Index n) const { return nodes_[std::size_t(n)]; }
    Point at(Index v) const { return v == at_start ? start_ : mesh_.point(v); }
    bool turns(Index v) const { return v != at_start && mesh_.turns[std::size_t(v)]; }
    bool is_goal(Index p) const { return std::find(goals_.begin(), goals_.end(), p) != goals_.end(); }

    void begin(Point start, Point goal, const std::vector<Index>& goals, Trace* trace) {
        if (++query_ == 0) {
            std::fill(best_.begin(), best_.end(), Arrival{});
            query_ = 1;
        }
        nodes_.clear();
        heap_.clear();
        start_ = start, goal_ = goal, goals_ = goals, price_ = {}, trace_ = trace;
    }
    Route straight() const {
        Route route;
        route.status = Status::found;
        route.path = {start_, goal_};
        if (start_ == goal_) route.path.pop_back();
        route.length = distance(start_, goal_);
        route.price = price_;
        return route;
    }

    // --- the order of nodes
    // ----------------------------------------------------------------------------------
    Index pop() {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        const Index n = heap_.back().second;
        heap_.pop_back();
        return n;
    }
    // Whether a shorter way to the root of a node is known by now.
    bool is_stale(const Node& n) const {
        return n.root != at_start && n.g > best_[std::size_t(n.root)].g * (1 + 1e-13);
    }
    // Notes a way of length g to a corner, coming from another one to turn by `hand` there; false if a
    // shorter way is known, or one as long that has to turn less for all that this one reaches. (Grids have
    // many ways of one length; following each of them takes time without end.)
    bool reach(Index v, double g, Index from, Hand hand) {
        Arrival& best = best_[std::size_t(v)];
        const bool is_first = best.query != query_;
        if (!is_first && g > best.g * (1 + 1e-13)) return false;
        if (is_first || g < best.g * (1 - 1e-13)) best.from[0] = best.from[1] = none;
        best.query = query_;
        best.g = is_first ? g : std::min(best.g, g);
        Index& known = best.from[hand];
        if (known != none && known != from && sign_of[hand] * orientation(at(known), at(v), at(from)) >= 0)
            return false;
        known = from;
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
    double estimate(Point r, Point left, Point right) const {
        Point t = goal_;
        const Point along = left - right;
        const double t_side = cross(along, t - right);
        if (t_side >
            0) {  // the goal, mirrored at the edge: the interval is crossed from its left to its right side
            const double s = 2 * t_side / squared_norm(along);
            t = {t.x + s * along.y, t.y - s * along.x};
        }
        if (cross(left - r, t - r) > 0) return distance(r, left) + distance(left, t);
        if (cross(right - r, t - r) < 0) return distance(r, right) + distance(right, t);
        return distance(r, t);
    }

    // The interval of the edge from a to b (a on the right) that the root sees between two lines becomes a
    // node.
    void push(Index root, double g, Line on_left, Line on_right, Index edge, Index parent, Index via = none) {
        ++price_.edges;
        const Index entered = mesh_.twin[std::size_t(edge)];
        const Index p = mesh_.polygon[std::size_t(entered)];
        if (mesh_.doors[std::size_t(p)] <= 1 && !is_goal(p)) return;
        const Index a = mesh_.corner[std::size_t(edge)], b = mesh_.corner[std::size_t(mesh_.next(edge))];
        const Point right = meet(on_right, a, b, a), left = meet(on_left, a, b, b);
        const double f = g + estimate(at(root), left, right);
        nodes_.push_back({f, g, left, right, on_left, on_right, root, entered, parent, via});
        heap_.push_back({f, Index(nodes_.size() - 1)});
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }

    // All of an edge is reached from its nearer end v, to which a path leads along the line of the edge.
    void push_along(Index from, double g, Index v, Index far, Hand hand, Index edge, Index parent,
                    Index via) {
        g += distance(at(from), at(v));
        if (!turns(v) || !reach(v, g, from, hand)) return;
        const Line along{v, far};
        push(v, g, hand == to_the_right ? along : Line{}, hand == to_the_right ? Line{} : along, edge, parent,
             via);
    }

    // What can be reached from the root of a node inside the polygon that it enters.
    void expand(Index n) {
        const Node from = node(n);  // nodes_ will grow
        ++price_.nodes;
        if (trace_) trace_->push_back({0, from.right, from.left, from.f});
        const Index entry = from.edge;
        // The edge as the polygon sees it begins on the left of who enters.
        const Index left_end = mesh_.corner[std::size_t(entry)],
                    right_end = mesh_.corner[std::size_t(mesh_.next(entry))];
        const bool may_turn_right =
            from.on_right.to == right_end && turns(right_end) && from.root != right_end;
        const bool may_turn_left = from.on_left.to == left_end && turns(left_end) && from.root != left_end;
        const double g_right = may_turn_right ? from.g + distance(at(from.root), at(right_end)) : 0;
        const double g_left = may_turn_left ? from.g + distance(at(from.root), at(left_end)) : 0;
        const bool right_open = may_turn_right && reach(right_end, g_right, from.root, to_the_right);
        const bool left_open = may_turn_left && reach(left_end, g_left, from.root, to_the_left);
        for (Index e = mesh_.next(entry); e != entry; e = mesh_.next(e)) {
            if (mesh_.twin[std::size_t(e)] == none) continue;
            see(from, n, e);
            if (right_open) turn_right(from.on_right, right_end, g_right, e, n);
            if (left_open) turn_left(from.on_left, left_end, g_left, e, n);
        }
    }
    void expand_start(Index p) {
        ++price_.nodes;
        Node from{};
        from.root = at_start;
        from.edge = none;
        for (Index e = mesh_.begin(p); e < mesh_.end(p); ++e)
            if (mesh_.twin[std::size_t(e)] != none) see(from, none, e);
    }

    // The part of an edge that a root sees between the lines of a node.
    void see(const Node& from, Index parent, Index edge) {
        const Index a = mesh_.corner[std::size_t(edge)], b = mesh_.corner[std::size_t(mesh_.next(edge))];
        const Point r = at(from.root);
        const int facing = a == from.root || b == from.root ? 0 : orientation(r, at(a), at(b));
        if (facing < 0) return;
        if (facing == 0) return see_along(from, parent, edge, a, b);
        if (is_past(from.on_right, -1, r, b) || is_past(from.on_left, 1, r, a)) return;
        const bool a_is_hidden = from.on_right.to != none && side(from.on_right, a) < 0;
        const bool b_is_hidden = from.on_left.to != none && side(from.on_left, b) > 0;
        push(from.root, from.g, b_is_hidden ? from.on_left : Line{from.root, b},
             a_is_hidden ? from.on_right : Line{from.root, a}, edge, parent);
    }
    // An edge on one line with the root: it is entered from the root itself, or from its nearer end. Where
    // the start lies on the edge, the polygon across holds it too; at an end of the edge that was entered it
    // is reached by a turn.
    void see_along(const Node& from, Index parent, Index edge, Index a, Index b) {
        const Point r = at(from.root);
        if (a == from.root) return push(from.root, from.g, {from.root, b}, {}, edge, parent);
        if (b == from.root) return push(from.root, from.g, {}, {from.root, a}, edge, parent);
        if (from.root == at_start && is_between(at(a), r, at(b))) return;
        if (hidden(from, a) || hidden(from, b)) return;
        const bool a_is_near = is_between(r, at(a), at(b));
        if (is_end_of(from.edge, a_is_near ? a : b)) return;
        if (a_is_near)
            push_along(from.root, from.g, a, b, to_the_right, edge, parent, none);
        else
            push_along(from.root, from.g, b, a, to_the_left, edge, parent, none);
    }
    bool is_end_of(Index edge, Index v) const {
        return edge != none &&
               (mesh_.corner[std::size_t(edge)] == v || mesh_.corner[std::size_t(mesh_.next(edge))] == v);
    }
    bool hidden(const Node& from, Index v) const {
        return (from.on_right.to != none && side(from.on_right, v) < 0) ||
               (from.on_left.to != none && side(from.on_left, v) > 0);
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
    void turn_right(Line line, Index v, double g, Index edge, Index parent) {
        const Index a = mesh_.corner[std::size_t(edge)], b = mesh_.corner[std::size_t(mesh_.next(edge))];
        if (a == v) {
            if (side(line, b) <= 0) push(v, g, {v, b}, {}, edge, parent);
            return;
        }
        if (b == v || side(line, a) >= 0) return;
        if (orientation(at(v), at(a), at(b)) == 0)
            return push_along(v, g, a, b, to_the_right, edge, parent, v);
        push(v, g, side(line, b) <= 0 ? Line{v, b} : line, {v, a}, edge, parent);
    }
    void turn_left(Line line, Index v, double g, Index edge, Index parent) {
        const Index a = mesh_.corner[std::size_t(edge)], b = mesh_.corner[std::size_t(mesh_.next(edge))];
        if (b == v) {
            if (side(line, a) >= 0) push(v, g, {}, {v, a}, edge, parent);
            return;
        }
        if (a == v || side(line, b) <= 0) return;
        if (orientation(at(v), at(a), at(b)) == 0)
            return push_along(v, g, b, a, to_the_left, edge, parent, v);
        push(v, g, {v, b}, side(line, a) >= 0 ? Line{v, a} : line, edge, parent);
    }

    Route finish(Index last) const {
        Route route;
        route.status = Status::found;
        route.price = price_;
        const Node& end = node(last);
        const Point r = at(end.root);
        route.path.push_back(goal_);
        if (cross(end.left - r, goal_ - r) > 0)
            route.path.push_back(end.left);
        else if (cross(end.right - r, goal_ - r) < 0)
            route.path.push_back(end.right);
        const auto add = [&](Index v) {
            if (!(route.path.back() == at(v))) route.path.push_back(at(v));
        };
        for (Index n = last; n != none; n = node(n).parent) {
            add(node(n).root);
            if (node(n).via != none) add(node(n).via);
        }
        if (!(route.path.back() == start_)) route.path.push_back(start_);
        std::reverse(route.path.begin(), route.path.end());
        route.length = length_of(route.path);
        return route;
    }
};

}  // namespace cspace::navigation
