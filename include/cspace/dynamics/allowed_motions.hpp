// Motions that closed loops allow: those of least kinetic energy among the solutions of K x = b.
//
// Kᵀ P = Q R with column pivoting (Businger and Golub 1965), without units: the first columns of Q span the
// rows of K, the others, G, the motions that are allowed. With a solution x_p of the independent rows, x =
// x_p + G y, where Gᵀ M G y = Gᵀ (p − M x_p) makes ½ xᵀ M x − pᵀ x least (Gauss's principle). Dependent rows
// do no harm, and M itself may be singular as long as every motion that is allowed has kinetic energy.
#pragma once

#include <algorithm>
#include <cstddef>

#include "cspace/dynamics/loop_memory.hpp"
#include "cspace/kinematics/loop_equations.hpp"
#include "cspace/math/linear.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

inline LoopMemory make_loop_memory(const ClosedLoops& loops, void* bytes) {
    char* next = static_cast<char*>(bytes);
    const auto take = [&](auto* type, int count) {
        auto* const array = reinterpret_cast<decltype(type)>(next);
        next += sizeof(*type) * std::size_t(count);
        return array;
    };
    const auto numbers = [&](int count) { return take(static_cast<double*>(nullptr), count); };
    const auto poses = [&](int count) { return take(static_cast<Posed*>(nullptr), count); };
    const int n = loops.n_joints, r = loops.n_rows, dof = loops.dof;
    LoopMemory memory{};
    memory.places = {poses(n), poses(2 * loops.n_loops),
                     take(static_cast<kinematics::LoopMotion*>(nullptr), n)};
    memory.motions = {{numbers(r * dof), r}, numbers(r), numbers(r), nullptr, 0};
    memory.K = numbers(r * dof);
    for (double** each : {&memory.phi, &memory.b}) *each = numbers(r);
    for (double** each : {&memory.G, &memory.MG, &memory.H, &memory.M}) *each = numbers(dof * dof);
    for (double** each : {&memory.x, &memory.pull, &memory.y, &memory.own, &memory.q, &memory.qd,
                          &memory.tried, &memory.force})
        *each = numbers(dof);
    memory.motions.order = take(static_cast<int*>(nullptr), r);
    return memory;
}

// Places q, and finds its φ.
inline void place_row(const ClosedLoops& loops, const double* q, LoopMemory& memory) {
    kinematics::place_loops(loops, q, memory.places);
    kinematics::find_residual(loops, memory.places, memory.phi);
}

// The motions that are allowed at the placement in the memory, with its φ. cap: no more rows are independent;
// −1: as many as are.
inline void find_allowed_motions(const ClosedLoops& loops, int cap, LoopMemory& memory) {
    AllowedMotions& motions = memory.motions;
    MatrixRows<double>& A = motions.reflections;
    const int dof = loops.dof, r = loops.n_rows, most = cap < 0 ? r : std::min(cap, r);
    kinematics::find_loop_jacobian(loops, memory.places, memory.K);
    for (int i = 0; i < r; ++i) {
        motions.order[i] = i;
        for (int j = 0; j < dof; ++j) A[j][i] = memory.K[i * dof + j] * loops.rows[i].scale * loops.unit[j];
    }
    const double open = kinematics::residual_size(loops, memory.phi);
    const double least = tolerance::loop_rank + tolerance::loop_rank_slack * open;
    double first = 0.0;
    int& k = motions.rank;
    for (k = 0; k < std::min(dof, most); ++k) {
        int best = k;
        double largest = 0.0;
        for (int i = k; i < r; ++i) {
            double square = 0.0;
            for (int j = k; j < dof; ++j) square += A[j][i] * A[j][i];
            if (square > largest) {
                largest = square;
                best = i;
            }
        }
        if (k == 0) first = largest;
        if (!(largest > least * least * first)) break;
        for (int j = 0; j < dof; ++j) std::swap(A[j][k], A[j][best]);
        std::swap(motions.order[k], motions.order[best]);
        linear::reduce_column(A, dof, r, k, motions.diagonal[k], motions.factor[k]);
    }
}

// x := Q x (dof,), with the units of velocities.
inline void turn_back(const ClosedLoops& loops, const AllowedMotions& motions, double* x) {
    for (int k = motions.rank - 1; k >= 0; --k)
        linear::reflect_vector(motions.reflections, loops.dof, k, motions.factor[k], x);
    for (int j = 0; j < loops.dof; ++j) x[j] *= loops.unit[j];
}

// y := M x (dof,).
inline void multiply_matrix(const double* M, const double* x, int dof, double* y) {
    for (int i = 0; i < dof; ++i) {
        y[i] = 0.0;
        for (int j = 0; j < dof; ++j) y[i] += M[i * dof + j] * x[j];
    }
}

// The x (dof,) with K x = b (n_rows,) that makes ½ xᵀ M x − pᵀ x least; p null for zero. False where an
// allowed motion has no kinetic energy.
inline bool solve_least_energy(const ClosedLoops& loops, const double* M, const double* b, const double* p,
                               LoopMemory& memory, double* x) {
    const AllowedMotions& motions = memory.motions;
    const int dof = loops.dof, rank = motions.rank, free = dof - rank;
    for (int j = 0; j < dof; ++j) x[j] = 0.0;
    for (int j = 0; j < rank; ++j) {
        const int row = motions.order[j];
        double sum = b[row] * loops.rows[row].scale;
        for (int i = 0; i < j; ++i) sum -= motions.reflections[i][j] * x[i];
        x[j] = sum / motions.diagonal[j];
    }
    turn_back(loops, motions, x);
    if (free == 0) return true;
    multiply_matrix(M, x, dof, memory.pull);
    for (int j = 0; j < dof; ++j) memory.pull[j] = (p ? p[j] : 0.0) - memory.pull[j];
    for (int f = 0; f < free; ++f) {  // by columns
        double* const column = memory.G + f * dof;
        for (int j = 0; j < dof; ++j) column[j] = j == rank + f ? 1.0 : 0.0;
        turn_back(loops, motions, column);
        multiply_matrix(M, column, dof, memory.MG + f * dof);
    }
    MatrixRows<double> H = {memory.H, free};
    double* const y = memory.y;
    for (int f = 0; f < free; ++f) {
        const double* const column = memory.G + f * dof;
        y[f] = 0.0;
        for (int j = 0; j < dof; ++j) y[f] += column[j] * memory.pull[j];
        for (int g = f; g < free; ++g) {
            double sum = 0.0;
            for (int j = 0; j < dof; ++j) sum += column[j] * memory.MG[g * dof + j];
            H[f][g] = sum;
        }
    }
    for (int f = 0; f < free; ++f) memory.own[f] = H[f][f];
    bool is_regular = factor_ldl(H, free);
    for (int f = 0; f < free; ++f)  // the inverse pivots stand on the diagonal
        is_regular = is_regular && tolerance::singular_inertia * memory.own[f] * H[f][f] < 1.0;
    solve_ldl(H, free, y);
    for (int f = 0; f < free; ++f)
        for (int j = 0; j < dof; ++j) x[j] += memory.G[f * dof + j] * y[f];
    return is_regular;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
