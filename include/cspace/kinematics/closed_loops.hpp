// The loops of a mechanism as plain data: the joints of a tree, and what each loop ties.
//
// With the frame A of a loop in its parent and B in its child, d = R_Aᵀ (p_B − p_A) and D = R_Aᵀ R_B, a row
// of φ(q) = 0 is P · d + Σ C ∘ D, or that of a rod (d · d − l²) / (2 l).
#pragma once

#include <cstddef>

#include "cspace/math/vec.hpp"

namespace cspace::kinematics {

// A joint about or along the z axis of its frame, which stands at `before` in the frame of its parent, −1 for
// the base. column: its velocity is ratio times that one.
struct LoopJoint {
    int parent, coordinate, column;
    bool turns;
    double ratio, offset;
    Posed before;
};
struct LoopEnd {
    int joint;  // that carries it, −1 for the base
    Posed place;
};
// signed: rows are also zero upside down, where Σ upright ∘ D is not positive.
struct Loop {
    LoopEnd a, b;
    bool is_signed;
    Mat3d upright;
};
struct LoopRow {
    int loop;
    Vec3d P;
    Mat3d C;
    double rod;    // l, 0 for a row that is no rod
    double scale;  // makes a number without unit of the row
};

// All of them. sides (loops, joints): 1 for joints that move B against A, −1
// for those that move A, 0 for others. unit (dof,): of each velocity. length: of the mechanism [m].
struct ClosedLoops {
    const LoopJoint* joints;
    const Loop* loops;
    const LoopRow* rows;
    const signed char* sides;
    const double* unit;
    int n_joints, n_loops, n_rows, n_coordinates, dof;
    double length;
};

}  // namespace cspace::kinematics
