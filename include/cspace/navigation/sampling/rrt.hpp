// Rapidly exploring random trees in the plane: RRT, and RRT* with informed samples; see
// search/random_tree.hpp.
#pragma once

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/sampling/problem.hpp"
#include "cspace/navigation/sampling/samples.hpp"
#include "cspace/search/nearest_neighbours.hpp"
#include "cspace/search/random_tree.hpp"

namespace cspace::navigation::sampling {

struct Growth {
    std::int64_t samples = 0;
    double step = 1;          // the longest edge towards a sample [m]
    double goal_bias = 0;     // how often the goal is drawn while no path is known
    bool is_optimal = false;  // RRT*
    std::uint64_t seed = 0;
};

// The component of free space of a problem, as a tree grows in it. Node 0 is the start.
class TreeSpace {
  public:
    using Place = Located;

    TreeSpace(const Problem& problem, const Growth& growth, Trace* trace)
        : problem_(problem),
          step_(growth.step),
          trace_(trace),
          draws_(problem.world, problem.component, growth.seed),
          near_(draws_.box().low, draws_.box().high),
          goal_{problem.goal.at, none} {}

    std::int64_t looks() const { return looks_; }  // segments tested
    Point at(int node) const { return near_.point(node); }

    double uniform() { return draws_.uniform(); }
    bool draw(Located& drawn) { return (drawn = draws_.draw()).triangle != none; }
    void draw_goal(Located& drawn) const { drawn = goal_; }
    bool draw_within(double bound, Located& drawn) {
        return (drawn = draws_.draw_within(at(0), goal_.at, bound)).triangle != none;
    }
    void add(const Located& place) { near_.add(place.at), triangles_.push_back(place.triangle); }
    Located place(int node) const { return {at(node), triangles_[std::size_t(node)]}; }
    int find_nearest(const Located& place) const { return near_.nearest(place.at); }
    void find_near(const Located& place, double bound, std::vector<int>& out) const {
        double area = draws_.area();
        if (bound < std::numeric_limits<double>::infinity())
            area = std::min(area, Samples::ellipse_area(cspace::distance(at(0), goal_.at), bound));
        near_.within(place.at, std::min(joining_radius(area, near_.size() + 1), step_), out);
    }
    double distance(int node, const Located& place) const { return cspace::distance(at(node), place.at); }
    int goals() const { return 1; }
    const Located& goal(int) const { return goal_; }

    bool steer(int node, const Located& target, Located& made) {
        const Point from = at(node);
        const double far = cspace::distance(from, target.at);
        if (far == 0) return false;
        made.at = far <= step_ ? target.at : from + (step_ / far) * (target.at - from);
        made.triangle = sight(node, made.at);
        return made.triangle != none && is_within(problem_.world.space, made.triangle, made.at);
    }
    bool is_free(int node, const Located& place) { return sight(node, place.at) != none; }
    bool is_free(const Located& place, int node) {
        ++looks_;
        return end_of_sight(problem_.world.space, place, at(node)) != none;
    }
    void note_edge(int node, const Located& place, double cost) {
        if (trace_) trace_->push_back({connect, at(node), place.at, cost});
    }
    void note_rewired(int parent, int node, double cost) {
        if (trace_) trace_->push_back({rewire, at(parent), at(node), cost});
    }

  private:
    const Problem& problem_;
    const double step_;
    Trace* trace_;
    Samples draws_;
    search::Buckets near_;
    std::vector<Index> triangles_;  // of the nodes
    const Located goal_;
    std::int64_t looks_ = 0;

    Index sight(int from, Point q) {
        ++looks_;
        return from == 0 ? problem_.sight(problem_.start, q)
                         : end_of_sight(problem_.world.space, place(from), q);
    }
};

class Tree {
  public:
    Tree(const Problem& problem, const Growth& growth, Trace* trace)
        : problem_(problem),
          growth_(growth),
          space_(problem, growth, trace),
          tree_(space_,
                {growth.goal_bias, growth.is_optimal ? std::numeric_limits<double>::infinity() : growth.step,
                 growth.is_optimal}) {}

    SampledRoute solve() {
        tree_.add_root({problem_.start.at, none});
        tree_.try_roots();
        SampledRoute answer;
        InterruptPoll poll(16);
        while (answer.samples < growth_.samples && !is_done()) {
            poll.step();
            ++answer.samples;
            tree_.grow();
        }
        Route& route = answer.route;
        route.stats = {std::int64_t(tree_.size()), space_.looks()};
        if (!tree_.has_path()) return answer;
        route.path.push_back(problem_.goal.at);
        for (int n = tree_.last(); n >= 0; n = tree_.parent(n)) route.path.push_back(space_.at(n));
        finish_reversed(route);
        return answer;
    }

  private:
    const Problem& problem_;
    const Growth& growth_;
    TreeSpace space_;
    search::RandomTree<TreeSpace> tree_;

    bool is_done() const {
        return tree_.has_path() &&
               (!growth_.is_optimal || tree_.goal_cost() <= distance(problem_.start.at, problem_.goal.at));
    }
};

}  // namespace cspace::navigation::sampling
