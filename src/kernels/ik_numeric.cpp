#include "cspace/ik/numeric/descent.hpp"
#include "ik.hpp"

namespace cspace::ik::inline CSPACE_ISA {

void ik_descend(const DescentRows& rows) { run_descents<Pack<native_width>>(rows); }

}  // namespace cspace::ik::inline CSPACE_ISA
