// Result of inverse kinematics for one goal.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/math/lanes.hpp"

namespace cspace::ik {

inline constexpr int max_solutions = 16;
inline constexpr int max_arm = 8;  // joints of an arm with a closed form

enum class Status : unsigned char {
    unreachable,  // no configuration meets the goal
    exact,        // every configuration that meets it is listed
    singular,     // some of those listed stand for a self-motion: joints move and the tip does not
    nearest,      // nothing meets the goal; the least-squares answer, because it was asked for
};

// The result of the closed form alone for a goal.
enum class FastPath : unsigned char {
    settled,   // the branches listed are all there are
    doubtful,  // the slow path has to decide
    refused,   // not a pose: a number that is not finite, a wrong last row, no rotation
};

struct Solutions {
    int count = 0;
    Status status = Status::unreachable;
    bool complete = true;  // nothing that meets the goal is left out, self-motions by a representative
    bool crowded = false;  // some solutions come close to each other: there may be self-motions among them
    double q[max_solutions][max_arm];
    signed char branch[max_solutions];         // which of the closed form's branches
    bool self_motion[max_solutions];           // stands for a one-parameter self-motion
    bool settled[max_solutions] = {};          // known to be isolated
    double direction[max_solutions][max_arm];  // of the self-motion at q, unit; else undefined
    double conditioning[max_solutions] = {};   // smallest singular value of the Jacobian; 0: not known
};

// The configuration that comes nearest to a goal out of reach, and what is missing there.
struct NearestPose {
    double q[max_joints];
    double position = 0;  // [m]
    double rotation = 0;  // [rad]
    double cost = 0;      // ½ (‖Δp‖/length)² + ½ (weight · angle)²
};

// The feasible intervals of a redundant joint for one goal. What ends one, if not a joint: nothing (it is the
// full circle), or a fold.
inline constexpr int end_none = -1, end_fold = -2;

struct Interval {
    double lower, upper;  // of the parameter [rad or m]
    int branch;
    int end[2];            // the joint that stops it, end_fold or end_none
    int side[2];           // at its lower (0) or upper (1) limit
    double q[max_joints];  // a configuration in its middle
};
struct Intervals {
    static constexpr int room = 128;
    int count = 0;
    bool complete = true;
    Interval interval[room];
};

// Results of a closed form for six joints: up to eight candidates, each with the angles of all joints.

inline constexpr int max_branches = 8;

// The angles t_i of the Denavit–Hartenberg form, in (−π, π] up to a multiple of 2π. `doubt` marks the poses
// (lanes) that the careful solver must check again.
template <class V>
struct Branches {
    V t[max_branches][6];
    mask_of<V> ok[max_branches];
    mask_of<V> doubt;
};

// The same for one goal, with its branches on lanes: branch 2 k + i is lane k of t[i].
struct Abreast {
    Pack<4> t[2][6];
    Mask<4> ok;  // of both
    bool doubt;
};

}  // namespace cspace::ik
