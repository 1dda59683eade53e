// Self-motions: in which direction one starts, and the curve of configurations that it runs along.
#include "library/ik_self_motion.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <optional>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ik.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

std::optional<Doubles> find_direction(SolverArgument solver, const ConstDoubles& q, bool whole_pose) {
    const ik::BuiltArm& arm = solver.arm();
    require_sizes(q.size == arm.dof);
    double direction[ik::max_joints];
    if (!ik::self_motion_direction(arm, q.data, whole_pose, direction)) return {};
    return Doubles({arm.dof}, direction);
}

std::tuple<Doubles, Doubles, int> follow_curve(SolverArgument solver, const ConstDoubles& q,
                                               const ConstDoubles& direction, bool whole_pose) {
    const ik::BuiltArm& arm = solver.arm();
    require_sizes(q.size == arm.dof && direction.size == arm.dof);
    const ik::SelfMotionCurve curve = ik::follow_self_motion(arm, q.data, direction.data, whole_pose);
    const npy_intp rows = npy_intp(curve.q.size()) / arm.dof;
    return {Doubles({rows, arm.dof}, curve.q.data()), Doubles({rows, arm.dof}, curve.tangents.data()),
            curve.end};
}

std::tuple<Doubles, Doubles> project_rows(SolverArgument solver, const ConstDoubles& q,
                                          const ConstDoubles& near, const ConstDoubles& along,
                                          bool whole_pose) {
    const ik::BuiltArm& arm = solver.arm();
    const npy_intp n = arm.dof, k = near.size / n;
    require_sizes(q.size == n && near.size == k * n && along.size == k * n);
    const Doubles rows({k, n}, near.data), tangents({k, n}, along.data);
    ik::project_on_self_motion(arm, q.data, whole_pose, int(k), rows.data, tangents.data);
    return {rows, tangents};
}

}  // namespace

void bind_ik_self_motion(nb::module_& m) {
    m.def("_ik_direction", find_direction, "The unit joint velocity of the self-motion through q, or None.");
    m.def("_ik_follow", follow_curve,
          "The self-motion through q from there on: configurations (m, n), tangents (m, n), how it ends.");
    m.def("_ik_onto", project_rows,
          "Rows (k, n) brought onto the self-motion through q, and their tangents; NaN where that failed.");
}
