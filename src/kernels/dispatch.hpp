// Which of the compiled copies of a kernel runs: decided once, by what the processor can do.
//
// A kernel is declared with CSPACE_KERNEL(result, name, (parameters)) in a header of this folder, defined in
// `namespace cspace::inline CSPACE_ISA` in the .cpp of the same name (compiled once per instruction set), and
// called as kernels::name(...). The files compiled per instruction set hold plain arrays only: a standard
// container instantiated there could leak its AVX2 copy into the rest of the program (a test looks for
// leaks).
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
#if defined(CSPACE_HAS_AVX512)
#define CSPACE_KERNEL_COPIES(result, name, parameters)     \
    CSPACE_KERNEL_COPY(baseline, result, name, parameters) \
    CSPACE_KERNEL_COPY(avx2, result, name, parameters)     \
    CSPACE_KERNEL_COPY(avx512, result, name, parameters)
#define CSPACE_KERNEL_CHOICE(name) \
    (isa() == Isa::avx512 ? &avx512::name : isa() == Isa::avx2 ? &avx2::name : &baseline::name)
#elif defined(CSPACE_HAS_AVX2)
#define CSPACE_KERNEL_COPIES(result, name, parameters)     \
    CSPACE_KERNEL_COPY(baseline, result, name, parameters) \
    CSPACE_KERNEL_COPY(avx2, result, name, parameters)
#define CSPACE_KERNEL_CHOICE(name) (isa() == Isa::avx2 ? &avx2::name : &baseline::name)
#else
#define CSPACE_KERNEL_COPIES(result, name, parameters) \
    CSPACE_KERNEL_COPY(inline CSPACE_ISA, result, name, parameters)
#define CSPACE_KERNEL_CHOICE(name) (&CSPACE_ISA::name)
#endif

#if defined(CSPACE_COMPILING_KERNELS)
#define CSPACE_KERNEL(result, name, parameters) CSPACE_KERNEL_COPIES(result, name, parameters)
#else
#define CSPACE_KERNEL(result, name, parameters)                         \
    CSPACE_KERNEL_COPIES(result, name, parameters)                      \
    namespace cspace::kernels {                                         \
    static result(*const name) parameters = CSPACE_KERNEL_CHOICE(name); \
    }
#endif
