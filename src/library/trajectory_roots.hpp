// The real roots of many polynomials, each within its own interval.
#pragma once

#include <cstddef>

namespace cspace::trajectory {

// Of Σ c_i t^i on begin ≤ t ≤ end, ascending: coefficients (rows, terms), begin, end (rows), roots (rows,
// terms − 1), NaN where there are fewer. A root without a change of sign may be missing. converged: last step
// of the search, relative to the interval.
void find_roots(const double* coefficients, const double* begin, const double* end, std::size_t rows,
                std::size_t terms, double converged, double* roots);

}  // namespace cspace::trajectory
