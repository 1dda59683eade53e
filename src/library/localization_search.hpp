// The search of a whole map for the poses of a scan: what the bindings call.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "maps_grid.hpp"
#include "table.hpp"

namespace cspace::localization {

// A field, where it lies, and the score outside of it.
struct FieldView {
    maps::CellBytes scores;
    double resolution;
    Point origin;
    int outside;
};

using ModeRow = std::array<double, 4>;  // x, y [m], θ [rad], score 0 … 1

// The best separate poses of points of base (scans/map_search.hpp). allowed: a byte per cell, 0 where no base
// may be, or none at all. rule: most, least score, headings, and how far two of them are apart [m, rad].
// Throws std::invalid_argument for an empty scan or field.
Table<ModeRow> search_map(const FieldView& field, std::span<const std::uint8_t> allowed,
                          std::span<const Point> points, const std::array<double, 5>& rule);

}  // namespace cspace::localization
