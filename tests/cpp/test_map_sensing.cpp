// What range sensors measure on maps: distances between cells, rays, evidence, and searches of whole maps,
// against trying everything.
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "check.hpp"
#include "cspace/localization/scans/map_search.hpp"
#include "cspace/maps/clearance.hpp"
#include "cspace/maps/evidence.hpp"
#include "cspace/maps/likelihood_field.hpp"
#include "cspace/maps/rays.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::localization;

namespace {

BitGrid random_grid(check::Random& random, int most) {
    BitGrid grid(1 + random.below(most), 1 + random.below(most));
    const double share = random.below(4) == 0 ? 0 : random.uniform(0, 0.3);
    for (int r = 0; r < grid.rows(); ++r)
        for (int c = 0; c < grid.columns(); ++c)
            if (random.uniform(0, 1) < share) grid.set(r, c, true);
    return grid;
}

// All poses in order of heading, row and column; the first of the greatest scores that is apart from others.
std::vector<FoundPose> try_all(const ByteField& field, const std::vector<std::uint8_t>& allowed,
                               const std::vector<Point>& points, const MapSearchRule& rule) {
    std::vector<FoundPose> modes;
    const double whole = 255.0 * double(points.size());
    while (int(modes.size()) < rule.most) {
        FoundPose best{0, 0, 0, -1};
        for (int k = 0; k < rule.headings; ++k) {
            double turn = 2 * std::numbers::pi * k / rule.headings;
            if (turn > std::numbers::pi) turn -= 2 * std::numbers::pi;
            const double c = std::cos(turn) / field.frame.resolution,
                         s = std::sin(turn) / field.frame.resolution;
            for (int row = 0; row < field.rows; ++row)
                for (int column = 0; column < field.columns; ++column) {
                    if (!allowed.empty() && !allowed[std::size_t(row * field.columns + column)]) continue;
                    const Point at = field.frame.center({row, column});
                    bool is_near = false;
                    for (const FoundPose& mode : modes)
                        is_near |= distance({mode.x, mode.y}, at) <= rule.apart &&
                                   std::abs(short_way(turn - mode.theta)) <= rule.apart_heading;
                    if (is_near) continue;
                    int sum = 0;
                    for (const Point p : points)
                        sum += field.at({row + int(std::floor(s * p.x + c * p.y + 0.5)),
                                         column + int(std::floor(c * p.x - s * p.y + 0.5))});
                    if (sum / whole > best.score) best = {at.x, at.y, turn, sum / whole};
                }
        }
        const double least =
            modes.empty() ? rule.least_score : std::max(rule.least_score, modes.front().score - rule.margin);
        if (best.score < least - 1e-12) break;
        modes.push_back(best);
    }
    return modes;
}

}  // namespace

TEST(distances_between_centres_are_those_to_all_blocked_cells) {
    check::Random random{1};
    for (int repeat = 0; repeat < 400; ++repeat) {
        const BitGrid grid = random_grid(random, 30);
        const Clearance clearance = make_clearance<ToCenters>(grid);
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column) {
                std::uint32_t least = no_cell;
                for (int r = 0; r < grid.rows(); ++r)
                    for (int c = 0; c < grid.columns(); ++c)
                        if (grid.blocked(r, c))
                            least = std::min(least, std::uint32_t(4 * ((r - row) * (r - row) +
                                                                       (c - column) * (c - column))));
                const std::uint32_t number = grid.number({row, column});
                CHECK(clearance.squared[number] == least);
                if (grid.blocked(row, column) || least == no_cell) continue;
                const Cell nearest = grid.cell(clearance.nearest[number]);
                CHECK(grid.contains(nearest) && grid.blocked(nearest));
            }
    }
}

TEST(a_search_of_large_blocks_first_is_that_of_all_poses) {
    check::Random random{2};
    int found = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
        const BitGrid grid = random_grid(random, 40);
        const GridFrame frame{random.uniform(0.05, 0.5), {random.uniform(-5, 5), random.uniform(-5, 5)}};
        ByteField field =
            make_likelihood_field(grid, frame, {2 * frame.resolution, 0.1}, [](int, int) { return true; });
        field.outside = std::uint8_t(random.below(3) == 0 ? random.below(256) : 0);
        std::vector<Point> points(std::size_t(1 + random.below(300)));
        const double far = random.uniform(0.1, 1.5) * frame.resolution * grid.columns();
        for (Point& p : points) p = {random.uniform(-far, far), random.uniform(-far, far)};
        std::vector<std::uint8_t> allowed;
        if (random.below(2))
            for (std::size_t k = 0; k < field.scores.size(); ++k) allowed.push_back(random.below(3) == 0);
        MapSearchRule rule;
        rule.least_score = random.below(2) ? 0 : 0.3;
        rule.margin = random.below(2) ? 1 : 0.1;
        rule.headings = 1 + random.below(8);
        rule.apart = random.uniform(0, 9) * frame.resolution;
        rule.most_blocks = random.below(3) == 0 ? 1 + 9 * rule.headings : std::int64_t(1) << 25;
        const std::vector<FoundPose> wanted = try_all(field, allowed, points, rule);
        const std::vector<FoundPose> got = MapSearch<>(field, allowed, points, rule).find();
        CHECK(got.size() == wanted.size());
        for (std::size_t k = 0; k < got.size() && k < wanted.size(); ++k) {
            CHECK(got[k].x == wanted[k].x && got[k].y == wanted[k].y && got[k].theta == wanted[k].theta);
            CHECK(got[k].score == wanted[k].score);
            ++found;
        }
    }
    CHECK(found > 60);
}

TEST(beams_end_in_hits_and_pass_through_misses) {
    check::Random random{3};
    for (int repeat = 0; repeat < 300; ++repeat) {
        EvidencePart part{
            random.uniform(0.05, 0.5), {random.uniform(-1, 1), random.uniform(-1, 1)}, 0, 0, 0, 0};
        const EvidenceRule rule{85, -20, 6, random.below(2) ? 2.0 : 0.0};
        const std::vector<double> angles = {random.uniform(-4, 4)};
        const LaserPose laser{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-4, 4)};
        const std::vector<float> ranges = {random.below(3) ? float(random.uniform(0.01, 7))
                                                           : std::numeric_limits<float>::quiet_NaN()};
        const CellRange reached = reached_cells(part, rule, {angles, 20}, {&laser, 1}, ranges);
        part.low_row = int(reached.low_row), part.low_column = int(reached.low_column);
        part.rows = int(reached.high_row - reached.low_row + 1);
        part.columns = int(reached.high_column - reached.low_column + 1);
        std::vector<std::int32_t> sums(std::size_t(part.rows) * std::size_t(part.columns));
        EvidenceMarker(part, rule, sums.data()).add({angles, 20}, laser, ranges);
        const bool is_hit = ranges[0] <= 6;
        int hits = 0, misses = 0;
        for (const std::int32_t sum : sums) hits += sum == 85, misses += sum == -20;
        CHECK(hits == is_hit);
        const bool is_used = is_hit || ranges[0] > 6 || rule.clear_range > 0;
        CHECK(hits + misses == (is_used ? part.rows + part.columns - 1 : 0));
    }
}
