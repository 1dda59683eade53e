#include "kinematics_loops.hpp"

#include <vector>

#include "cspace/kinematics/loop_equations.hpp"
#include "cspace/math/threads.hpp"

namespace cspace::kinematics {
namespace {

// Configurations that are worth a thread.
constexpr std::size_t rows_worth_a_thread = 512;

struct Memory {
    std::vector<Posed> joints, ends;
    std::vector<LoopMotion> motions;
    explicit Memory(const ClosedLoops& loops)
        : joints(std::size_t(loops.n_joints)),
          ends(2 * std::size_t(loops.n_loops)),
          motions(std::size_t(loops.n_joints)) {}
};

void evaluate_row(const ClosedLoops& loops, const LoopArrays& arrays, std::size_t i, LoopPlaces& places) {
    const std::size_t n = std::size_t(loops.n_coordinates), dof = std::size_t(loops.dof);
    const std::size_t r = std::size_t(loops.n_rows), count = std::size_t(loops.n_loops);
    place_loops(loops, arrays.q + i * n, places);
    if (arrays.phi) find_residual(loops, places, arrays.phi + i * r);
    if (arrays.over)
        for (std::size_t l = 0; l < count; ++l)
            arrays.over[i * count + l] = is_turned_over(loops, places, int(l));
    if (arrays.K) find_loop_jacobian(loops, places, arrays.K + i * r * dof);
    if (arrays.wrenches) {
        double* to = arrays.wrenches + i * r * 6;
        for (int row = 0; row < loops.n_rows; ++row, to += 6) {
            Vec3d f, m;
            find_row_wrench(loops.rows[row], places, f, m);
            const double values[6] = {f.x, f.y, f.z, m.x, m.y, m.z};
            for (int j = 0; j < 6; ++j) to[j] = values[j];
        }
    }
    if (arrays.k) find_loop_bias(loops, arrays.qd + i * dof, places, arrays.k + i * r);
}

}  // namespace

void evaluate_loops(const ClosedLoops& loops, const LoopArrays& arrays, std::size_t rows, int threads) {
    over_rows(rows, threads, 1, rows_worth_a_thread, [&](std::size_t begin, std::size_t end) {
        Memory memory(loops);
        LoopPlaces places = {memory.joints.data(), memory.ends.data(), memory.motions.data()};
        for (std::size_t i = begin; i < end; ++i) evaluate_row(loops, arrays, i, places);
        return true;
    });
}

}  // namespace cspace::kinematics
