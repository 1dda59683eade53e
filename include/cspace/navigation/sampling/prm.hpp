// A probabilistic roadmap: points drawn from free space, joined to those near them that they see, and a
// shortest way on it (Kavraki, Svestka, Latombe & Overmars 1996, "Probabilistic roadmaps for path planning in
// high-dimensional configuration spaces"; joined within the radius of Karaman & Frazzoli 2011, or to the k
// nearest).
#pragma once

#include "cspace/navigation/best_first.hpp"
#include "cspace/navigation/sampling/buckets.hpp"
#include "cspace/navigation/sampling/problem.hpp"
#include "cspace/navigation/sampling/samples.hpp"

namespace cspace::navigation::sampling {

class Roadmap {
  public:
    Roadmap(const Problem& problem, std::int64_t samples, std::int64_t neighbours, std::uint64_t seed)
        : problem_(problem),
          draws_(problem.world, problem.component, seed),
          near_(draws_.low(), draws_.high()) {
        add({problem.start.at, problem.start.triangles.front()});
        add({problem.goal.at, problem.goal.triangles.front()});
        for (std::int64_t i = 0; i < samples; ++i) {
            const Located drawn = draws_.draw();
            if (drawn.triangle != none) add(drawn);
        }
        answer_.samples = samples;
        choose_pairs(neighbours);
    }

    Answer solve(Trace* trace) {
        join(trace);
        search();
        answer_.route.price.nodes = std::int64_t(nodes_.size());
        answer_.route.price.edges = std::int64_t(pairs_.size());
        return answer_;
    }

    // What best_first asks of a space.
    bool settle(std::uint32_t node) {
        const bool is_new = !settled_[node];
        settled_[node] = 1;
        return is_new;
    }
    bool is_goal(std::uint32_t node) const { return node == 1; }
    void expand(std::uint32_t node, PriorityQueue& queue) {
        for (std::int32_t k = first_[node]; k < first_[node + 1]; ++k) {
            const auto to = std::uint32_t(to_[std::size_t(k)]);
            const double cost = cost_[node] + distance(nodes_[node].at, nodes_[to].at);
            if (!(cost < cost_[to])) continue;
            cost_[to] = cost, parent_[to] = node;
            queue.push({cost + distance(nodes_[to].at, problem_.goal.at), -float(cost), to});
        }
    }

  private:
    const Problem& problem_;
    Samples draws_;
    Buckets near_;
    Answer answer_;
    std::vector<Located> nodes_;                                // start, goal, samples
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs_;  // the larger first
    std::vector<std::int32_t> first_, to_;                      // the edges of each node
    std::vector<double> cost_;
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> settled_;

    void add(Located node) {
        nodes_.push_back(node);
        near_.add(node.at);
    }

    void choose_pairs(std::int64_t neighbours) {
        const double radius = joining_radius(draws_.area(), nodes_.size());
        std::vector<std::int32_t> found;
        for (std::int32_t i = 0; i < std::int32_t(nodes_.size()); ++i) {
            const Point at = nodes_[std::size_t(i)].at;
            if (neighbours > 0)
                near_.nearest(at, std::size_t(neighbours) + 1, found);
            else
                near_.within(at, radius, found);
            for (const std::int32_t j : found)
                if (j < i || (neighbours > 0 && j != i)) pairs_.push_back({std::max(i, j), std::min(i, j)});
        }
        if (neighbours <= 0) return;
        std::sort(pairs_.begin(), pairs_.end());
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    }

    // Keeps the pairs that see each other. Samples lie inside their triangles, so it is from them that one
    // looks.
    void join(Trace* trace) {
        std::vector<std::pair<std::int32_t, std::int32_t>> kept;
        first_.assign(nodes_.size() + 1, 0);
        for (const auto& [i, j] : pairs_) {
            const Located &a = nodes_[std::size_t(i)], &b = nodes_[std::size_t(j)];
            const Index end =
                i > 1 ? end_of_sight(problem_.world.space, a, b.at) : problem_.sight(problem_.goal, b.at);
            if (end == none) continue;
            kept.push_back({i, j});
            ++first_[std::size_t(i) + 1], ++first_[std::size_t(j) + 1];
            if (trace) trace->push_back({connect, a.at, b.at, distance(a.at, b.at)});
        }
        for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
        std::vector<std::int32_t> place(first_.begin(), first_.end() - 1);
        to_.resize(2 * kept.size());
        for (const auto& [i, j] : kept) {
            to_[std::size_t(place[std::size_t(i)]++)] = j;
            to_[std::size_t(place[std::size_t(j)]++)] = i;
        }
    }

    void search() {
        cost_.assign(nodes_.size(), std::numeric_limits<double>::infinity());
        parent_.assign(nodes_.size(), no_node);
        settled_.assign(nodes_.size(), 0);
        PriorityQueue queue;
        cost_[0] = 0;
        queue.push({distance(problem_.start.at, problem_.goal.at), 0, 0});
        Effort effort;
        if (best_first(*this, queue, effort) == no_node) return;
        Route& route = answer_.route;
        for (std::uint32_t n = 1; n != no_node; n = parent_[n]) route.path.push_back(nodes_[n].at);
        std::reverse(route.path.begin(), route.path.end());
        route.status = Status::found;
        route.length = length_of(route.path);
    }
};

}  // namespace cspace::navigation::sampling
