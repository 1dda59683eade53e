// The numbers behind a robot's solver, by the names that they have in the headers and in the order in which
// they stand there: what the export writes down.
#include <nanobind/nanobind.h>

#include <cstddef>

#include "bindings.hpp"
#include "ik_shared.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

nb::object numbers(double x) { return nb::float_(x); }
nb::object numbers(int x) { return nb::int_(x); }
nb::object numbers(bool x) { return nb::bool_(x); }
nb::object numbers(ik::Family x) { return nb::int_(int(x)); }
nb::object numbers(ik::FirstThree x) { return nb::int_(int(x)); }

nb::object numbers(const Vec3d& v);
nb::object numbers(const Mat3d& R);
nb::object numbers(const Posed& T);
nb::object numbers(const Turn<double>& t);
nb::object numbers(const ik::Chain& c);
nb::object numbers(const ik::DhForm& f);
nb::object numbers(const Wrist& w);
nb::object numbers(const ik::ThreeJoints& g);
nb::object numbers(const ik::SphericalWrist& s);
nb::object numbers(const ik::ThreeParallel& p);
nb::object numbers(const ik::LoopFrames& f);
nb::object numbers(const ik::GeneralPlan& p);
nb::object numbers(const ThreeTurns& t);
nb::object numbers(const ik::PositionFirst& p);
template <class T>
nb::object list_of(const T* values, int count) {
    nb::list out;
    for (int i = 0; i < count; ++i) out.append(numbers(values[i]));
    return out;
}
template <class T, int n>
nb::object numbers(const T (&values)[n]) {
    return list_of(values, n);
}

class Fields {
  public:
    template <class T>
    Fields& operator()(const char* name, const T& value) {
        dict_[name] = numbers(value);
        return *this;
    }
    Fields& operator()(const char* name, nb::object value) {
        dict_[name] = value;
        return *this;
    }
    operator nb::object() const { return dict_; }

  private:
    nb::dict dict_;
};

nb::object numbers(const Vec3d& v) { return Fields()("x", v.x)("y", v.y)("z", v.z); }
nb::object numbers(const Mat3d& R) {
    nb::list rows;
    for (const auto& row : R.m) rows.append(list_of(row, 3));
    return Fields()("m", nb::object(rows));
}
nb::object numbers(const Posed& T) { return Fields()("R", T.R)("t", T.t); }
nb::object numbers(const Turn<double>& t) { return Fields()("c", t.c)("s", t.s); }

nb::object numbers(const ik::Chain& c) {
    return Fields()("n", c.n)("axis", list_of(c.axis, c.n))("point", list_of(c.point, c.n))(
        "prismatic", list_of(c.prismatic, c.n))("tip", c.tip);
}
nb::object numbers(const ik::DhForm& f) {
    return Fields()("a", f.a)("d", f.d)("ca", f.ca)("sa", f.sa)("offset", f.offset)("parallel", f.parallel)(
        "meeting", f.meeting)("base", f.base)("tool", f.tool)("length", f.length)("deviation", f.deviation)(
        "degenerate", f.degenerate);
}
nb::object numbers(const Wrist& w) {
    return Fields()("ca4", w.ca4)("sa4", w.sa4)("ca5", w.ca5)("sa5", w.sa5)("c_sum", w.c_sum)(
        "s_sum", w.s_sum)("c_diff", w.c_diff)("s_diff", w.s_diff)("inv", w.inv)("right_angled",
                                                                                w.right_angled);
}
nb::object numbers(const ik::ThreeJoints& g) {
    return Fields()("kind", g.kind)("a1", g.a1)("ca1", g.ca1)("sa1", g.sa1)("d2", g.d2)("a2", g.a2)(
        "ca2", g.ca2)("sa2", g.sa2)("w", g.w)("length", g.length)("wrist_reach", g.wrist_reach)("w_angle",
                                                                                                g.w_angle);
}
nb::object numbers(const ik::SphericalWrist& s) {
    return Fields()("first", s.first)("last", s.last)("ca3", s.ca3)("sa3", s.sa3);
}
nb::object numbers(const ik::ThreeParallel& p) {
    return Fields()("a1", p.a1)("ca1", p.ca1)("sa1", p.sa1)("height", p.height)("l2", p.l2)("l3", p.l3)(
        "x4", p.x4)("y4", p.y4)("last", p.last)("length", p.length);
}
nb::object numbers(const ik::Plan& p) {
    const bool wrist = p.family == ik::Family::spherical_wrist;
    const bool parallel = p.family == ik::Family::three_parallel;
    return Fields()("family", p.family)("reversed", p.reversed)("joint", p.joint)("sign", p.sign)(
        "chain", numbers(p.chain))("form", p.form)("wrist", wrist ? numbers(p.wrist) : nb::dict())(
        "parallel", parallel ? numbers(p.parallel) : nb::dict())("to_form_left", p.to_form_left)(
        "to_form_right", p.to_form_right)("virtual_joints", p.virtual_joints)("on_lanes", p.on_lanes)(
        "idealised", p.idealised)("polish", p.polish);
}
nb::object numbers(const ik::LoopFrames& f) {
    return Fields()("between", f.between)("first", f.first)("last", f.last);
}
nb::object numbers(const ik::GeneralPlan& p) {
    return Fields()("chain", p.chain)("length", p.length)("slides", p.slides)("frames", p.frames)(
        "order", list_of(p.order, p.regular))("regular", p.regular)("sensitivity", p.sensitivity)(
        "paired", p.paired)("ghosts", p.ghosts)("ghost", p.ghost);
}
nb::object numbers(const ThreeTurns& t) {
    return Fields()("h", t.h)("a", t.a)("b", t.b)("constant", t.constant);
}
nb::object numbers(const ik::PositionFirst& p) {
    return Fields()("serves", p.serves)("backwards", p.backwards)("arm", p.arm)("first", p.first)(
        "centre_in_tip", p.centre_in_tip)("wrist", p.wrist);
}
nb::object numbers(const ik::GeneralArm& a) {
    return Fields()("chain", a.chain)("plan", a.plan)(
        "position_first", a.position_first.serves ? numbers(a.position_first) : nb::dict())(
        "neighbour", list_of(a.neighbour, a.has_neighbours ? 2 : 0))("alone", a.alone)("has_neighbours",
                                                                                       a.has_neighbours);
}

nb::object solver_numbers(nb::handle robot) {
    const ik::Arm* arm = arm_of(robot.ptr());
    if (!arm || !can_solve(*arm)) throw nb::type_error("_ik_numbers takes a robot with a solver");
    if (arm->has_plan) return nb::make_tuple("closed", numbers(arm->plan));
    if (arm->is_general) return nb::make_tuple("general", numbers(arm->general));
    return nb::make_tuple(arm->is_short ? "short" : "any", numbers(arm->plan.chain));
}

}  // namespace

void bind_ik_numbers(nb::module_& m) {
    m.def("_ik_numbers", &solver_numbers, nb::arg("robot"),
          "How a robot is solved (closed, general, short, any) and the numbers of its plan.");
}
