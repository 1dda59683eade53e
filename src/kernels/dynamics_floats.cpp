#include "dynamics_packs.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

bool inverse_float_rows(const FloatRows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, float_register_lanes,
        [&](std::size_t i) { return inverse_pack<FloatPack>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return inverse_pack<FloatPack>(rows, memory, i, count); });
}
bool mass_float_rows(const FloatRows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, float_register_lanes,
        [&](std::size_t i) { return mass_pack<FloatPack>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return mass_pack<FloatPack>(rows, memory, i, count); });
}
bool forward_float_rows(const FloatRows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, float_register_lanes,
        [&](std::size_t i) { return forward_pack<FloatPack>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return forward_pack<FloatPack>(rows, memory, i, count); });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
