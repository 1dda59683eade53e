#include "maps_sensing.hpp"

#include <cmath>
#include <stdexcept>

#include "cspace/maps/likelihood_field.hpp"
#include "cspace/maps/rays.hpp"
#include "cspace/math/interrupts.hpp"
#include "maps_grid_state.hpp"

namespace cspace::maps {

Table<double> cast_rays(const GridWorld& world, std::span<const Point> from, std::span<const double> angles,
                        double most) {
    if (from.size() != angles.size()) throw std::invalid_argument("as many points as angles are needed");
    const auto& [bits, frame, parts] = world.state();
    Table<double> ranges;
    ranges.values.reserve(from.size());
    InterruptPoll poll(64);
    for (std::size_t k = 0; k < from.size(); ++k) {
        poll.step();
        const Point direction{std::cos(angles[k]), std::sin(angles[k])};
        ranges.values.push_back(cast_ray(bits, frame, from[k], direction, most));
    }
    return ranges;
}

Table<std::uint8_t> likelihood_field(const GridWorld& world, double sigma, double floor) {
    const auto& [bits, frame, parts] = world.state();
    const auto all = [](int, int) { return true; };
    ByteField field = make_likelihood_field(bits, frame, {sigma, floor}, all);
    return {std::move(field.scores), std::size_t(field.columns)};
}

Table<std::uint8_t> likelihood_field_of_known(CellBytes blocked, CellBytes known, double resolution,
                                              double sigma, double floor) {
    if (blocked.rows != known.rows || blocked.columns != known.columns)
        throw std::invalid_argument("blocked and known must have the same shape");
    const BitGrid bits(blocked.data, blocked.rows, blocked.columns);
    const auto columns = std::size_t(known.columns);
    const auto is_known = [&](int row, int column) {
        return known.data[std::size_t(row) * columns + std::size_t(column)] != 0;
    };
    ByteField field = make_likelihood_field(bits, {resolution, {}}, {sigma, floor}, is_known);
    return {std::move(field.scores), columns};
}

}  // namespace cspace::maps
