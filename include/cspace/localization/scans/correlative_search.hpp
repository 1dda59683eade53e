// Correlative scan matching (Olson 2009): the score of every translation and rotation in a window, and what
// its surface tells: the best pose, its covariance, and whether another peak is as good.
//
// The score of a pose is the mean of the field at the ends of the beams. Small windows are scored whole. In
// large ones blocks of 4 × 4 translations are bounded by the field pooled over such blocks, and scored in the
// order of their bounds until none can be better: the same answer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "cspace/localization/scans/padded_field.hpp"
#include "cspace/localization/scans/scan_field.hpp"
#include "cspace/localization/scans/window_sums.hpp"

namespace cspace::localization {

inline constexpr int most_beams = 256;  // of a scan in a search

// Half the sides of the window of poses that are tried.
struct SearchWindow {
    double reach = 0.8;  // [m]
    double turn = 0.26;  // [rad]
};
// How much of the score is lost with the square of the distance from the guess.
struct SearchPrior {
    double place = 0;  // [1/m²]
    double turn = 0;   // [1/rad²]
};

struct SearchPeak {
    bool is_found = false;      // false: no pose scores as much as asked
    bool is_ambiguous = false;  // another peak scores nearly as much
    bool is_clipped = false;    // the pose lies at the edge of the window: it need not be a peak
    PlanarSpace::Pose pose;
    double score = 0;                  // 0 to 1
    double second = 0;                 // the best score outside of the peak, as far as it was asked for
    PlanarSpace::Square covariance{};  // of the twist in base
};

namespace search {

// Beams do not err independently: walls bend, and neighbours hit the same ones. Beside the prior the score
// counts as that of so many beams.
inline constexpr double independent_beams = 25;
// In the covariance it counts as that of so many: the bells of the field are several times as wide as the
// scatter of the beams.
inline constexpr double covariance_beams = 250;
inline constexpr double ambiguous_share = 0.95;                            // of the best score
inline constexpr double apart = 0.3;                                       // [m]: nearer peaks are one
inline constexpr double apart_turn = 0.1;                                  // [rad]
inline constexpr double least_turn_step = 0.004, most_turn_step = 0.0175;  // [rad]
inline constexpr double most_whole = 1.5e5;                       // cells of a window that is scored whole
inline constexpr double most_cells = 1e9;                         // of any window: a byte each marks peaks
inline constexpr double covered_reach = 0.4, covered_turn = 0.1;  // for the covariance in large windows
inline constexpr double least_log_weight = -7;                    // of a cell that counts in the covariance

}  // namespace search

template <class Kernels>
class CorrelativeSearch {
  public:
    using Pose = PlanarSpace::Pose;

    // points: in base, at most most_beams. least_score: of a pose that is found. finds_second: also where a
    // second peak is far below the first.
    SearchPeak find_peak(const maps::ByteField& field, std::span<const Point> points, const Pose& guess,
                         const SearchWindow& window, const SearchPrior& prior = {}, double least_score = 0,
                         bool finds_second = false) {
        SearchPeak peak;
        if (points.empty()) return peak;
        points_ = points.first(std::min(points.size(), std::size_t(most_beams)));
        guess_ = guess;
        full_ = double(full_score) * double(points_.size());
        least_ = std::max(1, int(std::ceil(least_score * full_)));
        lay_steps(field.frame.resolution, window, prior);
        const bool is_whole = double(angles()) * side() * side() <= search::most_whole;
        const bool is_found = is_whole ? search_whole(field) : search_blocks(field);
        if (!is_found) return peak;
        find_component();
        find_second(is_whole, finds_second);
        peak.is_found = true;
        peak.is_clipped = std::max(std::abs(best_.row), std::abs(best_.column)) == most_shift_ ||
                          std::abs(best_.angle) == most_angle_;
        peak.pose = pose_of(best_);
        peak.score = best_.sum / full_;
        peak.second = std::max(0, second_) / full_;
        peak.is_ambiguous = second_ >= search::ambiguous_share * best_.score;
        if (!is_whole) cover_peak(field, peak.pose);
        peak.covariance = measure_covariance();
        return peak;
    }

    double turn_step() const { return turn_step_; }

  private:
    // A translation and a rotation, in steps from the guess, and its score less the prior.
    struct Cell {
        int score, sum, angle, row, column;
    };
    // Translations of one angle that begin at a cell, and the bound of their scores.
    struct Block {
        int bound, angle, row, column;
    };

    int angles() const { return 2 * most_angle_ + 1; }
    int side() const { return 2 * most_shift_ + 1; }

    void lay_steps(double resolution, const SearchWindow& window, const SearchPrior& prior) {
        resolution_ = resolution;
        double squares = 0;
        for (const Point p : points_) squares += squared_norm(p), reach_ = 0;
        for (const Point p : points_) reach_ = std::max(reach_, norm(p));
        const double spread = std::sqrt(squares / double(points_.size()));
        turn_step_ = std::clamp(resolution / std::max(spread, resolution), search::least_turn_step,
                                search::most_turn_step);
        most_angle_ = int(std::ceil(window.turn / turn_step_ - rounding));
        const double shifted = std::ceil(window.reach / resolution - rounding);
        if (!((2 * most_angle_ + 1) * (2 * shifted + 1) * (2 * shifted + 1) < search::most_cells))
            throw std::length_error("the window has too many poses");
        most_shift_ = int(shifted);
        const double shifts = most_shift_ * resolution * std::sqrt(2.0);
        reach_ += shifts + 2 * resolution;
        shift_loss_ = prior.place * resolution * resolution * full_;
        turn_loss_ = prior.turn * turn_step_ * turn_step_ * full_;
    }
    int loss_of(int angle, int row, int column) const {
        return int(shift_loss_ * (row * row + column * column) + turn_loss_ * angle * angle);
    }
    // The order of cells: by score, then by nearness to the guess. What is still equal is told apart in the
    // frame of the guess, so that turned problems have turned answers.
    bool is_better(const Cell& a, const Cell& b) const {
        if (a.score != b.score) return a.score > b.score;
        const int near_a = a.row * a.row + a.column * a.column, near_b = b.row * b.row + b.column * b.column;
        if (near_a != near_b) return near_a < near_b;
        if (std::abs(a.angle) != std::abs(b.angle)) return std::abs(a.angle) < std::abs(b.angle);
        if (a.angle != b.angle) return a.angle > b.angle;
        const double row = a.row - b.row, column = a.column - b.column;
        const double along = guess_.c * column + guess_.s * row;
        constexpr double same = 1e-9;  // steps
        return std::fabs(along) > same ? along > 0 : guess_.c * row - guess_.s * column > 0;
    }
    Pose pose_of(const Cell& cell) const {
        const double turn = cell.angle * turn_step_, c = std::cos(turn), s = std::sin(turn);
        return {guess_.x + cell.column * resolution_, guess_.y + cell.row * resolution_,
                guess_.c * c - guess_.s * s, guess_.s * c + guess_.c * s};
    }

    // Where the windows of all beams begin at an angle, as rows and columns of the padded field.
    void place_windows(int angle) {
        const Pose turned = pose_of({0, 0, angle, 0, 0});
        const Point origin = padded_.origin;
        const double scale = 1 / resolution_;
        starts_.resize(points_.size());
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const Point p = place_point(turned, points_[k]);
            const double across = (p.x - origin.x) * scale - most_shift_;
            const double up = (p.y - origin.y) * scale - most_shift_;
            starts_[k] = {int(std::clamp(up, 0.0, double(padded_.last_row))),
                          int(std::clamp(across, 0.0, double(padded_.last_column)))};
        }
    }

    bool search_whole(const maps::ByteField& field) {
        const int width = padded_columns(side());
        padded_.copy_part(field, {guess_.x, guess_.y}, reach_, round_block(side()), width);
        const std::size_t surface = std::size_t(side() * width);
        sums_.resize(std::size_t(angles()) * surface);
        greatest_.resize(std::size_t(angles()));
        offsets_.resize(points_.size());
        for (int angle = 0; angle < angles(); ++angle) {
            place_windows(angle - most_angle_);
            for (std::size_t k = 0; k < starts_.size(); ++k)
                offsets_[k] = starts_[k].row * padded_.stride + starts_[k].column;
            greatest_[std::size_t(angle)] = Kernels::sum_windows(
                padded_.bytes.data(), offsets_.data(), int(offsets_.size()), padded_.stride, side(), side(),
                sums_.data() + std::size_t(angle) * surface);
            poll_interrupts();
        }
        best_ = {least_ - 1, 0, 0, 0, 0};
        visit_surface([&] { return best_.score; },
                      [&](const Cell& cell) {
                          if (cell.score >= least_ && is_better(cell, best_)) best_ = cell;
                      });
        if (best_.score < least_) return false;
        high_.clear();
        const int high = int(std::ceil(search::ambiguous_share * best_.score));
        visit_surface([&] { return high; }, [&](const Cell& cell) { high_.push_back(cell); });
        return true;
    }
    // visit(cell) for the cells of a surface that was scored whole with at least a score, angle by angle.
    template <class Least, class Visit>
    void visit_surface(const Least& least, const Visit& visit) const {
        const int width = padded_columns(side());
        for (int angle = 0; angle < angles(); ++angle) {
            const int turned = angle - most_angle_;
            if (greatest_[std::size_t(angle)] - loss_of(turned, 0, 0) < least()) continue;
            const std::uint16_t* row_sums = sums_.data() + std::size_t(angle) * std::size_t(side() * width);
            for (int row = 0; row < side(); ++row, row_sums += width) {
                const int needed = least() + loss_of(turned, row - most_shift_, 0);
                for (int column = 0; column < side(); ++column) {
                    const int sum = row_sums[column];
                    if (sum < needed) continue;
                    const int score = sum - loss_of(turned, row - most_shift_, column - most_shift_);
                    if (score >= least())
                        visit(Cell{score, sum, turned, row - most_shift_, column - most_shift_});
                }
            }
        }
    }

    bool search_blocks(const maps::ByteField& field) {
        constexpr int block = PaddedField::block;
        const int blocks = (side() + block - 1) / block, width = padded_columns(blocks);
        padded_.copy_part(field, {guess_.x, guess_.y}, reach_, blocks * block, width * block);
        padded_.pool_blocks();
        sums_.resize(std::size_t(blocks * width));
        all_starts_.clear(), blocks_.clear();
        offsets_.resize(points_.size());
        for (int angle = -most_angle_; angle <= most_angle_; ++angle) {
            place_windows(angle);
            for (std::size_t k = 0; k < starts_.size(); ++k) {
                offsets_[k] = padded_.pooled_at(starts_[k].row, starts_[k].column);
                all_starts_.push_back(starts_[k].row * padded_.stride + starts_[k].column);
            }
            Kernels::sum_windows(padded_.pooled.data(), offsets_.data(), int(offsets_.size()),
                                 padded_.pooled_stride(), blocks, blocks, sums_.data());
            for (int row = 0; row < blocks; ++row) {
                for (int column = 0; column < blocks; ++column) {
                    const Block made{sums_[std::size_t(row * width + column)], angle,
                                     row * block - most_shift_, column * block - most_shift_};
                    const int bound =
                        made.bound - loss_of(angle, nearest_zero(made.row), nearest_zero(made.column));
                    if (bound >= least_) blocks_.push_back({bound, angle, made.row, made.column});
                }
            }
            poll_interrupts();
        }
        std::sort(blocks_.begin(), blocks_.end(), [](const Block& a, const Block& b) {
            if (a.bound != b.bound) return a.bound > b.bound;
            if (a.angle != b.angle) return a.angle < b.angle;
            return a.row != b.row ? a.row < b.row : a.column < b.column;
        });
        best_ = {least_ - 1, 0, 0, 0, 0};
        scored_.clear(), next_block_ = 0;
        InterruptPoll poll(1 << 5);
        for (; next_block_ < blocks_.size(); ++next_block_) {
            const Block& next = blocks_[next_block_];
            if (next.bound < search::ambiguous_share * best_.score) break;
            score_block(next, [&](const Cell& cell) {
                scored_.push_back(cell);
                if (cell.score >= least_ && is_better(cell, best_)) best_ = cell;
            });
            poll.step();
        }
        if (best_.score < least_) return false;
        high_.clear();
        for (const Cell& cell : scored_)
            if (cell.score >= search::ambiguous_share * best_.score) high_.push_back(cell);
        return true;
    }
    static int nearest_zero(int first) { return std::clamp(0, first, first + PaddedField::block - 1); }
    template <class Visit>
    void score_block(const Block& made, const Visit& visit) const {
        constexpr int block = PaddedField::block;
        std::uint16_t sums[block * window_lanes];
        const std::int32_t* const starts =
            all_starts_.data() + std::size_t(made.angle + most_angle_) * points_.size();
        const int shift = (made.row + most_shift_) * padded_.stride + made.column + most_shift_;
        Kernels::sum_windows(padded_.bytes.data() + shift, starts, int(points_.size()), padded_.stride, block,
                             block, sums);
        for (int i = 0; i < block; ++i) {
            for (int j = 0; j < block; ++j) {
                const int row = made.row + i, column = made.column + j;
                if (row > most_shift_ || column > most_shift_) continue;
                const int sum = sums[i * window_lanes + j];
                visit(Cell{sum - loss_of(made.angle, row, column), sum, made.angle, row, column});
            }
        }
    }

    // The box about the cells that are joined to the best one by cells of nearly its score.
    void find_component() {
        mark_.assign(std::size_t(angles()) * std::size_t(side() * side()), 0);
        for (const Cell& cell : high_) mark_[index_of(cell.angle, cell.row, cell.column)] = 1;
        low_ = top_ = {best_.angle, best_.row, best_.column};
        queue_.assign(1, low_);
        mark_[index_of(best_.angle, best_.row, best_.column)] = 0;
        while (!queue_.empty()) {
            const auto at = queue_.back();
            queue_.pop_back();
            for (int k = 0; k < 27; ++k) {
                const std::array<int, 3> next{at[0] + k / 9 - 1, at[1] + k / 3 % 3 - 1, at[2] + k % 3 - 1};
                if (std::abs(next[0]) > most_angle_ || std::abs(next[1]) > most_shift_ ||
                    std::abs(next[2]) > most_shift_)
                    continue;
                char& is_new = mark_[index_of(next[0], next[1], next[2])];
                if (!is_new) continue;
                is_new = 0;
                queue_.push_back(next);
                for (std::size_t i = 0; i < 3; ++i)
                    low_[i] = std::min(low_[i], next[i]), top_[i] = std::max(top_[i], next[i]);
            }
        }
        const int turns = int(std::ceil(search::apart_turn / turn_step_));
        const int shifts = int(std::ceil(search::apart / resolution_));
        low_[0] -= turns, top_[0] += turns;
        for (std::size_t i = 1; i < 3; ++i) low_[i] -= shifts, top_[i] += shifts;
    }
    std::size_t index_of(int angle, int row, int column) const {
        const auto wide = std::size_t(side());
        return (std::size_t(angle + most_angle_) * wide + std::size_t(row + most_shift_)) * wide +
               std::size_t(column + most_shift_);
    }
    bool is_in_peak(int angle, int row, int column) const {
        return angle >= low_[0] && angle <= top_[0] && row >= low_[1] && row <= top_[1] &&
               column >= low_[2] && column <= top_[2];
    }
    void find_second(bool is_whole, bool is_exact) {
        second_ = 0;
        const auto admit = [&](const Cell& cell) {
            if (cell.score > second_ && !is_in_peak(cell.angle, cell.row, cell.column)) second_ = cell.score;
        };
        if (is_whole) {
            if (!is_exact) second_ = std::max(0, int(search::ambiguous_share * best_.score) - 1);
            visit_surface([&] { return second_ + 1; }, admit);
            return;
        }
        for (const Cell& cell : scored_) admit(cell);
        if (!is_exact) return;
        InterruptPoll poll(1 << 5);
        for (std::size_t k = next_block_; k < blocks_.size() && blocks_[k].bound > second_; ++k) {
            const Block& made = blocks_[k];
            constexpr int last = PaddedField::block - 1;
            if (is_in_peak(made.angle, made.row, made.column) &&
                is_in_peak(made.angle, made.row + last, made.column + last))
                continue;
            score_block(made, admit);
            poll.step();
        }
    }

    // Scores a small window about the peak whole.
    void cover_peak(const maps::ByteField& field, const Pose& pose) {
        const double turn = std::min(search::covered_turn, most_angle_ * turn_step_);
        const double reach = std::min(search::covered_reach, most_shift_ * resolution_);
        guess_ = pose, least_ = 1;
        lay_steps(resolution_, {reach, turn}, {});
        search_whole(field);
    }

    // The second moment of the surface about its best cell, each weighted by the likelihood that its score
    // stands for.
    PlanarSpace::Square measure_covariance() {
        const double scale = search::covariance_beams / full_;
        const int least = std::max(1, int(best_.score + search::least_log_weight / scale));
        std::array<double, 6> sums{};  // xx, xy, yy, xt, yt, tt
        std::array<double, 3> means{};
        double total = 0;
        weights_.resize(std::size_t(std::max(1, best_.score - least + 1)));
        for (std::size_t k = 0; k < weights_.size(); ++k) weights_[k] = std::exp(-double(k) * scale);
        visit_surface([&] { return least; },
                      [&](const Cell& cell) {
                          const double w = weights_[std::size_t(std::max(0, best_.score - cell.score))];
                          const double x = cell.column - best_.column, y = cell.row - best_.row,
                                       t = cell.angle - best_.angle;
                          total += w;
                          means[0] += w * x, means[1] += w * y, means[2] += w * t;
                          sums[0] += w * x * x, sums[1] += w * x * y, sums[2] += w * y * y;
                          sums[3] += w * x * t, sums[4] += w * y * t, sums[5] += w * t * t;
                      });
        constexpr double uniform = 1.0 / 12;  // the variance of a place within one cell
        const auto moment = [&](std::size_t k, std::size_t i, std::size_t j) {
            return sums[k] / total - means[i] * means[j] / (total * total);
        };
        const double r = resolution_, q = turn_step_;
        const double xx = r * r * (moment(0, 0, 0) + uniform), xy = r * r * moment(1, 0, 1);
        const double yy = r * r * (moment(2, 1, 1) + uniform), tt = q * q * (moment(5, 2, 2) + uniform);
        const double xt = r * q * moment(3, 0, 2), yt = r * q * moment(4, 1, 2);
        const Pose pose = pose_of(best_);
        const double c = pose.c, s = pose.s;
        const double bxx = c * c * xx + 2 * c * s * xy + s * s * yy;
        const double byy = s * s * xx - 2 * c * s * xy + c * c * yy;
        const double bxy = c * s * (yy - xx) + (c * c - s * s) * xy;
        const double bxt = c * xt + s * yt, byt = c * yt - s * xt;
        return {bxx, bxy, bxt, bxy, byy, byt, bxt, byt, tt};
    }

    static int round_block(int count) {
        return (count + PaddedField::block - 1) / PaddedField::block * PaddedField::block;
    }
    static constexpr double rounding = 1e-9;  // steps: a window of whole steps has just so many

    struct Start {
        int row, column;
    };
    std::span<const Point> points_;
    Pose guess_;
    double full_ = 1, resolution_ = 1, turn_step_ = 0.01, reach_ = 0, shift_loss_ = 0, turn_loss_ = 0;
    int least_ = 1, most_angle_ = 0, most_shift_ = 0, second_ = 0;
    Cell best_{};
    PaddedField padded_;
    std::vector<Start> starts_;
    std::vector<std::int32_t> offsets_, all_starts_;
    std::vector<std::uint16_t> sums_;
    std::vector<int> greatest_;
    std::vector<Block> blocks_;
    std::size_t next_block_ = 0;
    std::vector<Cell> high_, scored_;
    std::vector<char> mark_;
    std::vector<std::array<int, 3>> queue_;
    std::array<int, 3> low_{}, top_{};
    std::vector<double> weights_;
};

}  // namespace cspace::localization
