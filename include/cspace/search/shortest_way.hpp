// A shortest way on a graph from any of its starts to any of its goals, by A*. An edge may be unchecked: it
// is checked when a node would be settled through it, so that few are (Cohen, Phillips & Likhachev 2014,
// "Planning single-arm manipulations with n-arm robots", lazy A*). A graph offers:
//
//   graph.each_arc(node, visit)  visit(to, edge, length) for each arc that leaves a node
//   graph.bound(node)            no way from there to a goal is shorter
//   graph.is_goal(node)
//   graph.is_known(edge)         whether it is known to be free
//   graph.check(arc)             an EdgeState; unknown: not to be said any more, the search stops
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/search/best_first.hpp"

namespace cspace::search {

enum class EdgeState : std::uint8_t { unknown, free, blocked };

// The last edge of a way to a node; cost: of the whole way.
struct WayArc {
    std::uint32_t from, to, edge;
    double cost;
};

template <class Graph>
class ShortestWay {
  public:
    enum class End { found, none, stopped };

    ShortestWay(Graph& graph, std::size_t nodes) : graph_(graph), ways_(nodes) {}

    void add_start(std::uint32_t node) { offer({no_node, node, no_node, 0}); }
    End run() {
        last_ = best_first(*this, queue_, effort_);
        return last_ != no_node ? End::found : is_stopped_ ? End::stopped : End::none;
    }

    // The arcs of the way found, from the start on.
    std::vector<WayArc> arcs() const {
        std::vector<WayArc> found;
        std::uint32_t at = last_ == no_node ? no_node : ways_.before(arcs_[last_].to);
        for (; arcs_[at].from != no_node; at = ways_.before(arcs_[at].from)) found.push_back(arcs_[at]);
        std::reverse(found.begin(), found.end());
        return found;
    }
    const Ways& ways() const { return ways_; }

    // The interface of a space for best_first, whose nodes are arcs here.
    bool settle(std::uint32_t arc) {
        const WayArc at = arcs_[arc];
        if (ways_.is_settled(at.to)) return false;
        if (at.cost < ways_.cost(at.to)) {
            const EdgeState state = graph_.check(at);
            if (state == EdgeState::unknown) stop();
            if (state != EdgeState::free) return false;
            ways_.improve(at.to, at.cost, arc);
        }
        return ways_.settle(at.to);
    }
    bool is_goal(std::uint32_t arc) const { return graph_.is_goal(arcs_[arc].to); }
    void expand(std::uint32_t arc, PriorityQueue&) {
        const std::uint32_t node = arcs_[arc].to;
        const double cost = ways_.cost(node);
        graph_.each_arc(node, [&](std::uint32_t to, std::uint32_t edge, double length) {
            offer({node, to, edge, cost + length});
        });
    }

  private:
    Graph& graph_;
    Ways ways_;                 // before each node: the arc to it
    std::vector<WayArc> arcs_;  // all that were offered
    PriorityQueue queue_;
    Effort effort_;
    std::uint32_t last_ = no_node;
    bool is_stopped_ = false;

    void stop() { is_stopped_ = true, effort_.pause = 0; }

    void offer(const WayArc& arc) {
        const std::uint32_t number = std::uint32_t(arcs_.size());
        const bool is_known = arc.from == no_node || graph_.is_known(arc.edge);
        const bool is_better = is_known ? ways_.improve(arc.to, arc.cost, number)
                                        : !ways_.is_settled(arc.to) && arc.cost < ways_.cost(arc.to);
        if (!is_better) return;
        arcs_.push_back(arc);
        queue_.push({arc.cost + graph_.bound(arc.to), -float(arc.cost), number});
    }
};

}  // namespace cspace::search
