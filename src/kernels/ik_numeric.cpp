#include "cspace/ik/numeric/descent.hpp"
#include "ik.hpp"

namespace cspace::ik::inline CSPACE_ISA {

void ik_descend(const DescentRows& rows) { run_descents<Pack<native_width>>(rows); }

void ik_many_starts(const Chain& chain, const double* T, const double* starts, std::size_t count, double* q,
                    double* residual) {
    descend_from_starts<Pack<native_width>>(chain, T, starts, count, q, residual);
}

}  // namespace cspace::ik::inline CSPACE_ISA
