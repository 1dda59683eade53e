// SLAM of landmarks by an extended Kalman filter on a pose and all landmarks at once.
//
// Errors are kept in axes of the map. Three ways to linearise differ in where positions enter derivatives:
// - invariant: the error of the group of poses with landmarks, disturbed on the left (Barrau & Bonnabel
// 2015).
//   In axes of the map its retraction is p ← p + V(δθ) δp and l ← l + V(δθ) δl, and after it every error
//   gains J (new − old) δθ, a product of rank two.
// - first estimates: positions as they were first estimated (Huang, Mourikis & Roumeliotis 2010).
// - plain: the latest estimates, which gains a heading that nobody measured (Julier & Uhlmann 2001).
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cspace/localization/landmarks/joint_compatibility.hpp"
#include "cspace/localization/landmarks/rejection_sum.hpp"

namespace cspace::localization {

struct MappedLandmark {
    std::int64_t name = 0;
    Vector2 point{}, first{};
    int seen = 0, missed = 0;
};

template <class Kernel>
class EkfSlam {
  public:
    static constexpr bool is_resumable =
        true;  // after an interrupt: readings that it came before are not used

    EkfSlam(const EkfSlamRule& rule, const Vector3& start, const std::array<double, 9>& covariance)
        : rule_(rule),
          pose_(PlanarSpace::read_pose(start.data())),
          first_{pose_.x, pose_.y},
          gate_(rule.landmarks.gate),
          pairing_gate_(rule.landmarks.pair_share),
          new_gate_(rule.landmarks.new_share),
          rejections_(rule.landmarks.lost_after) {
        P_.pose() = turn_covariance(covariance, pose_.c, pose_.s);
    }

    // The next pose in the last one, and the covariance of its disturbance in the new base.
    void predict(const PlanarSpace::Pose& increment, const std::array<double, 9>& noise) {
        P_.finish_update();
        pose_ = PlanarSpace::compose(pose_, increment);
        const double scale = 1 / std::hypot(pose_.c, pose_.s);
        pose_.c *= scale, pose_.s *= scale;
        P_.move_pose({first_[1] - pose_.y, pose_.x - first_[0]}, turn_covariance(noise, pose_.c, pose_.s));
        first_ = {pose_.x, pose_.y};
    }

    // All readings of one time. Outcomes are in the order of the readings.
    std::span<const ReadingOutcome> update(std::span<const LandmarkReading> readings) {
        P_.finish_update();
        outcomes_.assign(readings.size(), {});
        numbers_.clear(), pairs_.clear(), fresh_.clear();
        for (const LandmarkReading& reading : readings)
            numbers_.push_back(read_numbers(reading, rule_.sensor));
        if (readings.empty()) return outcomes_;
        ++counts_.updates;
        const bool named = readings[0].name >= 0;
        if (!named) P_.apply_pending();  // all landmarks are read
        named ? match_names(readings) : associate_readings();
        for (std::size_t k = 0; k < pairs_.size(); k += most_at_once)
            correct(std::span(pairs_).subspan(k, std::min(most_at_once, pairs_.size() - k)));
        create_landmarks(readings);
        for (const ReadingOutcome& outcome : outcomes_) count_outcome(outcome);
        if (!named) drop_landmarks();
        return outcomes_;
    }

    const PlanarSpace::Pose& pose() const { return pose_; }
    const JointCovariance<Kernel>& covariance() const { return P_; }
    // The covariance of the disturbance on the right of the pose.
    std::array<double, 9> base_covariance() const { return turn_covariance(P_.pose(), pose_.c, -pose_.s); }
    const std::vector<MappedLandmark>& landmarks() const { return landmarks_; }
    bool is_confirmed(const MappedLandmark& landmark) const {
        return row_of_.contains(landmark.name) || landmark.seen >= rule_.landmarks.confirmed_after;
    }
    bool is_lost() const { return rejections_.is_lost(); }
    const LandmarkCounts& counts() const { return counts_; }
    const EkfSlamRule& rule() const { return rule_; }

  private:
    static constexpr double inflation = 4;  // of the covariance of the pose when lost: twice the deviations
    static constexpr std::size_t most_at_once = 8;  // readings per update of the covariance: sixteen numbers

    struct Pair {
        std::size_t reading;
        int landmark;
    };

    EkfSlamRule rule_;
    PlanarSpace::Pose pose_;
    Vector2 first_;  // the position where predictions and headings are linearised
    JointCovariance<Kernel> P_;
    std::vector<MappedLandmark> landmarks_;
    std::unordered_map<std::int64_t, int> row_of_;  // of landmarks that readings name
    std::int64_t next_name_ = 0;
    ChiSquareGate gate_, pairing_gate_, new_gate_;
    RejectionSum rejections_;
    LandmarkCounts counts_;
    std::vector<ReadingOutcome> outcomes_;
    std::vector<MeasuredNumbers> numbers_;
    std::vector<Pair> pairs_;
    std::vector<std::size_t> fresh_;  // readings of landmarks that are not there yet
    std::vector<double> W_, columns_;

    // blkdiag(R, 1) P blkdiag(R, 1)ᵀ.
    static std::array<double, 9> turn_covariance(const std::array<double, 9>& P, double c, double s) {
        const double xx = c * c * P[0] - 2 * c * s * P[1] + s * s * P[4];
        const double yy = s * s * P[0] + 2 * c * s * P[1] + c * c * P[4];
        const double xy = c * s * (P[0] - P[4]) + (c * c - s * s) * P[1];
        const double xt = c * P[2] - s * P[5], yt = s * P[2] + c * P[5];
        return {xx, xy, xt, xy, yy, yt, xt, yt, P[8]};
    }
    ReadingModel model(std::size_t reading, int j, const SensorPose& at) const {
        const MappedLandmark& landmark = landmarks_[std::size_t(j)];
        const Vector2 held =
            rule_.linearization == Linearization::first_estimate ? landmark.first : landmark.point;
        return model_reading(numbers_[reading], rule_.sensor, at, landmark.point,
                             {held[0] - first_[0], held[1] - first_[1]});
    }
    // νᵀ S⁻¹ ν; infinite where S is singular.
    double measure_nis(const ReadingModel& model, int j) const {
        Matrix2 S = innovation_block(P_, model, j, model, j);
        S[0] += model.noise[0], S[3] += model.noise[1];
        const WeighedInnovation found = weigh_innovation(model.innovation, S, model.count);
        return found.is_regular ? found.nis : std::numeric_limits<double>::infinity();
    }
    void note_innovation(std::size_t reading, const ReadingModel& model, double nis) {
        ReadingOutcome& outcome = outcomes_[reading];
        outcome.nis = nis, outcome.dof = model.count;
        for (std::size_t k = 0; k < std::size_t(model.count); ++k)
            outcome.innovation[k] = model.innovation[k];
    }
    void pair_reading(std::size_t reading, int j) {
        outcomes_[reading].verdict = ReadingVerdict::used;
        outcomes_[reading].name = landmarks_[std::size_t(j)].name;
        pairs_.push_back({reading, j});
        MappedLandmark& landmark = landmarks_[std::size_t(j)];
        ++landmark.seen, landmark.missed = 0;
    }
    void reject() {
        if (!rejections_.reject()) return;
        ++counts_.inflations;
        for (double& p : P_.pose()) p *= inflation;
    }

    void match_names(std::span<const LandmarkReading> readings) {
        const SensorPose at = place_sensor(pose_, rule_.sensor.mount);
        for (std::size_t k = 0; k < readings.size(); ++k) {
            outcomes_[k].name = readings[k].name;
            const auto found = row_of_.find(readings[k].name);
            if (found == row_of_.end()) {
                fresh_.push_back(k);
                continue;
            }
            test_reading(k, found->second, at);
        }
    }
    void test_reading(std::size_t k, int j, const SensorPose& at) {
        const ReadingModel seen = model(k, j, at);
        const double nis = measure_nis(seen, j);
        note_innovation(k, seen, nis);
        if (nis <= gate_.limit(seen.count)) {
            rejections_.accept();
            return pair_reading(k, j);
        }
        outcomes_[k].verdict = ReadingVerdict::rejected;
        reject();
    }

    void associate_readings() {
        const SensorPose at = place_sensor(pose_, rule_.sensor.mount);
        std::vector<std::vector<Candidate>> candidates(numbers_.size());
        std::vector<char> is_new(numbers_.size(), 1);
        for (std::size_t k = 0; k < numbers_.size(); ++k) {
            for (int j = 0; j < int(landmarks_.size()) && numbers_[k].count; ++j) {
                const ReadingModel seen = model(k, j, at);
                const double nis = measure_nis(seen, j);
                if (nis <= new_gate_.limit(seen.count)) is_new[k] = 0;
                if (nis <= pairing_gate_.limit(seen.count)) candidates[k].push_back({j, seen, nis});
            }
            std::sort(candidates[k].begin(), candidates[k].end(),
                      [](const Candidate& a, const Candidate& b) { return a.nis < b.nis; });
            poll_interrupts();
        }
        PairingSearch search(P_, candidates, {rule_.landmarks.pair_share, rule_.most_nodes, rule_.is_joint});
        const std::vector<int> chosen = search.find_pairings();
        counts_.capped += search.is_capped();
        bool any_fits = false;  // an ambiguous reading fits too
        for (std::size_t k = 0; k < numbers_.size(); ++k) {
            any_fits = any_fits || !candidates[k].empty();
            if (chosen[k] >= 0) {
                const Candidate& candidate = candidates[k][std::size_t(chosen[k])];
                note_innovation(k, candidate.model, candidate.nis);
                pair_reading(k, candidate.landmark);
            } else if (is_new[k]) {
                fresh_.push_back(k);
            } else {
                outcomes_[k].verdict = ReadingVerdict::rejected;
            }
        }
        const bool expected = miss_landmarks(at);
        if (!pairs_.empty())
            rejections_.accept();
        else if (!any_fits && expected)
            reject();
    }
    // Counts the landmarks in view that no reading saw; whether a confirmed one was expected.
    bool miss_landmarks(const SensorPose& at) {
        bool expected = false;
        std::vector<char> is_paired(landmarks_.size());
        for (const Pair& pair : pairs_) is_paired[std::size_t(pair.landmark)] = 1;
        for (std::size_t j = 0; j < landmarks_.size(); ++j) {
            if (!is_in_view(rule_.sensor, at.see(landmarks_[j].point))) continue;
            expected = expected || is_confirmed(landmarks_[j]);
            landmarks_[j].missed += !is_paired[j];
        }
        return expected;
    }
    void drop_landmarks() {
        for (std::size_t j = landmarks_.size(); j-- > 0;) {
            if (is_confirmed(landmarks_[j]) || landmarks_[j].missed < rule_.landmarks.dropped_after) continue;
            P_.remove_landmark(int(j));
            landmarks_[j] = landmarks_.back();
            landmarks_.pop_back();
            ++counts_.dropped;
        }
    }

    // The update of all errors by some readings at once.
    void correct(std::span<const Pair> pairs) {
        const SensorPose at = place_sensor(pose_, rule_.sensor.mount);
        const std::size_t size = P_.padded();
        LowRank& change = P_.begin_update();
        JointInnovation innovation;
        W_.clear();
        std::vector<Vector3> W_pose;
        columns_.resize(2 * size);
        for (const Pair& pair : pairs) {
            const ReadingModel seen = model(pair.reading, pair.landmark, at);
            gather_products(seen, pair.landmark, W_pose);
            if (append_innovation(innovation, seen, pair.landmark, W_pose)) continue;
            W_.resize(W_.size() - std::size_t(seen.count) * size);  // it depends on the others
            W_pose.resize(W_pose.size() - std::size_t(seen.count));
        }
        const std::size_t rows = W_pose.size();
        for (std::size_t k = 0; k < rows; ++k) {
            change.append();
            Vector3 pose = W_pose[k];
            double* v = change.x_of(int(k));
            std::copy_n(W_.data() + k * size, size, v);
            for (std::size_t m = 0; m < k; ++m) subtract(innovation.factor(k, m), change, m, pose, v);
            const double scale = 1 / innovation.factor(k, k);
            for (double& p : pose) p *= scale;
            double* y = change.y_of(int(k));
            for (std::size_t c = 0; c < size; ++c) v[c] *= scale, y[c] = -v[c];
            change.pose_x[k] = pose, change.pose_y[k] = {-pose[0], -pose[1], -pose[2]};
        }
        move_state(innovation.whitened(), change);
        P_.apply_update();
    }
    static void subtract(double factor, LowRank& change, std::size_t m, Vector3& pose, double* v) {
        const double* earlier = change.x_of(int(m));
        for (std::size_t c = 0; c < change.stride; ++c) v[c] -= factor * earlier[c];
        for (std::size_t c = 0; c < 3; ++c) pose[c] -= factor * change.pose_x[m][c];
    }
    // The columns of P Hᵀ of a reading.
    void gather_products(const ReadingModel& model, int j, std::vector<Vector3>& W_pose) {
        const std::size_t size = P_.padded();
        double *first = columns_.data(), *second = first + size;
        P_.copy_columns(j, first, second);
        const auto& X = P_.pose();
        const double *x = P_.cross(0).data(), *y = P_.cross(1).data(), *turn = P_.cross(2).data();
        for (std::size_t r = 0; r < std::size_t(model.count); ++r) {
            const double a = model.A[2 * r], b = model.A[2 * r + 1], t = model.turn[r];
            Vector3 pose;
            for (std::size_t c = 0; c < 3; ++c) {
                const double* own = P_.cross(c).data() + 2 * j;
                pose[c] = a * (own[0] - X[3 * c]) + b * (own[1] - X[3 * c + 1]) + t * X[3 * c + 2];
            }
            W_pose.push_back(pose);
            W_.resize(W_.size() + size);
            double* to = W_.data() + W_.size() - size;
            for (std::size_t c = 0; c < size; ++c)
                to[c] = a * (first[c] - x[c]) + b * (second[c] - y[c]) + t * turn[c];
        }
    }
    // A number of a reading times a column of P Hᵀ.
    static double project(const ReadingModel& model, std::size_t row, int j, const Vector3& pose,
                          const double* column) {
        const double a = model.A[2 * row], b = model.A[2 * row + 1];
        return a * (column[2 * j] - pose[0]) + b * (column[2 * j + 1] - pose[1]) + model.turn[row] * pose[2];
    }
    // Appends the innovation of the last reading, given the columns of P Hᵀ of it and of those before it.
    bool append_innovation(JointInnovation& innovation, const ReadingModel& last, int j,
                           const std::vector<Vector3>& W_pose) const {
        const std::size_t size = P_.padded(), before = std::size_t(innovation.rows()),
                          rows = std::size_t(last.count);
        std::array<double, 4 * most_at_once> with;
        Matrix2 own{};
        for (std::size_t r = 0; r < rows; ++r) {
            for (std::size_t c = 0; c < before; ++c)
                with[r * before + c] = project(last, r, j, W_pose[c], W_.data() + c * size);
            for (std::size_t c = 0; c < rows; ++c)
                own[2 * r + c] = project(last, r, j, W_pose[before + c], W_.data() + (before + c) * size);
            own[2 * r + r] += last.noise[r];
        }
        return innovation.append(last, with.data(), own);
    }
    // Moves the state by V y, and for the invariant error its covariance to the new state.
    void move_state(const std::vector<double>& y, LowRank& change) {
        Vector3 by_pose{};
        std::vector<double> by(change.stride);
        for (std::size_t k = 0; k < y.size(); ++k) {
            const double* v = change.x_of(int(k));
            for (std::size_t c = 0; c < by.size(); ++c) by[c] += y[k] * v[c];
            for (std::size_t c = 0; c < 3; ++c) by_pose[c] += y[k] * change.pose_x[k][c];
        }
        const double c = std::cos(by_pose[2]), s = std::sin(by_pose[2]);
        const bool is_invariant = rule_.linearization == Linearization::invariant;
        if (is_invariant) {  // the exponential of the group: p ← p + V δ
            const spatial::PlanarJacobian V(by_pose[2], c, s);
            const auto bend = [&](double* v) { std::copy_n(V.times(v).begin(), 2, v); };
            bend(by_pose.data());
            for (std::size_t i = 0; i < by.size(); i += 2) bend(by.data() + i);
        }
        pose_ = {pose_.x + by_pose[0], pose_.y + by_pose[1], c * pose_.c - s * pose_.s,
                 s * pose_.c + c * pose_.s};
        for (std::size_t j = 0; j < landmarks_.size(); ++j)
            landmarks_[j].point[0] += by[2 * j], landmarks_[j].point[1] += by[2 * j + 1];
        if (rule_.linearization != Linearization::first_estimate) first_ = {pose_.x, pose_.y};
        if (is_invariant) carry_covariance(by_pose, by, y.size(), change);
    }
    // P ← B P Bᵀ with B = I + b e_θᵀ and b = J (new − old), as P + b cᵀ + c bᵀ with c = P e_θ + ½ P_θθ b.
    void carry_covariance(const Vector3& by_pose, const std::vector<double>& by, std::size_t rows,
                          LowRank& change) {
        change.append(), change.append();
        Vector3 with_turn{P_.pose()[2], P_.pose()[5], P_.pose()[8]};
        double *b = change.x_of(int(rows)), *c = change.y_of(int(rows));
        std::copy(P_.cross(2).begin(), P_.cross(2).end(), c);
        for (std::size_t k = 0; k < rows; ++k) {
            const double* v = change.x_of(int(k));
            const double own = change.pose_x[k][2];
            for (std::size_t i = 0; i < change.stride; ++i) c[i] -= own * v[i];
            for (std::size_t i = 0; i < 3; ++i) with_turn[i] -= own * change.pose_x[k][i];
        }
        const double half = with_turn[2] / 2;
        const Vector3 b_pose{-by_pose[1], by_pose[0], 0};
        for (std::size_t i = 0; i < change.stride; i += 2) b[i] = -by[i + 1], b[i + 1] = by[i];
        for (std::size_t i = 0; i < change.stride; ++i) c[i] += half * b[i];
        for (std::size_t i = 0; i < 3; ++i) with_turn[i] += half * b_pose[i];
        std::copy_n(c, change.stride, change.x_of(int(rows) + 1));
        std::copy_n(b, change.stride, change.y_of(int(rows) + 1));
        change.pose_x[rows] = change.pose_y[rows + 1] = b_pose;
        change.pose_y[rows] = change.pose_x[rows + 1] = with_turn;
    }

    void create_landmarks(std::span<const LandmarkReading> readings) {
        std::vector<std::size_t> again;  // readings of landmarks that one before them made
        for (const std::size_t k : fresh_) {
            const MeasuredNumbers& numbers = numbers_[k];
            if (readings[k].name >= 0 && row_of_.contains(readings[k].name)) {
                again.push_back(k);
                continue;
            }
            if (numbers.count < 2 || numbers.value[0] < closest_landmark) continue;
            const SensorPose at = place_sensor(pose_, rule_.sensor.mount);
            MappedLandmark made;
            made.name = readings[k].name >= 0 ? readings[k].name : next_name_++;
            made.point = made.first = at.place(locate_landmark(numbers));
            made.seen = 1;
            P_.add_landmark({made.point[0] - first_[0], made.point[1] - first_[1]},
                            locate_covariance(numbers, rule_.sensor, at));
            if (readings[k].name >= 0) row_of_[made.name] = int(landmarks_.size());
            landmarks_.push_back(made);
            outcomes_[k].verdict = ReadingVerdict::created, outcomes_[k].name = made.name;
        }
        pairs_.clear();
        const SensorPose at = place_sensor(pose_, rule_.sensor.mount);
        for (const std::size_t k : again) test_reading(k, row_of_.at(readings[k].name), at);
        for (std::size_t k = 0; k < pairs_.size(); k += most_at_once)
            correct(std::span(pairs_).subspan(k, std::min(most_at_once, pairs_.size() - k)));
    }
    void count_outcome(const ReadingOutcome& outcome) {
        long* const counts[] = {&counts_.used, &counts_.rejected, &counts_.created, &counts_.skipped};
        ++*counts[std::size_t(outcome.verdict)];
    }
};

}  // namespace cspace::localization
