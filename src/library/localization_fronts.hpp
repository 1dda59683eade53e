// The dense loops of a front, for SparseCholesky and CliqueTree, compiled per instruction set.
#pragma once

#include "kernels/math_fronts.hpp"

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
