// The dense loops of a front, for SparseCholesky and CliqueTree, compiled per instruction set. What finds an
// order of elimination and the pattern of the factor is compiled in localization_incremental.cpp alone.
#pragma once

#include "cspace/math/sparse/nested_dissection.hpp"
#include "cspace/math/sparse/symbolic.hpp"
#include "kernels/math_fronts.hpp"

namespace cspace {

extern template BlockGraph make_block_graph(std::vector<int>, const std::vector<BlockPair>&);
extern template std::vector<int> order_minimum_degree(const BlockGraph&);
extern template std::vector<int> order_nested_dissection(const BlockGraph&);
extern template SymbolicFactor analyze_pattern(const BlockGraph&, std::vector<int>, const Amalgamation&);

}  // namespace cspace

namespace cspace::localization {

struct KernelFronts {
    static bool factor(double* panel, int stride, int pivots, int first) {
        return kernels::factor_front_columns(panel, stride, pivots, first);
    }
    static void update(double* schur, int size, const double* panel, int stride, int pivots, int row) {
        kernels::update_front_strip(schur, size, panel, stride, pivots, row);
    }
    static void lower(const double* panel, int stride, int pivots, double* x) {
        kernels::solve_front_lower(panel, stride, pivots, x);
    }
    static void upper(const double* panel, int stride, int pivots, double* x) {
        kernels::solve_front_upper(panel, stride, pivots, x);
    }
};

}  // namespace cspace::localization
