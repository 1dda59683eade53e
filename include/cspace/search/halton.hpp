// Points that fill a box evenly: Halton (1960, "On the efficiency of certain quasi-random sequences of points
// in evaluating multi-dimensional integrals"), the dimensions in bases 3, 5, 7, 11, … Seeds shift all points
// modulo 1 (Cranley & Patterson 1976).
//
// The first bases count as they are. In large bases the first points of two dimensions lie on few lines, so
// their digits are multiplied by a fixed number modulo the base (Matoušek 1998, "On the L2-discrepancy for
// anchored boxes").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cspace/math/made_once.hpp"
#include "cspace/search/draws.hpp"

namespace cspace::search {

inline constexpr int most_dimensions = 64;

// Unit points, made in chunks when first read; any number of threads may read.
class HaltonTable {
  public:
    static constexpr std::size_t chunk_rows = 256, most_chunks = 256;

    explicit HaltonTable(int dimensions) : dimensions_(std::size_t(dimensions)) {
        for (std::uint32_t n = 3; bases_.size() < dimensions_; n += 2)
            if (is_odd_prime(n)) bases_.push_back(n);
        for (const std::uint32_t base : bases_) factors_.push_back(factor_of(base));
    }
    std::size_t dimensions() const { return dimensions_; }

    // Chunk c holds the rows from c · chunk_rows on; null from most_chunks on: they are not kept.
    const float* find_chunk(std::size_t c) const {
        if (c >= most_chunks) return nullptr;
        const auto make = [&] {
            auto rows = std::make_unique<std::vector<float>>(chunk_rows * dimensions_);
            fill_chunk(c, rows->data());
            return rows;
        };
        return chunks_[c].get(make).data();
    }
    void fill_chunk(std::size_t c, float* rows) const {
        for (std::size_t k = 0; k < dimensions_; ++k) fill_column(k, c * chunk_rows + 1, rows + k);
    }

  private:
    std::size_t dimensions_;
    std::vector<std::uint32_t> bases_, factors_;
    std::array<MadeOnce<std::vector<float>>, most_chunks> chunks_;

    static bool is_odd_prime(std::uint32_t n) {
        for (std::uint32_t d = 3; d * d <= n; d += 2)
            if (n % d == 0) return false;
        return true;
    }
    static std::uint32_t factor_of(std::uint32_t base) {
        constexpr std::uint32_t largest_plain = 31;
        return base <= largest_plain ? 1 : 1 + std::uint32_t(Draws(base).uniform() * (base - 1));
    }
    // The digits of i behind the point, in reverse order.
    double invert(std::size_t k, std::uint64_t i) const {
        const std::uint64_t base = bases_[k];
        double digits = 0, scale = 1;
        for (; i > 0; i /= base, scale *= double(base))
            digits = digits * double(base) + double(i % base * factors_[k] % base);
        return digits / scale;
    }
    void fill_column(std::size_t k, std::uint64_t first, float* column) const {
        constexpr float below_one = 0x1.fffffep-1f;
        const std::uint64_t base = bases_[k], end = first + chunk_rows;
        double rest = invert(k, first / base);
        std::uint64_t digit = first % base;
        for (std::uint64_t i = first; i < end; ++i, ++digit, column += dimensions_) {
            if (digit == base) digit = 0, rest = invert(k, i / base);
            const float u = float((double(digit * factors_[k] % base) + rest) / double(base));
            *column = u < below_one ? u : below_one;
        }
    }
};

// One reader of a table; its points are shifted by a seed, 0: not at all.
class HaltonPoints {
  public:
    HaltonPoints(const HaltonTable& table, std::uint64_t seed) : table_(table) {
        Draws draws(seed);
        for (std::size_t k = 0; k < table.dimensions(); ++k)
            shifts_[k] = seed == 0 ? 0.0f : float(draws.uniform());
    }

    // The next point, in [0, 1) per dimension; it lasts until the next call.
    const float* next() {
        if (left_ == 0) begin_chunk();
        --left_;
        for (std::size_t k = 0; k < table_.dimensions(); ++k) {
            const float u = row_[k] + shifts_[k];
            point_[k] = u < 1.0f ? u : u - 1.0f;
        }
        row_ += table_.dimensions();
        return point_.data();
    }

  private:
    const HaltonTable& table_;
    std::array<float, most_dimensions> shifts_, point_;
    const float* row_ = nullptr;
    std::size_t chunk_ = 0, left_ = 0;
    std::vector<float> own_;  // a chunk that the table does not keep

    void begin_chunk() {
        row_ = table_.find_chunk(chunk_);
        if (!row_) {
            own_.resize(HaltonTable::chunk_rows * table_.dimensions());
            table_.fill_chunk(chunk_, own_.data());
            row_ = own_.data();
        }
        ++chunk_, left_ = HaltonTable::chunk_rows;
    }
};

}  // namespace cspace::search
