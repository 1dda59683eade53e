// The path from the base to one frame, reduced so that following it costs little.
//
// Every rotation is Rz(φ) Rx(α) Rz(ψ) (Euler Z-X-Z). The turns φ and ψ about the axes of two neighbouring
// joints melt into the angles of these joints, which leaves per joint
//     Rz(turn · q + angle) · Tr(x, y, slide · q + z) · Rx(α).
// This is the form of Denavit and Hartenberg (1955) with a free translation: it keeps its digits where axes
// are almost parallel and their common normal runs away.
#pragma once

#include <cmath>

#include "cspace/math/vec.hpp"

namespace cspace::model {

// Most arms have axes that are parallel or perpendicular: their turns by α cost nothing.
enum class Tilt : unsigned char { none, quarter, half, any };

struct ChainJoint {
    double turn, angle;     // turn is 0 for a prismatic joint
    double slide, x, y, z;  // slide is 0 for a revolute joint
    double cos_alpha, sin_alpha;
    double ratio;  // of the joint to its coordinate, whatever its kind
    int coordinate;
    bool prismatic;
    Tilt tilt;
};
struct Chain {
    const ChainJoint* joints;
    int n;                      // joints on the path
    int n_coordinates;          // of the whole robot
    bool ordered;               // joint i is coordinate i itself, and there are no others
    Posed T_base_first;         // the frame of the first joint
    double cos_last, sin_last;  // the remaining rotation ψ at the tip
};

}  // namespace cspace::model
