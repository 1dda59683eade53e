// Names the instruction set this translation unit is compiled for.
//
// A kernel is compiled once per instruction set and chosen at run time, so the same template exists several
// times in one program. Every function that may be compiled so lives in `cspace::inline CSPACE_ISA`, which
// keeps the copies apart for the linker; plain data shared between them lives in `cspace`.
//
// The copies of the library are named by the build (CSPACE_ISA=baseline, avx2, …). Code that includes the
// headers itself has different names, so that the linker never confuses the two.
#pragma once

#if defined(CSPACE_ISA)
#elif defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define CSPACE_ISA header_avx512
#elif defined(__AVX2__)
#define CSPACE_ISA header_avx2
#elif defined(__aarch64__) || defined(_M_ARM64)
#define CSPACE_ISA header_neon
#else
#define CSPACE_ISA header
#endif

namespace cspace {
inline namespace CSPACE_ISA {}
}  // namespace cspace

#if defined(__GNUC__) || defined(__clang__)
#if defined(__SANITIZE_ADDRESS__)
#define CSPACE_INLINE inline  // checks in every copy would make kernels too large to compile
#else
#define CSPACE_INLINE inline __attribute__((always_inline))
#endif
#define CSPACE_NOINLINE __attribute__((noinline))
// For the rare path of a hot function: out of line and away from the hot code.
#define CSPACE_COLD __attribute__((noinline, cold))
#else
#define CSPACE_INLINE __forceinline
#define CSPACE_NOINLINE __declspec(noinline)
#define CSPACE_COLD __declspec(noinline)
#endif

// Before a large function that several files of the library call: each copy compiles it once, in the file
// that instantiates it (src/kernels/once.hpp). For others it is a function template like any other.
#define CSPACE_ONCE template <class = void>

// Registers of the vector extensions of GCC and Clang; other compilers (or CSPACE_FORCE_ARRAY_LANES, so that
// their path can be tested anywhere) get arrays.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(CSPACE_FORCE_ARRAY_LANES)
#define CSPACE_VECTOR_EXTENSIONS 1
#else
#define CSPACE_VECTOR_EXTENSIONS 0
#endif
