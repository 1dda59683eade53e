// A probabilistic roadmap: points drawn from free space, joined to those near them that they see, and a
// shortest way on it (Kavraki, Svestka, Latombe & Overmars 1996, "Probabilistic roadmaps for path planning in
// high-dimensional configuration spaces"; joined within the radius of Karaman & Frazzoli 2011, or to the k
// nearest).
#pragma once

#include <span>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/sampling/problem.hpp"
#include "cspace/navigation/sampling/samples.hpp"
#include "cspace/search/cache.hpp"
#include "cspace/search/nearest_neighbours.hpp"
#include "cspace/search/roadmap.hpp"
#include "cspace/search/shortest_way.hpp"

namespace cspace::navigation::sampling {

struct RoadmapKey {
    Index component = none;
    std::int64_t samples = 0, neighbours = 0;  // 0 neighbours: all within the joining radius
    std::uint64_t seed = 0;
    friend bool operator==(const RoadmapKey&, const RoadmapKey&) = default;
};

// The samples of a component and the segments between them, whatever the ends are; it never changes.
class Roadmap {
  public:
    Roadmap(const maps::PolygonWorld& world, const RoadmapKey& key)
        : Roadmap(world, key, {world, key.component, key.seed}) {}

    std::uint32_t size() const { return std::uint32_t(nodes_.size()); }
    const Located& operator[](std::uint32_t node) const { return nodes_[node]; }
    const RoadmapKey& key() const { return key_; }
    std::int64_t tested() const { return std::int64_t(pairs_.size()); }  // segments
    std::size_t bytes() const { return 64 * nodes_.size() + 8 * pairs_.size() + edges_.bytes(); }
    // The samples that are joined with a node.
    std::span<const std::int32_t> joined_with(std::uint32_t node) const { return edges_.of(node); }
    // The samples that an end is joined with if it sees them; returns how far away they may be.
    double near(Point end, std::vector<std::int32_t>& found) const {
        if (key_.neighbours <= 0) return near_.within(end, radius_, found), radius_;
        near_.nearest(end, std::size_t(key_.neighbours), found);
        return found.empty() ? radius_ : distance(end, (*this)[std::uint32_t(found.back())].at);
    }

  private:
    RoadmapKey key_;
    search::Buckets near_;
    double radius_ = 0;
    std::vector<Located> nodes_;
    std::vector<search::NodePair> pairs_;    // tested
    search::Adjacency<std::int32_t> edges_;  // the nodes at the other ends

    Roadmap(const maps::PolygonWorld& world, const RoadmapKey& key, Samples draws)
        : key_(key), near_(draws.box().low, draws.box().high) {
        InterruptPoll poll(64);
        for (std::int64_t i = 0; i < key.samples; ++i) {
            poll.step();
            const Located drawn = draws.draw();
            if (drawn.triangle == none) continue;
            nodes_.push_back(drawn);
            near_.add(drawn.at);
        }
        constexpr std::size_t ends = 2;
        radius_ = joining_radius(draws.area(), nodes_.size() + ends);
        choose_pairs();
        join(world);
    }

    void choose_pairs() {
        const bool is_radius = key_.neighbours <= 0;
        pairs_ =
            search::choose_pairs(std::int32_t(nodes_.size()), is_radius, [&](std::int32_t i, auto& found) {
                const Point at = nodes_[std::size_t(i)].at;
                if (is_radius)
                    near_.within(at, radius_, found);
                else
                    near_.nearest(at, std::size_t(key_.neighbours) + 1, found);
            });
    }

    // Keeps the pairs that see each other.
    void join(const maps::PolygonWorld& world) {
        std::vector<search::NodePair> kept;
        InterruptPoll poll(64);
        for (const auto& [i, j] : pairs_) {
            poll.step();
            if (end_of_sight(world.space, nodes_[std::size_t(i)], nodes_[std::size_t(j)].at) != none)
                kept.push_back({i, j});
        }
        const auto other_end = [](std::int32_t node, std::int32_t) { return node; };
        edges_ = search::join_pairs<std::int32_t>(nodes_.size(), kept, other_end);
    }
};

// A shortest way from start to goal on a roadmap: its nodes are the samples, then start, then goal.
class RoadmapSearch {
  public:
    RoadmapSearch(const Problem& problem, const Roadmap& roadmap)
        : problem_(problem), roadmap_(roadmap), start_(roadmap.size()), goal_(start_ + 1) {}

    SampledRoute solve(Trace* trace) {
        join();
        if (trace) record(*trace);
        search();
        answer_.samples = roadmap_.key().samples;
        answer_.route.stats.nodes = std::int64_t(roadmap_.size()) + 2;
        answer_.route.stats.edges = roadmap_.tested() + looks_;
        return answer_;
    }

    // The interface of a graph for ShortestWay.
    bool is_goal(std::uint32_t node) const { return node == goal_; }
    double bound(std::uint32_t node) const { return distance(at(node), problem_.goal.at); }
    template <class Visit>
    void each_arc(std::uint32_t node, const Visit& visit) const {
        const auto reach = [&](std::uint32_t to) { visit(to, search::no_node, distance(at(node), at(to))); };
        if (node == start_) {
            for (const std::int32_t to : from_start_) reach(std::uint32_t(to));
            return;
        }
        for (const std::int32_t to : roadmap_.joined_with(node)) reach(std::uint32_t(to));
        if (sees_goal_[node]) reach(goal_);
    }
    // All edges are tested before.
    static constexpr bool is_known(std::uint32_t) { return true; }
    static constexpr search::EdgeState check(const search::WayArc&) { return search::EdgeState::free; }

  private:
    const Problem& problem_;
    const Roadmap& roadmap_;
    std::uint32_t start_, goal_;
    SampledRoute answer_;
    std::int64_t looks_ = 0;                // segments tested from the ends
    std::vector<std::int32_t> from_start_;  // also the goal, where they see each other
    std::vector<std::uint8_t> sees_goal_;   // each sample

    Point at(std::uint32_t node) const {
        return node == start_ ? problem_.start.at : node == goal_ ? problem_.goal.at : roadmap_[node].at;
    }

    // Samples lie inside their triangles, so it is from them that one looks at an end.
    bool sees(std::int32_t sample, Point end) {
        ++looks_;
        return end_of_sight(problem_.world.space, roadmap_[std::uint32_t(sample)], end) != none;
    }
    void join() {
        const Point start = problem_.start.at, goal = problem_.goal.at;
        std::vector<std::int32_t> found;
        sees_goal_.assign(roadmap_.size(), 0);
        const double from_goal = roadmap_.near(goal, found);
        for (const std::int32_t i : found) sees_goal_[std::size_t(i)] = sees(i, goal);
        const double from_start = roadmap_.near(start, found);
        for (const std::int32_t i : found)
            if (sees(i, start)) from_start_.push_back(i);
        if (distance(start, goal) > std::max(from_start, from_goal)) return;
        ++looks_;
        if (problem_.sight(problem_.goal, start) != none) from_start_.push_back(std::int32_t(goal_));
    }
    void record(Trace& trace) const {
        const auto add = [&](std::uint32_t a, std::uint32_t b) {
            trace.push_back({connect, at(a), at(b), distance(at(a), at(b))});
        };
        for (std::uint32_t i = 0; i < roadmap_.size(); ++i)
            for (const std::int32_t j : roadmap_.joined_with(i))
                if (std::uint32_t(j) < i) add(i, std::uint32_t(j));
        for (const std::int32_t i : from_start_) add(start_, std::uint32_t(i));
        for (std::uint32_t i = 0; i < roadmap_.size(); ++i)
            if (sees_goal_[i]) add(i, goal_);
    }

    void search() {
        using Search = search::ShortestWay<RoadmapSearch>;
        Search way(*this, goal_ + 1);
        way.add_start(start_);
        if (way.run() != Search::End::found) return;
        Route& route = answer_.route;
        route.path.push_back(problem_.goal.at);
        const std::vector<search::WayArc> arcs = way.arcs();
        for (std::size_t i = arcs.size(); i-- > 0;) route.path.push_back(at(arcs[i].from));
        finish_reversed(route);
    }
};

// The data stored with a world: the most recent roadmap.
using KeptRoadmap = search::LastMade<RoadmapKey, Roadmap>;

}  // namespace cspace::navigation::sampling
