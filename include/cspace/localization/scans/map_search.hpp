// The poses from which a scan fits a whole map best: branch and bound over headings and blocks of cells
// (Olson 2009; Hess, Kohler, Rapp & Andor 2016).
//
// A pose is the centre of a cell and one of evenly spaced headings. Its score is the sum of the scores of the
// cells in which the points of the scan then lie. The greatest score within a block of cells bounds that of
// all poses in it: first all large blocks at all headings are bounded. Then, greatest bound first, blocks are
// split into quarters, and the poses of the smallest blocks scored. So the result is that of trying all
// poses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cspace/localization/scans/block_sums.hpp"
#include "cspace/maps/byte_field.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/plane.hpp"
#include "cspace/math/wrapping.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::localization {

struct FoundPose {
    double x, y, theta;  // [m], [rad] in (−π, π]
    double score;        // mean of the scores of the points, 0 … 1
};

struct MapSearchRule {
    int most = 3;                           // modes
    double least_score = 0.5;               // of a mode
    double margin = 0.25;                   // by which the score of a mode may be below that of the best
    int headings = 360;                     // all around
    double apart = 1, apart_heading = 0.5;  // two modes differ more in one of them [m], [rad]
    // Blocks times headings up to which the first blocks are not made larger: 64 MB of bounds.
    std::int64_t most_blocks = std::int64_t(1) << 25;
};

namespace map_search {

// The smallest blocks have 2³ cells along a side; so have the first ones, which on large maps are larger.
inline constexpr int finest = 3;
static_assert(1 << finest == block_side);
// For each cell the greatest score in the square of 2^level cells along a side of which it is the lowest and
// leftmost one; and a margin around the grid.
struct MaxImage {
    int margin = 0, stride = 0, rows = 0;
    std::vector<std::uint8_t> values;

    // Where a square of so many cells along a side begins: that nearest one inside whose values are the same.
    std::int64_t place(int row, int column, int side = 1) const {
        const int up = std::clamp(row + margin, 0, rows - side);
        return std::int64_t(up) * stride + std::clamp(column + margin, 0, stride - side);
    }
    std::uint8_t at(int row, int column) const { return values[std::size_t(place(row, column))]; }
};

// The scores themselves, with a margin.
inline MaxImage make_image(const maps::ByteField& field, int margin) {
    MaxImage made{margin, field.columns + 2 * margin, field.rows + 2 * margin, {}};
    made.values =
        filled_vector<std::uint8_t>(std::size_t(made.rows) * std::size_t(made.stride), field.outside);
    InterruptPoll poll(64);
    for (int row = 0; row < field.rows; ++row) {
        poll.step();
        const std::uint8_t* from = field.scores.data() + std::size_t(row) * std::size_t(field.columns);
        std::copy_n(from, field.columns,
                    made.values.begin() + std::ptrdiff_t(row + margin) * made.stride + margin);
    }
    return made;
}

// From squares of half the side.
inline MaxImage widen_image(const MaxImage& image, int half) {
    MaxImage made{image.margin, image.stride, image.rows, filled_vector<std::uint8_t>(image.values.size())};
    std::vector<std::uint8_t> both(std::size_t(image.stride) + std::size_t(half));
    InterruptPoll poll(64);
    for (int row = 0; row < image.rows; ++row) {
        poll.step();
        const std::uint8_t* low = image.values.data() + std::size_t(row) * std::size_t(image.stride);
        const std::uint8_t* high = image.values.data() + std::size_t(std::min(row + half, image.rows - 1)) *
                                                             std::size_t(image.stride);
        std::uint8_t* into = made.values.data() + std::size_t(row) * std::size_t(image.stride);
        for (int k = 0; k < image.stride; ++k) both[std::size_t(k)] = std::max(low[k], high[k]);
        std::fill(both.end() - half, both.end(), both[std::size_t(image.stride) - 1]);
        for (int k = 0; k < image.stride; ++k)
            into[k] = std::max(both[std::size_t(k)], both[std::size_t(k + half)]);
    }
    return made;
}

// Where a search may look for poses: for each level which blocks contain an allowed cell.
class AllowedBlocks {
  public:
    AllowedBlocks(std::span<const std::uint8_t> cells, int rows, int columns, int levels) {
        if (cells.empty()) return;
        levels_.push_back({rows, columns, {cells.begin(), cells.end()}});
        for (int k = 0; k < levels; ++k) {
            const Level& fine = levels_.back();
            Level made{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
            made.cells.resize(std::size_t(made.rows) * std::size_t(made.columns));
            InterruptPoll poll(64);
            for (int row = 0; row < fine.rows; ++row) {
                poll.step();
                for (int column = 0; column < fine.columns; ++column)
                    if (fine.at(row, column))
                        made.cells[std::size_t(row / 2) * std::size_t(made.columns) +
                                   std::size_t(column / 2)] = 1;
            }
            levels_.push_back(std::move(made));
        }
    }
    // Of a block whose lowest and leftmost cell is given.
    bool has(int level, int row, int column) const {
        return levels_.empty() || levels_[std::size_t(level)].at(row >> level, column >> level);
    }

  private:
    struct Level {
        int rows, columns;
        std::vector<std::uint8_t> cells;
        bool at(int row, int column) const {
            return cells[std::size_t(row) * std::size_t(columns) + std::size_t(column)] != 0;
        }
    };
    std::vector<Level> levels_;
};

// The image of the coarsest level, its scores reduced to five bits and rounded up, sorted by the remainders
// of row and column: what a beam reads for all blocks of a row lies side by side.
class BlockImage {
  public:
    BlockImage(const MaxImage& image, int level, int rows, int columns, std::uint8_t outside)
        : level_(level),
          rows_((rows + side() - 1) / side()),
          columns_((columns + side() - 1) / side()),
          width_((columns_ + block_lanes - 1) / block_lanes * block_lanes),
          stride_(3 * std::int64_t(width_)),
          outside_(std::size_t(width_), reduce(outside)) {
        values_ = filled_vector<std::uint8_t>(
            std::size_t(side()) * std::size_t(side()) * std::size_t(rows_ + 1) * std::size_t(stride_),
            reduce(outside));
        InterruptPoll poll(8);
        for (int row = -side(); row < side() * rows_; ++row) {
            poll.step();
            for (int column = -side(); column < side() * columns_; ++column)
                values_[std::size_t(plane(row, column) + ((row >> level_) + 1) * stride_ + width_ +
                                    (column >> level_))] = reduce(image.at(row, column));
        }
    }

    int rows() const { return rows_; }
    int columns() const { return columns_; }
    int width() const { return width_; }  // columns, rounded up to lanes
    PlaneRows planes() const { return {stride_, rows_ + 1, outside_.data()}; }
    int outside() const { return outside_.front(); }

    // What a beam reads that ends so many rows and columns from the base.
    BeamRows rows_of(int row, int column) const {
        const int along = column >> level_;
        if (along > columns_ || along < -columns_) return outside_rows();
        return {values_.data() + plane(row, column) + (width_ + along), (row >> level_) + 1};
    }
    BeamRows outside_rows() const { return {outside_.data(), std::numeric_limits<std::int32_t>::min() / 2}; }

  private:
    int side() const { return 1 << level_; }
    static std::uint8_t reduce(std::uint8_t score) {
        return std::uint8_t((score * most_block_score + 254) / 255);
    }
    // Where the plane of a row and a column begins.
    std::int64_t plane(int row, int column) const {
        const int down = row & (side() - 1), beside = column & (side() - 1);
        return (std::int64_t(down) * side() + beside) * (rows_ + 1) * stride_;
    }

    int level_, rows_, columns_, width_;
    std::int64_t stride_;
    std::vector<std::uint8_t> outside_, values_;
};

// The cells in which the points of a scan lie at a heading, from that of the base.
struct Offset {
    std::int32_t row, column;
};

// A block of poses: all with one heading whose bases lie in a square of 2^level cells along a side. Of level
// 0: the best pose of a smallest block, but for those too near to modes found.
struct Block {
    std::int32_t score;  // no pose in it has a greater one
    std::int32_t level, heading, row, column;

    // Which is looked at first: that of the greater score, then of the larger blocks, then of the earlier
    // heading, row and column.
    friend bool operator<(const Block& a, const Block& b) {
        if (a.score != b.score) return a.score > b.score;
        if (a.level != b.level) return a.level > b.level;
        if (a.heading != b.heading) return a.heading < b.heading;
        return a.row != b.row ? a.row < b.row : a.column < b.column;
    }
};

}  // namespace map_search

// The sums as headers; the library has kernels that do the same.
struct HeaderSums {
    static void blocks(const BeamRows* beams, int count, const PlaneRows& planes, int rows, int columns,
                       std::uint16_t* sums) {
        sum_blocks(beams, count, planes, rows, columns, sums);
    }
    static void cells(const std::uint8_t* scores, const std::int64_t* at, int beams, std::int64_t stride,
                      std::uint16_t* sums) {
        sum_cells(scores, at, beams, stride, sums);
    }
};

template <class BeamSums = HeaderSums>
class MapSearch {
  public:
    // allowed: a byte per cell, 0 where no base may be; or none.
    MapSearch(const maps::ByteField& field, std::span<const std::uint8_t> allowed,
              std::span<const Point> points, const MapSearchRule& rule)
        : field_(field),
          points_(points),
          rule_(rule),
          whole_(255.0 * double(points.size())),
          level_(choose_level()),
          allowed_(allowed, field.rows, field.columns, level_),
          at_(points.size()) {
        images_.push_back(map_search::make_image(field, 1 << level_));
        for (int k = 0; k < level_; ++k) {
            images_.push_back(map_search::widen_image(images_.back(), 1 << k));
            if (k > 0 && k < map_search::finest) images_[std::size_t(k)] = {};
        }
        least_ = int(std::ceil(rule.least_score * whole_ - rounding));
    }

    // The best pose, then the best of those apart from it, and so on. Among equal scores the one of the first
    // heading, row and column comes first.
    std::vector<FoundPose> find() {
        find_offsets();
        bound_blocks();
        int limit = int(whole_) + 1;
        while (int(modes_.size()) < rule_.most) {
            while (queue_.empty() || queue_.top().score < limit)
                if (!add_blocks(limit)) break;
            if (queue_.empty()) break;
            const Block block = queue_.pop();
            poll_.step();
            if (block.level > map_search::finest && !is_near_mode(block))
                split(block);
            else if (block.level == map_search::finest && !is_near_mode(block))
                score_poses(block);
            else if (block.level == 0)
                take(block);
        }
        return modes_;
    }
    std::int64_t scored() const { return scored_; }  // blocks whose poses were scored

  private:
    using Block = map_search::Block;
    using Offset = map_search::Offset;
    static constexpr std::int64_t growth = 4;  // of the batches
    static constexpr double rounding = 1e-9;   // of a least score that is a whole number of scores

    const maps::ByteField& field_;
    const std::span<const Point> points_;
    const MapSearchRule rule_;
    const double whole_;  // the greatest sum of scores
    const int level_;
    const map_search::AllowedBlocks allowed_;
    std::vector<map_search::MaxImage> images_;  // by level
    std::vector<Offset> offsets_;               // by heading · points + point
    std::vector<std::uint16_t> sums_;           // reduced bounds, by (heading · rows + row) · width + column
    std::vector<std::int64_t> counts_;          // of blocks by reduced bound
    int rows_ = 0, columns_ = 0, width_ = 0;    // of blocks
    int least_ = 0;
    cspace::search::Heap<Block> queue_;
    std::int64_t batch_ = 4096;  // blocks that are put into the queue at once
    InterruptPoll poll_{32};
    std::int64_t scored_ = 0;
    std::vector<FoundPose> modes_;
    std::vector<std::int64_t> at_;  // of each point: where the cells of a block are in the image

    int choose_level() const {
        int level = map_search::finest;
        const auto blocks = [&](int k) {
            return std::int64_t((field_.rows >> k) + 1) * ((field_.columns >> k) + 1) * rule_.headings;
        };
        while (blocks(level) > rule_.most_blocks) ++level;
        return level;
    }
    double heading(int k) const { return wrap_once(2 * pi * k / rule_.headings); }
    std::span<const Offset> offsets(int k) const {
        return std::span(offsets_).subspan(std::size_t(k) * points_.size(), points_.size());
    }
    void find_offsets() {
        offsets_.reserve(points_.size() * std::size_t(rule_.headings));
        InterruptPoll poll(32);
        for (int k = 0; k < rule_.headings; ++k) {
            poll.step();
            const double c = std::cos(heading(k)) / field_.frame.resolution;
            const double s = std::sin(heading(k)) / field_.frame.resolution;
            for (const Point p : points_)
                offsets_.push_back({std::int32_t(std::floor(s * p.x + c * p.y + 0.5)),
                                    std::int32_t(std::floor(c * p.x - s * p.y + 0.5))});
        }
    }

    // The reduced bounds of all blocks of the coarsest level.
    void bound_blocks() {
        const map_search::BlockImage image(images_.back(), level_, field_.rows, field_.columns,
                                           field_.outside);
        rows_ = image.rows(), columns_ = image.columns(), width_ = image.width();
        const std::size_t size = std::size_t(rows_) * std::size_t(width_);
        sums_ = filled_vector<std::uint16_t>(size * std::size_t(rule_.headings));
        const std::size_t count = points_.size();
        std::vector<BeamRows> beams((count + beams_at_once - 1) / beams_at_once * beams_at_once,
                                    image.outside_rows());
        const int fill = int(beams.size() - count) * image.outside();
        counts_.assign(std::size_t(most_block_score) * beams.size() + 1, 0);
        for (int k = 0; k < rule_.headings; ++k) {
            poll_interrupts();
            const std::span<const Offset> at = offsets(k);
            for (std::size_t i = 0; i < count; ++i) beams[i] = image.rows_of(at[i].row, at[i].column);
            std::uint16_t* sums = sums_.data() + std::size_t(k) * size;
            BeamSums::blocks(beams.data(), int(beams.size()), image.planes(), rows_, width_, sums);
            for (int row = 0; row < rows_; ++row, sums += width_)
                for (int column = 0; column < columns_; ++column) {
                    sums[column] = std::uint16_t(sums[column] - fill);
                    ++counts_[sums[column]];
                }
        }
    }
    static int full(int reduced) { return reduced * 255 / most_block_score; }

    // Puts the next blocks into the queue, those whose bounds are below a limit and not below the next one,
    // which becomes the limit; false if there are none.
    bool add_blocks(int& limit) {
        int high = int(counts_.size());
        while (high > 0 && full(high - 1) >= limit) --high;
        if (high == 0 || limit <= least_) return limit = 0, false;
        int low = high;
        for (std::int64_t count = 0; low > 0 && count < batch_;) count += counts_[std::size_t(--low)];
        batch_ *= growth;
        const std::uint16_t* sums = sums_.data();
        for (int k = 0; k < rule_.headings; ++k) {
            poll_interrupts();
            for (int row = 0; row < rows_; ++row, sums += width_)
                for (int column = 0; column < columns_; ++column)
                    if (sums[column] >= low && sums[column] < high)
                        add({full(sums[column]), level_, k, row << level_, column << level_});
        }
        limit = full(low);
        return true;
    }
    void add(const Block& block) {
        if (block.score >= least_ && allowed_.has(block.level, block.row, block.column)) queue_.push(block);
    }
    // Its quarters.
    void split(const Block& block) {
        const int level = block.level - 1, half = 1 << level;
        const map_search::MaxImage& image = images_[std::size_t(level)];
        for (int k = 0; k < 4; ++k) {
            const int row = block.row + (k / 2) * half, column = block.column + (k % 2) * half;
            if (row >= field_.rows || column >= field_.columns || !allowed_.has(level, row, column)) continue;
            std::int32_t sum = 0;
            for (const Offset at : offsets(block.heading)) sum += image.at(row + at.row, column + at.column);
            add({std::min(sum, block.score), level, block.heading, row, column});
        }
    }
    // The best pose of a smallest block that is not too near to a mode.
    void score_poses(const Block& block) {
        ++scored_;
        std::int32_t sums[block_side * block_side] = {};
        sum_poses(block, sums);
        Block best{least_ - 1, 0, block.heading, 0, 0};
        const int rows = std::min(block_side, field_.rows - block.row);
        const int columns = std::min(block_side, field_.columns - block.column);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const Block pose{sums[i * block_side + j], 0, block.heading, block.row + i, block.column + j};
                if (pose.score > best.score && allowed_.has(0, pose.row, pose.column) && !is_near_mode(pose))
                    best = pose;
            }
        add(best);
    }
    void sum_poses(const Block& block, std::int32_t* sums) {
        const map_search::MaxImage& image = images_[0];
        const std::span<const Offset> offsets = this->offsets(block.heading);
        for (std::size_t k = 0; k < at_.size(); ++k)
            at_[k] = image.place(block.row + offsets[k].row, block.column + offsets[k].column, block_side);
        for (std::size_t first = 0; first < at_.size(); first += most_cell_beams) {
            const std::size_t count = std::min(at_.size() - first, std::size_t(most_cell_beams));
            std::uint16_t part[block_side * block_side];
            BeamSums::cells(image.values.data(), at_.data() + first, int(count), image.stride, part);
            for (int k = 0; k < block_side * block_side; ++k) sums[k] += part[k];
        }
    }
    // The best pose that is left is a mode, unless one was found near it since it was scored.
    void take(const Block& pose) {
        if (modes_.empty())
            least_ = std::max(least_, int(std::ceil(pose.score - rule_.margin * whole_ - rounding)));
        if (!is_near_mode(pose)) modes_.push_back(mode_of(pose));
        constexpr int aligned = ~(block_side - 1);
        score_poses(
            {pose.score, map_search::finest, pose.heading, pose.row & aligned, pose.column & aligned});
    }
    FoundPose mode_of(const Block& block) const {
        const Point at = field_.frame.center({block.row, block.column});
        return {at.x, at.y, heading(block.heading), block.score / whole_};
    }
    // Whether all poses of a block are too near to one found.
    bool is_near_mode(const Block& block) const {
        const int last = (1 << block.level) - 1;
        return std::any_of(modes_.begin(), modes_.end(), [&](const FoundPose& mode) {
            if (std::abs(short_way(heading(block.heading) - mode.theta)) > rule_.apart_heading) return false;
            double far = 0;
            for (int k = 0; k < 4; ++k)
                far = std::max(
                    far, distance({mode.x, mode.y}, field_.frame.center({block.row + (k / 2) * last,
                                                                         block.column + (k % 2) * last})));
            return far <= rule_.apart;
        });
    }
};

}  // namespace cspace::localization
