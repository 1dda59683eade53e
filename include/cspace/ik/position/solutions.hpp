// Results of inverse kinematics for an arm with up to three joints.
#pragma once

#include "cspace/ik/chain.hpp"

namespace cspace::ik {

inline constexpr int max_position_joints = 3, max_position_solutions = 8;

// The result of a position goal.
struct PositionSolutions {
    int count = 0;
    double q[max_position_solutions][max_position_joints] = {};
    double residual[max_position_solutions] = {};  // ‖tip − goal‖ [m]
    // Whether solution i belongs to a family, and the unit direction in which its joints move without the
    // tip; close: whether it does, or merges with another, but for what rounding leaves.
    bool free[max_position_solutions] = {};
    bool close[max_position_solutions] = {};
    double direction[max_position_solutions][max_position_joints] = {};
    // Without a solution: the distance that is missing [m], and the joints that come nearest.
    double out_of_reach = 0;
    double nearest[max_position_joints] = {};
};

// The result of a pose goal for such an arm.
struct FewJointSolutions {
    int count = 0;
    double q[max_position_solutions][max_position_joints] = {};
    double position_error[max_position_solutions] = {};  // [m]
    double rotation_error[max_position_solutions] = {};  // [rad]
    bool free[max_position_solutions] = {};
    bool close[max_position_solutions] = {};
    double direction[max_position_solutions][max_position_joints] = {};
};

}  // namespace cspace::ik
