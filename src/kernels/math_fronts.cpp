#include "math_fronts.hpp"

#include "cspace/math/sparse/front.hpp"

namespace cspace::inline CSPACE_ISA {

bool factor_front_columns(double* panel, int stride, int pivots, int first) {
    return factor_columns(panel, stride, pivots, first);
}

void update_front_strip(double* schur, int size, const double* panel, int stride, int pivots, int row) {
    update_strip(schur, size, panel, stride, pivots, row);
}

void solve_front_lower(const double* panel, int stride, int pivots, double* x) {
    solve_lower(panel, stride, pivots, x);
}

void solve_front_upper(const double* panel, int stride, int pivots, double* x) {
    solve_upper(panel, stride, pivots, x);
}

}  // namespace cspace::inline CSPACE_ISA
