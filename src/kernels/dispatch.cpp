#include "dispatch.hpp"

#include <cstdlib>
#include <cstring>

#if defined(CSPACE_HAS_AVX2) && defined(_MSC_VER)
#include <intrin.h>
#endif

namespace cspace::kernels {

#if defined(CSPACE_HAS_AVX2)
static bool processor_has_avx2_and_fma() {
#if defined(_MSC_VER)
    int words[4];
    __cpuid(words, 1);
    const bool fma = words[2] & (1 << 12), saves_ymm = words[2] & (1 << 27);
    if (!fma || !saves_ymm || (_xgetbv(0) & 6) != 6) return false;
    __cpuidex(words, 7, 0);
    return words[1] & (1 << 5);
#else
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
}
#endif

Isa isa() {
    static const Isa chosen = [] {
        const char* wish = std::getenv("CSPACE_ISA");
        if (wish && std::strcmp(wish, "baseline") == 0) return Isa::baseline;
#if defined(CSPACE_HAS_AVX2)
        if (processor_has_avx2_and_fma()) return Isa::avx2;
#endif
        return Isa::baseline;
    }();
    return chosen;
}

}  // namespace cspace::kernels
