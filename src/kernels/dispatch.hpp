// Which of the compiled copies of a kernel runs: decided once, by what the processor can do.
//
// A kernel is declared with CSPACE_KERNEL(result, name, (parameters)) in a header of this folder, defined in
// `namespace cspace::inline CSPACE_ISA` in the .cpp of the same name (compiled once per instruction set), and
// called as kernels::name(...). CSPACE_NARROW_KERNEL declares one whose packs hold four numbers: its widest
// copy is that for AVX2, for an AVX-512 copy would gain nothing (cmake/kernels.cmake lists the others). The
// files compiled per instruction set hold plain arrays only: a standard container instantiated there could
// leak its AVX2 copy into the rest of the program (a test looks for leaks).
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

#define CSPACE_KERNEL_COPY(copy, result, name, parameters) \
    namespace cspace::copy {                               \
    result name parameters;                                \
    }

#if defined(CSPACE_HAS_AVX2)
#define CSPACE_NARROW_COPIES(result, name, parameters)     \
    CSPACE_KERNEL_COPY(baseline, result, name, parameters) \
    CSPACE_KERNEL_COPY(avx2, result, name, parameters)
#define CSPACE_NARROW_CHOICE(name) (isa() == Isa::baseline ? &baseline::name : &avx2::name)
#else
#define CSPACE_NARROW_COPIES(result, name, parameters) CSPACE_KERNEL_COPY(baseline, result, name, parameters)
#define CSPACE_NARROW_CHOICE(name) (&baseline::name)
#endif

#if defined(CSPACE_HAS_AVX512)
#define CSPACE_KERNEL_COPIES(result, name, parameters) \
    CSPACE_NARROW_COPIES(result, name, parameters)     \
    CSPACE_KERNEL_COPY(avx512, result, name, parameters)
#define CSPACE_KERNEL_CHOICE(name) (isa() == Isa::avx512 ? &avx512::name : CSPACE_NARROW_CHOICE(name))
#else
#define CSPACE_KERNEL_COPIES CSPACE_NARROW_COPIES
#define CSPACE_KERNEL_CHOICE CSPACE_NARROW_CHOICE
#endif

#if defined(CSPACE_COMPILING_KERNELS)
#define CSPACE_KERNEL(result, name, parameters) CSPACE_KERNEL_COPIES(result, name, parameters)
#define CSPACE_NARROW_KERNEL(result, name, parameters) CSPACE_NARROW_COPIES(result, name, parameters)
#else
#define CSPACE_KERNEL_POINTER(choice, result, name, parameters) \
    namespace cspace::kernels {                                 \
    static result(*const name) parameters = choice(name);       \
    }
#define CSPACE_KERNEL(result, name, parameters)    \
    CSPACE_KERNEL_COPIES(result, name, parameters) \
    CSPACE_KERNEL_POINTER(CSPACE_KERNEL_CHOICE, result, name, parameters)
#define CSPACE_NARROW_KERNEL(result, name, parameters) \
    CSPACE_NARROW_COPIES(result, name, parameters)     \
    CSPACE_KERNEL_POINTER(CSPACE_NARROW_CHOICE, result, name, parameters)
#endif
