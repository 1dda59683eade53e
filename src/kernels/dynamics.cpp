#include "dynamics_packs.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

bool inverse_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, native_width, [&](std::size_t i) { return inverse_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return inverse_pack<Wide>(rows, memory, i, count); });
}
bool mass_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, native_width, [&](std::size_t i) { return mass_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return mass_pack<Wide>(rows, memory, i, count); });
}
bool forward_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, native_width, [&](std::size_t i) { return forward_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return forward_pack<Wide>(rows, memory, i, count); });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
