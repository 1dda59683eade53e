// What the solver of a robot rests on, as plain numbers: cspace.ik.explain puts it into words and equations.
#include <nanobind/stl/vector.h>

#include <cmath>
#include <vector>

#include "bindings.hpp"
#include "cspace/ik/goal.hpp"
#include "ik_shared.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

template <class T>
nb::list list_of(const T* values, int n) {
    nb::list out;
    for (int i = 0; i < n; ++i) out.append(values[i]);
    return out;
}

nb::list rows_of(const Posed& T) {
    nb::list rows;
    const double t[3] = {T.t.x, T.t.y, T.t.z};
    for (int i = 0; i < 3; ++i) {
        nb::list row = list_of(T.R.m[i], 3);
        row.append(t[i]);
        rows.append(row);
    }
    const double last[4] = {0, 0, 0, 1};
    rows.append(list_of(last, 4));
    return rows;
}

// The six joints of a closed form: the chain's joint behind each (−1: virtual), and their table.
nb::dict form_of(const ik::Plan& plan) {
    nb::dict out;
    const ik::DhForm& f = plan.form;
    out["joint"] = list_of(plan.joint, 6);
    out["sign"] = list_of(plan.sign, 6);
    out["a"] = list_of(f.a, 6);
    out["d"] = list_of(f.d, 6);
    out["ca"] = list_of(f.ca, 6);
    out["sa"] = list_of(f.sa, 6);
    out["offset"] = list_of(f.offset, 6);
    out["parallel"] = list_of(f.parallel, 5);
    out["meeting"] = list_of(f.meeting, 5);
    out["base"] = rows_of(f.base);
    out["tool"] = rows_of(f.tool);
    return out;
}

nb::list vector_of(const Vec3d& v) {
    const double entries[3] = {v.x, v.y, v.z};
    return list_of(entries, 3);
}

// The six joints of a general arm, virtual ones behind its own, in metres.
void put_joints(const ik::GeneralPlan& plan, nb::dict& out) {
    nb::list axes, points;
    for (int i = 0; i < 6; ++i) {
        axes.append(vector_of(plan.chain.axis[i]));
        points.append(vector_of(plan.length * plan.chain.point[i]));
    }
    out["axes"] = axes;
    out["points"] = points;
    out["prismatic"] = list_of(plan.chain.prismatic, 6);
    out["tip"] = rows_of({plan.chain.tip.R, plan.length * plan.chain.tip.t});
}

// How a general arm is solved: by a wrist behind three joints (`wrist`: whether it is at the base), or by the
// loop, whose frames have lengths over the arm's. order: for each formulation as they are asked its number,
// the joints behind a0 … a5 and whether it is read backwards; none where three joints slide.
nb::dict loop_of(const ik::GeneralArm& arm) {
    nb::dict out;
    const ik::GeneralPlan& plan = arm.plan;
    put_joints(plan, out);
    nb::list order, between;
    for (const Posed& link : plan.frames.between) between.append(rows_of(link));
    for (int k = 0; k < plan.regular && plan.slides < 3; ++k) {
        const ik::Formulation form = formulation(plan.order[k]);
        const ik::Loop loop = make_loop(plan.frames, plan.chain.prismatic, plan.chain.tip, form);
        order.append(nb::make_tuple(plan.order[k], list_of(loop.joint, 6), form.backwards));
    }
    out["order"] = order;
    out["between"] = between;
    out["first"] = rows_of(plan.frames.first);
    out["last"] = rows_of(plan.frames.last);
    out["length"] = plan.length;
    out["neighbours"] = arm.has_neighbours;
    if (arm.position_first.serves) out["wrist"] = arm.position_first.backwards;
    return out;
}

// _ik_plan(robot) → {"form": …} of an arm with a closed form, {"loop": …} of a general one, else {}.
nb::dict plan(nb::object robot) {
    nb::dict out;
    const ik::Arm* arm = arm_of(robot.ptr());
    if (arm && arm->has_plan) out["form"] = form_of(arm->plan);
    if (arm && arm->is_general && !arm->has_plan) out["loop"] = loop_of(arm->general);
    return out;
}

// _ik_determinant(robot, goal rows, formulation, a0) → f(a0), whose zeros are the solutions' hidden angles.
double hidden_determinant(nb::object robot, const std::vector<double>& goal, int number, double a0) {
    const ik::Arm* arm = arm_of(robot.ptr());
    if (!arm || !arm->is_general || arm->has_plan || arm->general.plan.regular == 0 ||
        arm->general.plan.slides > 2 || goal.size() != 16)
        throw nb::type_error("_ik_determinant takes a general arm and the 16 numbers of a goal");
    const ik::GeneralPlan& plan = arm->general.plan;
    Posed T = read_goal(goal.data()).T;
    T.t = (1 / plan.length) * T.t;
    const ik::Loop loop = make_loop(plan.frames, plan.chain.prismatic, T, formulation(number));
    if (plan.slides < 2) return determinant(eliminate(loop), std::cos(a0), std::sin(a0));
    return lane(lack_on_both(two_sheets(loop), fill<Pack<4>>(std::cos(a0)), fill<Pack<4>>(std::sin(a0))), 0);
}

}  // namespace

void bind_ik_plan(nb::module_& m) {
    m.def("_ik_plan", &plan, nb::arg("robot"), "What the solver of a robot rests on.");
    m.def("_ik_determinant", &hidden_determinant, nb::arg("robot"), nb::arg("goal"), nb::arg("formulation"),
          nb::arg("a0"), "The determinant of a general arm at one hidden angle.");
}
