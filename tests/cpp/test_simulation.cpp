// Roll-outs of the core without Python: exponentials, Jacobians of rotations, the Lagrangian, and steps that
// conserve momenta, do not depend on where a loop is interrupted, and agree in lanes and alone.
#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "cspace/dynamics/roll_out.hpp"
#include "library/dynamics_roll_out.hpp"
#include "random_trees.hpp"

using namespace cspace;
using namespace cspace::dynamics;
using namespace random_trees;

namespace {

// A simulation of random rows, with all its arrays.
struct Rows {
    std::vector<double> q, qd, T, tau, stopped, time, length, records[6];
    std::vector<int> status, joint;
    std::vector<long long> next;
    std::vector<double> kp, kd, goal;
    RollOut task{};

    Rows(Random& random, const Multibody& bodies, bool floating, Method method, std::size_t rows, double dt,
         long long steps) {
        const std::size_t n = std::size_t(bodies.n_coordinates), dof = n + (floating ? 6 : 0),
                          count = std::size_t(steps) + 1;
        q = random_numbers(random, rows * n);
        qd = random_numbers(random, rows * dof);
        for (std::size_t i = 0; i < rows; ++i) {
            double matrix[16];
            kinematics::write_matrix(random_pose(random), matrix);
            T.insert(T.end(), matrix, matrix + 16);
        }
        tau.resize(rows * dof);
        stopped.resize(rows);
        time.resize(rows);
        length.assign(rows, dt);
        status.resize(rows);
        joint.resize(rows);
        next.resize(rows);
        const std::size_t widths[] = {n, dof, dof, 1, 16, 6};
        for (int k = 0; k < 6; ++k) records[k].resize(rows * count * widths[k]);
        kp.assign(n, 3.0);
        kd.assign(n, 0.4);
        goal = random_numbers(random, n);
        task.mechanics.bodies = bodies;
        task.mechanics.floating = floating;
        task.mechanics.friction_speed = 1.0;
        task.method = method;
        task.duration = dt * double(steps);
        task.dt = dt;
        task.tolerance = 1e-9;
        task.steps = steps;
        task.every = 1;
        task.is_held = task.keeps_pieces = true;
        task.control = {
            ControlLaw::pd, {}, {kp.data(), 0}, {kd.data(), 0}, {goal.data(), 0}, true, {}, 0, {}, {}};
        point();
    }
    Rows(const Rows& other) { *this = other; }
    Rows& operator=(const Rows&) = default;
    // The arrays of this object, also after it was copied.
    void point() {
        task.q = q.data();
        task.qd = qd.data();
        task.T = T.data();
        task.T_stride = 16;
        task.tau = tau.data();
        task.status = status.data();
        task.joint = joint.data();
        task.stopped = stopped.data();
        task.time = time.data();
        task.length = length.data();
        task.next = next.data();
        task.control.kp.values = kp.data();
        task.control.kd.values = kd.data();
        task.control.goal.values = goal.data();
        task.records = {records[0].data(),          records[1].data(),
                        records[2].data(),          records[3].data(),
                        records[5].data(),          task.mechanics.floating ? records[4].data() : nullptr,
                        std::size_t(task.steps) + 1};
    }
};

void roll(Rows& rows, int threads) {
    std::vector<std::vector<double>> pieces(rows.status.size());
    if (rows.task.method == Method::adaptive)
        roll_out_adaptively(rows.task, rows.status.size(), 0, rows.task.steps + 1, threads, Deadline::max(),
                            pieces);
    else
        roll_out(rows.task, rows.status.size(), 0, rows.task.steps + 1, threads, Deadline::max());
}

}  // namespace

TEST(exponentials_are_those_of_the_library) {
    Random random;
    for (int i = 0; i < 20000; ++i) {
        const double x = random() * std::pow(10.0, random(-12.0, 2.8));
        const double e = std::expm1(x), t = std::tanh(x);
        CHECK_NEAR(cspace::expm1(x), e, 4e-16 * (1.0 + std::fabs(e)) * 2.0);
        CHECK_NEAR(cspace::expm1(x), e, 1e-15 * std::fabs(e));
        CHECK_NEAR(cspace::tanh(x), t, 1e-15 * std::fabs(t));
        CHECK_NEAR(get_lane(cspace::expm1(fill_lanes<Pack<4>>(x)), 2), e, 1e-15 * std::fabs(e));
    }
    CHECK(cspace::expm1(0.0) == 0.0);
    CHECK(cspace::tanh(-std::numeric_limits<double>::infinity()) == -1.0);
    CHECK(std::isnan(cspace::expm1(std::nan(""))));
    CHECK(std::isnan(cspace::tanh(std::nan(""))));
    CHECK(std::isfinite(cspace::expm1(1e6)));
}

TEST(left_jacobians_are_inverse_to_each_other_and_the_slope_of_the_exponential) {
    Random random;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d axis = {random(), random(), random()}, a = {random(), random(), random()};
        const double angle = i % 2 ? random(0.0, 3.1) : std::pow(10.0, random(-9.0, 0.0));
        const Vec3d u = (angle / norm(axis)) * axis;
        const Vec3d back = spatial::left_jacobian_inverse_times(u, spatial::left_jacobian_times(u, a));
        CHECK(norm(back - a) < 1e-14);
        // exp(u + ε a) exp(u)ᵀ turns by ε J(u) a.
        const double small = 1e-6;
        const Mat3d ahead = spatial::rotation_of_rotvec(u + small * a),
                    behind = spatial::rotation_of_rotvec(u - small * a);
        const Vec3d rate = (0.5 / small) * spatial::sine_between(behind, ahead);
        CHECK(norm(rate - spatial::left_jacobian_times(u, a)) < 1e-8);
    }
}

TEST(momenta_are_the_mass_matrix_times_velocities_and_slopes_those_of_the_energy) {
    Random random;
    for (const bool shares : {false, true}) {
        const model::RobotModel robot = random_robot(random, 6, shares);
        const Links made(robot.tree());
        const Multibody& bodies = made.view();
        const int n = bodies.n_coordinates;
        auto q = random_numbers(random, std::size_t(n));
        const auto qd = random_numbers(random, std::size_t(n));
        std::vector<LinkMomentum<double>> links(8);
        std::vector<LinkComposite<double>> composites(8);
        std::vector<double> p(8), slope(8), M(64), rest(8), other(8);
        const Vec3d gravity = {0.4, -0.3, -9.8};
        const Twist<double> still = {{0, 0, 0}, {0, 0, 0}};
        const auto lagrangian = [&] {
            const auto whole = lagrangian_rates(bodies, still, gravity, q.data(), qd.data(), links.data(),
                                                rest.data(), other.data());
            double twice = 0.0;
            for (int j = 0; j < n; ++j) twice += qd[std::size_t(j)] * rest[std::size_t(j)];
            return 0.5 * twice + dot(gravity, whole.first);
        };
        lagrangian_rates(bodies, still, gravity, q.data(), qd.data(), links.data(), p.data(), slope.data());
        mass_matrix(bodies, q.data(), identity_pose().R, false, composites.data(), M.data());
        for (int i = 0; i < n; ++i) {
            double sum = 0.0;
            for (int j = 0; j < n; ++j) sum += M[std::size_t(i * n + j)] * qd[std::size_t(j)];
            CHECK_NEAR(p[std::size_t(i)], sum, 1e-11);
            const double at = q[std::size_t(i)], h = 1e-5;
            q[std::size_t(i)] = at + h;
            const double ahead = lagrangian();
            q[std::size_t(i)] = at - h;
            CHECK_NEAR(slope[std::size_t(i)], (ahead - lagrangian()) / (2.0 * h), 1e-6);
            q[std::size_t(i)] = at;
        }
    }
}

TEST(roll_outs_do_not_depend_on_threads_interruptions_or_other_rows) {
    Random random;
    for (const Method method : {Method::runge_kutta, Method::variational, Method::adaptive}) {
        for (const bool floating : {false, true}) {
            const model::RobotModel robot = random_robot(random, 5, floating);
            const Links links(robot.tree());
            const Rows start(random, links.view(), floating, method, 21, 0.002, 12);
            Rows one = start, four = start, parts = start;
            for (Rows* rows : {&one, &four, &parts}) rows->point();
            roll(one, 1);
            roll(four, 4);
            for (const int status : one.status) CHECK(status == ended);
            for (int k = 0; k < 6; ++k) CHECK(one.records[k] == four.records[k]);
            if (method == Method::adaptive) continue;
            for (long long k = 0; k <= start.task.steps; ++k)
                roll_out(parts.task, 21, k, k + 1, 1, Deadline::max());
            for (int k = 0; k < 6; ++k) CHECK(one.records[k] == parts.records[k]);
            // A row alone is not computed in lanes.
            Rows alone = start;
            alone.point();
            roll_out(alone.task, 1, 0, start.task.steps + 1, 1, Deadline::max());
            for (std::size_t j = 0; j < 13 * std::size_t(start.task.mechanics.dof()); ++j)
                CHECK_NEAR(alone.records[1][j], one.records[1][j],
                           1e-11 * (1.0 + std::fabs(one.records[1][j])));
        }
    }
}

TEST(a_free_robot_keeps_its_energy_to_the_order_of_the_method) {
    Random random;
    const model::RobotModel robot = random_robot(random, 4, false);
    const Links links(robot.tree());
    Multibody bodies = links.view();
    for (const Method method : {Method::runge_kutta, Method::variational}) {
        double errors[2];
        Rows start(random, bodies, true, method, 3, 0.002, 40);
        start.task.mechanics.gravity = {0.0, 0.0, -9.81};
        start.task.control = {};
        for (int half = 0; half < 2; ++half) {
            Rows rows = start;
            rows.point();
            rows.task.control = {};
            if (half) {
                rows.task.dt /= 2.0;
                rows.task.steps *= 2;
                for (int k = 0; k < 6; ++k) rows.records[k].resize(2 * rows.records[k].size());
                rows.point();
                rows.task.control = {};
            }
            roll(rows, 1);
            errors[half] = 0.0;
            const std::size_t count = rows.task.records.count;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < count; ++k)
                    errors[half] = std::max(
                        errors[half], std::fabs(rows.records[3][i * count + k] - rows.records[3][i * count]));
        }
        CHECK(errors[0] > (method == Method::runge_kutta ? 12.0 : 3.5) * errors[1]);
    }
}
