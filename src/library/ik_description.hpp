// How an arm is solved, as plain numbers: for cspace.ik.explain, which puts it into words and equations, and
// for cspace.export, which prints it as source code.
#pragma once

#include <string>

#include "ik_arm.hpp"
#include "value.hpp"

namespace cspace::ik {

// Which solver serves the arm ("closed", "general", "few_joints", "any") and every number of its plan.
std::pair<std::string, Value> plan_numbers(const BuiltArm& built);

// {"form": …} of an arm with a closed form, {"loop": …} of a general one, else nothing.
Value plan_outline(const BuiltArm& built);

// f(a0) of one formulation of a general arm with at most two prismatic joints: its zeros are the hidden
// angles of the solutions.
bool has_hidden_determinant(const BuiltArm& built);
double hidden_determinant(const BuiltArm& built, const double* goal, int formulation, double a0);

}  // namespace cspace::ik
