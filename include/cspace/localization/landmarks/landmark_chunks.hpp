// Maps of many particles, of which most are equal: landmarks in chunks that particles share until one of them
// changes its own (copy on write; Montemerlo et al. 2002 keep trees for the same purpose).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "cspace/localization/landmarks/range_bearing.hpp"

namespace cspace::localization {

// A landmark of one particle; the covariance is in axes of the map.
struct ParticleLandmark {
    Vector2 point{};
    Symmetric2 covariance{};
    std::int32_t seen = 0, missed = 0;  // not seen: it is not there
};

class LandmarkChunks {
  public:
    static constexpr std::size_t size = 16;  // landmarks
    static constexpr std::int32_t none = -1;

    explicit LandmarkChunks(std::size_t particles) : count_(particles) {}

    // Slots per particle, of which any may hold a landmark.
    std::size_t slots() const { return width_ * size; }
    const ParticleLandmark& read(std::size_t particle, std::size_t slot) const {
        static const ParticleLandmark nothing;
        const std::int32_t chunk = slot < slots() ? table_[particle * width_ + slot / size] : none;
        return chunk == none ? nothing : chunks_[std::size_t(chunk)][slot % size];
    }
    ParticleLandmark& write(std::size_t particle, std::size_t slot) {
        if (slot >= slots()) widen(slot / size + 1);
        std::int32_t& chunk = table_[particle * width_ + slot / size];
        if (chunk == none) {
            chunk = take_chunk();
            chunks_[std::size_t(chunk)] = {};
        } else if (uses_[std::size_t(chunk)] > 1) {
            --uses_[std::size_t(chunk)];
            const std::int32_t own = take_chunk();
            chunks_[std::size_t(own)] = chunks_[std::size_t(chunk)];
            chunk = own;
        }
        return chunks_[std::size_t(chunk)][slot % size];
    }
    // Particle k becomes a copy of particle sources[k].
    void select(const std::vector<std::uint32_t>& sources) {
        std::vector<std::int32_t> selected(table_.size());
        for (std::size_t k = 0; k < count_; ++k) {
            for (std::size_t c = 0; c < width_; ++c) {
                const std::int32_t chunk = table_[sources[k] * width_ + c];
                selected[k * width_ + c] = chunk;
                if (chunk != none) ++uses_[std::size_t(chunk)];
            }
        }
        for (const std::int32_t chunk : table_) {
            if (chunk != none && --uses_[std::size_t(chunk)] == 0) free_.push_back(chunk);
        }
        table_ = std::move(selected);
    }
    // Chunks in use, of which each holds 16 landmarks.
    std::size_t used() const { return chunks_.size() - free_.size(); }

  private:
    std::size_t count_, width_ = 0;  // chunks per particle
    std::vector<std::int32_t> table_, uses_, free_;
    std::deque<std::array<ParticleLandmark, size>> chunks_;

    std::int32_t take_chunk() {
        if (free_.empty()) {
            chunks_.emplace_back(), uses_.push_back(1);
            return std::int32_t(chunks_.size() - 1);
        }
        const std::int32_t chunk = free_.back();
        free_.pop_back();
        uses_[std::size_t(chunk)] = 1;
        return chunk;
    }
    void widen(std::size_t width) {
        std::vector<std::int32_t> wider(count_ * width, none);
        for (std::size_t k = 0; k < count_; ++k) {
            for (std::size_t c = 0; c < width_; ++c) wider[k * width + c] = table_[k * width_ + c];
        }
        table_ = std::move(wider), width_ = width;
    }
};

}  // namespace cspace::localization
