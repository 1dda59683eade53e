// The covariance of a pose and of all landmarks, in axes of the map: x, y, θ, then x, y of each landmark.
//
// Three parts: that of the pose, the three columns of the pose against all landmarks, and the landmarks in
// panels. A prediction touches the first two; an update adds a product of low rank to all of them. Products
// with the panels are put off until there are enough for a kernel; until then readers add them to the numbers
// they read. The kernel may be interrupted: what is left of it is done before anything else.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "cspace/localization/landmarks/covariance_panels.hpp"
#include "cspace/localization/landmarks/range_bearing.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::localization {

using Vector3 = std::array<double, 3>;

// The kernels of the headers alone.
struct HeaderPanels {
    static void add(double* panels, int first, int last, const double* X, const double* Y,
                    std::ptrdiff_t stride, int rank) {
        add_products(panels, first, last, X, Y, stride, rank);
    }
    static void add_weighted(double* const* to, int count, const WeightedVectors& from) {
        localization::add_weighted(to, count, from);
    }
};

// P += Σ X_k Y_kᵀ with a symmetric sum: the parts of the landmarks of each vector, those before `first` of
// earlier updates, and the parts of the pose.
struct LowRank {
    int first = 0, rank = 0;
    std::size_t stride = 0;
    std::vector<Vector3> pose_x, pose_y;
    std::vector<double> x, y;

    int all() const { return first + rank; }
    void reset(std::size_t padded) {
        first = rank = 0, stride = padded, pose_x.clear(), pose_y.clear(), x.clear(), y.clear();
    }
    void begin() { first += rank, rank = 0, pose_x.clear(), pose_y.clear(); }
    // Room for one more pair of vectors, filled with zeros.
    void append() {
        ++rank;
        pose_x.emplace_back(), pose_y.emplace_back();
        x.resize(std::size_t(all()) * stride), y.resize(x.size());
    }
    double* x_of(int k) { return x.data() + std::size_t(first + k) * stride; }
    double* y_of(int k) { return y.data() + std::size_t(first + k) * stride; }
};

template <class Kernel>
class JointCovariance {
  public:
    int landmarks() const { return landmarks_; }
    // The length of vectors over all landmarks: twice their number, up to a multiple of four.
    std::size_t padded() const { return cross_[0].size(); }

    std::array<double, 9>& pose() { return pose_; }
    const std::array<double, 9>& pose() const { return pose_; }
    // The covariances of x, y or θ with all landmarks.
    std::vector<double>& cross(std::size_t k) { return cross_[k]; }
    const std::vector<double>& cross(std::size_t k) const { return cross_[k]; }

    // The block of landmarks i and j, row by row.
    Matrix2 block(int i, int j) const {
        if (i < j) {
            const Matrix2 other = block(j, i);
            return {other[0], other[2], other[1], other[3]};
        }
        const double* at = panels_.data() + entry(2 * i, 2 * j);
        Matrix2 found{at[0], at[panel_rows], at[1], at[panel_rows + 1]};
        const double* x = change_.x.data() + 2 * i;
        const double* y = change_.y.data() + 2 * j;
        for (int k = 0; k < change_.all(); ++k, x += change_.stride, y += change_.stride) {
            found[0] += x[0] * y[0], found[1] += x[0] * y[1];
            found[2] += x[1] * y[0], found[3] += x[1] * y[1];
        }
        return found;
    }

    // The two columns of a landmark, of padded() numbers each.
    void copy_columns(int j, double* first, double* second) const {
        const std::size_t own = std::size_t(j) / 2, size = padded() / panel_rows;
        const double* row = panels_.data() + panel_offset(own) + 2 * (std::size_t(j) % 2);
        for (std::size_t c = 0; c < panel_rows * own; ++c)
            first[c] = row[panel_rows * c], second[c] = row[panel_rows * c + 1];
        for (std::size_t p = own; p < size; ++p) {
            const double* from = panels_.data() + panel_offset(p) + panel_rows * std::size_t(2 * j);
            for (std::size_t r = 0; r < panel_rows; ++r)
                first[panel_rows * p + r] = from[r], second[panel_rows * p + r] = from[panel_rows + r];
        }
        const auto stride = std::ptrdiff_t(change_.stride);
        double* const columns[] = {first, second};
        Kernel::add_weighted(columns, 2,
                             {change_.x.data(), stride, change_.all(), change_.y.data() + 2 * j, stride});
    }

    // The pose moves: every error gains b times that of the heading, and the noise in axes of the map.
    void move_pose(Vector2 b, const std::array<double, 9>& noise) {
        auto& P = pose_;
        const double turn = P[8];
        const Vector2 with{P[2], P[5]};
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 0; j < 2; ++j)
                P[3 * i + j] += b[i] * with[j] + with[i] * b[j] + b[i] * turn * b[j];
            P[3 * i + 2] = P[6 + i] = with[i] + b[i] * turn;
        }
        for (std::size_t k = 0; k < 9; ++k) P[k] += noise[k];
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t c = 0; c < padded(); ++c) cross_[i][c] += b[i] * cross_[2][c];
        }
    }
    // A landmark seen from the pose: δl = δp + J arm δθ + n, with the covariance of n.
    void add_landmark(Vector2 arm, const Symmetric2& noise) {
        apply_pending();
        const int j = landmarks_++;
        if (j % 2 == 0) {
            for (auto& column : cross_) column.resize(column.size() + panel_rows);
            panels_.resize(panel_offset(padded() / panel_rows));
        }
        const std::size_t first = std::size_t(2 * j);
        const Vector2 lever{-arm[1], arm[0]};
        for (std::size_t k = 0; k < 2; ++k) {
            for (std::size_t c = 0; c < first; ++c)
                set_entry(first + k, c, cross_[k][c] + lever[k] * cross_[2][c]);
            for (std::size_t c = 0; c < 3; ++c)
                cross_[c][first + k] = pose_[3 * k + c] + lever[k] * pose_[6 + c];
        }
        const double xx = cross_[0][first] + lever[0] * cross_[2][first] + noise[0];
        const double xy = cross_[1][first] + lever[1] * cross_[2][first] + noise[1];
        const double yy = cross_[1][first + 1] + lever[1] * cross_[2][first + 1] + noise[2];
        set_entry(first, first, xx), set_entry(first + 1, first + 1, yy);
        set_entry(first + 1, first, xy), set_entry(first, first + 1, xy);
    }
    // The last landmark takes the place of this one.
    void remove_landmark(int j) {
        apply_pending();
        const int last = landmarks_ - 1;
        if (j < last) {
            std::vector<double> first(padded()), second(padded());
            copy_columns(last, first.data(), second.data());
            const std::size_t to = std::size_t(2 * j), from = std::size_t(2 * last);
            for (auto& column : cross_) column[to] = column[from], column[to + 1] = column[from + 1];
            first[to] = first[from], first[to + 1] = first[from + 1];
            second[to] = second[from], second[to + 1] = second[from + 1];
            for (std::size_t c = 0; c < from; ++c) {
                set_symmetric(to, c, first[c]);
                set_symmetric(to + 1, c, second[c]);
            }
            set_symmetric(to + 1, to, first[to + 1]);
        }
        forget_last();
    }

    LowRank& begin_update() {
        constexpr int most_pending = 16;  // vectors; more cost readers more than the kernel gains
        if (change_.stride != padded() || change_.all() >= most_pending) apply_pending();
        change_.begin();
        return change_;
    }
    void apply_update() {
        for (int k = 0; k < change_.rank; ++k) {
            const Vector3 &x = change_.pose_x[std::size_t(k)], &y = change_.pose_y[std::size_t(k)];
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) pose_[3 * i + j] += x[i] * y[j];
        }
        if (change_.rank > 0) {
            double* const columns[] = {cross_[0].data(), cross_[1].data(), cross_[2].data()};
            Kernel::add_weighted(
                columns, 3,
                {change_.x_of(0), std::ptrdiff_t(change_.stride), change_.rank, change_.pose_y[0].data(), 3});
        }
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < i; ++j)
                pose_[3 * j + i] = pose_[3 * i + j] = (pose_[3 * i + j] + pose_[3 * j + i]) / 2;
        }
    }
    // Adds the products that were put off.
    void apply_pending() {
        if (change_.all() > 0 && !is_applying_) next_panel_ = 0, is_applying_ = true;
        finish_update();
        change_.reset(padded());
    }
    // What is left of products whose addition was interrupted.
    void finish_update() {
        if (!is_applying_) return;
        constexpr std::size_t numbers_per_look = 1 << 21;  // take some hundred microseconds
        const int end = int(change_.stride / panel_rows);
        while (next_panel_ < end) {
            int last = next_panel_ + 1;
            while (last < end && panel_offset(std::size_t(last)) - panel_offset(std::size_t(next_panel_)) <
                                     numbers_per_look / std::size_t(change_.all()))
                ++last;
            Kernel::add(panels_.data(), next_panel_, last, change_.x.data(), change_.y.data(),
                        std::ptrdiff_t(change_.stride), change_.all());
            next_panel_ = last;
            if (next_panel_ < end) poll_interrupts();
        }
        is_applying_ = false;
        change_.reset(padded());
    }

  private:
    int landmarks_ = 0;
    std::array<double, 9> pose_{};
    std::array<std::vector<double>, 3> cross_;
    std::vector<double> panels_;
    LowRank change_;
    int next_panel_ = 0;
    bool is_applying_ = false;  // the panels before the next one have the products already

    static std::size_t entry(int row, int column) { return entry(std::size_t(row), std::size_t(column)); }
    static std::size_t entry(std::size_t row, std::size_t column) {
        return panel_offset(row / panel_rows) + panel_rows * column + row % panel_rows;
    }
    // The entry, and its mirror image where the panel holds that too.
    void set_entry(std::size_t row, std::size_t column, double value) {
        panels_[entry(row, column)] = value;
        if (row / panel_rows == column / panel_rows) panels_[entry(column, row)] = value;
    }
    void set_symmetric(std::size_t a, std::size_t b, double value) {
        set_entry(std::max(a, b), std::min(a, b), value);
    }
    void forget_last() {
        const std::size_t row = std::size_t(2 * --landmarks_);
        if (landmarks_ % 2 == 0) {
            for (auto& column : cross_) column.resize(column.size() - panel_rows);
            panels_.resize(panel_offset(padded() / panel_rows));
        } else {
            for (std::size_t r = row; r < row + 2; ++r) {
                for (std::size_t c = 0; c <= r; ++c) set_entry(r, c, 0);
                for (auto& column : cross_) column[r] = 0;
            }
        }
        change_.reset(padded());
    }
};

}  // namespace cspace::localization
