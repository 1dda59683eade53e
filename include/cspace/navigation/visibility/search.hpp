// The shortest path on the visibility graph, with start and goal joined to what they see: A* with the
// straight line to the goal as estimate (Hart, Nilsson & Raphael 1968).
#pragma once

#include <algorithm>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/navigation/visibility/graph.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

class VisibilitySearch {
  public:
    // The graph of a space, which several searches may share.
    VisibilitySearch(const VisibilityGraph& graph, const maps::FreeSpace& space)
        : graph_(graph), view_(space), state_(std::size_t(graph.size()) + 1) {}

    // Start and goal lie in one component of free space.
    Route solve(const maps::Settled& start, const maps::Settled& goal, Trace* trace = nullptr) {
        ++query_;
        stats_ = {};
        start_ = start.at, goal_ = goal.at;
        if (sees(start, goal)) return straight();
        for (const auto& edge : at_goal_) state_of(edge.to).to_goal = edge.length;
        Open open{*this, trace};
        queue_.clear();
        for (const auto& edge : at_start_) open.relax(edge.to, edge.length, none, queue_);
        search::Effort effort;
        const bool arrives = search::best_first(open, queue_, effort) != search::no_node;
        stats_.nodes = std::int64_t(effort.settled);
        if (arrives) return finish();
        return Route{Status::unreachable, {}, std::numeric_limits<double>::infinity(), stats_};
    }

  private:
    struct State {
        std::uint32_t query = 0;
        bool closed = false;
        Index parent = none;
        double g = 0, to_goal = 0;
    };
    // The corners as nodes of best_first, and the goal after the last of them.
    struct Open {
        VisibilitySearch& search;
        Trace* trace;

        bool settle(std::uint32_t node) {
            State& s = search.state_of(Index(node));
            if (s.closed) return false;
            s.closed = true;
            if (trace && !is_goal(node))
                trace->push_back({0, search.point(s.parent), search.point(Index(node)), s.g});
            return true;
        }
        bool is_goal(std::uint32_t node) const { return Index(node) == search.graph_.size(); }
        void expand(std::uint32_t node, search::PriorityQueue& queue) {
            const State s = search.state_of(Index(node));
            for (const auto& edge : search.graph_.edges_of(Index(node)))
                relax(edge.to, s.g + edge.length, Index(node), queue);
            if (s.to_goal < far) relax(search.graph_.size(), s.g + s.to_goal, Index(node), queue);
        }
        void relax(Index n, double g, Index parent, search::PriorityQueue& queue) {
            State& s = search.state_of(n);
            ++search.stats_.edges;
            if (s.closed || g >= s.g) return;
            s.g = g;
            s.parent = parent;
            queue.push({g + distance(search.point(n), search.goal_), 0, std::uint32_t(n)});
        }
    };
    static constexpr double far = std::numeric_limits<double>::infinity();
    const VisibilityGraph& graph_;
    View view_;
    std::vector<State> state_;
    std::uint32_t query_ = 0;
    search::PriorityQueue queue_;
    std::vector<VisibilityGraph::Edge> at_start_, at_goal_;
    Point start_, goal_;
    Stats stats_;

    Point point(Index n) const { return n == none ? start_ : n == graph_.size() ? goal_ : graph_.point(n); }
    State& state_of(Index n) {
        State& s = state_[std::size_t(n)];
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
    Route straight() const {
        Route route{Status::found, {start_}, distance(start_, goal_), stats_};
        if (!(start_ == goal_)) route.path.push_back(goal_);
        return route;
    }
    Route finish() {
        Route route{Status::found, {goal_}, 0, stats_};
        for (Index n = graph_.size(); n != none;) {
            n = state_of(n).parent;
            if (!(point(n) == route.path.back())) route.path.push_back(point(n));
        }
        finish_reversed(route);
        return route;
    }
};

}  // namespace cspace::navigation
