// Dynamics of the core without Python: forward undoes inverse, columns of the mass matrix are torques, lanes
// agree with one configuration, on random trees with a fixed or floating base and with shared coordinates.
#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "kernels/dynamics.hpp"
#include "random_trees.hpp"

using namespace cspace;
using namespace cspace::dynamics;
using namespace random_trees;

namespace {

struct Case {
    int n;
    bool shares, floating;
};

}  // namespace

TEST(forward_dynamics_undoes_inverse_dynamics_and_the_mass_matrix_is_their_slope) {
    Random random;
    for (const Case& c : {Case{1, false, false}, Case{7, false, false}, Case{9, false, true},
                          Case{8, true, false}, Case{8, true, true}}) {
        const model::RobotModel robot = random_robot(random, c.n, c.shares);
        const Links links(robot.tree());
        const std::size_t n = std::size_t(robot.n_coordinates()), dof = n + (c.floating ? 6 : 0), count = 13;
        CHECK(links.view().shares == c.shares);
        const auto q = random_numbers(random, count * n), qd = random_numbers(random, count * dof),
                   qdd = random_numbers(random, count * dof);
        std::vector<double> tau(count * dof), again(count * dof), alone(dof), M(count * dof * dof);
        Rows rows{};
        rows.bodies = links.view();
        rows.gravity = {0.3, -0.2, -9.81};
        rows.floating = c.floating;
        rows.rubs = true;
        rows.q = q.data();
        rows.qd = qd.data();
        rows.force = qdd.data();
        rows.result = tau.data();
        const Memory memory(scratch_bytes(rows));
        CHECK(kernels::inverse_rows(rows, 0, count, memory.start));
        rows.force = tau.data();
        rows.result = again.data();
        CHECK(kernels::forward_rows(rows, 0, count, memory.start));
        for (std::size_t i = 0; i < again.size(); ++i) CHECK_NEAR(again[i], qdd[i], 1e-7);
        // One configuration alone.
        rows.force = qdd.data();
        rows.result = alone.data();
        CHECK(kernels::inverse_rows(rows, 0, 1, memory.start));
        for (std::size_t i = 0; i < dof; ++i) CHECK_NEAR(alone[i], tau[i], 1e-10);
        // M q̈ is what acceleration adds to the torques.
        rows.result = M.data();
        CHECK(kernels::mass_rows(rows, 0, count, memory.start));
        rows.force = nullptr;
        rows.result = again.data();
        CHECK(kernels::inverse_rows(rows, 0, count, memory.start));
        for (std::size_t r = 0; r < count; ++r) {
            for (std::size_t i = 0; i < dof; ++i) {
                double sum = again[r * dof + i];
                for (std::size_t j = 0; j < dof; ++j) {
                    sum += M[(r * dof + i) * dof + j] * qdd[r * dof + j];
                    CHECK_NEAR(M[(r * dof + i) * dof + j], M[(r * dof + j) * dof + i], 0.0);
                }
                CHECK_NEAR(sum, tau[r * dof + i], 1e-9);
            }
        }
        // The Coriolis matrix and the derivatives fit into the same memory, and C q̇ is what velocity adds.
        std::vector<double> C(count * dof * dof), both(3 * count * dof * dof), rest(count * dof),
            still(count * dof);
        rows.rubs = false;
        rows.what = What::coriolis;
        rows.result = C.data();
        CHECK(kernels::spatial_rows(rows, 0, count, memory.start));
        rows.what = What::derivatives;
        rows.result = both.data();
        CHECK(kernels::spatial_rows(rows, 0, count, memory.start));
        rows.result = again.data();
        CHECK(kernels::inverse_rows(rows, 0, count, memory.start));
        rows.qd = rest.data();
        rows.result = still.data();
        CHECK(kernels::inverse_rows(rows, 0, count, memory.start));
        for (std::size_t r = 0; r < count; ++r) {
            for (std::size_t i = 0; i < dof; ++i) {
                double sum = still[r * dof + i];
                for (std::size_t j = 0; j < dof; ++j) sum += C[(r * dof + i) * dof + j] * qd[r * dof + j];
                CHECK_NEAR(sum, again[r * dof + i], 1e-9);
            }
        }
    }
}

TEST(floats_are_near_doubles_and_wrenches_are_weights) {
    Random random;
    for (const Case& c : {Case{7, false, false}, Case{9, false, true}, Case{8, true, true}}) {
        const model::RobotModel robot = random_robot(random, c.n, c.shares);
        const Links links(robot.tree());
        const std::size_t n = std::size_t(robot.n_coordinates()), dof = n + (c.floating ? 6 : 0), count = 21;
        const auto q = random_numbers(random, count * n), qd = random_numbers(random, count * dof),
                   force = random_numbers(random, count * dof), push = random_numbers(random, 6 * count);
        const std::vector<float> q_32(q.begin(), q.end()), qd_32(qd.begin(), qd.end()),
            force_32(force.begin(), force.end()), push_32(push.begin(), push.end());
        std::vector<double> tau(count * dof), again(count * dof);
        std::vector<float> tau_32(count * dof);
        const std::vector<int> path = links.path_to(c.n - 1);
        const Posed at = random_pose(random);
        const BasicPush<double> wrench = {path.data(), int(path.size()), false, at.t, at.R, push.data(), 6};
        const BasicPush<float> wrench_32 = {path.data(), int(path.size()), false, to_floats(at.t),
                                            {},          push_32.data(),   6};
        Rows rows{};
        rows.bodies = links.view();
        rows.gravity = {0.3, -0.2, -9.81};
        rows.floating = c.floating;
        rows.rubs = true;
        rows.q = q.data();
        rows.qd = qd.data();
        rows.force = force.data();
        rows.result = tau.data();
        rows.wrenches = &wrench;
        rows.n_wrenches = 1;
        const Memory memory(scratch_bytes(rows));
        CHECK(kernels::inverse_rows(rows, 0, count, memory.start));
        FloatRows floats{};
        floats.bodies = links.float_view();
        floats.gravity = rows.gravity;
        floats.floating = rows.floating;
        floats.rubs = rows.rubs;
        floats.q = q_32.data();
        floats.qd = qd_32.data();
        floats.force = force_32.data();
        floats.result = tau_32.data();
        floats.wrenches = &wrench_32;
        floats.n_wrenches = 1;
        CHECK(kernels::inverse_float_rows(floats, 0, count, memory.start));
        double largest = 0.0;
        for (double x : tau) largest = std::max(largest, std::fabs(x));
        for (std::size_t i = 0; i < tau.size(); ++i)
            CHECK_NEAR(double(tau_32[i]) / largest, tau[i] / largest, 1e-5);
        rows.force = tau.data();
        rows.result = again.data();
        CHECK(kernels::forward_rows(rows, 0, count, memory.start));
        for (std::size_t i = 0; i < again.size(); ++i) CHECK_NEAR(again[i], force[i], 1e-7);
    }
}

TEST(derivatives_of_forward_dynamics_are_those_of_inverse_dynamics_through_the_mass_matrix) {
    Random random;
    for (const Case& c :
         {Case{1, false, false}, Case{7, false, false}, Case{18, false, true}, Case{8, true, true}}) {
        const model::RobotModel robot = random_robot(random, c.n, c.shares);
        const Links links(robot.tree());
        const std::size_t n = std::size_t(robot.n_coordinates()), dof = n + (c.floating ? 6 : 0), count = 11;
        const std::size_t square = dof * dof;
        const auto q = random_numbers(random, count * n), qd = random_numbers(random, count * dof),
                   qdd = random_numbers(random, count * dof);
        std::vector<double> slopes(3 * count * square), responses(3 * count * square), alone(3 * square);
        Rows rows{};
        rows.bodies = links.view();
        rows.gravity = {0.3, -0.2, -9.81};
        rows.floating = c.floating;
        rows.q = q.data();
        rows.qd = qd.data();
        rows.force = qdd.data();
        rows.what = What::derivatives;
        rows.result = slopes.data();
        const Memory memory(scratch_bytes(rows));
        CHECK(kernels::spatial_rows(rows, 0, count, memory.start));
        rows.what = What::responses;
        rows.result = responses.data();
        CHECK(kernels::spatial_rows(rows, 0, count, memory.start));
        rows.result = alone.data();
        CHECK(kernels::spatial_rows(rows, 0, 1, memory.start));
        for (std::size_t i = 0; i < alone.size(); ++i) CHECK_NEAR(alone[i], responses[i], 1e-8);
        for (std::size_t r = 0; r < count; ++r) {
            const double *M = &slopes[(3 * r + 2) * square], *found = &responses[3 * r * square];
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t i = 0; i < square; ++i) {
                    double sum = 0.0;
                    for (std::size_t j = 0; j < dof; ++j)
                        sum += M[i / dof * dof + j] * found[k * square + j * dof + i % dof];
                    const double expected = k == 2 ? i / dof == i % dof : -slopes[(3 * r + k) * square + i];
                    CHECK_NEAR(sum, expected, 1e-8);
                }
            }
        }
    }
}

TEST(a_number_that_is_not_finite_is_refused) {
    Random random;
    const model::RobotModel robot = random_robot(random, 3, false);
    const Links links(robot.tree());
    std::vector<double> q(3), result(3);
    q[1] = std::nan("");
    Rows rows{};
    rows.bodies = links.view();
    rows.q = q.data();
    rows.result = result.data();
    const Memory memory(scratch_bytes(rows));
    CHECK(!kernels::inverse_rows(rows, 0, 1, memory.start));
}
