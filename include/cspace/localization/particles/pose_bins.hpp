// Bins of poses: squares of the plane times sectors of the heading, numbered in the order of their discovery.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cspace/localization/particles/heading.hpp"

namespace cspace::localization {

struct PoseBin {
    std::int32_t column, row, sector;
    friend bool operator==(const PoseBin&, const PoseBin&) = default;
};

// How bins are cut.
struct BinRule {
    double per_metre;  // squares
    int sectors;       // of the full circle
    PoseBin bin_of(double x, double y, Heading heading) const {
        constexpr double farthest = 1e9;
        // The whole number below, without a call of std::floor.
        const auto index = [&](double at) {
            const double k = std::clamp(at * per_metre, -farthest, farthest);
            const std::int32_t whole = std::int32_t(k);
            return whole - std::int32_t(double(whole) > k);
        };
        return {index(x), index(y), std::int32_t((std::uint64_t(heading) * std::uint64_t(sectors)) >> 32)};
    }
};

class BinTable {
  public:
    // The number of a bin, a new one if it was not seen before.
    int number_of(const PoseBin& bin) {
        if (last_ >= 0 && bins_[std::size_t(last_)] == bin) return last_;  // as that of the particle before
        if (2 * (bins_.size() + 1) > slots_.size()) grow();
        int& slot = find_slot(bin);
        if (slot < 0) slot = int(bins_.size()), bins_.push_back(bin);
        return last_ = slot;
    }
    // −1 for a bin not seen.
    int find(const PoseBin& bin) { return bins_.empty() ? -1 : find_slot(bin); }
    std::size_t size() const { return bins_.size(); }
    const PoseBin& operator[](std::size_t number) const { return bins_[number]; }

  private:
    std::vector<int> slots_ = std::vector<int>(64, -1);  // a power of two
    std::vector<PoseBin> bins_;
    int last_ = -1;  // number that was asked for last

    static std::size_t hash(const PoseBin& bin) {
        std::uint64_t h = std::uint64_t(std::uint32_t(bin.column)) << 32 | std::uint32_t(bin.row);
        h = (h ^ std::uint64_t(bin.sector) * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
        return std::size_t(h ^ (h >> 29));
    }
    int& find_slot(const PoseBin& bin) {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = hash(bin) & mask;
        while (slots_[at] >= 0 && !(bins_[std::size_t(slots_[at])] == bin)) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow() {
        slots_.assign(2 * slots_.size(), -1);
        for (std::size_t k = 0; k < bins_.size(); ++k) find_slot(bins_[k]) = int(k);
    }
};

}  // namespace cspace::localization
