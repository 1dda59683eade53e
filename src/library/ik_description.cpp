#include "ik_description.hpp"

#include <cmath>

#include "cspace/ik/arm.hpp"
#include "cspace/ik/goal.hpp"

namespace cspace::ik {

namespace {

Value numbers(double x) { return x; }
Value numbers(int x) { return x; }
Value numbers(bool x) { return x; }
Value numbers(Family x) { return int(x); }
Value numbers(FirstThree x) { return int(x); }
Value numbers(const Vec3d& v);
Value numbers(const Mat3d& R);
Value numbers(const Posed& T);
Value numbers(const Turn<double>& t);
Value numbers(const Chain& c);
Value numbers(const DhForm& f);
Value numbers(const Wrist& w);
Value numbers(const ThreeJoints& g);
Value numbers(const SphericalWrist& s);
Value numbers(const ThreeParallel& p);
Value numbers(const LoopFrames& f);
Value numbers(const GeneralPlan& p);
Value numbers(const ThreeTurns& t);
Value numbers(const PositionFirst& p);
template <class T>
Value list_of(const T* values, int count) {
    std::vector<Value> out;
    for (int i = 0; i < count; ++i) out.push_back(numbers(values[i]));
    return out;
}
template <class T, int n>
Value numbers(const T (&values)[n]) {
    return list_of(values, n);
}

// The parts of a structure by name, one call each.
class Parts {
  public:
    template <class T>
    Parts& operator()(const char* name, const T& value) {
        all_.add(name, numbers(value));
        return *this;
    }
    Parts& operator()(const char* name, Value value) {
        all_.add(name, std::move(value));
        return *this;
    }
    operator Value() const { return all_; }

  private:
    Value all_;
};

Value numbers(const Vec3d& v) { return Parts()("x", v.x)("y", v.y)("z", v.z); }
Value numbers(const Mat3d& R) {
    std::vector<Value> rows;
    for (const auto& row : R.m) rows.push_back(list_of(row, 3));
    return Parts()("m", Value(std::move(rows)));
}
Value numbers(const Posed& T) { return Parts()("R", T.R)("t", T.t); }
Value numbers(const Turn<double>& t) { return Parts()("c", t.c)("s", t.s); }

Value numbers(const Chain& c) {
    return Parts()("n", c.n)("axis", list_of(c.axis, c.n))("point", list_of(c.point, c.n))(
        "prismatic", list_of(c.prismatic, c.n))("tip", c.tip);
}
Value numbers(const DhForm& f) {
    return Parts()("a", f.a)("d", f.d)("ca", f.ca)("sa", f.sa)("offset", f.offset)("parallel", f.parallel)(
        "meeting", f.meeting)("base", f.base)("tool", f.tool)("length", f.length)("deviation", f.deviation)(
        "degenerate", f.degenerate);
}
Value numbers(const Wrist& w) {
    return Parts()("ca4", w.ca4)("sa4", w.sa4)("ca5", w.ca5)("sa5", w.sa5)("c_sum", w.c_sum)(
        "s_sum", w.s_sum)("c_diff", w.c_diff)("s_diff", w.s_diff)("inv", w.inv)("right_angled",
                                                                                w.right_angled);
}
Value numbers(const ThreeJoints& g) {
    return Parts()("kind", g.kind)("a1", g.a1)("ca1", g.ca1)("sa1", g.sa1)("d2", g.d2)("a2", g.a2)(
        "ca2", g.ca2)("sa2", g.sa2)("w", g.w)("length", g.length)("wrist_reach", g.wrist_reach)("w_angle",
                                                                                                g.w_angle);
}
Value numbers(const SphericalWrist& s) {
    return Parts()("first", s.first)("last", s.last)("ca3", s.ca3)("sa3", s.sa3);
}
Value numbers(const ThreeParallel& p) {
    return Parts()("a1", p.a1)("ca1", p.ca1)("sa1", p.sa1)("height", p.height)("l2", p.l2)("l3", p.l3)(
        "x4", p.x4)("y4", p.y4)("last", p.last)("length", p.length);
}
Value numbers(const Plan& p) {
    const bool wrist = p.family == Family::spherical_wrist;
    const bool parallel = p.family == Family::three_parallel;
    return Parts()("family", p.family)("reversed", p.reversed)("joint", p.joint)("sign", p.sign)(
        "chain", numbers(p.chain))("form", p.form)("wrist", wrist ? numbers(p.wrist) : Value())(
        "parallel", parallel ? numbers(p.parallel) : Value())("to_form_left", p.to_form_left)(
        "to_form_right", p.to_form_right)("virtual_joints", p.virtual_joints)("on_lanes", p.on_lanes)(
        "idealised", p.idealised)("polish", p.polish);
}
Value numbers(const LoopFrames& f) { return Parts()("between", f.between)("first", f.first)("last", f.last); }
Value numbers(const GeneralPlan& p) {
    return Parts()("chain", p.chain)("length", p.length)("slides", p.slides)("frames", p.frames)(
        "order", list_of(p.order, p.regular))("regular", p.regular)("sensitivity", p.sensitivity)(
        "paired", p.paired)("spurious_roots", p.spurious_roots)("spurious", p.spurious);
}
Value numbers(const ThreeTurns& t) { return Parts()("h", t.h)("a", t.a)("b", t.b)("constant", t.constant); }
Value numbers(const PositionFirst& p) {
    return Parts()("serves", p.serves)("backwards", p.backwards)("arm", p.arm)("first", p.first)(
        "centre_in_tip", p.centre_in_tip)("wrist", p.wrist);
}
Value numbers(const GeneralArm& a) {
    return Parts()("chain", a.chain)("plan", a.plan)(
        "position_first", a.position_first.serves ? numbers(a.position_first) : Value())(
        "perturbed", list_of(a.perturbed, a.has_perturbed ? 2 : 0))("alone", a.alone)("has_perturbed",
                                                                                      a.has_perturbed);
}

// --- the outline ---------------------------------------------------------------------------------------

Value rows_of(const Posed& T) {
    std::vector<Value> rows;
    const double t[3] = {T.t.x, T.t.y, T.t.z}, last[4] = {0, 0, 0, 1};
    for (int i = 0; i < 3; ++i) {
        Value row = list_of(T.R.m[i], 3);
        row.items.push_back(t[i]);
        rows.push_back(std::move(row));
    }
    rows.push_back(list_of(last, 4));
    return rows;
}

Value form_of(const Plan& plan) {
    const DhForm& f = plan.form;
    return Parts()("joint", plan.joint)("sign", plan.sign)("a", f.a)("d", f.d)("ca", f.ca)("sa", f.sa)(
        "offset", f.offset)("parallel", f.parallel)("meeting", f.meeting)("base", rows_of(f.base))(
        "tool", rows_of(f.tool));
}

Value vector_of(const Vec3d& v) {
    const double entries[3] = {v.x, v.y, v.z};
    return list_of(entries, 3);
}

// A general arm is solved by a wrist behind three joints (`wrist`: whether it is at the base), or by the
// loop, whose frames have lengths over the arm's. order: for each formulation as they are tried its number,
// the joints behind a0 … a5 and whether it is read backwards; none where three joints are prismatic.
Value loop_of(const GeneralArm& arm) {
    const GeneralPlan& plan = arm.plan;
    std::vector<Value> axes, points, order, between;
    for (int i = 0; i < 6; ++i) {
        axes.push_back(vector_of(plan.chain.axis[i]));
        points.push_back(vector_of(plan.length * plan.chain.point[i]));
    }
    for (const Posed& link : plan.frames.between) between.push_back(rows_of(link));
    for (int k = 0; k < plan.regular && plan.slides < 3; ++k) {
        const Formulation form = formulation(plan.order[k]);
        const Loop loop = make_loop(plan.frames, plan.chain.prismatic, plan.chain.tip, form);
        order.push_back(std::vector<Value>{plan.order[k], list_of(loop.joint, 6), form.backwards});
    }
    Parts out;
    out("axes", Value(std::move(axes)))("points", Value(std::move(points)))("prismatic",
                                                                            list_of(plan.chain.prismatic, 6))(
        "tip", rows_of({plan.chain.tip.R, plan.length * plan.chain.tip.t}))("order", Value(std::move(order)))(
        "between", Value(std::move(between)))("first", rows_of(plan.frames.first))(
        "last", rows_of(plan.frames.last))("length", plan.length)("perturbed_arms", arm.has_perturbed);
    if (arm.position_first.serves) out("wrist", arm.position_first.backwards);
    return out;
}

}  // namespace

std::pair<std::string, Value> plan_numbers(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    if (arm.has_plan) return {"closed", numbers(arm.plan)};
    if (arm.is_general) return {"general", numbers(arm.general)};
    return {arm.has_few_joints ? "few_joints" : "any", numbers(arm.plan.chain)};
}

Value plan_outline(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    if (arm.has_plan) return Parts()("form", form_of(arm.plan));
    return arm.is_general ? Value(Parts()("loop", loop_of(arm.general))) : Value();
}

bool has_hidden_determinant(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    return arm.is_general && !arm.has_plan && arm.general.plan.regular > 0 && arm.general.plan.slides <= 2;
}

double hidden_determinant(const BuiltArm& built, const double* goal, int number, double a0) {
    const GeneralPlan& plan = built.arm->general.plan;
    Posed T = read_goal(goal).T;
    T.t = (1 / plan.length) * T.t;
    const Loop loop = make_loop(plan.frames, plan.chain.prismatic, T, formulation(number));
    if (plan.slides < 2) return determinant(eliminate_angles(loop), std::cos(a0), std::sin(a0));
    return lane(lack_on_both(two_sheets(loop), fill<Pack<4>>(std::cos(a0)), fill<Pack<4>>(std::sin(a0))), 0);
}

}  // namespace cspace::ik
