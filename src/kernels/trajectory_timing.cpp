#include "trajectory_timing.hpp"

namespace cspace::trajectory::inline CSPACE_ISA {

std::ptrdiff_t bound_path_speeds(const TimedRows& path, std::size_t begin, std::size_t end, SpeedRange* range,
                                 Carry* carry, double* memory) {
    return path.degree == 2 ? bound_speeds<2>(path, begin, end, range, carry, memory)
                            : bound_speeds<4>(path, begin, end, range, carry, memory);
}

void raise_path_speeds(const TimedRows& path, std::size_t begin, std::size_t end, const SpeedRange* range,
                       double* speed, Carry* carry, double* memory) {
    path.degree == 2 ? raise_speeds<2>(path, begin, end, range, speed, carry, memory)
                     : raise_speeds<4>(path, begin, end, range, speed, carry, memory);
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
