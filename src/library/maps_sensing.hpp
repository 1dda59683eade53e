// What range sensors measure on maps, rays and likelihood fields: what the bindings call.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "maps_grid.hpp"
#include "table.hpp"

namespace cspace::maps {

// How far rays from points in directions go on a grid until they enter a blocked cell; at most `most`.
Table<double> cast_rays(const GridWorld& world, std::span<const Point> from, std::span<const double> angles,
                        double most);

// Scores of the cells of a grid (rows, columns), of a sigma [m] and a floor (maps/likelihood_field.hpp).
Table<std::uint8_t> likelihood_field(const GridWorld& world, double sigma, double floor);
// The same of cells that are blocked, and 0 in those that are not known.
Table<std::uint8_t> likelihood_field_of_known(CellBytes blocked, CellBytes known, double resolution,
                                              double sigma, double floor);

// Scans of a laser: poses (n, 3) of it in map, ranges by scan · beams + beam, and below which range a beam
// has returned.
using LaserRow = std::array<double, 3>;
struct ScanRows {
    std::span<const LaserRow> lasers;
    std::span<const float> ranges;
    std::span<const double> angles;
    double most;
};
// Resolution, and x and y of the anchor [m]; hit and miss, and the greatest ranges [m] (maps/evidence.hpp).
using EvidenceNumbers = std::array<double, 7>;

// The lowest row, the lowest column, the highest row and the highest column that scans reach, as floats: they
// may lie far away. Throws std::invalid_argument for ranges that do not fit.
std::array<double, 4> reached_cells(const ScanRows& scans, const EvidenceNumbers& numbers);
// Adds scans to sums of evidence whose cell (0, 0) lies in a row and a column of the endless grid.
void add_evidence(std::span<std::int32_t> sums, int columns, std::array<std::int32_t, 2> low,
                  const ScanRows& scans, const EvidenceNumbers& numbers, int threads);

}  // namespace cspace::maps
