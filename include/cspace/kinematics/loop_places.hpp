// Where the joints and loops of a mechanism are, and how they move, as plain data.
#pragma once

#include "cspace/kinematics/closed_loops.hpp"

namespace cspace::kinematics {

// How a body moves against the base where no joint accelerates: w and v of the point of the body at the
// origin of the base, and their spatial accelerations.
struct LoopMotion {
    Vec3d w, v, alpha, a;
};

// Room for one configuration: joints (n_joints,) and motions (n_joints,), ends (2 n_loops,): A and B of each
// loop.
struct LoopPlaces {
    Posed *joints, *ends;
    LoopMotion* motions;
};

}  // namespace cspace::kinematics
