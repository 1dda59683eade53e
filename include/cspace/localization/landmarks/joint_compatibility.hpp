// Data association by joint compatibility: branch and bound over pairings of readings with landmarks (Neira &
// Tardós 2001), and sequential compatible nearest neighbour.
//
// A set of pairings is compatible if its joint innovation passes a gate of χ². Each node of the search extends
// the Cholesky factor of the joint covariance by one block. Most pairings win; of as many, the least NIS.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cspace/localization/landmarks/joint_covariance.hpp"
#include "cspace/math/chi_square.hpp"

namespace cspace::localization {

// The covariance of the innovations of two readings, of landmarks i and j: a row per number of the first.
template <class Covariance>
Matrix2 innovation_block(const Covariance& P, const ReadingModel& a, int i, const ReadingModel& b, int j) {
    const auto& X = P.pose();
    const Matrix2 L = P.block(i, j);
    Matrix2 S{};
    for (int r = 0; r < a.count; ++r) {
        const double *A = a.A.data() + 2 * r, Hx[3] = {-A[0], -A[1], a.turn[std::size_t(r)]};
        // Covariances of the first number with the pose and with landmark j.
        double with_pose[3], with_landmark[2];
        for (std::size_t c = 0; c < 3; ++c) {
            const double* column = P.cross(c).data() + 2 * i;
            with_pose[c] = Hx[0] * X[c] + Hx[1] * X[3 + c] + Hx[2] * X[6 + c] + A[0] * column[0] + A[1] * column[1];
        }
        for (std::size_t c = 0; c < 2; ++c) {
            const std::size_t at = 2 * std::size_t(j) + c;
            with_landmark[c] = Hx[0] * P.cross(0)[at] + Hx[1] * P.cross(1)[at] + Hx[2] * P.cross(2)[at] +
                               A[0] * L[c] + A[1] * L[2 + c];
        }
        for (int s = 0; s < b.count; ++s) {
            const double* B = b.A.data() + 2 * s;
            S[std::size_t(2 * r + s)] = B[0] * (with_landmark[0] - with_pose[0]) +
                                        B[1] * (with_landmark[1] - with_pose[1]) +
                                        b.turn[std::size_t(s)] * with_pose[2];
        }
    }
    return S;
}

// The innovations of pairings that were accepted one by one: L with L Lᵀ their covariance, and L⁻¹ ν.
class JointInnovation {
  public:
    int rows() const { return int(y_.size()); }
    double nis() const { return nis_; }
    // Appends a reading, given its covariances with all rows so far (count × rows()) and its own; false, and
    // nothing appended, where the whole is not positive definite.
    bool append(const ReadingModel& model, const double* with, const Matrix2& own) {
        const std::size_t before = y_.size(), kept = factor_.size();
        const double nis = nis_;
        for (std::size_t r = 0; r < std::size_t(model.count); ++r) {
            const std::size_t row = before + r, start = factor_.size();
            factor_.resize(start + row + 1);
            double* l = factor_.data() + start;
            double rest = own[2 * r + r], value = model.innovation[r];
            for (std::size_t c = 0; c < row; ++c) {
                double sum = c < before ? with[r * before + c] : own[2 * r + c - before];
                const double* other = factor_.data() + c * (c + 1) / 2;
                for (std::size_t k = 0; k < c; ++k) sum -= l[k] * other[k];
                l[c] = sum / other[c];
                rest -= l[c] * l[c], value -= l[c] * y_[c];
            }
            if (!(rest > 0)) {
                y_.resize(before), factor_.resize(kept), nis_ = nis;
                return false;
            }
            l[row] = std::sqrt(rest);
            y_.push_back(value / l[row]);
            nis_ += y_.back() * y_.back();
        }
        return true;
    }
    void remove(int count) {
        y_.resize(y_.size() - std::size_t(count));
        factor_.resize(y_.size() * (y_.size() + 1) / 2);
        nis_ = 0;
        for (double y : y_) nis_ += y * y;
    }
    // νᵀ S⁻¹ ν + log det S: minus twice the logarithm of the likelihood, but for a constant.
    double cost() const {
        double sum = nis_;
        for (std::size_t k = 0; k < y_.size(); ++k) sum += 2 * std::log(factor(k, k));
        return sum;
    }
    double factor(std::size_t row, std::size_t column) const { return factor_[row * (row + 1) / 2 + column]; }
    const std::vector<double>& whitened() const { return y_; }

  private:
    std::vector<double> factor_, y_;  // the factor row by row, without what lies above its diagonal
    double nis_ = 0;
};

struct Candidate {
    int landmark;
    ReadingModel model;
    double nis;
};

struct PairingRule {
    double share;     // of χ² of all pairings at once
    long most_nodes;  // then the best pairings so far are taken
    bool is_joint;    // false: sequential compatible nearest neighbour alone
};

template <class Covariance>
class PairingSearch {
  public:
    // candidates: of each reading, individually compatible ones by NIS.
    PairingSearch(const Covariance& P, const std::vector<std::vector<Candidate>>& candidates, const PairingRule& rule)
        : P_(P), candidates_(candidates), rule_(rule), gate_(rule.share), chosen_(candidates.size(), none) {
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            if (!candidates[i].empty()) order_.push_back(i);
        }
        std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            return candidates[a].size() < candidates[b].size();
        });
    }
    static constexpr int none = -1;

    // The candidate of each reading, or none: also for a reading that another landmark explains nearly as well.
    std::vector<int> find_pairings() {
        pair_nearest();
        if (rule_.is_joint && best_count_ < int(order_.size())) branch(0);
        drop_ambiguous();
        return best_;
    }
    bool is_capped() const { return nodes_ > rule_.most_nodes; }
    long nodes() const { return nodes_; }

  private:
    const Covariance& P_;
    const std::vector<std::vector<Candidate>>& candidates_;
    PairingRule rule_;
    ChiSquareGate gate_;
    JointInnovation innovation_;
    std::vector<std::size_t> order_;
    std::vector<int> chosen_, best_;
    std::vector<const Candidate*> paired_;
    std::vector<double> with_;
    int best_count_ = none;
    double best_nis_ = 0;
    long nodes_ = 0;

    bool is_taken(int landmark) const {
        return std::any_of(paired_.begin(), paired_.end(), [&](const Candidate* c) { return c->landmark == landmark; });
    }
    // Whether the pairings so far stay compatible with one more, which is then among them.
    bool add_pairing(const Candidate& candidate) {
        if (is_taken(candidate.landmark)) return false;
        const std::size_t rows = std::size_t(innovation_.rows());
        with_.assign(2 * rows, 0);
        std::size_t column = 0;
        for (const Candidate* other : paired_) {
            const Matrix2 S = innovation_block(P_, candidate.model, candidate.landmark, other->model, other->landmark);
            for (int s = 0; s < other->model.count; ++s, ++column) {
                for (int r = 0; r < candidate.model.count; ++r) with_[std::size_t(r) * rows + column] = S[std::size_t(2 * r + s)];
            }
        }
        Matrix2 own = innovation_block(P_, candidate.model, candidate.landmark, candidate.model, candidate.landmark);
        own[0] += candidate.model.noise[0], own[3] += candidate.model.noise[1];
        if (!innovation_.append(candidate.model, with_.data(), own)) return false;
        paired_.push_back(&candidate);
        if (innovation_.nis() <= gate_.limit(innovation_.rows())) return true;
        remove_pairing();
        return false;
    }
    void remove_pairing() {
        innovation_.remove(paired_.back()->model.count);
        paired_.pop_back();
    }
    void keep_if_better() {
        const int count = int(paired_.size());
        if (count < best_count_ || (count == best_count_ && innovation_.nis() >= best_nis_)) return;
        best_ = chosen_, best_count_ = count, best_nis_ = innovation_.nis();
    }
    // Each reading in turn takes the nearest landmark that is compatible with all pairings so far.
    void pair_nearest() {
        for (const std::size_t i : order_) {
            for (std::size_t c = 0; c < candidates_[i].size() && chosen_[i] == none; ++c) {
                if (add_pairing(candidates_[i][c])) chosen_[i] = int(c);
            }
        }
        keep_if_better();
        while (!paired_.empty()) remove_pairing();
        chosen_.assign(chosen_.size(), none);
    }
    // The cost of a pairing beside those of all other readings; infinite where it is not compatible.
    double cost_of(std::size_t reading, int candidate) {
        double cost = std::numeric_limits<double>::infinity();
        bool are_all = true;
        for (const std::size_t i : order_)
            are_all = are_all && (i == reading || best_[i] == none || add_pairing(candidates_[i][std::size_t(best_[i])]));
        if (are_all && add_pairing(candidates_[reading][std::size_t(candidate)])) cost = innovation_.cost();
        while (!paired_.empty()) remove_pairing();
        return cost;
    }
    void drop_ambiguous() {
        constexpr double twice_log_twenty = 5.99;  // the other landmark is not twenty times less likely
        std::vector<std::size_t> ambiguous;
        for (const std::size_t i : order_) {
            if (best_[i] == none || candidates_[i].size() < 2) continue;
            const double cost = cost_of(i, best_[i]);
            for (int c = 0; c < int(candidates_[i].size()); ++c) {
                if (c == best_[i] || cost_of(i, c) > cost + twice_log_twenty) continue;
                ambiguous.push_back(i);
                break;
            }
        }
        for (const std::size_t i : ambiguous) best_[i] = none;
    }
    void branch(std::size_t depth) {
        if (++nodes_ > rule_.most_nodes) return;
        const int left = int(order_.size() - depth), count = int(paired_.size());
        if (count + left < best_count_ || (count + left == best_count_ && innovation_.nis() >= best_nis_)) return;
        if (!left) return keep_if_better();
        const std::size_t i = order_[depth];
        for (std::size_t c = 0; c < candidates_[i].size(); ++c) {
            if (!add_pairing(candidates_[i][c])) continue;
            chosen_[i] = int(c);
            branch(depth + 1);
            chosen_[i] = none;
            remove_pairing();
        }
        branch(depth + 1);
    }
};

}  // namespace cspace::localization
