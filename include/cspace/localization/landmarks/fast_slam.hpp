// SLAM of landmarks by particles: each has a pose and a small Kalman filter per landmark (FastSLAM;
// Montemerlo et al. 2002, 2003).
//
// Motion between two updates is one increment with one covariance, as the covariance of a disturbance on the
// right does not depend on the pose. Version 1 draws the pose from it and weighs by the readings. Version 2
// draws from it given the readings, and weighs by their density with the pose unknown:
// N(ν; 0, H P Hᵀ + A Σ Aᵀ + R). Several readings are taken in turn, each given those before it.
//
// Particles begin at one pose. Readings of unknown landmarks tell nothing of the error of the start, which
// moves poses and landmarks like one rigid body; it is added to their covariances as it is. Drawn into the
// particles it would be lost a little with each resampling.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "cspace/localization/graph/residuals.hpp"
#include "cspace/localization/landmarks/ekf_slam.hpp"
#include "cspace/localization/landmarks/landmark_chunks.hpp"
#include "cspace/localization/landmarks/rejection_sum.hpp"
#include "cspace/math/counter_draws.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::localization {

using Covariance3 = std::array<double, 9>;

class FastSlam {
  public:
    using Pose = PlanarSpace::Pose;
    static constexpr bool is_resumable = false;  // an interrupt leaves some particles updated and some not

    FastSlam(const FastSlamRule& rule, const Vector3& start, const Covariance3& covariance)
        : rule_(rule),
          start_(PlanarSpace::read_pose(start.data())),
          start_covariance_(covariance),
          poses_(rule.particles, start_),
          log_weights_(rule.particles),
          shares_(rule.particles, 1.0 / double(rule.particles)),
          counts_of_(rule.particles),
          chunks_(rule.particles),
          gate_(rule.landmarks.gate),
          pair_gate_(rule.landmarks.pair_share),
          new_gate_(rule.landmarks.new_share),
          rejections_(rule.landmarks.lost_after),
          mount_(PlanarSpace::read_pose(rule.sensor.mount.data())) {}

    void predict(const Pose& increment, const Covariance3& noise) {
        pending_ = PlanarSpace::compose(pending_, increment);
        pending_noise_ = carry(PlanarSpace::adjoint(PlanarSpace::inverse(increment)), pending_noise_);
        for (std::size_t k = 0; k < 9; ++k) pending_noise_[k] += noise[k];
    }

    std::span<const ReadingOutcome> update(std::span<const LandmarkReading> readings) {
        outcomes_.assign(readings.size(), {});
        if (readings.empty()) return outcomes_;
        ++counts_.updates, ++step_;
        is_named_ = readings[0].name >= 0;
        numbers_.clear(), slots_.assign(readings.size(), none);
        for (const LandmarkReading& reading : readings)
            numbers_.push_back(read_numbers(reading, rule_.sensor));
        move_particles();
        const std::size_t best = heaviest();
        if (is_named_) find_slots(readings), test_readings();
        for (std::size_t k = 0; k < poses_.size(); ++k) {
            update_particle(k, k == best);
            poll_interrupts();
        }
        for (const ReadingOutcome& outcome : outcomes_) count_outcome(outcome);
        if (!is_named_) count_losses();
        normalize();
        if (effective() < rule_.resample_below * double(poses_.size())) resample();
        return outcomes_;
    }

    // The mean pose, and the covariance of the disturbance on its right.
    Pose pose() const { return PlanarSpace::compose(mean_pose(), pending_); }
    Covariance3 base_covariance() const {
        const Pose mean = mean_pose();
        const Pose since = PlanarSpace::between(start_, PlanarSpace::compose(mean, pending_));
        Covariance3 P = carry(PlanarSpace::adjoint(PlanarSpace::inverse(pending_)), spread(mean));
        const Covariance3 first = carry(PlanarSpace::adjoint(PlanarSpace::inverse(since)), start_covariance_);
        for (std::size_t k = 0; k < 9; ++k) P[k] += pending_noise_[k] + first[k];
        return P;
    }
    // The landmarks: with names the means over all particles, without them those of the heaviest one.
    std::vector<MappedLandmark> landmarks(std::vector<Symmetric2>& covariances) const {
        std::vector<MappedLandmark> found;
        covariances.clear();
        if (is_named_) {
            for (std::size_t slot = 0; slot < names_.size(); ++slot)
                average_landmark(slot, found, covariances);
            return found;
        }
        const std::size_t k = heaviest();
        for (std::size_t slot = 0; slot < counts_of_[k]; ++slot) {
            const ParticleLandmark& landmark = chunks_.read(k, slot);
            found.push_back(
                {std::int64_t(slot), landmark.point, landmark.point, landmark.seen, landmark.missed});
            covariances.push_back(add_start(landmark.point, landmark.covariance));
        }
        return found;
    }
    bool is_confirmed(const MappedLandmark& landmark) const {
        return is_named_ || landmark.seen >= rule_.landmarks.confirmed_after;
    }
    // The poses of the particles, and their shares.
    Pose particle(std::size_t k) const { return PlanarSpace::compose(poses_[k], pending_); }
    const std::vector<double>& shares() const { return shares_; }
    std::size_t particles() const { return poses_.size(); }
    std::size_t chunks() const { return chunks_.used(); }
    bool is_lost() const { return rejections_.is_lost(); }
    const LandmarkCounts& counts() const { return counts_; }
    double effective() const {
        double squares = 0;
        for (const double share : shares_) squares += share * share;
        return 1 / squares;
    }

  private:
    static constexpr std::size_t none = std::size_t(-1);

    FastSlamRule rule_;
    Pose start_;
    Covariance3 start_covariance_;
    std::vector<Pose> poses_;
    std::vector<double> log_weights_, shares_;
    std::vector<std::size_t> counts_of_;  // landmarks of each particle, without names
    LandmarkChunks chunks_;
    Pose pending_;
    Covariance3 pending_noise_{};
    Covariance3 noise_{};  // of the particles in this update
    ChiSquareGate gate_, pair_gate_, new_gate_;
    bool is_named_ = true;
    std::unordered_map<std::int64_t, std::size_t> slot_of_;
    std::vector<std::int64_t> names_;
    std::uint64_t step_ = 0;
    RejectionSum rejections_;
    Pose mount_;  // of the sensor
    bool best_expected_ = false;
    LandmarkCounts counts_;
    std::vector<ReadingOutcome> outcomes_;
    std::vector<MeasuredNumbers> numbers_;
    std::vector<std::size_t> slots_;  // of each reading with a name
    std::vector<std::size_t> own_slots_;

    static Covariance3 carry(const Covariance3& A, const Covariance3& P) {
        const Covariance3 PA = transpose_times<3, 3, 3>(P, transpose(A));  // P Aᵀ
        return multiply<3, 3, 3>(A, PA);
    }
    static Covariance3 transpose(const Covariance3& A) {
        return {A[0], A[3], A[6], A[1], A[4], A[7], A[2], A[5], A[8]};
    }
    // A draw from a normal distribution that may be singular, the same for a seed, an update and a particle.
    Vector3 draw(const Covariance3& P, std::size_t particle) const {
        const Covariance3 L = factor_semidefinite<3>(P, 0);
        const Vector3 normal = draw_normals(particle);
        Vector3 drawn{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j <= i; ++j) drawn[i] += L[3 * i + j] * normal[j];
        }
        return drawn;
    }
    // Random words of this update and a particle, or of the one past the last.
    FourWords draw_four(std::size_t particle, std::uint32_t part) const {
        const std::uint32_t low = std::uint32_t(particle), step = std::uint32_t(step_);
        const std::uint32_t high = std::uint32_t(step_ >> 32);
        return draw_words({{low, part, step, high}},
                          {{std::uint32_t(rule_.seed), std::uint32_t(rule_.seed >> 32)}});
    }
    // In (0, 1), from two words.
    static double uniform(std::uint32_t first, std::uint32_t second) {
        constexpr double last_place = 0x1p-53;
        const std::uint64_t bits = (std::uint64_t(first) << 32 | second) >> 12;
        return double(2 * bits + 1) * last_place;
    }
    // Box & Muller 1958.
    Vector3 draw_normals(std::size_t particle) const {
        Vector3 normal{};
        for (std::uint32_t k = 0; k < 2; ++k) {
            const FourWords drawn = draw_four(particle, k);
            const double radius = std::sqrt(-2 * std::log(uniform(drawn.word[0], drawn.word[1])));
            const double angle = 2 * pi * uniform(drawn.word[2], drawn.word[3]);
            normal[2 * k] = radius * std::cos(angle);
            if (k == 0) normal[1] = radius * std::sin(angle);
        }
        return normal;
    }

    // All motion since the last update; version 1 draws its noise at once.
    void move_particles() {
        noise_ = pending_noise_;
        for (std::size_t k = 0; k < poses_.size(); ++k) {
            poses_[k] = PlanarSpace::compose(poses_[k], pending_);
            if (rule_.version == 1) poses_[k] = PlanarSpace::move(poses_[k], draw(noise_, k).data());
        }
        if (rule_.version == 1) noise_ = {};
        pending_ = {}, pending_noise_ = {};
    }
    std::size_t heaviest() const {
        return std::size_t(std::max_element(shares_.begin(), shares_.end()) - shares_.begin());
    }

    // What a particle expects of a reading: the innovation, its derivative by the disturbance of the pose,
    // and by the landmark in axes of the map.
    struct Expected {
        ReadingModel model;
        std::array<double, 6> by_pose{};
        Matrix2 own{};  // A Σ Aᵀ + R
    };
    std::vector<Expected> expected_;  // (readings, particles), where readings have names
    Expected expect(const MeasuredNumbers& numbers, const Pose& pose,
                    const ParticleLandmark& landmark) const {
        const SensorPose at = place_mounted(pose, mount_);
        Expected found{model_reading(numbers, rule_.sensor, at, landmark.point,
                                     {landmark.point[0] - pose.x, landmark.point[1] - pose.y})};
        const Symmetric2& C = landmark.covariance;
        for (std::size_t r = 0; r < std::size_t(found.model.count); ++r) {
            const double* A = found.model.A.data() + 2 * r;
            found.by_pose[3 * r] = -(A[0] * pose.c + A[1] * pose.s);
            found.by_pose[3 * r + 1] = A[0] * pose.s - A[1] * pose.c;
            found.by_pose[3 * r + 2] = found.model.turn[r];
            for (std::size_t s = 0; s < std::size_t(found.model.count); ++s) {
                const double* B = found.model.A.data() + 2 * s;
                found.own[2 * r + s] =
                    A[0] * (C[0] * B[0] + C[1] * B[1]) + A[1] * (C[1] * B[0] + C[2] * B[1]);
            }
            found.own[2 * r + r] += found.model.noise[r];
        }
        return found;
    }
    // f of the number of measured values as a constant, so that loops over them are unrolled.
    template <class Function>
    static auto with_count(int count, const Function& f) {
        if (count == 2) return f(std::integral_constant<std::size_t, 2>());
        if (count == 1) return f(std::integral_constant<std::size_t, 1>());
        return f(std::integral_constant<std::size_t, 0>());
    }
    // own + H P Hᵀ.
    static Matrix2 innovation_covariance(const Expected& found, const Covariance3& P) {
        return with_count(found.model.count, [&](auto count) { return add_pose<count()>(found, P); });
    }
    template <std::size_t count>
    static Matrix2 add_pose(const Expected& found, const Covariance3& P) {
        Matrix2 S = found.own;
        for (std::size_t r = 0; r < count; ++r) {
            double HP[3] = {};
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t k = 0; k < 3; ++k) HP[c] += found.by_pose[3 * r + k] * P[3 * k + c];
            }
            for (std::size_t s = 0; s < count; ++s) {
                for (std::size_t c = 0; c < 3; ++c) S[2 * r + s] += HP[c] * found.by_pose[3 * s + c];
            }
        }
        return S;
    }

    void find_slots(std::span<const LandmarkReading> readings) {
        for (std::size_t k = 0; k < readings.size(); ++k) {
            outcomes_[k].name = readings[k].name;
            const auto known = slot_of_.find(readings[k].name);
            if (known != slot_of_.end()) {
                slots_[k] = known->second;
                outcomes_[k].verdict = is_mapped(slots_[k]) ? ReadingVerdict::used : ReadingVerdict::created;
            } else if (can_create(numbers_[k])) {
                slots_[k] = names_.size();
                slot_of_[readings[k].name] = names_.size();
                names_.push_back(readings[k].name);
                outcomes_[k].verdict = ReadingVerdict::created;
            }
        }
    }
    bool is_mapped(std::size_t slot) const { return chunks_.read(0, slot).seen > 0; }
    static bool can_create(const MeasuredNumbers& numbers) {
        return numbers.count == 2 && numbers.value[0] >= closest_landmark;
    }
    // Readings of landmarks with names, at the gate of the mixture of all particles.
    void test_readings() {
        const std::size_t n = poses_.size();
        expected_.resize(n * numbers_.size());
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            if (slots_[i] == none || !is_mapped(slots_[i])) continue;
            Vector2 mean{};
            Matrix2 S{};
            int count = 0;
            for (std::size_t k = 0; k < poses_.size(); ++k) {
                const Expected found = expect(numbers_[i], poses_[k], chunks_.read(k, slots_[i]));
                expected_[n * i + k] = found;
                const Matrix2 own = innovation_covariance(found, noise_);
                const Vector2& v = found.model.innovation;
                count = found.model.count;
                for (std::size_t r = 0; r < 2; ++r) {
                    mean[r] += shares_[k] * v[r];
                    for (std::size_t s = 0; s < 2; ++s)
                        S[2 * r + s] += shares_[k] * (own[2 * r + s] + v[r] * v[s]);
                }
            }
            for (std::size_t r = 0; r < 2; ++r) {
                for (std::size_t s = 0; s < 2; ++s) S[2 * r + s] -= mean[r] * mean[s];
            }
            note_innovation(i, mean, weigh_innovation(mean, S, count), count);
            if (outcomes_[i].nis <= gate_.limit(count)) {
                rejections_.accept();
                continue;
            }
            outcomes_[i].verdict = ReadingVerdict::rejected, slots_[i] = none;
            reject();
        }
    }
    void note_innovation(std::size_t i, const Vector2& v, const WeighedInnovation& found, int count) {
        outcomes_[i].nis = found.nis, outcomes_[i].dof = count;
        for (std::size_t r = 0; r < std::size_t(count); ++r) outcomes_[i].innovation[r] = v[r];
    }
    void reject() {
        if (!rejections_.reject()) return;
        ++counts_.inflations;
        const Covariance3 wide = spread(mean_pose());
        for (std::size_t k = 0; k < 9; ++k) pending_noise_[k] += 3 * wide[k];  // twice the deviations
    }

    // One particle: its pose given the readings (version 2), its weight, its landmarks.
    void update_particle(std::size_t k, bool is_best) {
        Pose mean = poses_[k];
        Covariance3 P = noise_;
        own_slots_ = slots_;
        bool is_refined = false;
        if (!is_named_) associate(k, P, is_best);
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            if (own_slots_[i] == none || !chunks_.read(k, own_slots_[i]).seen) continue;
            const Expected found = !is_refined && has_expected(i)
                                       ? expected_[poses_.size() * i + k]
                                       : expect(numbers_[i], mean, chunks_.read(k, own_slots_[i]));
            const WeighedInnovation weighed =
                weigh_innovation(found.model.innovation, innovation_covariance(found, P), found.model.count);
            if (!weighed.is_regular) continue;
            if (rule_.version == 1) {
                log_weights_[k] += weighed.log_density();
                update_landmark(found, chunks_.write(k, own_slots_[i]));
            } else {
                log_weights_[k] += weighed.log_density();
                refine_pose(found, weighed, mean, P);
                is_refined = true;
            }
        }
        if (rule_.version == 2) {
            mean = PlanarSpace::move(mean, draw(P, k).data());
            for (std::size_t i = 0; i < numbers_.size(); ++i) {
                if (own_slots_[i] == none || !chunks_.read(k, own_slots_[i]).seen) continue;
                update_landmark(expect(numbers_[i], mean, chunks_.read(k, own_slots_[i])),
                                chunks_.write(k, own_slots_[i]));
            }
        }
        poses_[k] = mean;
        create_landmarks(k);
        if (!is_named_) drop_landmarks(k);
    }
    // Whether a particle whose pose stays still expects of a reading what it did when the reading was tested:
    // a landmark stays until its first reading.
    bool has_expected(std::size_t i) const {
        const auto end = slots_.begin() + std::ptrdiff_t(i);
        return is_named_ && std::find(slots_.begin(), end, slots_[i]) == end;
    }
    // The Kalman update of the pose alone, with the landmark unknown by its covariance.
    static void refine_pose(const Expected& found, const WeighedInnovation& weighed, Pose& mean,
                            Covariance3& P) {
        with_count(found.model.count, [&](auto count) { refine_by<count()>(found, weighed, mean, P); });
    }
    template <std::size_t count>
    static void refine_by(const Expected& found, const WeighedInnovation& weighed, Pose& mean,
                          Covariance3& P) {
        double PH[6] = {}, K[6] = {};
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t k = 0; k < 3; ++k) PH[2 * c + r] += P[3 * c + k] * found.by_pose[3 * r + k];
            }
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t s = 0; s < count; ++s)
                    K[2 * c + r] += PH[2 * c + s] * weighed.inverse[2 * s + r];
            }
        }
        Vector3 xi{};
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t r = 0; r < count; ++r) xi[c] += K[2 * c + r] * found.model.innovation[r];
            for (std::size_t d = 0; d < 3; ++d) {
                for (std::size_t r = 0; r < count; ++r) P[3 * c + d] -= K[2 * c + r] * PH[2 * d + r];
            }
        }
        mean = PlanarSpace::move(mean, xi.data());
    }
    // The Kalman update of one landmark at a known pose.
    static void update_landmark(const Expected& found, ParticleLandmark& landmark) {
        const WeighedInnovation weighed =
            weigh_innovation(found.model.innovation, found.own, found.model.count);
        ++landmark.seen, landmark.missed = 0;
        if (!weighed.is_regular) return;
        with_count(found.model.count,
                   [&](auto count) { correct_landmark<count()>(found, weighed, landmark); });
    }
    template <std::size_t count>
    static void correct_landmark(const Expected& found, const WeighedInnovation& weighed,
                                 ParticleLandmark& landmark) {
        Symmetric2& C = landmark.covariance;
        double CA[4] = {}, K[4] = {};
        for (std::size_t r = 0; r < count; ++r) {
            const double* A = found.model.A.data() + 2 * r;
            CA[r] = C[0] * A[0] + C[1] * A[1], CA[2 + r] = C[1] * A[0] + C[2] * A[1];
        }
        for (std::size_t c = 0; c < 2; ++c) {
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t s = 0; s < count; ++s)
                    K[2 * c + r] += CA[2 * c + s] * weighed.inverse[2 * s + r];
                landmark.point[c] += K[2 * c + r] * found.model.innovation[r];
            }
        }
        for (std::size_t r = 0; r < count; ++r) {
            C[0] -= K[r] * CA[r], C[1] -= (K[r] * CA[2 + r] + K[2 + r] * CA[r]) / 2,
                C[2] -= K[2 + r] * CA[2 + r];
        }
    }
    void create_landmarks(std::size_t k) {
        const SensorPose at = place_mounted(poses_[k], mount_);
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            if (own_slots_[i] == none || chunks_.read(k, own_slots_[i]).seen) continue;
            ParticleLandmark& made = chunks_.write(k, own_slots_[i]);
            made = {at.place(locate_landmark(numbers_[i])), locate_covariance(numbers_[i], rule_.sensor, at),
                    1, 0};
        }
    }

    // Readings without names: of each the landmark that most likely made it, by νᵀ S⁻¹ ν + log det S, if the
    // two are compatible; a new one if it is far from all. A landmark is paired once.
    void associate(std::size_t k, const Covariance3& P, bool is_best) {
        const std::size_t count = counts_of_[k];
        std::vector<char> is_taken(count);
        std::size_t next = count;
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            const double pair_limit = pair_gate_.limit(std::max(numbers_[i].count, 1));
            const double new_limit = new_gate_.limit(std::max(numbers_[i].count, 1));
            double best_density = -std::numeric_limits<double>::infinity();
            bool is_new = can_create(numbers_[i]);
            Expected chosen;
            WeighedInnovation chosen_weight;
            for (std::size_t slot = 0; slot < count && numbers_[i].count; ++slot) {
                const Expected found = expect(numbers_[i], poses_[k], chunks_.read(k, slot));
                const WeighedInnovation weighed = weigh_innovation(
                    found.model.innovation, innovation_covariance(found, P), found.model.count);
                if (!weighed.is_regular) continue;
                is_new = is_new && weighed.nis > new_limit;
                if (is_taken[slot] || weighed.nis > pair_limit || weighed.log_density() <= best_density)
                    continue;
                best_density = weighed.log_density(), own_slots_[i] = slot, chosen = found,
                chosen_weight = weighed;
            }
            const bool is_paired = own_slots_[i] != none;
            if (is_paired)
                is_taken[own_slots_[i]] = 1;
            else
                log_weights_[k] += log_unpaired(numbers_[i], new_limit);
            if (!is_paired && is_new) own_slots_[i] = next++;
            if (is_best) {
                if (is_paired) note_innovation(i, chosen.model.innovation, chosen_weight, chosen.model.count);
                outcomes_[i].verdict = is_paired                 ? ReadingVerdict::used
                                       : is_new                  ? ReadingVerdict::created
                                       : can_create(numbers_[i]) ? ReadingVerdict::rejected
                                                                 : ReadingVerdict::skipped;
                if (own_slots_[i] != none) outcomes_[i].name = std::int64_t(own_slots_[i]);
            }
        }
        counts_of_[k] = next;
        miss_landmarks(k, is_taken, is_best);
    }
    // The density of a reading that no landmark explains: that of the sensor at the limit of a new landmark.
    double log_unpaired(const MeasuredNumbers& numbers, double limit) const {
        double log_determinant = 0;
        for (int r = 0; r < numbers.count; ++r)
            log_determinant += std::log(variance_of(rule_.sensor, is_bearing(numbers, r)));
        return -0.5 * (limit + log_determinant + numbers.count * log_turn);
    }
    void miss_landmarks(std::size_t k, const std::vector<char>& is_taken, bool is_best) {
        if (is_best) best_expected_ = false;
        const SensorPose at = place_mounted(poses_[k], mount_);
        for (std::size_t slot = 0; slot < is_taken.size(); ++slot) {
            const ParticleLandmark& landmark = chunks_.read(k, slot);
            if (!is_in_view(rule_.sensor, at.see(landmark.point))) continue;
            if (landmark.seen >= rule_.landmarks.confirmed_after) {
                best_expected_ = best_expected_ || is_best;
            } else if (!is_taken[slot]) {
                ++chunks_.write(k, slot).missed;
            }
        }
    }
    void drop_landmarks(std::size_t k) {
        for (std::size_t slot = counts_of_[k]; slot-- > 0;) {
            const ParticleLandmark& landmark = chunks_.read(k, slot);
            if (landmark.seen >= rule_.landmarks.confirmed_after ||
                landmark.missed < rule_.landmarks.dropped_after)
                continue;
            const std::size_t last = --counts_of_[k];
            const ParticleLandmark moved = chunks_.read(k, last);
            chunks_.write(k, slot) = moved;
            chunks_.write(k, last) = {};
            ++counts_.dropped;
        }
    }
    void count_losses() {
        bool any_paired = false;
        for (const ReadingOutcome& outcome : outcomes_)
            any_paired = any_paired || outcome.verdict == ReadingVerdict::used;
        if (any_paired)
            rejections_.accept();
        else if (best_expected_)
            reject();
    }
    void count_outcome(const ReadingOutcome& outcome) {
        long* const counts[] = {&counts_.used, &counts_.rejected, &counts_.created, &counts_.skipped};
        ++*counts[std::size_t(outcome.verdict)];
    }

    void normalize() {
        const double largest = *std::max_element(log_weights_.begin(), log_weights_.end());
        double sum = 0;
        for (std::size_t k = 0; k < shares_.size(); ++k) {
            log_weights_[k] -= largest;
            sum += shares_[k] = std::exp(log_weights_[k]);
        }
        for (double& share : shares_) share /= sum;
    }
    // Low variance: one draw, then equal steps.
    void resample() {
        const std::size_t n = poses_.size();
        const FourWords drawn = draw_four(n, 0);
        const double start = uniform(drawn.word[0], drawn.word[1]);
        std::vector<std::uint32_t> sources(n);
        double sum = shares_[0];
        std::size_t from = 0;
        for (std::size_t k = 0; k < n; ++k) {
            const double mark = (double(k) + start) / double(n);
            while (sum < mark && from + 1 < n) sum += shares_[++from];
            sources[k] = std::uint32_t(from);
        }
        std::vector<Pose> poses(n);
        std::vector<std::size_t> counts(n);
        for (std::size_t k = 0; k < n; ++k) poses[k] = poses_[sources[k]], counts[k] = counts_of_[sources[k]];
        poses_ = std::move(poses), counts_of_ = std::move(counts);
        chunks_.select(sources);
        log_weights_.assign(n, 0);
        shares_.assign(n, 1.0 / double(n));
        ++counts_.resamplings;
    }

    Pose mean_pose() const {
        constexpr int rounds = 2;  // the second one moves it by the square of the spread
        Pose mean = poses_[heaviest()];
        for (int round = 0; round < rounds; ++round) {
            Vector3 offset{};
            for (std::size_t k = 0; k < poses_.size(); ++k) {
                const Vector3 xi = PlanarSpace::logarithm(PlanarSpace::between(mean, poses_[k]));
                for (std::size_t c = 0; c < 3; ++c) offset[c] += shares_[k] * xi[c];
            }
            mean = PlanarSpace::move(mean, offset.data());
        }
        return mean;
    }
    Covariance3 spread(const Pose& mean) const {
        Covariance3 P{};
        for (std::size_t k = 0; k < poses_.size(); ++k) {
            const Vector3 xi = PlanarSpace::logarithm(PlanarSpace::between(mean, poses_[k]));
            for (std::size_t c = 0; c < 9; ++c) P[c] += shares_[k] * xi[c / 3] * xi[c % 3];
        }
        return P;
    }
    void average_landmark(std::size_t slot, std::vector<MappedLandmark>& found,
                          std::vector<Symmetric2>& covariances) const {
        MappedLandmark mean;
        mean.name = names_[slot];
        for (std::size_t k = 0; k < poses_.size(); ++k) {
            const ParticleLandmark& landmark = chunks_.read(k, slot);
            for (std::size_t c = 0; c < 2; ++c) mean.point[c] += shares_[k] * landmark.point[c];
            mean.seen = std::max(mean.seen, landmark.seen);
        }
        if (!mean.seen) return;
        Symmetric2 C{};
        for (std::size_t k = 0; k < poses_.size(); ++k) {
            const ParticleLandmark& landmark = chunks_.read(k, slot);
            const double x = landmark.point[0] - mean.point[0], y = landmark.point[1] - mean.point[1];
            const double outer[] = {x * x, x * y, y * y};
            for (std::size_t c = 0; c < 3; ++c) C[c] += shares_[k] * (landmark.covariance[c] + outer[c]);
        }
        found.push_back(mean), covariances.push_back(add_start(mean.point, C));
    }
    // The covariance of a point of the map with that of the start, which turns it about the start.
    Symmetric2 add_start(const Vector2& point, Symmetric2 C) const {
        const double x = point[0] - start_.x, y = point[1] - start_.y;
        const double by_start[2][3] = {{start_.c, -start_.s, -y}, {start_.s, start_.c, x}};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                const double covariance = start_covariance_[3 * i + j];
                C[0] += by_start[0][i] * covariance * by_start[0][j];
                C[1] += by_start[0][i] * covariance * by_start[1][j];
                C[2] += by_start[1][i] * covariance * by_start[1][j];
            }
        }
        return C;
    }
};

}  // namespace cspace::localization
