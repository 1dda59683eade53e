// How an arm is solved, as plain numbers: for cspace.ik.explain, which puts it into words and equations, and
// for cspace.export, which prints it as source code.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ik_arm.hpp"

namespace cspace::ik {

// A number, a list or named parts: a structure on its way to plain objects.
struct Value {
    enum class Kind { truth, integer, real, list, parts };
    Kind kind = Kind::parts;
    double number = 0;
    std::vector<Value> items;
    std::vector<std::string> names;  // of the items, where they are parts

    Value() = default;
    Value(bool x) : kind(Kind::truth), number(x) {}
    Value(int x) : kind(Kind::integer), number(x) {}
    Value(double x) : kind(Kind::real), number(x) {}
    Value(std::vector<Value> list) : kind(Kind::list), items(std::move(list)) {}

    Value& add(std::string name, Value part) {
        names.push_back(std::move(name));
        items.push_back(std::move(part));
        return *this;
    }
    Value& add(const Value& parts) {
        for (std::size_t k = 0; k < parts.items.size(); ++k) add(parts.names[k], parts.items[k]);
        return *this;
    }
};

// Which solver serves the arm ("closed", "general", "few_joints", "any") and every number of its plan.
std::pair<std::string, Value> plan_numbers(const BuiltArm& built);

// What the classification of an arm saw.
Value arm_geometry(const BuiltArm& built);

// {"form": …} of an arm with a closed form, {"loop": …} of a general one, else nothing.
Value plan_outline(const BuiltArm& built);

// f(a0) of one formulation of a general arm with at most two prismatic joints: its zeros are the hidden
// angles of the solutions.
bool has_hidden_determinant(const BuiltArm& built);
double hidden_determinant(const BuiltArm& built, const double* goal, int formulation, double a0);

}  // namespace cspace::ik
