// Arms with redundant joints: what the bindings call. The solver keeps, for every set of joints that was
// locked, the plan of those that move.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ik_arm.hpp"

namespace cspace::ik {

struct LockedArm;

// The configurations that answer one goal.
struct GoalAnswer {
    Status status = Status::unreachable;
    bool complete = true;
    int count = 0;
    std::vector<double> q, whole;  // rows of the arm, and of the longer one of a partial goal
    std::vector<std::int8_t> branch;
    std::vector<char> self_motion;
    int values = 0;         // of a redundant joint at which branches are listed; 0: one configuration of many
    bool feasible = false;  // whether these values keep all limits

    void append(const SolutionRows& rows, int n) {
        for (int k = 0; k < rows.count; ++k)
            append_row(rows.q + k * rows.stride, n, rows.branch[k], rows.self_motion && rows.self_motion[k]);
        status = rows.status;
        complete = rows.complete;
    }
    void append_row(const double* row, int n, int number, bool is_self_motion) {
        q.insert(q.end(), row, row + n);
        branch.push_back(std::int8_t(number));
        self_motion.push_back(is_self_motion);
        ++count;
    }
};

// Intervals as disjoint ones, ascending; and the middles of n equal parts of all that they cover.
using Span = std::pair<double, double>;
std::vector<Span> unite_intervals(std::vector<Span> intervals);
std::vector<double> spread_values(std::vector<Span> intervals, int n);

// Whether a joint stands for the distance to a point that the tool looks at: a goal's own prismatic joint
// that begins at zero.
inline bool leads_ahead(const Chain& chain, const double* weight, const double* lower, int joint) {
    return chain.prismatic[joint] && weight[joint] == 0 && lower[joint] == 0;
}

class RedundantSolver {
  public:
    // Limits and weights of distances per joint.
    RedundantSolver(const Chain& chain, const double* lower, const double* upper, const double* weight);

    const Chain& chain() const;
    RedundantSolver& without_limits();  // the same arm, made when first needed
    int redundant_joints() const;       // beyond those that the tip needs to move as it can
    std::vector<int> default_locked() const;
    bool has_closed_form() const;                              // of the joints that move by default
    int redundant_with(const std::vector<int>& locked) const;  // the same, some locked

    // The plan with these joints locked, built when first needed. Throws std::invalid_argument unless they
    // ascend and leave one to six to move.
    const LockedArm& lock(const std::vector<int>& joints) const;
    int room_for(const std::vector<int>& locked) const;

    // Goals (n, 16) with the locked joints at their values: `at` (n, dof), or one row for all; q (n, room,
    // dof).
    struct Rows {
        const double* goals;
        std::size_t n;
        const double* at;
        bool at_each;
        const double* unconstrained;
        std::size_t room;
        double* q;
        std::int8_t* branch;
        bool* self_motion;
        std::int64_t* count;
        std::uint8_t* status;
        int threads;
    };
    void solve(const LockedArm& locked, const Rows& rows) const;

    // The configuration nearest to a seed, by multiples of 2π as close to it as the limits allow; false where
    // the search finds none.
    bool find_nearest_turned(const double* goal, const double* seed, double* q) const;
    // The nearest within limits; where the search finds none, the nearest of all, and `is_within` is false.
    // complete: whether there is none if none was found.
    struct NearestFound {
        bool any = false, is_within = false, complete = false;
    };
    NearestFound find_nearest_within(const double* goal, const double* seed, double* q);

    // The feasible intervals of one locked joint, with configurations within the limits, and whether none is
    // missing.
    std::vector<Interval> intervals(int parameter, const double* goal, bool& complete);

    // All branches at n values of the default locked joint, spread over its feasible intervals; where none is
    // feasible, over the values that reach the goal. Returns whether there are any such values.
    bool sample(const double* goal, int n, GoalAnswer& out);

    // A configuration that reaches a goal, near the middle of the limits (0 for joints without). To look at a
    // point far away, the search first looks at a closer one in the same direction.
    bool find_near_middle(const double* goal, double* q) const;

    // Arms with two spherical joints, by the swivel of their elbow: whether axes 1, 2, 3 and 5, 6, 7 meet.
    bool has_swivel() const;
    // Goal i at swivel i, or one goal at all of the n swivels: q (n, 8, 7), NaN in rows without a solution.
    void solve_swivels(const double* goals, bool one_goal, const double* swivels, std::size_t n,
                       double* q) const;
    double swivel_at(const double* q) const;

  private:
    bool find_one_within(const double* goal, double* q, bool& complete);
    void start_of_search(const double* goal, int attempt, double* start) const;

    struct State;
    std::shared_ptr<State> state_;
};

// One goal with the locked joints at their values `at` (dof,). False where the goal is no pose.
bool solve_locked_goal(const LockedArm& locked, const double* goal, const double* at, SolutionStore& store,
                       SolutionRows& rows);

}  // namespace cspace::ik
