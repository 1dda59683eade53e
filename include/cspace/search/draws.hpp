// Random numbers that are the same on every machine: xoshiro256++ (Blackman & Vigna 2021, "Scrambled linear
// pseudorandom number generators"), its state filled by SplitMix64.
#pragma once

#include <bit>
#include <cstdint>

namespace cspace::search {

class Draws {
  public:
    explicit Draws(std::uint64_t seed) {
        for (std::uint64_t& word : state_) {
            seed += 0x9e3779b97f4a7c15u;
            std::uint64_t z = seed;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
            z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
            word = z ^ (z >> 31);
        }
    }
    // In [0, 1), a multiple of 2⁻⁵³.
    double uniform() {
        constexpr double last_place = 0x1p-53;
        return double(next() >> 11) * last_place;
    }

  private:
    std::uint64_t state_[4];

    std::uint64_t next() {
        const std::uint64_t drawn = std::rotl(state_[0] + state_[3], 23) + state_[0];
        const std::uint64_t shifted = state_[1] << 17;
        state_[2] ^= state_[0], state_[3] ^= state_[1];
        state_[1] ^= state_[2], state_[0] ^= state_[3];
        state_[2] ^= shifted;
        state_[3] = std::rotl(state_[3], 45);
        return drawn;
    }
};

}  // namespace cspace::search
