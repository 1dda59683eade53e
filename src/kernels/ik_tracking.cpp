#include "cspace/ik/tracking/along.hpp"
#include "cspace/ik/tracking/follow.hpp"
#include "ik.hpp"

namespace cspace::ik::inline CSPACE_ISA {

void ik_track(const Track& track) { follow_branches<Pack<native_width>>(track); }

void ik_path_rows(const PathRows& rows) { correct_path<Pack<native_width>>(rows); }

}  // namespace cspace::ik::inline CSPACE_ISA
