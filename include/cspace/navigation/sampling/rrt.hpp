// Rapidly exploring random trees: the nearest node grows a step towards each point drawn (LaValle 1998), and
// RRT*, which joins a new node where the way to it is shortest and leads others through it where that
// shortens theirs (Karaman & Frazzoli 2011), drawing only what can still shorten the best way once there is
// one (Gammell, Srinivasa & Barfoot 2014).
#pragma once

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/sampling/problem.hpp"
#include "cspace/navigation/sampling/samples.hpp"
#include "cspace/search/nearest_neighbours.hpp"

namespace cspace::navigation::sampling {

struct Growth {
    std::int64_t samples = 0;
    double step = 1;          // the longest edge towards a sample [m]
    double goal_bias = 0;     // how often the goal is drawn while no path is known
    bool is_optimal = false;  // RRT*
    std::uint64_t seed = 0;
};

class Tree {
  public:
    Tree(const Problem& problem, const Growth& growth, Trace* trace)
        : problem_(problem),
          growth_(growth),
          trace_(trace),
          draws_(problem.world, problem.component, growth.seed),
          near_(draws_.box().low, draws_.box().high) {}

    SampledRoute solve() {
        add({problem_.start.at, none}, -1);
        try_goal(0);
        SampledRoute answer;
        InterruptPoll poll(16);
        while (answer.samples < growth_.samples && !is_done()) {
            poll.step();
            ++answer.samples;
            Located drawn;
            if (draw(drawn)) grow_towards(drawn.at);
        }
        Route& route = answer.route;
        route.stats = {std::int64_t(nodes_.size()), looks_};
        if (last_ < 0) return answer;
        route.path.push_back(problem_.goal.at);
        for (std::int32_t n = last_; n >= 0; n = node(n).parent) route.path.push_back(node(n).at);
        finish_reversed(route);
        return answer;
    }

  private:
    struct Node {
        Point at;
        Index triangle;
        std::int32_t parent, child, sibling;  // its first child, the next of its parent's
        double cost;                          // of the way from the start
    };
    const Problem& problem_;
    const Growth& growth_;
    Trace* trace_;
    Samples draws_;
    search::Buckets near_;
    std::vector<Node> nodes_;
    std::int32_t last_ = -1;  // the node before the goal
    std::int64_t looks_ = 0;  // segments tested
    std::vector<std::int32_t> around_, changed_;
    std::vector<std::pair<double, std::int32_t>> ways_;

    Node& node(std::int32_t i) { return nodes_[std::size_t(i)]; }

    double goal_cost() {
        return last_ < 0 ? std::numeric_limits<double>::infinity()
                         : node(last_).cost + distance(node(last_).at, problem_.goal.at);
    }
    bool is_done() {
        return last_ >= 0 &&
               (!growth_.is_optimal || goal_cost() <= distance(problem_.start.at, problem_.goal.at));
    }

    bool draw(Located& drawn) {
        if (last_ >= 0)
            drawn = draws_.draw_within(problem_.start.at, problem_.goal.at, goal_cost());
        else if (draws_.uniform() < growth_.goal_bias)
            return drawn.at = problem_.goal.at, true;
        else
            drawn = draws_.draw();
        return drawn.triangle != none;
    }

    Index sight(std::int32_t from, Point q) {
        ++looks_;
        return from == 0 ? problem_.sight(problem_.start, q)
                         : end_of_sight(problem_.world.space, {node(from).at, node(from).triangle}, q);
    }

    void grow_towards(Point target) {
        const std::int32_t nearest = near_.nearest(target);
        const Point from = node(nearest).at;
        const double far = distance(from, target);
        if (far == 0) return;
        const Point at = far <= growth_.step ? target : from + (growth_.step / far) * (target - from);
        const Index t = sight(nearest, at);
        if (t == none || !is_within(problem_.world.space, t, at)) return;
        const Located made{at, t};
        if (growth_.is_optimal) return join_best(made, nearest);
        add(made, nearest);
        try_goal(std::int32_t(nodes_.size()) - 1);
    }

    void join_best(Located made, std::int32_t nearest) {
        const double area =
            last_ < 0
                ? draws_.area()
                : std::min(draws_.area(),
                           Samples::ellipse_area(distance(problem_.start.at, problem_.goal.at), goal_cost()));
        near_.within(made.at, std::min(joining_radius(area, nodes_.size() + 1), growth_.step), around_);
        std::int32_t parent = nearest;
        double least = node(nearest).cost + distance(node(nearest).at, made.at);
        ways_.clear();
        for (const std::int32_t i : around_) {
            const double cost = node(i).cost + distance(node(i).at, made.at);
            if (cost < least) ways_.push_back({cost, i});
        }
        std::sort(ways_.begin(), ways_.end());
        for (const auto& [cost, i] : ways_) {
            ++looks_;
            if (end_of_sight(problem_.world.space, made, node(i).at) == none) continue;
            parent = i;
            break;
        }
        add(made, parent);
        const std::int32_t added = std::int32_t(nodes_.size()) - 1;
        try_goal(added);
        for (const std::int32_t i : around_) shorten(i, added);
    }

    // Leads the way to a node through another, where that is shorter and free.
    void shorten(std::int32_t i, std::int32_t through) {
        const double cost = node(through).cost + distance(node(through).at, node(i).at);
        if (!(cost < node(i).cost) || sight(through, node(i).at) == none) return;
        std::int32_t* link = &node(node(i).parent).child;
        while (*link != i) link = &node(*link).sibling;
        *link = node(i).sibling;
        hang(i, through);
        if (trace_) trace_->push_back({rewire, node(through).at, node(i).at, cost});
        changed_.assign(1, i);
        while (!changed_.empty()) {
            const std::int32_t n = changed_.back();
            changed_.pop_back();
            node(n).cost = node(node(n).parent).cost + distance(node(node(n).parent).at, node(n).at);
            for (std::int32_t c = node(n).child; c >= 0; c = node(c).sibling) changed_.push_back(c);
        }
        try_goal(i);
    }

    void hang(std::int32_t i, std::int32_t parent) {
        node(i).parent = parent;
        node(i).sibling = node(parent).child;
        node(parent).child = i;
    }

    void add(Located made, std::int32_t parent) {
        const std::int32_t i = std::int32_t(nodes_.size());
        nodes_.push_back({made.at, made.triangle, -1, -1, -1, 0});
        near_.add(made.at);
        if (parent < 0) return;
        hang(i, parent);
        node(i).cost = node(parent).cost + distance(node(parent).at, made.at);
        if (trace_) trace_->push_back({connect, node(parent).at, made.at, node(i).cost});
    }

    // Ends the way at the goal: RRT from no farther than a step, RRT* from wherever that shortens it.
    void try_goal(std::int32_t i) {
        const double far = distance(node(i).at, problem_.goal.at);
        if (!growth_.is_optimal && far > growth_.step) return;
        if (!(node(i).cost + far < goal_cost())) return;
        if (sight(i, problem_.goal.at) == none) return;
        last_ = i;
        if (trace_) trace_->push_back({connect, node(i).at, problem_.goal.at, node(i).cost + far});
    }
};

}  // namespace cspace::navigation::sampling
