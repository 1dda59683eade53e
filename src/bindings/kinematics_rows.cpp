// Batches of configurations: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#include "kinematics_rows.hpp"

#include <bit>

#include "bindings.hpp"
#include "kernels/kinematics.hpp"
#include "kinematics.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

bool chain_rows(nb::handle robot, int frame, const ConstDoubles& q, const In& qd, const In& T_world_base,
                const In& point, const Out& T, const Out& J, const Out& J_rate, const Out& sigma,
                unsigned chosen, bool in_tip, int threads) {
    const KinematicsObject& object = robot_from(robot);
    kinematics::ChainRows rows{};
    rows.chain = chain_on(robot, frame);
    rows.floating = object.floating;
    rows.in_tip = in_tip;
    rows.chosen = chosen & 63u;
    const int n = object.model->n_coordinates(), dof = velocities_of(object);
    const npy_intp count = row_count(q, n);
    rows.count = std::size_t(count);
    rows.q = q.data;
    rows.qd = values_of(qd, count, dof);
    rows.T_world_base = shared_values(T_world_base, count, 16, rows.base_stride);
    rows.point = shared_values(point, count, 3, rows.point_stride);
    rows.T = values_of(T, count, 16);
    rows.J = values_of(J, count, 6 * dof);
    rows.J_rate = values_of(J_rate, count, 6 * dof);
    rows.sigma = values_of(sigma, count, std::min(std::popcount(rows.chosen), n));
    if (rows.J_rate && !rows.qd) throw nb::value_error("J_rate needs qd");
    return run_kernel(rows, count, threads, kernels::chain_rows);
}

void chain_misses(nb::handle robot, int frame, const ConstDoubles& q, const ConstDoubles& goals,
                  const Doubles& miss, int threads) {
    kinematics::ChainRows rows{};
    rows.chain = chain_on(robot, frame);
    const npy_intp count = row_count(q, robot_from(robot).model->n_coordinates());
    rows.count = std::size_t(count);
    rows.q = q.data;
    rows.goals = goals.data;
    rows.goal_size = goals.shape(goals.ndim() - 1) == 3 ? 3 : 16;
    const npy_intp n = goals.size / npy_intp(rows.goal_size);
    if (miss.size != count || (count > 0 && (n < 1 || count % n != 0)))
        throw nb::value_error("each goal has as many rows");
    rows.goal_rows = n > 0 ? std::size_t(count / n) : 1;
    rows.miss = miss.data;
    run_kernel(rows, count, threads, kernels::chain_rows);
}

bool tree_rows(nb::handle robot, const ConstDoubles& q, const In& T_world_base, const Out& T,
               const Out& center, const Out& center_columns, int threads) {
    const KinematicsObject& object = robot_from(robot);
    kinematics::TreeRows rows{};
    rows.tree = object.model->tree();
    rows.floating = object.floating;
    const npy_intp count = row_count(q, object.model->n_coordinates());
    rows.q = q.data;
    rows.T_world_base = shared_values(T_world_base, count, 16, rows.base_stride);
    rows.T = values_of(T, count, 16 * npy_intp(object.model->n_frames()));
    rows.center = values_of(center, count, 3);
    rows.center_columns = values_of(center_columns, count, 3 * velocities_of(object));
    return run_kernel(rows, count, threads, kernels::tree_rows);
}

}  // namespace

void bind_kinematics_rows(nb::module_& m) {
    m.def("_chain_rows", chain_rows, "robot"_a, "frame"_a, "q"_a, "qd"_a.none(), "T_world_base"_a.none(),
          "point"_a.none(), "T"_a.none(), "J"_a.none(), "J_rate"_a.none(), "sigma"_a.none(), "chosen"_a,
          "in_tip"_a, "threads"_a,
          "Fills the arrays that are not None; False if a value of q is not finite.");
    m.def("_chain_misses", chain_misses, "robot"_a, "frame"_a, "q"_a, "goals"_a, "miss"_a, "threads"_a,
          "Fills in how far each row is from its goal; NaN for a row of NaN.");
    m.def("_tree_rows", tree_rows, "robot"_a, "q"_a, "T_world_base"_a.none(), "T"_a.none(), "center"_a.none(),
          "center_columns"_a.none(), "threads"_a,
          "Fills the arrays that are not None; False if a value of q is not finite.");
}
