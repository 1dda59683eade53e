#include "ik_self_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/ik/arm.hpp"

namespace cspace::ik {

namespace {

TipConstraint constraint_at(const Chain& chain, const double* q, bool whole_pose) {
    return {forward_kinematics(chain, q), whole_pose, characteristic_length(chain)};
}

// Between metres and the unit of length of the curve.
void scale_prismatic(const Chain& chain, double factor, double* v) {
    for (int i = 0; i < chain.n; ++i)
        if (chain.prismatic[i]) v[i] *= factor;
}

}  // namespace

bool self_motion_direction(const BuiltArm& built, const double* q, bool whole_pose, double* direction) {
    const Chain& chain = built.arm->plan.chain;
    const TipConstraint constraint = constraint_at(chain, q, whole_pose);
    PoseError error;
    measure_constrained(chain, constraint, q, error);
    const bool found =
        whole_pose ? find_self_motion(chain, constraint.goal, constraint.length, q, error.jacobian, direction)
                   : start_direction(chain, constraint, q,
                                     error.jacobian.v[weakest_direction(error.jacobian)], direction);
    if (!found) return false;
    if (!whole_pose) scale_prismatic(chain, constraint.length, direction);
    const double size = std::sqrt(dot_n(direction, direction, chain.n));
    for (int i = 0; i < chain.n; ++i) direction[i] /= size;
    return true;
}

SelfMotionCurve follow_self_motion(const BuiltArm& built, const double* q, const double* direction,
                                   bool whole_pose) {
    const Chain& chain = built.arm->plan.chain;
    const TipConstraint constraint = constraint_at(chain, q, whole_pose);
    SelfMotionCurve curve;
    double along[max_joints];
    for (int i = 0; i < chain.n; ++i) along[i] = direction[i];
    scale_prismatic(chain, 1 / constraint.length, along);
    const auto visit = [&](const double* at, const double* t, double) {
        curve.q.insert(curve.q.end(), at, at + chain.n);
        curve.tangents.insert(curve.tangents.end(), t, t + chain.n);
        scale_prismatic(chain, constraint.length, curve.tangents.data() + curve.tangents.size() - chain.n);
    };
    constexpr double between_samples = 0.05;  // [rad, arm's lengths] close enough to draw
    curve.end = int(follow_curve(chain, constraint, q, along, visit, most_curve_steps, between_samples));
    return curve;
}

void project_on_self_motion(const BuiltArm& built, const double* q, bool whole_pose, int k, double* rows,
                            double* tangents) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const Chain& chain = built.arm->plan.chain;
    const TipConstraint constraint = constraint_at(chain, q, whole_pose);
    const int n = chain.n;
    for (int i = 0; i < k; ++i) {
        double *row = rows + i * n, *t = tangents + i * n, tangent[max_joints];
        PoseError error;
        scale_prismatic(chain, 1 / constraint.length, t);
        const bool arrived =
            onto_curve(chain, constraint, row, error) && tangent_at(chain, error.jacobian, t, tangent);
        for (int j = 0; j < n; ++j) t[j] = arrived ? tangent[j] : none;
        if (!arrived) std::fill(row, row + n, none);
        scale_prismatic(chain, constraint.length, t);
    }
}

}  // namespace cspace::ik
