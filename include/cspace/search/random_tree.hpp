// Rapidly exploring random trees: the nearest node grows a step towards each place drawn (LaValle 1998,
// "Rapidly-exploring random trees: a new tool for path planning"), and RRT*, which joins a new node where the
// way to it is shortest and leads others through it where that shortens theirs (Karaman & Frazzoli 2011,
// "Sampling-based algorithms for optimal motion planning"). Once there is a path, the space may draw only
// what can still shorten it (Gammell, Srinivasa & Barfoot 2014, "Informed RRT*").
//
// A space knows the places of the nodes by their numbers, and offers:
//
//   Space::Place                     where a node may be
//   space.uniform()                  a random number in [0, 1)
//   space.draw(place)                draws a place; false if that was in vain
//   space.draw_goal(place)           draws a goal
//   space.draw_within(bound, place)  draws a place through which a path may be shorter than the bound; false
//                                    if that was in vain
//   space.add(place)                 keeps the place of the next node
//   space.place(node)                the place of a node
//   space.find_nearest(place)        the nearest node
//   space.find_near(place, bound, out)     the nodes that may be joined with a place, where a path of the
//   cost
//                                    `bound` is known (infinite: none is)
//   space.distance(node, place), space.goals(), space.goal(g)
//   space.steer(node, target, made)  the place at most a step from a node towards a target; false if the edge
//                                    to it is blocked, or has no length
//   space.is_free(node, place), space.is_free(place, node)   whether the edge is free, looking from the first
//   space.note_edge(node, place, cost), space.note_rewired(parent, node, cost)   what has happened
//   space.keep(nodes)                these, in the order of their numbers, are the nodes from now on; needed
//                                    only for `remove_branch`
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace::search {

struct TreeGrowth {
    static constexpr double any_reach = std::numeric_limits<double>::infinity();
    double goal_bias = 0;      // how often a goal is drawn while no path is known
    double reach = any_reach;  // edges to goals may be so long
    bool is_optimal = false;   // RRT*
};

template <class Space>
class RandomTree {
  public:
    using Place = typename Space::Place;
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    RandomTree(Space& space, const TreeGrowth& growth) : space_(space), growth_(growth) {}

    void add_root(const Place& place) { add(place, none); }
    // Looks for paths straight from the roots, which are all there is.
    void try_roots() {
        for (int i = 0; i < size(); ++i) try_goals(i);
    }
    // Draws a place and grows towards it. `bound`: of the paths that are looked for, where one is known.
    void grow(double bound) {
        Place drawn, made;
        if (!draw(bound, drawn)) return;
        const int nearest = space_.find_nearest(drawn);
        if (!space_.steer(nearest, drawn, made)) return;
        if (growth_.is_optimal) return join_best(made, nearest, bound);
        add(made, nearest);
        try_goals(size() - 1);
    }
    void grow() { grow(goal_cost()); }

    int size() const { return int(nodes_.size()); }
    int parent(int i) const { return node(i).parent; }  // −1 of a root
    double cost(int i) const { return node(i).cost; }   // of the way from a root
    // The last node of the best path, −1 where none is known, and its goal.
    int last() const { return last_; }
    int goal() const { return goal_; }
    bool has_path() const { return last_ >= 0; }
    double goal_cost() const {
        return has_path() ? node(last_).cost + space_.distance(last_, space_.goal(goal_)) : infinity;
    }

    // Removes a node and all below it; the others close up. The best path is forgotten.
    void remove_branch(int removed) {
        std::vector<int> numbers(nodes_.size(), 0), kept;
        visit_branch(removed, [&](int i) { numbers[std::size_t(i)] = none; });
        visit_range(0, nodes_.size(), [&](std::size_t i) {
            if (numbers[i] == none) return;
            numbers[i] = int(kept.size()), kept.push_back(int(i));
        });
        std::vector<Node> left;
        left.reserve(kept.size());
        visit_range(0, kept.size(), [&](std::size_t i) { left.push_back(node(kept[i])); });
        nodes_ = std::move(left);
        for (Node& each : nodes_) each.child = none;
        visit_range(0, nodes_.size(), [&](std::size_t i) {
            const int above = nodes_[i].parent;
            if (above >= 0) hang(int(i), numbers[std::size_t(above)], nodes_[i].length);
        });
        space_.keep(kept);
        forget_path();
    }
    // Of the best path its edge to the goal alone is removed.
    void forget_path() { last_ = goal_ = none; }

  private:
    static constexpr int none = -1;
    struct Node {
        int parent, child, sibling;  // child: its first; sibling: the next child of its parent
        double length, cost;         // of the edge from its parent; of the way from a root
    };

    Space& space_;
    const TreeGrowth growth_;
    std::vector<Node> nodes_;
    int last_ = none, goal_ = none;
    std::vector<int> near_, below_;
    std::vector<std::pair<double, int>> ways_;

    Node& node(int i) { return nodes_[std::size_t(i)]; }
    const Node& node(int i) const { return nodes_[std::size_t(i)]; }

    bool draw(double bound, Place& drawn) {
        if (bound < infinity) return space_.draw_within(bound, drawn);
        if (space_.uniform() < growth_.goal_bias) return space_.draw_goal(drawn), true;
        return space_.draw(drawn);
    }

    void join_best(const Place& made, int nearest, double bound) {
        space_.find_near(made, bound, near_);
        int parent = nearest;
        const double least = node(nearest).cost + space_.distance(nearest, made);
        ways_.clear();
        for (const int i : near_) {
            const double cost = node(i).cost + space_.distance(i, made);
            if (cost < least) ways_.push_back({cost, i});
        }
        std::sort(ways_.begin(), ways_.end());
        for (const auto& [cost, i] : ways_) {
            if (!space_.is_free(made, i)) continue;
            parent = i;
            break;
        }
        add(made, parent);
        const int added = size() - 1;
        try_goals(added);
        for (const int i : near_) shorten(i, added);
    }

    // Leads the way to a node through another, where that is shorter and free.
    void shorten(int i, int through) {
        const double length = space_.distance(through, space_.place(i)), cost = node(through).cost + length;
        if (!(cost < node(i).cost) || !space_.is_free(through, space_.place(i))) return;
        unhang(i);
        hang(i, through, length);
        space_.note_rewired(through, i, cost);
        visit_branch(i, [&](int n) { node(n).cost = node(node(n).parent).cost + node(n).length; });
        try_goals(i);
    }

    void add(const Place& place, int parent) {
        const int i = size();
        nodes_.push_back({none, none, none, 0, 0});
        space_.add(place);
        if (parent == none) return;
        hang(i, parent, space_.distance(parent, place));
        node(i).cost = node(parent).cost + node(i).length;
        space_.note_edge(parent, place, node(i).cost);
    }
    void hang(int i, int parent, double length) {
        node(i).parent = parent, node(i).length = length;
        node(i).sibling = node(parent).child;
        node(parent).child = i;
    }
    void unhang(int i) {
        int* link = &node(node(i).parent).child;
        while (*link != i) link = &node(*link).sibling;
        *link = node(i).sibling;
    }
    // A node and all below it, parents first.
    template <class Visit>
    void visit_branch(int top, const Visit& visit) {
        InterruptPoll poll(1024);
        below_.assign(1, top);
        while (!below_.empty()) {
            poll.step();
            const int n = below_.back();
            below_.pop_back();
            visit(n);
            for (int c = node(n).child; c != none; c = node(c).sibling) below_.push_back(c);
        }
    }

    void try_goals(int i) {
        for (int g = 0; g < space_.goals(); ++g) {
            const double far = space_.distance(i, space_.goal(g)), cost = node(i).cost + far;
            if (far > growth_.reach || !(cost < goal_cost()) || !space_.is_free(i, space_.goal(g))) continue;
            last_ = i, goal_ = g;
            space_.note_edge(i, space_.goal(g), cost);
        }
    }
};

}  // namespace cspace::search
