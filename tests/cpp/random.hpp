// Seeded random vectors for the tests: the same numbers on every machine.
#pragma once

#include <cstdint>

#include "cspace/math/vec.hpp"

namespace check {

struct Random {
    std::uint64_t state;
    // Uniform in [lower, upper) (Steele, Lea & Flood 2014: splitmix64).
    double uniform(double lower, double upper) {
        std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return lower + (upper - lower) * double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    int below(int n) { return int(uniform(0, n)); }
    cspace::Vec3d vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
    cspace::Vec3d axis() {
        cspace::Vec3d v = vector();
        return (1.0 / cspace::norm(v)) * v;
    }
};

}  // namespace check
