#include "maps_sensing.hpp"

#include <cmath>
#include <stdexcept>
#include <thread>

#include "cspace/maps/evidence.hpp"
#include "cspace/maps/likelihood_field.hpp"
#include "cspace/maps/rays.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/threads.hpp"
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

namespace {

EvidencePart part_of(const EvidenceNumbers& n) { return {n[0], {n[1], n[2]}, 0, 0, 0, 0}; }
EvidenceRule rule_of(const EvidenceNumbers& n) {
    return {std::int32_t(n[3]), std::int32_t(n[4]), n[5], n[6]};
}
std::span<const LaserPose> lasers_of(const ScanRows& scans) {
    static_assert(sizeof(LaserPose) == sizeof(LaserRow));
    if (scans.ranges.size() != scans.lasers.size() * scans.angles.size())
        throw std::invalid_argument("a range per scan and beam is needed");
    return {reinterpret_cast<const LaserPose*>(scans.lasers.data()), scans.lasers.size()};
}

}  // namespace

std::array<double, 4> reached_cells(const ScanRows& scans, const EvidenceNumbers& numbers) {
    const CellRange reached = reached_cells(part_of(numbers), rule_of(numbers), {scans.angles, scans.most},
                                            lasers_of(scans), scans.ranges);
    return {double(reached.low_row), double(reached.low_column), double(reached.high_row),
            double(reached.high_column)};
}

void add_evidence(std::span<std::int32_t> sums, int columns, std::array<std::int32_t, 2> low,
                  const ScanRows& scans, const EvidenceNumbers& numbers, int threads) {
    const std::span<const LaserPose> lasers = lasers_of(scans);
    if (sums.empty() || columns < 1 || sums.size() % std::size_t(columns) != 0)
        throw std::invalid_argument("sums need whole rows");
    EvidencePart part = part_of(numbers);
    part.low_row = low[0], part.low_column = low[1];
    part.rows = std::int32_t(sums.size() / std::size_t(columns)), part.columns = columns;
    const std::size_t beams = scans.angles.size();
    const auto mark = [&](std::int32_t* into, std::size_t first, std::size_t step) {
        EvidenceMarker marker(part, rule_of(numbers), into);
        InterruptPoll poll(2);
        for (std::size_t k = first; k < lasers.size(); k += step) {
            poll.step();
            marker.add({scans.angles, scans.most}, lasers[k], scans.ranges.subspan(k * beams, beams));
        }
    };
    // Each thread has its own sums; those of whole numbers are the same in any order.
    constexpr std::size_t few_scans = 64;
    const std::size_t most =
        threads > 0 ? std::size_t(threads) : std::max(1u, std::thread::hardware_concurrency());
    const std::size_t parts = std::clamp<std::size_t>(lasers.size() / few_scans, 1, most);
    std::vector<std::vector<std::int32_t>> others(parts - 1);
    over_rows(parts, int(parts), 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            if (k > 0) others[k - 1] = filled_vector<std::int32_t>(sums.size());
            mark(k > 0 ? others[k - 1].data() : sums.data(), k, parts);
        }
        return true;
    });
    for (const auto& other : others) visit_range(0, sums.size(), [&](std::size_t k) { sums[k] += other[k]; });
}

}  // namespace cspace::maps
