#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/ik/near_singular.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::inline CSPACE_ISA {
template void decompose_matrix(SmallSvd<6, ik::max_joints>&, bool);
}

namespace cspace::ik::inline CSPACE_ISA {

template CurveEnd follow_curve(const Chain&, const TipConstraint&, const double*, const double*, VisitCurve,
                               int, double);
template bool find_self_motion(const Chain&, const Posed&, double, const double*, const PoseSvd&, double*);
template int accept_solution(Solutions&, const Chain&, const Posed&, double, double*, int, int);

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

bool ik_self_motion_direction(const Chain& chain, const double* q, bool whole_pose, double* direction) {
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

CurveEnd ik_follow_self_motion(const Chain& chain, const double* q, const double* direction, bool whole_pose,
                               void (*visit)(void*, const double*, const double*), void* data) {
    constexpr double between_samples = 0.05;  // [rad, arm's lengths] close enough to draw
    const TipConstraint constraint = constraint_at(chain, q, whole_pose);
    double along[max_joints], tangent[max_joints];
    std::copy_n(direction, chain.n, along);
    scale_prismatic(chain, 1 / constraint.length, along);
    const auto visit_scaled = [&](const double* at, const double* t, double) {
        std::copy_n(t, chain.n, tangent);
        scale_prismatic(chain, constraint.length, tangent);
        visit(data, at, tangent);
    };
    return follow_curve(chain, constraint, q, along, visit_scaled, most_curve_steps, between_samples);
}

void ik_project_on_self_motion(const Chain& chain, const double* q, bool whole_pose, int k, double* rows,
                               double* tangents) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
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

}  // namespace cspace::ik::inline CSPACE_ISA
