// Equations of closed loops: derivatives against differences, the motions that loops allow, and projection.
#include <cmath>
#include <vector>

#include "check.hpp"
#include "cspace/dynamics/closed_loop_motion.hpp"
#include "random_trees.hpp"

using namespace cspace;
using namespace cspace::dynamics;
using namespace random_trees;

namespace {

constexpr double step = 1e-6;
constexpr int n_joints = 7, n_loops = 2;

// A tree whose loops have rows of any numbers, a rod among them; no pose has to close them.
struct RandomLoops {
    std::vector<kinematics::LoopJoint> joints;
    std::vector<kinematics::Loop> loops;
    std::vector<kinematics::LoopRow> rows;
    std::vector<signed char> sides;
    std::vector<double> unit;
    int first;

    RandomLoops(Random& random, bool floating) : unit(n_joints - 1u, 1.0), first(floating ? 6 : 0) {
        unit.resize(unit.size() + std::size_t(first), 1.0);
        const auto number = [&] { return random(); };
        const auto vector = [&] { return Vec3d{number(), number(), number()}; };
        for (int k = 0; k < n_joints; ++k) {  // the last two joints share a coordinate
            const int parent = int(random(0.0, k + 0.999)) - 1;
            const int coordinate = std::min(k, n_joints - 2);
            joints.push_back({parent, coordinate, coordinate + first, k % 3 != 1, k == 6 ? -0.7 : 1.0,
                              number(), random_pose(random)});
        }
        for (int l = 0; l < n_loops; ++l) {
            const int ends[2] = {l - 1, n_joints - 1 - l};
            loops.push_back({{ends[0], random_pose(random)}, {ends[1], random_pose(random)}, false, {}});
            std::vector<signed char> side(n_joints, 0);
            for (int e = 0; e < 2; ++e)
                for (int k = ends[e]; k >= 0; k = joints[std::size_t(k)].parent)
                    side[std::size_t(k)] = static_cast<signed char>(side[std::size_t(k)] + (e ? 1 : -1));
            sides.insert(sides.end(), side.begin(), side.end());
            Mat3d C;
            for (auto& row : C.m)
                for (double& entry : row) entry = number();
            rows.push_back({l, vector(), C, 0.0, 1.0});
            rows.push_back({l, {}, {}, 1.5, 1.0});
        }
        rows.push_back(rows[0]);  // a row that depends on others
        rows.back().P = 2.0 * rows.back().P;
        for (auto& row : rows.back().C.m)
            for (double& entry : row) entry *= 2.0;
    }
    ClosedLoops view() const {
        return {joints.data(),
                loops.data(),
                rows.data(),
                sides.data(),
                unit.data(),
                int(joints.size()),
                int(loops.size()),
                int(rows.size()),
                int(unit.size()) - first,
                int(unit.size()),
                1.0};
    }
};

struct Held {
    std::vector<char> bytes;
    LoopMemory memory;
    explicit Held(const ClosedLoops& loops)
        : bytes(loop_memory_bytes(loops)), memory(make_loop_memory(loops, bytes.data())) {}
};

using Numbers = std::vector<double>;

Numbers residual_at(const ClosedLoops& loops, LoopMemory& memory, const Numbers& q) {
    place_row(loops, q.data(), memory);
    return {memory.phi, memory.phi + loops.n_rows};
}
// K q̇ at q.
Numbers rate_at(const ClosedLoops& loops, LoopMemory& memory, const Numbers& q, const Numbers& qd) {
    place_row(loops, q.data(), memory);
    kinematics::find_loop_jacobian(loops, memory.places, memory.K);
    Numbers rate(std::size_t(loops.n_rows), 0.0);
    for (int r = 0; r < loops.n_rows; ++r)
        for (int j = 0; j < loops.dof; ++j)
            rate[std::size_t(r)] += memory.K[r * loops.dof + j] * qd[std::size_t(j)];
    return rate;
}

void check_derivatives(Random& random, bool floating) {
    const RandomLoops made(random, floating);
    const ClosedLoops loops = made.view();
    Held held(loops);
    const Numbers q = random_numbers(random, std::size_t(loops.n_coordinates));
    const Numbers qd = random_numbers(random, std::size_t(loops.dof));
    Numbers ahead = q, back = q;
    for (std::size_t j = 0; j < q.size(); ++j) {
        ahead[j] += step * qd[j + std::size_t(made.first)];
        back[j] -= step * qd[j + std::size_t(made.first)];
    }
    const Numbers phi_ahead = residual_at(loops, held.memory, ahead);
    const Numbers phi_back = residual_at(loops, held.memory, back);
    const Numbers rate_ahead = rate_at(loops, held.memory, ahead, qd);
    const Numbers rate_back = rate_at(loops, held.memory, back, qd),
                  rate = rate_at(loops, held.memory, q, qd);
    Numbers k(std::size_t(loops.n_rows));
    kinematics::find_loop_bias(loops, qd.data(), held.memory.places, k.data());
    for (std::size_t r = 0; r < k.size(); ++r) {
        CHECK(std::fabs(rate[r] - (phi_ahead[r] - phi_back[r]) / (2 * step)) < 1e-6);
        CHECK(std::fabs(k[r] - (rate_ahead[r] - rate_back[r]) / (2 * step)) < 1e-5);
    }
}

// Motions of least energy obey K x = b; what they leave of p is no work in allowed motions.
void check_motions(Random& random, bool floating) {
    const RandomLoops made(random, floating);
    const ClosedLoops loops = made.view();
    Held held(loops);
    LoopMemory& memory = held.memory;
    const std::size_t dof = std::size_t(loops.dof);
    const Numbers q = random_numbers(random, std::size_t(loops.n_coordinates)),
                  p = random_numbers(random, dof);
    const Numbers root = random_numbers(random, dof * dof);
    for (std::size_t i = 0; i < dof; ++i)
        for (std::size_t j = 0; j < dof; ++j) {
            double sum = i == j ? 1.0 : 0.0;
            for (std::size_t m = 0; m < dof; ++m) sum += root[m * dof + i] * root[m * dof + j];
            memory.M[i * dof + j] = sum;
        }
    place_row(loops, q.data(), memory);
    std::fill(memory.phi, memory.phi + loops.n_rows, 0.0);  // the rank as at closed loops
    find_allowed_motions(loops, -1, memory);
    CHECK(memory.motions.rank <= loops.n_rows - 1);
    const Numbers qd = random_numbers(random, dof), b = rate_at(loops, memory, q, qd);
    std::fill(memory.phi, memory.phi + loops.n_rows, 0.0);
    find_allowed_motions(loops, -1, memory);
    CHECK(solve_least_energy(loops, memory.M, b.data(), p.data(), memory, memory.x));
    const Numbers x(memory.x, memory.x + dof), reached = rate_at(loops, memory, q, x);
    for (std::size_t r = 0; r < b.size(); ++r) CHECK(std::fabs(reached[r] - b[r]) < 1e-9);
    // G is still in the memory, by columns: Gᵀ (M x − p) = 0.
    Numbers left(dof);
    multiply_matrix(memory.M, x.data(), loops.dof, left.data());
    for (std::size_t j = 0; j < dof; ++j) left[j] -= p[j];
    for (int f = 0; f < loops.dof - memory.motions.rank; ++f) {
        double work = 0.0;
        for (std::size_t j = 0; j < dof; ++j) work += memory.G[std::size_t(f) * dof + j] * left[j];
        CHECK(std::fabs(work) < 1e-9);
    }
}

// Loops that are closed at some q are closed again from nearby.
void check_projection(Random& random) {
    RandomLoops made(random, false);
    const Numbers q = random_numbers(random, std::size_t(made.view().n_coordinates));
    {
        const ClosedLoops open = made.view();
        Held held(open);
        place_row(open, q.data(), held.memory);
        for (std::size_t r = 0; r < made.rows.size(); ++r) {
            kinematics::LoopRow& row = made.rows[r];
            const Posed B = kinematics::relative_place(held.memory.places, row.loop);
            if (row.rod > 0.0)
                row.rod = norm(B.t);
            else
                row.C.m[0][0] -= held.memory.phi[r] / B.R.m[0][0];
        }
    }
    const ClosedLoops loops = made.view();
    Held held(loops);
    LoopMemory& memory = held.memory;
    place_row(loops, q.data(), memory);
    CHECK(kinematics::residual_size(loops, memory.phi) < 1e-12);
    const std::size_t dof = std::size_t(loops.dof);
    for (std::size_t i = 0; i < dof * dof; ++i) memory.M[i] = i % (dof + 1) ? 0.0 : 1.0;
    const Numbers off = random_numbers(random, dof);
    for (std::size_t j = 0; j < dof; ++j) {
        memory.q[j] = q[j] + 1e-6 * off[j];  // some are nearly singular
        memory.qd[j] = off[j];
    }
    int rank = -1;
    CHECK(settle_row(loops, rank, memory));
    CHECK(rank >= 1 && rank <= loops.n_rows);
    const Numbers closed(memory.q, memory.q + dof), speed(memory.qd, memory.qd + dof);
    place_row(loops, closed.data(), memory);
    CHECK(kinematics::residual_size(loops, memory.phi) < 1e-12);
    for (const double rate : rate_at(loops, memory, closed, speed)) CHECK(std::fabs(rate) < 1e-9);
}

}  // namespace

TEST(the_equations_of_loops_and_their_motions) {
    Random random;
    for (int i = 0; i < 200; ++i) {
        for (const bool floating : {false, true}) {
            check_derivatives(random, floating);
            check_motions(random, floating);
        }
        check_projection(random);
    }
}
