// The free configurations of a box as a random tree grows in them (search/random_tree.hpp): the nearest nodes
// are found among rows of floats, and edges are checked by a space that offers
//
//   edges.box()                              see box.hpp
//   edges.is_free(a, b)                      whether the edge between two rows is free
//   edges.find_nearest(tree, leaves, q)      the search::NearRow of a tree, whose first rows are in leaves
//   edges.find_nearest(tree, leaves, q, most, out)   up to so many; returns how many
//   edges.has_time()                         false: every further edge counts as blocked
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/planning/informed_samples.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/halton.hpp"
#include "cspace/search/nearest_row.hpp"
#include "cspace/search/row_leaves.hpp"
#include "cspace/search/star_neighbours.hpp"

namespace cspace::planning {

template <class Edges>
class TreeSpace {
  public:
    using Place = InformedSamples::Row;
    struct Counts {
        std::int64_t samples = 0, edges = 0, blocked = 0;
    };

    TreeSpace(Edges& edges, const search::HaltonTable& table, std::uint64_t seed, float range,
              bool is_informed)
        : edges_(edges),
          box_(edges.box()),
          points_(table, seed),
          samples_(box_, seed),
          range_(range),
          is_informed_(is_informed),
          nodes_(box_.width) {}
    TreeSpace(const TreeSpace&) = delete;
    TreeSpace& operator=(const TreeSpace&) = delete;

    // Before the first node is added.
    void add_goal(const Place& goal) { goals_.push_back(goal); }
    // The nodes up to here are the starts.
    void list_pairs() {
        InterruptPoll poll(1024);
        pairs_.clear();
        for (int s = 0; s < nodes_.size(); ++s)
            for (int g = 0; g < goals(); ++g) {
                poll.step();
                pairs_.push_back({float(distance(s, goal(g))), s, g});
            }
        sort_polled(pairs_);
    }
    // No path is shorter.
    double least_cost() const { return pairs_.front().distance; }
    const search::ConfigurationTree& nodes() const { return nodes_; }
    const Counts& counts() const { return counts_; }

    double uniform() { return samples_.uniform(); }
    bool draw(Place& drawn) {
        ++counts_.samples;
        box_.scale(points_.next(), drawn.data());
        return true;
    }
    void draw_goal(Place& drawn) {
        ++counts_.samples;
        drawn = goals_[pick(goals_.size())];
    }
    bool draw_within(double bound, Place& drawn) {
        if (!is_informed_) return draw(drawn);
        ++counts_.samples;
        const Pair shortest = {float(bound), 0, 0};
        const auto end = std::lower_bound(pairs_.begin(), pairs_.end(), shortest);
        if (end == pairs_.begin()) return false;
        const Pair& pair = pairs_[pick(std::size_t(end - pairs_.begin()))];
        return samples_.draw(place(pair.start).data(), goal(pair.goal).data(), float(bound), drawn.data());
    }
    void add(const Place& place) {
        nodes_.add(place.data(), search::ConfigurationTree::no_parent, 0);
        leaves_.update(nodes_);
    }
    Place place(int node) const {
        Place row;
        nodes_.copy_row(node, row.data());
        return row;
    }
    int find_nearest(const Place& place) { return edges_.find_nearest(nodes_, leaves_, place.data()).row; }
    void find_near(const Place& place, double, std::vector<int>& out) {
        const std::size_t with_new = std::size_t(nodes_.size()) + 1;
        near_.resize(std::size_t(search::star_neighbours(with_new, box_.width)));
        const int most = int(near_.size());
        near_.resize(std::size_t(edges_.find_nearest(nodes_, leaves_, place.data(), most, near_.data())));
        out.clear();
        for (const search::NearRow& each : near_) out.push_back(each.row);
    }
    double distance(int node, const Place& to) const { return box_.distance(place(node).data(), to.data()); }
    int goals() const { return int(goals_.size()); }
    const Place& goal(int g) const { return goals_[std::size_t(g)]; }

    bool steer(int node, const Place& target, Place& made) {
        const Place from = place(node);
        const float far = box_.distance(from.data(), target.data());
        if (far <= range_)
            std::copy_n(target.data(), box_.width, made.data());
        else
            box_.interpolate(from.data(), target.data(), range_ / far, made.data());
        return check_edge(from, made) && far > 0;
    }
    bool is_free(int node, const Place& to) { return check_edge(place(node), to); }
    bool is_free(const Place& from, int node) { return check_edge(from, place(node)); }
    void note_edge(int, const Place&, double) const {}
    void note_rewired(int, int, double) const {}

    void keep(const std::vector<int>& nodes) {
        search::ConfigurationTree kept(box_.width);
        InterruptPoll poll(1024);
        for (const int i : nodes) {
            poll.step();
            kept.add(place(i).data(), search::ConfigurationTree::no_parent, 0);
        }
        nodes_ = std::move(kept);
        leaves_.clear();
        leaves_.update(nodes_);
    }

  private:
    struct Pair {
        float distance;
        int start, goal;
        auto operator<=>(const Pair&) const = default;
    };

    Edges& edges_;
    const Box box_;
    search::HaltonPoints points_;
    InformedSamples samples_;
    const float range_;
    const bool is_informed_;
    search::ConfigurationTree nodes_;
    search::RowLeaves leaves_;  // of the nodes
    std::vector<Place> goals_;
    std::vector<Pair> pairs_;  // of a start and a goal, the nearest first
    std::vector<search::NearRow> near_;
    Counts counts_;

    std::size_t pick(std::size_t count) {
        return std::min(std::size_t(samples_.uniform() * double(count)), count - 1);
    }
    bool check_edge(const Place& a, const Place& b) {
        if (!edges_.has_time()) return false;
        ++counts_.edges;
        const bool is_free = edges_.is_free(a.data(), b.data());
        counts_.blocked += !is_free;
        return is_free;
    }
};

}  // namespace cspace::planning
