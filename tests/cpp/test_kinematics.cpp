// The kinematics of the core without Python: lanes against one configuration, chains against the tree,
// Jacobians against differences, sums of moments against the total.
#include <new>
#include <random>
#include <vector>

#include "check.hpp"
#include "cspace/kinematics/center_of_mass.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/kinematics/jacobian_rate.hpp"
#include "cspace/math/singular_values.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/model/robot_model.hpp"
#include "cspace/spatial/rotation.hpp"
#include "kernels/kinematics.hpp"

using namespace cspace;
using namespace cspace::kinematics;
using namespace cspace::model;

namespace {

struct Random {
    std::mt19937_64 generator{7};
    double operator()(double low = -1.0, double high = 1.0) {
        return std::uniform_real_distribution<double>(low, high)(generator);
    }
};

Posed random_pose(Random& random) {
    const Vec3d a{random(), random(), random()};
    const double angle = random(-3.0, 3.0);
    return {spatial::rotation_about((1.0 / norm(a)) * a, std::cos(angle), std::sin(angle)),
            {random(), random(), random()}};
}

// A tree: joint k hangs on an earlier joint, or, for a chain, on the one before.
RobotModel random_robot(Random& random, int n, bool chain) {
    std::vector<Joint> joints;
    std::vector<Frame> frames;
    std::vector<Body> bodies(1, Body{{0.1, 0.2, 0.3}, 1.0});
    for (int k = 0; k < n; ++k) {
        const int parent = chain || k == 0 ? k - 1 : int(random(0.0, k)) - 1;
        joints.push_back({random_pose(random), parent, k, 1.0, 0.0, random() > 0.5, 0.0});
        frames.push_back({random_pose(random), k});
        bodies.push_back({{random(), random(), random()}, random(0.1, 2.0)});
    }
    return {joints, frames, bodies, n};
}

struct Memory {
    explicit Memory(std::size_t bytes) : start(::operator new(bytes, std::align_val_t(64))) {}
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory() { ::operator delete(start, std::align_val_t(64)); }
    void* start;
};

}  // namespace

TEST(a_reduced_chain_ends_where_the_tree_puts_its_frame) {
    Random random;
    for (int n : {1, 2, 6, 7, 20}) {
        const RobotModel robot = random_robot(random, n, false);
        std::vector<double> q(n);
        for (double& x : q) x = random(-3.0, 3.0);
        std::vector<Posed> poses(n);
        const Posed identity{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
        joint_poses(robot.tree(), q.data(), identity, poses.data());
        for (int f = 0; f < n; ++f) {
            const Chain& chain = robot.chain(f);
            std::vector<double> s(chain.n + 3), c(chain.n + 3);
            chain_sines(chain, q.data(), s.data(), c.data());
            const Posed T = follow_chain(chain, chain.T_base_first, q.data(), s.data(), c.data(),
                                         [](int, const Vec3d&, const Vec3d&) {});
            const Posed expected = frame_pose(robot.tree().frames[f], identity, poses.data());
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) CHECK_NEAR(T.R.m[i][j], expected.R.m[i][j], 1e-13);
            }
            CHECK_NEAR(norm(T.t - expected.t), 0.0, 1e-13);
        }
    }
}

TEST(every_count_of_rows_gives_what_single_calls_give) {
    Random random;
    for (int n : {1, 6, 7, 9}) {
        const RobotModel robot = random_robot(random, n, true);
        for (std::size_t rows : {1, 2, 3, 4, 5, 7, 8, 9, 16, 17}) {
            std::vector<double> q(rows * n), T(rows * 16), J(rows * 6 * n), T_one(16), J_one(6 * n);
            for (double& x : q) x = random(-3.0, 3.0);
            ChainRows task{};
            task.chain = robot.chain(n - 1);
            task.q = q.data();
            task.T = T.data();
            task.J = J.data();
            const Memory memory(scratch_bytes(task));
            CHECK(kernels::chain_rows(task, 0, rows, memory.start));
            for (std::size_t i = 0; i < rows; ++i) {
                CHECK(
                    kernels::chain_jacobian(task.chain, &q[i * n], T_one.data(), J_one.data(), memory.start));
                for (int k = 0; k < 16; ++k) CHECK_NEAR(T[16 * i + k], T_one[k], 1e-13);
                for (int k = 0; k < 6 * n; ++k) CHECK_NEAR(J[6 * n * i + k], J_one[k], 1e-13);
            }
            q[rows * n - 1] = std::nan("");
            CHECK(!kernels::chain_rows(task, 0, rows, memory.start));
            CHECK(!kernels::chain_pose(task.chain, &q[(rows - 1) * n], T_one.data(), memory.start));
        }
    }
}

TEST(the_rate_of_the_jacobian_is_the_difference_of_jacobians) {
    Random random;
    const int n = 7;
    const double h = 1e-6;
    const RobotModel robot = random_robot(random, n, true);
    std::vector<double> q(3 * n), qd(3 * n), J(3 * 6 * n), rate(3 * 6 * n);
    for (int j = 0; j < n; ++j) {
        q[n + j] = random(-3.0, 3.0);
        for (int k = 0; k < 3; ++k) qd[k * n + j] = k ? qd[j] : random();
        q[j] = q[n + j] - h * qd[j];
        q[2 * n + j] = q[n + j] + h * qd[j];
    }
    ChainRows task{};
    task.chain = robot.chain(n - 1);
    task.q = q.data();
    task.qd = qd.data();
    task.J = J.data();
    task.J_rate = rate.data();
    for (bool in_tip : {false, true}) {
        task.in_tip = in_tip;
        const Memory memory(scratch_bytes(task));
        CHECK(kernels::chain_rows(task, 0, 3, memory.start));
        for (int k = 0; k < 6 * n; ++k) {
            CHECK_NEAR(rate[6 * n + k], (J[12 * n + k] - J[k]) / (2.0 * h), 1e-7);
        }
    }
}

TEST(the_centre_of_mass_moves_as_its_columns_say) {
    Random random;
    const int n = 9;
    const double h = 1e-6;
    const RobotModel robot = random_robot(random, n, false);
    for (int j = 0; j < n; ++j) {
        std::vector<double> q(3 * n), center(9), columns(9 * n);
        for (int i = 0; i < n; ++i) q[i] = q[n + i] = q[2 * n + i] = random(-3.0, 3.0);
        q[j] -= h;
        q[2 * n + j] += h;
        TreeRows task{};
        task.tree = robot.tree();
        task.q = q.data();
        task.center = center.data();
        task.center_columns = columns.data();
        const Memory memory(scratch_bytes(task));
        CHECK(kernels::tree_rows(task, 0, 3, memory.start));
        for (int r = 0; r < 3; ++r) {
            CHECK_NEAR(columns[3 * n + r * n + j], (center[6 + r] - center[r]) / (2.0 * h), 1e-8);
        }
    }
}

TEST(singular_values_multiply_to_the_determinant) {
    Random random;
    for (int size : {1, 2, 3}) {
        double A[9], copy[9], sigma[3], det, product = 1.0;
        for (double& x : A) x = random();
        for (int i = 0; i < size * size; ++i) copy[i] = A[i];
        det = size == 1   ? A[0]
              : size == 2 ? A[0] * A[3] - A[1] * A[2]
                          : A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
                                A[2] * (A[3] * A[7] - A[4] * A[6]);
        singular_values(copy, size, size, sigma);
        for (int i = 0; i < size; ++i) product *= sigma[i];
        for (int i = 1; i < size; ++i) CHECK(sigma[i] <= sigma[i - 1]);
        CHECK_NEAR(product, std::fabs(det), 1e-14);
    }
}

TEST(rows_are_split_over_threads_without_gaps) {
    for (std::size_t n : {0, 1, 5, 4096, 10001}) {
        for (int threads : {1, 2, 3, 0}) {
            std::vector<std::atomic<int>> seen(n);
            CHECK(over_rows(n, threads, 4, 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++seen[i];
                return true;
            }));
            for (const auto& count : seen) CHECK(count == 1);
        }
    }
    CHECK(!over_rows(100, 2, 4, 1, [](std::size_t begin, std::size_t) { return begin == 0; }));
}
