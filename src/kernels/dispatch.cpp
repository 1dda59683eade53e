#include "dispatch.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#if defined(CSPACE_HAS_AVX2) && defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#endif

namespace cspace::kernels {

// What the processor and the operating system offer, of the copies that this program holds.
static Isa best_isa() {
#if !defined(CSPACE_HAS_AVX2)
    return Isa::baseline;
#elif defined(_MSC_VER) && !defined(__clang__)
    int words[4];
    __cpuid(words, 1);
    const bool fma = words[2] & (1 << 12), saves_ymm = words[2] & (1 << 27);
    if (!fma || !saves_ymm || (_xgetbv(0) & 6) != 6) return Isa::baseline;
    __cpuidex(words, 7, 0);
    return words[1] & (1 << 5) ? Isa::avx2 : Isa::baseline;
#else
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return Isa::baseline;
#if defined(CSPACE_HAS_AVX512)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
        return Isa::avx512;
    }
#endif
    return Isa::avx2;
#endif
}

Isa isa() {
    static const Isa chosen = [] {
        const char* wish = std::getenv("CSPACE_ISA");
        if (wish && std::strcmp(wish, "baseline") == 0) return Isa::baseline;
        if (wish && std::strcmp(wish, "avx2") == 0) return std::min(best_isa(), Isa::avx2);
        return best_isa();
    }();
    return chosen;
}

const char* isa_name() {
    static constexpr const char* names[] = {"baseline", "avx2", "avx512"};
    return names[int(isa())];
}

}  // namespace cspace::kernels
