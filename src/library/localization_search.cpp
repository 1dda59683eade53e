#include "localization_search.hpp"

#include <stdexcept>

#include "cspace/localization/scans/map_search.hpp"
#include "kernels/localization_search.hpp"

namespace cspace::localization {

namespace {

struct KernelSums {
    static void blocks(const BeamRows* beams, int count, const PlaneRows& planes, int rows, int columns,
                       std::uint16_t* sums) {
        kernels::sum_block_scores(beams, count, planes, rows, columns, sums);
    }
    static void cells(const std::uint8_t* scores, const std::int64_t* at, int beams, std::int64_t stride,
                      std::uint16_t* sums) {
        kernels::sum_cell_scores(scores, at, beams, stride, sums);
    }
};

}  // namespace

Table<ModeRow> search_map(const FieldView& view, std::span<const std::uint8_t> allowed,
                          std::span<const Point> points, const std::array<double, 6>& rule) {
    const auto [data, rows, columns] = view.scores;
    const std::size_t cells = std::size_t(rows) * std::size_t(columns);
    if (cells == 0 || points.empty()) throw std::invalid_argument("a field and a scan must not be empty");
    if (!allowed.empty() && allowed.size() != cells)
        throw std::invalid_argument("allowed needs a byte per cell");
    const maps::ByteField field{
        {view.resolution, view.origin}, rows, columns, std::uint8_t(view.outside), {data, data + cells}};
    MapSearch<KernelSums> search(field, allowed, points,
                                 {int(rule[0]), rule[1], rule[2], int(rule[3]), rule[4], rule[5]});
    Table<ModeRow> modes;
    for (const FoundPose& mode : search.find())
        modes.values.push_back({mode.x, mode.y, mode.theta, mode.score});
    return modes;
}

}  // namespace cspace::localization
