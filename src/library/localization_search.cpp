#include "localization_search.hpp"

#include <stdexcept>

#include "cspace/localization/scans/map_search.hpp"
#include "kernels/localization_search.hpp"

namespace cspace::localization {

Table<ModeRow> search_map(const FieldView& view, std::span<const std::uint8_t> allowed,
                          std::span<const Point> points, const std::array<double, 5>& rule) {
    const auto [data, rows, columns] = view.scores;
    const std::size_t cells = std::size_t(rows) * std::size_t(columns);
    if (cells == 0 || points.empty()) throw std::invalid_argument("a field and a scan must not be empty");
    if (!allowed.empty() && allowed.size() != cells)
        throw std::invalid_argument("allowed needs a byte per cell");
    const maps::ByteField field{
        {view.resolution, view.origin}, rows, columns, std::uint8_t(view.outside), {data, data + cells}};
    const auto sum_blocks = [](const BeamRows* beams, int count, const PlaneRows& planes, int block_rows,
                               int width, std::uint16_t* sums) {
        kernels::sum_block_scores(beams, count, planes, block_rows, width, sums);
    };
    MapSearch search(field, allowed, points, {int(rule[0]), rule[1], int(rule[2]), rule[3], rule[4]},
                     sum_blocks);
    Table<ModeRow> modes;
    for (const PoseMode& mode : search.find())
        modes.values.push_back({mode.x, mode.y, mode.theta, mode.score});
    return modes;
}

}  // namespace cspace::localization
