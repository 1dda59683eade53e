// The loops of a mechanism as an object of Python, which owns their numbers.
#pragma once

#include <vector>

#include "arrays_in_place.hpp"
#include "cspace/kinematics/closed_loops.hpp"

class LoopTable {
  public:
    // joints (joints, 6 + 16): parent, coordinate, column, whether it turns, ratio, offset and its place;
    // loops (loops, 2 · 17 + 10): joint and place of both ends, whether it is signed, and what is upright;
    // rows (rows, 15): loop, P, C, rod, scale; sides (loops, joints); unit (dof,).
    LoopTable(const ConstDoubles& joints, const ConstDoubles& loops, const ConstDoubles& rows,
              const ConstDoubles& sides, const ConstDoubles& unit, int n_coordinates, double length);
    cspace::kinematics::ClosedLoops view() const;

  private:
    std::vector<cspace::kinematics::LoopJoint> joints_;
    std::vector<cspace::kinematics::Loop> loops_;
    std::vector<cspace::kinematics::LoopRow> rows_;
    std::vector<signed char> sides_;
    std::vector<double> unit_;
    int n_coordinates_;
    double length_;
};
