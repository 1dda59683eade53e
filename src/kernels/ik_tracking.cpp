#include "ik_tracking.hpp"

namespace cspace::inline CSPACE_ISA {

void ik_track(const ik::Track& track) { follow_branches<Pack<native_width>>(track); }

}  // namespace cspace::inline CSPACE_ISA
