// The shortest path on the visibility graph, with start and goal joined to what they see: A* with the
// straight line to the goal as estimate (Hart, Nilsson & Raphael 1968).
#pragma once

#include <algorithm>
#include <functional>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/navigation/visibility/graph.hpp"

namespace cspace::navigation {

class VisibilitySearch {
  public:
    explicit VisibilitySearch(const maps::PolygonWorld& world)
        : world_(world), graph_(world.space), view_(world.space), state_(std::size_t(graph_.size())) {}

    const VisibilityGraph& graph() const { return graph_; }

    // Start and goal lie in one component of free space.
    Route solve(const maps::Settled& start, const maps::Settled& goal, Trace* trace = nullptr) {
        ++query_;
        queue_.clear();
        price_ = {};
        goal_ = goal.at;
        if (sees(start, goal)) return straight(start.at);
        for (const auto& edge : at_goal_) {
            State& s = state_of(edge.to);
            s.to_goal = edge.length;
        }
        for (const auto& edge : at_start_) relax(edge.to, edge.length, none);
        double best = std::numeric_limits<double>::infinity();
        Index last = none;
        while (!queue_.empty() && queue_.front().first < best) {
            const auto [f, n] = pop();
            State& s = state_of(n);
            if (s.closed) continue;
            s.closed = true;
            ++price_.nodes;
            if (trace)
                trace->push_back(
                    {0, s.parent == none ? start.at : graph_.point(s.parent), graph_.point(n), s.g});
            if (s.g + s.to_goal < best) best = s.g + s.to_goal, last = n;
            for (const auto& edge : graph_.edges_of(n)) relax(edge.to, s.g + edge.length, n);
        }
        return last == none ? Route{Status::unreachable, {}, best, price_} : finish(start.at, last);
    }

  private:
    struct State {
        std::uint32_t query = 0;
        bool closed = false;
        Index parent = none;
        double g = 0, to_goal = 0;
    };
    const maps::PolygonWorld& world_;
    VisibilityGraph graph_;
    View view_;
    std::vector<State> state_;
    std::uint32_t query_ = 0;
    std::vector<std::pair<double, Index>> queue_;
    std::vector<VisibilityGraph::Edge> at_start_, at_goal_;
    Point goal_;
    Price price_;

    State& state_of(Index n) {
        State& s = state_[std::size_t(n)];
        constexpr double far = std::numeric_limits<double>::infinity();
        if (s.query != query_) s = {query_, false, none, far, far};
        return s;
    }
    // Fills what start and goal see; whether they see each other.
    bool sees(const maps::Settled& start, const maps::Settled& goal) {
        at_start_.clear();
        at_goal_.clear();
        const auto holds_goal = [&](Index t) {
            return std::find(goal.triangles.begin(), goal.triangles.end(), t) != goal.triangles.end();
        };
        bool seen = std::any_of(start.triangles.begin(), start.triangles.end(), holds_goal);
        graph_.see_from(view_, start.at, start.triangles, at_start_, [&](Index t, const Cone& cone) {
            seen = seen || (holds_goal(t) && cone.right.side(goal.at) >= 0 && cone.left.side(goal.at) <= 0);
        });
        if (!seen) graph_.see_from(view_, goal.at, goal.triangles, at_goal_, [](Index, const Cone&) {});
        return seen;
    }
    void relax(Index n, double g, Index parent) {
        State& s = state_of(n);
        ++price_.edges;
        if (s.closed || g >= s.g) return;
        s.g = g;
        s.parent = parent;
        queue_.push_back({g + distance(graph_.point(n), goal_), n});
        std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
    }
    std::pair<double, Index> pop() {
        std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
        const auto top = queue_.back();
        queue_.pop_back();
        return top;
    }
    Route straight(Point start) const {
        Route route{Status::found, {start}, distance(start, goal_), price_};
        if (!(start == goal_)) route.path.push_back(goal_);
        return route;
    }
    Route finish(Point start, Index last) {
        Route route{Status::found, {goal_}, 0, price_};
        for (Index n = last; n != none; n = state_of(n).parent)
            if (!(graph_.point(n) == route.path.back())) route.path.push_back(graph_.point(n));
        if (!(start == route.path.back())) route.path.push_back(start);
        std::reverse(route.path.begin(), route.path.end());
        route.length = length_of(route.path);
        return route;
    }
};

}  // namespace cspace::navigation
