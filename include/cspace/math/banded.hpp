// Symmetric systems with two diagonals beside the main one, as of splines.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cspace {

// A symmetric matrix, row by row its entries (i, i), (i, i − 1) and (i, i − 2).
class Pentadiagonal {
  public:
    explicit Pentadiagonal(std::size_t size) : rows_(size) {}
    // The entry of a row so many places left of the diagonal, 0 to 2.
    double& at(std::size_t row, std::size_t left) { return rows_[row][left]; }

    // Solves for b in place by factors L Lᵀ, which replace the matrix; false if it is not positive definite.
    bool solve(std::vector<double>& b) {
        const std::size_t n = rows_.size();
        for (std::size_t i = 0; i < n; ++i) {
            std::array<double, 3>& row = rows_[i];
            if (i >= 2) row[2] /= rows_[i - 2][0];
            if (i >= 1) row[1] = (row[1] - (i >= 2 ? row[2] * rows_[i - 1][1] : 0.0)) / rows_[i - 1][0];
            const double pivot = row[0] - row[1] * row[1] - row[2] * row[2];
            if (!(pivot > 0.0)) return false;
            row[0] = std::sqrt(pivot);
            b[i] -= (i >= 1 ? row[1] * b[i - 1] : 0.0) + (i >= 2 ? row[2] * b[i - 2] : 0.0);
            b[i] /= row[0];
        }
        for (std::size_t i = n; i-- > 0;) {
            if (i + 1 < n) b[i] -= rows_[i + 1][1] * b[i + 1];
            if (i + 2 < n) b[i] -= rows_[i + 2][2] * b[i + 2];
            b[i] /= rows_[i][0];
        }
        return true;
    }

  private:
    std::vector<std::array<double, 3>> rows_;
};

}  // namespace cspace
