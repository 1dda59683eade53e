// Roadmaps of arms: configurations and edges that are free of self-collision, whatever the scene; what is
// known of them in a scene; and plans on them (PRM, lazy PRM, PRM*).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "planning_arm.hpp"

namespace cspace::planning {

// What a roadmap is made of.
struct RoadmapRule {
    std::int64_t samples = 0;     // points drawn from the box; those free of self-collision are the nodes
    std::int32_t neighbours = 0;  // each node is joined to so many; 0: as PRM* demands
    std::uint64_t seed = 0;       // shifts the samples; 0: not at all
};

class ArmRoadmap {
  public:
    // robot: without obstacles; its margin counts. part: one with the same rule but fewer samples, whose
    // proofs are taken over; or null. The same bits on any number of threads (0: all). Throws
    // std::invalid_argument as plan_arm does.
    ArmRoadmap(const ArmSpace& robot, const RoadmapRule& rule, const ArmRoadmap* part, int threads);
    // One that was made before: nodes (n, dof), edges (e, 2). Throws std::invalid_argument for nodes outside
    // the bounds, and for edges that are not those of nodes, the larger first, in order.
    ArmRoadmap(const ArmSpace& robot, const RoadmapRule& rule, std::span<const double> nodes,
               std::span<const std::int32_t> edges);

    const RoadmapRule& rule() const;
    int width() const;
    std::vector<double> nodes() const;        // (n, dof)
    std::vector<std::int32_t> edges() const;  // (e, 2)
    std::size_t size() const;                 // of nodes
    std::size_t edge_count() const;
    std::int64_t components() const;
    int neighbours() const;  // to which each node is joined

    struct State;
    const State& state() const { return *state_; }

  private:
    std::shared_ptr<const State> state_;
};

// Which nodes and edges of a roadmap are free in one scene, as far as it was found out. Any number of threads
// may plan with it; what is known changes the time of a plan alone.
class RoadmapWorld {
  public:
    // is_self_free: what the roadmap proves of self-collision holds in this scene. search, resolution: how
    // its edges are checked.
    RoadmapWorld(std::shared_ptr<const ArmRoadmap> roadmap, std::shared_ptr<const collision::Checker> checker,
                 bool is_self_free, EdgeTest search, float resolution);
    ~RoadmapWorld();

    const collision::Checker& checker() const;
    std::pair<std::int64_t, std::int64_t> count_known() const;  // nodes, edges

    struct State;
    State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

// Lazy PRM (Bohlin & Kavraki 2000) checks an edge when a shortest way may use it; PRM checks all of them
// first. Both find the shortest way over the free edges, and the same one. Throws as plan_arm does, and for
// a space of another checker or width.
ArmPlan plan_on_roadmap(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                        const RoadmapWorld& world, bool is_lazy);
std::vector<ArmPlan> plan_each_on_roadmap(const ArmSpace& space, std::span<const ArmProblem> problems,
                                          const ArmOptions& options, const RoadmapWorld& world, bool is_lazy,
                                          int threads);

}  // namespace cspace::planning
