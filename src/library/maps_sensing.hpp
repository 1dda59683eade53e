// What range sensors measure on maps, rays and likelihood fields: what the bindings call.
#pragma once

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

}  // namespace cspace::maps
