#include "cspace/ik/tracking/follow.hpp"
#include "ik.hpp"

namespace cspace::ik::inline CSPACE_ISA {

void ik_track(const Track& track) { follow_branches<Pack<native_width>>(track); }

}  // namespace cspace::ik::inline CSPACE_ISA
