// What a planner of arms is given and what it answers: plain data.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/collision/workspace.hpp"

namespace cspace::planning {

// How edges are checked: at samples, or over their whole length.
enum class EdgeTest { sampled, proved };

struct ArmOptions {
    EdgeTest search = EdgeTest::proved;  // of the trees
    EdgeTest answer = EdgeTest::proved;  // of the path that is returned
    bool simplify = true;
    std::uint64_t seed = 0;                                       // shifts the samples; 0: not at all
    std::int64_t edges = 1 << 20;                                 // the search may check so many
    std::int64_t improve = 0;                                     // so many more, to find shorter paths
    double time_limit = std::numeric_limits<double>::infinity();  // [s], decides only whether there is a path
    float range = 1;                                              // the longest edge of a tree [rad, m]
    float resolution = 1.0f / 32;                                 // of sampled edges [rad, m]
};

// What a tree from the starts does: RRT, RRT*, informed RRT*.
struct TreeOptions {
    bool is_optimal =
        false;  // RRT*: joins and rewires; ArmOptions::improve is its budget after the first path
    bool is_informed = false;  // then draws only what can still shorten the path
    double goal_bias = 0.05;   // how often a goal is drawn while no path is known
};

// disconnected: the free edges of a graph join no start with a goal. resting: a descent does not arrive.
enum class PlanStatus { found, edge_budget, time_limit, invalid_start, invalid_goals, disconnected, resting };

// A given start or goal; contact: what touches.
enum class RowState { free, in_collision, out_of_bounds };
struct RowReport {
    RowState state = RowState::free;
    collision::Contact contact;
};

struct ArmStats {
    std::int64_t samples = 0, rejected = 0;           // points drawn; those outside the domain of their node
    std::int64_t edges = 0, blocked = 0, blocks = 0;  // of the search; blocks of eight configurations in all
    std::int64_t nodes = 0, removed = 0;              // of both trees; edges whose proof failed
    std::int64_t shortcuts = 0,
                 proofs = 0;        // edges checked for simplification; of what was left of the trees
    std::int64_t improvements = 0;  // shorter paths after the first
    std::int64_t start_nodes = 0, goal_nodes = 0;  // of a roadmap: those that the ends are joined with
    std::int64_t expansions = 0;                   // of nodes of a grid
    double search_seconds = 0, simplify_seconds = 0, proof_seconds = 0, improve_seconds = 0;
};

// The nearest nodes of the two trees.
struct Approach {
    double distance = std::numeric_limits<double>::infinity();
    std::vector<double> from, to;  // from the start, from a goal
};

struct ArmPlan {
    PlanStatus status = PlanStatus::invalid_start;
    // Rows (m, dof), moved through in straight lines. The first is the start and the last the goal, bit for
    // bit, but a joint that wraps ends at the goal plus 2π times `turns`.
    std::vector<double> path;
    std::vector<int> turns;
    double cost = std::numeric_limits<double>::infinity();  // length of the path (L2 norm) [rad, m]
    double raw_cost = cost;                                 // before it was simplified
    int start = -1, goal = -1;                              // which of those given
    bool certified = false;                                 // every edge is proved free
    std::vector<RowReport> starts, goals;
    ArmStats stats;
    Approach approach;           // where there is no path
    collision::Contact blocker;  // what blocked most edges, and how many; link < 0: nothing
    std::int64_t blocker_edges = 0;
};

}  // namespace cspace::planning
