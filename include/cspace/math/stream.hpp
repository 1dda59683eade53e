// Results larger than the caches are written past them: a line of memory need not be read before it is
// written.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cspace/math/lanes.hpp"

namespace cspace::inline CSPACE_ISA {

// Whether so many values leave no use for a cache.
inline bool goes_past_cache(std::size_t size) { return size >= std::size_t(3) << 18; }  // 6 MiB
// The requirements of `write_out` for stores that bypass the caches.
inline bool is_aligned(const double* to) { return reinterpret_cast<std::uintptr_t>(to) % 16 == 0; }

// Copies `size` values, an even number, from memory aligned like the widest register.
CSPACE_INLINE void write_out(double* to, const double* from, std::size_t size, bool past_cache) {
    std::size_t i = 0;
#if defined(CSPACE_X86_REGISTERS)
#if defined(__AVX__)
    if (past_cache && reinterpret_cast<std::uintptr_t>(to) % 32 == 0)
        for (; i + 4 <= size; i += 4) _mm256_stream_pd(to + i, _mm256_load_pd(from + i));
#endif
    if (past_cache)
        for (; i + 2 <= size; i += 2) _mm_stream_pd(to + i, _mm_load_pd(from + i));
#endif
    for (; i < size; ++i) to[i] = from[i];
}

// Makes what was written past the caches visible to other threads, in order.
CSPACE_INLINE void finish_streams() {
#if defined(CSPACE_X86_REGISTERS)
    _mm_sfence();
#endif
}

}  // namespace cspace::inline CSPACE_ISA
