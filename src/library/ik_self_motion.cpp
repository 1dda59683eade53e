#include "ik_self_motion.hpp"

#include <algorithm>

#include "cspace/ik/arm.hpp"
#include "cspace/math/interrupts.hpp"
#include "kernels/ik.hpp"

namespace cspace::ik {

bool self_motion_direction(const BuiltArm& built, const double* q, bool whole_pose, double* direction) {
    return kernels::ik_self_motion_direction(built.arm->plan.chain, q, whole_pose, direction);
}

SelfMotionCurve follow_self_motion(const BuiltArm& built, const double* q, const double* direction,
                                   bool whole_pose) {
    SelfMotionCurve curve;
    auto visit = [&, n = built.arm->plan.chain.n](const double* at, const double* tangent) {
        curve.q.insert(curve.q.end(), at, at + n);
        curve.tangents.insert(curve.tangents.end(), tangent, tangent + n);
        poll_interrupts();
    };
    const auto call = [](void* data, const double* at, const double* tangent) {
        (*static_cast<decltype(visit)*>(data))(at, tangent);
    };
    curve.end =
        int(kernels::ik_follow_self_motion(built.arm->plan.chain, q, direction, whole_pose, call, &visit));
    return curve;
}

void project_on_self_motion(const BuiltArm& built, const double* q, bool whole_pose, int k, double* rows,
                            double* tangents) {
    constexpr int part = 64;  // rows between two polls
    const Chain& chain = built.arm->plan.chain;
    for (int i = 0; i < k; i += part) {
        const int count = std::min(part, k - i);
        kernels::ik_project_on_self_motion(chain, q, whole_pose, count, rows + i * chain.n,
                                           tangents + i * chain.n);
        poll_interrupts();
    }
}

}  // namespace cspace::ik
