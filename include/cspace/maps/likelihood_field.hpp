// The likelihood field of a grid: how likely a laser beam ends in each cell, by the distance of its centre to
// that of the nearest wall (Thrun, Burgard & Fox 2005, section 6.4). Bytes of the logarithm.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/maps/byte_field.hpp"
#include "cspace/maps/clearance.hpp"

namespace cspace::maps {

// The likelihood (1 − floor) exp(−d² / 2 sigma²) + floor of a distance d.
struct HitModel {
    double sigma;  // of the distance [m]
    double floor;  // of a beam that ends anywhere, over that on a wall: above 0, below 1

    // 255 · (1 − log(likelihood) / log(floor)).
    std::uint8_t score(double distance) const {
        const double z = distance / sigma;
        const double likelihood = (1 - floor) * std::exp(-0.5 * z * z) + floor;
        return std::uint8_t(std::lround(255 * (1 - std::log(likelihood) / std::log(floor))));
    }
    // The scores by squared distance in cells, up to the last one above 0.
    std::vector<std::uint8_t> table(double resolution) const {
        std::vector<std::uint8_t> scores;
        InterruptPoll poll(256);
        for (std::uint32_t squared = 0;; ++squared) {
            poll.step();
            const std::uint8_t next = score(resolution * std::sqrt(double(squared)));
            if (next == 0) return scores;
            scores.push_back(next);
        }
    }
};

// Of the cells of a grid, and 0 outside; also 0 in cells of which is_known(row, column) is false.
template <class IsKnown>
ByteField make_likelihood_field(const BitGrid& grid, const GridFrame& frame, const HitModel& model,
                                const IsKnown& is_known) {
    const Clearance clearance = make_clearance<ToCenters>(grid);
    const std::vector<std::uint8_t> table = model.table(frame.resolution);
    const auto columns = std::size_t(grid.columns());
    ByteField field{frame, grid.rows(), grid.columns(), 0,
                    filled_vector<std::uint8_t>(std::size_t(grid.rows()) * columns)};
    InterruptPoll poll(16);
    for (int row = 0; row < grid.rows(); ++row) {
        poll.step();
        const std::uint32_t* squared = clearance.squared.data() + grid.number({row, 0});
        std::uint8_t* scores = field.scores.data() + std::size_t(row) * columns;
        for (int column = 0; column < grid.columns(); ++column) {
            const std::size_t cells = squared[column] / 4;  // from half cells
            if (cells < table.size() && is_known(row, column)) scores[column] = table[cells];
        }
    }
    return field;
}

}  // namespace cspace::maps
