// Which of the compiled copies of a kernel runs: decided once, by what the processor can do.
//
// A kernel is declared with CSPACE_KERNEL(room, result, name, (parameters)) in a header of this folder; the
// room is its namespace, such as cspace::ik. It is defined in `namespace room::inline CSPACE_ISA` in a .cpp
// of this folder (compiled once per instruction set), and called as kernels::name(...).
// CSPACE_NARROW_KERNEL declares one whose widest copy is that for AVX2, because an AVX-512 copy would gain
// nothing (listed in cmake/kernels.cmake). The files compiled per instruction set hold plain arrays only: a
// standard container instantiated there could leak its AVX2 copy into the rest of the program (a test looks
// for leaks).
//
// On x86-64 the build defines CSPACE_HAS_AVX2, and CSPACE_HAS_AVX512 where the compiler has vector
// extensions.
#pragma once

#include "cspace/math/isa.hpp"

namespace cspace::kernels {
enum class Isa { baseline, avx2, avx512 };
// The best instruction set of this processor. The environment variable CSPACE_ISA lowers it: to "baseline",
// or to "avx2".
Isa isa();
const char* isa_name();
}  // namespace cspace::kernels

#define CSPACE_KERNEL_COPY(room, copy, result, name, parameters) \
    namespace room::copy {                                       \
    result name parameters;                                      \
    }

#if defined(CSPACE_HAS_AVX2)
#define CSPACE_NARROW_COPIES(room, result, name, parameters)     \
    CSPACE_KERNEL_COPY(room, baseline, result, name, parameters) \
    CSPACE_KERNEL_COPY(room, avx2, result, name, parameters)
#define CSPACE_NARROW_CHOICE(room, name) (isa() == Isa::baseline ? &room::baseline::name : &room::avx2::name)
#else
#define CSPACE_NARROW_COPIES(room, result, name, parameters) \
    CSPACE_KERNEL_COPY(room, baseline, result, name, parameters)
#define CSPACE_NARROW_CHOICE(room, name) (&room::baseline::name)
#endif

#if defined(CSPACE_HAS_AVX512)
#define CSPACE_KERNEL_COPIES(room, result, name, parameters) \
    CSPACE_NARROW_COPIES(room, result, name, parameters)     \
    CSPACE_KERNEL_COPY(room, avx512, result, name, parameters)
#define CSPACE_KERNEL_CHOICE(room, name) \
    (isa() == Isa::avx512 ? &room::avx512::name : CSPACE_NARROW_CHOICE(room, name))
#else
#define CSPACE_KERNEL_COPIES CSPACE_NARROW_COPIES
#define CSPACE_KERNEL_CHOICE CSPACE_NARROW_CHOICE
#endif

#if defined(CSPACE_COMPILING_KERNELS)
// The namespace of this copy is inline, and has to be so where it is opened first.
#define CSPACE_DECLARE_KERNEL(room, name, copies, choice) \
    namespace room::inline CSPACE_ISA {}                  \
    copies
#else
#define CSPACE_DECLARE_KERNEL(room, name, copies, choice) \
    copies namespace cspace::kernels { static auto* const name = choice; }
#endif
#define CSPACE_KERNEL(room, result, name, parameters)                                       \
    CSPACE_DECLARE_KERNEL(room, name, CSPACE_KERNEL_COPIES(room, result, name, parameters), \
                          CSPACE_KERNEL_CHOICE(room, name))
#define CSPACE_NARROW_KERNEL(room, result, name, parameters)                                \
    CSPACE_DECLARE_KERNEL(room, name, CSPACE_NARROW_COPIES(room, result, name, parameters), \
                          CSPACE_NARROW_CHOICE(room, name))
