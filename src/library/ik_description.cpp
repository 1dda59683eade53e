#include "ik_description.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cspace/ik/arm.hpp"
#include "cspace/ik/goal.hpp"

namespace cspace::ik {

namespace {

// What the first three axes share, of arms with a spherical wrist and of three revolute joints.
int pieper_case_of(const Arm& arm) {
    if (arm.has_plan) return arm.plan.family == Family::spherical_wrist ? int(arm.plan.wrist.first.kind) : -1;
    const Chain& c = arm.plan.chain;
    if (c.n != 3 || c.prismatic[0] || c.prismatic[1] || c.prismatic[2]) return -1;
    bool parallel[2], meeting[2];
    for (int i = 0; i < 2; ++i) {
        const Vec3d normal = cross(c.axis[i], c.axis[i + 1]), gap = c.point[i + 1] - c.point[i];
        parallel[i] = norm(normal) <= tolerance::axis_relation;
        meeting[i] = !parallel[i] && std::fabs(dot(gap, normal)) <=
                                         tolerance::axis_relation * arm.plan.form.length * norm(normal);
    }
    return int(parallel[1]   ? PieperCase::last_parallel
               : parallel[0] ? PieperCase::first_parallel
               : meeting[0]  ? PieperCase::first_meet
               : meeting[1]  ? PieperCase::last_meet
                             : PieperCase::general);
}

// A JSON object.
struct Parts {
    std::string members;

    Parts& add(const std::string& name, const std::string& value) {
        members += (members.empty() ? "\"" : ",\"") + name + "\":" + value;
        return *this;
    }
    Parts& add(const Parts& more) {
        members += "," + more.members;
        return *this;
    }
    operator std::string() const { return "{" + members + "}"; }
};

// Structures as JSON. PARTS(t.c, t.s) are the parts "c" and "s".
struct Describe {
#define PARTS(...) parts(#__VA_ARGS__, __VA_ARGS__)
    template <class... T>
    static Parts parts(const std::string& names, const T&... values) {
        Parts out;
        std::size_t end = 0;
        const auto add = [&](const std::string& value) {
            end = std::min(names.find(',', end + 1), names.size());
            const std::size_t dot = names.rfind('.', end - 1);
            out.add(names.substr(dot + 1, end - dot - 1), value);
        };
        (add(describe(values)), ...);
        return out;
    }
    template <class T>
    static std::string list_of(const T* values, int count) {
        std::string out = "[";
        for (int i = 0; i < count; ++i) out += (i ? "," : "") + describe(values[i]);
        return out + "]";
    }
    template <class T, int n>
    static std::string describe(const T (&values)[n]) {
        return list_of(values, n);
    }
    static std::string describe(double x) {
        if (!std::isfinite(x)) return std::isnan(x) ? "NaN" : x > 0 ? "Infinity" : "-Infinity";
        char digits[32];  // an exponent tells a whole number from an integer
        const auto end = std::to_chars(digits, digits + sizeof digits, x, std::chars_format::scientific);
        return {digits, end.ptr};
    }
    static std::string describe(int x) { return std::to_string(x); }
    static std::string describe(bool x) { return x ? "true" : "false"; }
    static std::string describe(Family x) { return describe(int(x)); }
    static std::string describe(PieperCase x) { return describe(int(x)); }
    static std::string describe(const Vec3d& v) { return PARTS(v.x, v.y, v.z); }
    static std::string describe(const Mat3d& R) { return PARTS(R.m); }
    static std::string describe(const Posed& T) { return PARTS(T.R, T.t); }
    static std::string describe(const Turn<double>& t) { return PARTS(t.c, t.s); }
    static std::string describe(const Chain& c) {
        return PARTS(c.n)
            .add("axis", list_of(c.axis, c.n))
            .add("point", list_of(c.point, c.n))
            .add("prismatic", list_of(c.prismatic, c.n))
            .add("tip", describe(c.tip));
    }
    static std::string describe(const DhForm& f) {
        return PARTS(f.a, f.d, f.ca, f.sa, f.offset, f.parallel, f.meeting, f.base, f.tool, f.length,
                     f.deviation, f.degenerate);
    }
    static std::string describe(const Wrist& w) {
        return PARTS(w.ca4, w.sa4, w.ca5, w.sa5, w.c_sum, w.s_sum, w.c_diff, w.s_diff, w.inv, w.right_angled);
    }
    static std::string describe(const ThreeJoints& g) {
        return PARTS(g.kind, g.a1, g.ca1, g.sa1, g.d2, g.a2, g.ca2, g.sa2, g.w, g.length, g.wrist_reach,
                     g.w_angle);
    }
    static std::string describe(const SphericalWrist& s) { return PARTS(s.first, s.last, s.ca3, s.sa3); }
    static std::string describe(const ThreeParallel& p) {
        return PARTS(p.a1, p.ca1, p.sa1, p.height, p.l2, p.l3, p.x4, p.y4, p.last, p.length);
    }
    static std::string describe(const Plan& p) {
        return PARTS(p.family, p.reversed, p.joint, p.sign, p.chain, p.form)
            .add("wrist", p.family == Family::spherical_wrist ? describe(p.wrist) : Parts())
            .add("parallel", p.family == Family::three_parallel ? describe(p.parallel) : Parts())
            .add(PARTS(p.to_form_left, p.to_form_right, p.virtual_joints, p.on_lanes, p.idealised, p.polish));
    }
    static std::string describe(const LoopFrames& f) { return PARTS(f.between, f.first, f.last); }
    static std::string describe(const GeneralPlan& p) {
        return PARTS(p.chain, p.length, p.slides, p.frames)
            .add("order", list_of(p.order, p.regular))
            .add(PARTS(p.regular, p.sensitivity, p.paired, p.spurious_roots, p.spurious));
    }
    static std::string describe(const ThreeTurns& t) { return PARTS(t.h, t.a, t.b, t.constant); }
    static std::string describe(const PositionFirst& p) {
        return PARTS(p.applies, p.backwards, p.arm, p.first, p.centre_in_tip, p.wrist);
    }
    static std::string describe(const GeneralArm& a) {
        return PARTS(a.chain, a.plan)
            .add("position_first", a.position_first.applies ? describe(a.position_first) : Parts())
            .add("perturbed", list_of(a.perturbed, a.has_perturbed ? 2 : 0))
            .add(PARTS(a.alone, a.has_perturbed));
    }

    static std::string geometry(const Arm& arm) {
        const Plan& plan = arm.plan;
        return PARTS(plan.virtual_joints, plan.reversed, plan.polish, plan.form.deviation, plan.form.length)
            .add("family", describe(arm.has_plan ? int(plan.family) : -1))
            .add("general", describe(arm.is_general && !arm.has_plan))
            .add("pieper_case", describe(pieper_case_of(arm)));
    }
#undef PARTS
};

}  // namespace

std::pair<std::string, std::string> plan_numbers(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    if (arm.has_plan) return {"closed", Describe::describe(arm.plan)};
    if (arm.is_general) return {"general", Describe::describe(arm.general)};
    return {arm.has_few_joints ? "few_joints" : "any", Describe::describe(arm.plan.chain)};
}

std::string arm_geometry(const BuiltArm& built) { return Describe::geometry(*built.arm); }

bool has_hidden_determinant(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    return arm.is_general && !arm.has_plan && arm.general.plan.regular > 0 && arm.general.plan.slides <= 2;
}

double hidden_determinant(const BuiltArm& built, const double* goal, int number, double a0) {
    const GeneralPlan& plan = built.arm->general.plan;
    Posed T = read_goal(goal).T;
    T.t = (1 / plan.length) * T.t;
    const Loop loop = make_loop(plan.frames, plan.chain.prismatic, T, formulation_of(number));
    if (plan.slides < 2) return determinant(eliminate_angles(loop), std::cos(a0), std::sin(a0));
    return get_lane(
        lack_on_both(two_sheets(loop), fill_lanes<Pack<4>>(std::cos(a0)), fill_lanes<Pack<4>>(std::sin(a0))),
        0);
}

}  // namespace cspace::ik
