#include "ik_description.hpp"

#include <algorithm>
#include <cmath>

#include "cspace/ik/arm.hpp"
#include "cspace/ik/goal.hpp"
#include "cspace/kinematics/forward.hpp"

namespace cspace::ik {

namespace {

// What the first three axes share, of arms with a spherical wrist and of three revolute joints.
int shared_by_first_three(const Arm& arm) {
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
    return int(parallel[1]   ? FirstThree::last_parallel
               : parallel[0] ? FirstThree::first_parallel
               : meeting[0]  ? FirstThree::first_meet
               : meeting[1]  ? FirstThree::last_meet
                             : FirstThree::general);
}

// Structures as numbers, lists and parts. PARTS(t.c, t.s) are the parts "c" and "s".
struct Describe {
#define PARTS(...) parts(#__VA_ARGS__, __VA_ARGS__)
    template <class... T>
    static Value parts(const std::string& names, const T&... values) {
        Value out;
        std::size_t end = 0;
        const auto add = [&](Value value) {
            end = std::min(names.find(',', end + 1), names.size());
            const std::size_t dot = names.rfind('.', end - 1);
            out.add(names.substr(dot + 1, end - dot - 1), std::move(value));
        };
        (add(describe(values)), ...);
        return out;
    }
    template <class T>
    static Value list_of(const T* values, int count) {
        std::vector<Value> out;
        for (int i = 0; i < count; ++i) out.push_back(describe(values[i]));
        return out;
    }
    template <class T, int n>
    static Value describe(const T (&values)[n]) {
        return list_of(values, n);
    }
    static Value describe(double x) { return x; }
    static Value describe(int x) { return x; }
    static Value describe(bool x) { return x; }
    static Value describe(Family x) { return int(x); }
    static Value describe(FirstThree x) { return int(x); }
    static Value describe(const Vec3d& v) { return PARTS(v.x, v.y, v.z); }
    static Value describe(const Mat3d& R) { return PARTS(R.m); }
    static Value describe(const Posed& T) { return PARTS(T.R, T.t); }
    static Value describe(const Turn<double>& t) { return PARTS(t.c, t.s); }
    static Value describe(const Chain& c) {
        return PARTS(c.n)
            .add("axis", list_of(c.axis, c.n))
            .add("point", list_of(c.point, c.n))
            .add("prismatic", list_of(c.prismatic, c.n))
            .add("tip", describe(c.tip));
    }
    static Value describe(const DhForm& f) {
        return PARTS(f.a, f.d, f.ca, f.sa, f.offset, f.parallel, f.meeting, f.base, f.tool, f.length,
                     f.deviation, f.degenerate);
    }
    static Value describe(const Wrist& w) {
        return PARTS(w.ca4, w.sa4, w.ca5, w.sa5, w.c_sum, w.s_sum, w.c_diff, w.s_diff, w.inv, w.right_angled);
    }
    static Value describe(const ThreeJoints& g) {
        return PARTS(g.kind, g.a1, g.ca1, g.sa1, g.d2, g.a2, g.ca2, g.sa2, g.w, g.length, g.wrist_reach,
                     g.w_angle);
    }
    static Value describe(const SphericalWrist& s) { return PARTS(s.first, s.last, s.ca3, s.sa3); }
    static Value describe(const ThreeParallel& p) {
        return PARTS(p.a1, p.ca1, p.sa1, p.height, p.l2, p.l3, p.x4, p.y4, p.last, p.length);
    }
    static Value describe(const Plan& p) {
        const Value wrist = p.family == Family::spherical_wrist ? describe(p.wrist) : Value();
        const Value parallel = p.family == Family::three_parallel ? describe(p.parallel) : Value();
        Value out = PARTS(p.family, p.reversed, p.joint, p.sign, p.chain, p.form);
        out.add("wrist", wrist).add("parallel", parallel);
        return out.add(
            PARTS(p.to_form_left, p.to_form_right, p.virtual_joints, p.on_lanes, p.idealised, p.polish));
    }
    static Value describe(const LoopFrames& f) { return PARTS(f.between, f.first, f.last); }
    static Value describe(const GeneralPlan& p) {
        return PARTS(p.chain, p.length, p.slides, p.frames)
            .add("order", list_of(p.order, p.regular))
            .add(PARTS(p.regular, p.sensitivity, p.paired, p.spurious_roots, p.spurious));
    }
    static Value describe(const ThreeTurns& t) { return PARTS(t.h, t.a, t.b, t.constant); }
    static Value describe(const PositionFirst& p) {
        return PARTS(p.serves, p.backwards, p.arm, p.first, p.centre_in_tip, p.wrist);
    }
    static Value describe(const GeneralArm& a) {
        return PARTS(a.chain, a.plan)
            .add("position_first", a.position_first.serves ? describe(a.position_first) : Value())
            .add("perturbed", list_of(a.perturbed, a.has_perturbed ? 2 : 0))
            .add(PARTS(a.alone, a.has_perturbed));
    }

    static Value geometry(const Arm& arm) {
        const Plan& plan = arm.plan;
        Value out =
            PARTS(plan.virtual_joints, plan.reversed, plan.polish, plan.form.deviation, plan.form.length);
        return out.add("family", arm.has_plan ? int(plan.family) : -1)
            .add("general", arm.is_general && !arm.has_plan)
            .add("first_three", shared_by_first_three(arm));
    }

    // --- the outline -----------------------------------------------------------------------------------
    static Value rows_of(const Posed& T) {
        double m[4][4] = {};
        kinematics::write_matrix(T, m[0]);
        return describe(m);
    }
    static Value vector_of(const Vec3d& v) {
        const double entries[3] = {v.x, v.y, v.z};
        return describe(entries);
    }
    static Value outline(const Plan& plan) {
        const DhForm& f = plan.form;
        return PARTS(plan.joint, plan.sign, f.a, f.d, f.ca, f.sa, f.offset, f.parallel, f.meeting)
            .add("base", rows_of(f.base))
            .add("tool", rows_of(f.tool));
    }
    // A general arm is solved by a wrist behind three joints (`wrist`: whether it is at the base), or by the
    // loop, whose frames have lengths over the arm's. order: for each formulation as they are tried its
    // number, the joints behind a0 … a5 and whether it is read backwards; none where three joints are
    // prismatic.
    static Value outline(const GeneralArm& arm) {
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
        Value out;
        out.add("axes", std::move(axes))
            .add("points", std::move(points))
            .add("prismatic", list_of(plan.chain.prismatic, 6))
            .add("tip", rows_of({plan.chain.tip.R, plan.length * plan.chain.tip.t}))
            .add("order", std::move(order))
            .add("between", std::move(between))
            .add("first", rows_of(plan.frames.first))
            .add("last", rows_of(plan.frames.last))
            .add("length", plan.length)
            .add("perturbed_arms", arm.has_perturbed);
        if (arm.position_first.serves) out.add("wrist", arm.position_first.backwards);
        return out;
    }
#undef PARTS
};

}  // namespace

std::pair<std::string, Value> plan_numbers(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    if (arm.has_plan) return {"closed", Describe::describe(arm.plan)};
    if (arm.is_general) return {"general", Describe::describe(arm.general)};
    return {arm.has_few_joints ? "few_joints" : "any", Describe::describe(arm.plan.chain)};
}

Value arm_geometry(const BuiltArm& built) { return Describe::geometry(*built.arm); }

Value plan_outline(const BuiltArm& built) {
    const Arm& arm = *built.arm;
    Value out;
    if (arm.has_plan) return out.add("form", Describe::outline(arm.plan));
    return arm.is_general ? out.add("loop", Describe::outline(arm.general)) : out;
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
