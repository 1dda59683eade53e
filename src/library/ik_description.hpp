// How an arm is solved, as plain numbers in JSON: for cspace.ik.explain, which puts it into words and
// equations, and for cspace.export, which prints it as source code.
#pragma once

#include <string>
#include <utility>

#include "ik_arm.hpp"

namespace cspace::ik {

// Which solver serves the arm ("closed", "general", "few_joints", "any") and every number of its plan.
std::pair<std::string, std::string> plan_numbers(const BuiltArm& built);

// What the classification of an arm saw.
std::string arm_geometry(const BuiltArm& built);

// f(a0) of one formulation of a general arm with at most two prismatic joints: its zeros are the hidden
// angles of the solutions.
bool has_hidden_determinant(const BuiltArm& built);
double hidden_determinant(const BuiltArm& built, const double* goal, int formulation, double a0);

}  // namespace cspace::ik
