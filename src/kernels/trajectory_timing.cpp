#include "trajectory_timing.hpp"

namespace cspace::trajectory::inline CSPACE_ISA {

std::ptrdiff_t bound_path_speeds(const TimedRows& path, std::size_t begin, std::size_t end, SpeedRange* range,
                                 double* memory) {
    return path.degree == 2 ? bound_speeds<2>(path, begin, end, range, memory)
                            : bound_speeds<4>(path, begin, end, range, memory);
}

void raise_path_speeds(const TimedRows& path, std::size_t begin, std::size_t end, const SpeedRange* range,
                       double* speed, double* memory) {
    path.degree == 2 ? raise_speeds<2>(path, begin, end, range, speed, memory)
                     : raise_speeds<4>(path, begin, end, range, speed, memory);
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
