// Laws of landmark SLAM: quantiles of χ², the panels of a covariance against a dense matrix, joint
// compatibility against all pairings, and shared maps of particles against copies.
#include <array>
#include <vector>

#include "check.hpp"
#include "cspace/localization/landmarks/fast_slam.hpp"
#include "random.hpp"

namespace {

using namespace cspace::localization;
using cspace::chi_square_quantile;
using cspace::chi_square_tail;
using Slam = EkfSlam<HeaderPanels>;

TEST(quantiles_of_chi_square_are_those_of_tables) {
    CHECK_NEAR(chi_square_quantile(0.999, 1), 10.827566170662733, 1e-9);
    CHECK_NEAR(chi_square_quantile(0.999, 2), 13.815510557964274, 1e-9);
    CHECK_NEAR(chi_square_quantile(0.95, 3), 7.814727903251179, 1e-9);
    CHECK_NEAR(chi_square_quantile(0.99, 12), 26.216967305535853, 1e-9);
    CHECK_NEAR(chi_square_quantile(0.5, 31), 30.33594245819812, 1e-9);
    for (int dof = 1; dof < 40; ++dof)
        CHECK_NEAR(chi_square_tail(chi_square_quantile(0.9, dof), dof), 0.1, 1e-12);
}

// A filter that has seen some landmarks from some poses.
Slam make_slam(check::Random& random, int landmarks, Linearization linearization = Linearization::invariant) {
    EkfSlamRule rule;
    rule.linearization = linearization;
    rule.landmarks.gate = 1 - 1e-15;
    Slam slam(rule, {0, 0, 0}, {0.02, 0, 0, 0, 0.02, 0, 0, 0, 0.01});
    std::vector<Vector2> points(std::size_t(landmarks) + 0);
    for (Vector2& point : points) point = {random.uniform(-5, 5), random.uniform(-5, 5)};
    for (int step = 0; step < 4; ++step) {
        std::vector<LandmarkReading> readings;
        const auto& pose = slam.pose();
        for (int j = 0; j < landmarks; ++j) {
            const auto h = PlanarSpace::to_base(pose, points[std::size_t(j)]);
            readings.push_back({j, std::hypot(h[0], h[1]) + random.uniform(-0.1, 0.1),
                                std::atan2(h[1], h[0]) + random.uniform(-0.01, 0.01)});
        }
        slam.update(readings);
        const double twist[3] = {0.3, 0, 0.2};
        slam.predict(PlanarSpace::exponential(twist), {0.003, 0, 0, 0, 0.002, 0, 0, 0, 0.004});
    }
    return slam;
}

TEST(panels_hold_a_symmetric_matrix_and_add_products) {
    check::Random random{1};
    for (int panels = 1; panels < 6; ++panels) {
        const std::size_t n = std::size_t(4 * panels);
        for (int rank = 0; rank < 11; ++rank) {
            std::vector<double> P(panel_offset(std::size_t(panels))), X(std::size_t(rank) * n), Y(X.size());
            for (double& x : P) x = random.uniform(-1, 1);
            for (double& x : X) x = random.uniform(-1, 1);
            for (double& x : Y) x = random.uniform(-1, 1);
            const std::vector<double> before = P;
            HeaderPanels::add(P.data(), 0, panels, X.data(), Y.data(), std::ptrdiff_t(n), rank);
            for (std::size_t row = 0; row < n; ++row) {
                for (std::size_t column = 0; column < 4 * (row / 4 + 1); ++column) {
                    const std::size_t at = panel_offset(row / 4) + 4 * column + row % 4;
                    double sum = before[at];
                    for (std::size_t k = 0; k < std::size_t(rank); ++k)
                        sum += X[k * n + row] * Y[k * n + column];
                    CHECK_NEAR(P[at], sum, 1e-13);
                }
            }
        }
    }
}

TEST(blocks_are_symmetric_and_columns_are_blocks) {
    check::Random random{2};
    for (int count = 1; count < 8; ++count) {
        const Slam slam = make_slam(random, count);
        const auto& P = slam.covariance();
        CHECK(P.landmarks() == count);
        std::vector<double> first(P.padded()), second(P.padded());
        for (int j = 0; j < count; ++j) {
            P.copy_columns(j, first.data(), second.data());
            for (int i = 0; i < count; ++i) {
                const Matrix2 block = P.block(i, j), other = P.block(j, i);
                CHECK_NEAR(block[1], other[2], 1e-15);
                CHECK_NEAR(block[0], first[std::size_t(2 * i)], 1e-15);
                CHECK_NEAR(block[2], first[std::size_t(2 * i + 1)], 1e-15);
                CHECK_NEAR(block[1], second[std::size_t(2 * i)], 1e-15);
                CHECK_NEAR(block[3], second[std::size_t(2 * i + 1)], 1e-15);
            }
        }
    }
}

TEST(a_landmark_that_is_removed_leaves_the_others_as_they_are) {
    check::Random random{3};
    for (int count = 2; count < 8; ++count) {
        const Slam slam = make_slam(random, count);
        for (int gone = 0; gone < count; ++gone) {
            auto P = slam.covariance();
            P.remove_landmark(gone);
            CHECK(P.landmarks() == count - 1);
            const auto source = [&](int j) { return j == gone ? count - 1 : j; };
            for (int i = 0; i < count - 1; ++i) {
                for (int j = 0; j < count - 1; ++j) {
                    const Matrix2 a = P.block(i, j), b = slam.covariance().block(source(i), source(j));
                    for (std::size_t k = 0; k < 4; ++k) CHECK_NEAR(a[k], b[k], 1e-15);
                }
                for (std::size_t k = 0; k < 3; ++k)
                    CHECK_NEAR(P.cross(k)[std::size_t(2 * i)],
                               slam.covariance().cross(k)[std::size_t(2 * source(i))], 0);
            }
        }
    }
}

// All pairings, each tested as a whole: most pairs, then the least NIS.
struct Exhaustive {
    const JointCovariance<HeaderPanels>& P;
    const std::vector<std::vector<Candidate>>& candidates;
    double share;
    int best_count = -1;
    double best_nis = 0;

    void visit(std::size_t i, std::vector<const Candidate*>& chosen) {
        if (i == candidates.size()) return judge(chosen);
        visit(i + 1, chosen);
        for (const Candidate& candidate : candidates[i]) {
            bool is_taken = false;
            for (const Candidate* other : chosen)
                is_taken = is_taken || other->landmark == candidate.landmark;
            if (is_taken) continue;
            chosen.push_back(&candidate);
            visit(i + 1, chosen);
            chosen.pop_back();
        }
    }
    void judge(const std::vector<const Candidate*>& chosen) {
        const std::size_t n = 2 * chosen.size();
        std::vector<std::vector<double>> S(n, std::vector<double>(n + 1));
        for (std::size_t a = 0; a < chosen.size(); ++a) {
            for (std::size_t b = 0; b < chosen.size(); ++b) {
                const Matrix2 block = innovation_block(P, chosen[a]->model, chosen[a]->landmark,
                                                       chosen[b]->model, chosen[b]->landmark);
                for (std::size_t k = 0; k < 4; ++k) S[2 * a + k / 2][2 * b + k % 2] = block[k];
            }
            for (std::size_t k = 0; k < 2; ++k) {
                S[2 * a + k][2 * a + k] += chosen[a]->model.noise[k];
                S[2 * a + k][n] = chosen[a]->model.innovation[k];
            }
        }
        // Elimination without pivoting: νᵀ S⁻¹ ν is the sum of the squares of what is left, over the pivots.
        double nis = 0;
        for (std::size_t k = 0; k < n; ++k) {
            nis += S[k][n] * S[k][n] / S[k][k];
            for (std::size_t i = k + 1; i < n; ++i) {
                const double multiple = S[i][k] / S[k][k];
                for (std::size_t j = k; j <= n; ++j) S[i][j] -= multiple * S[k][j];
            }
        }
        if (n && nis > chi_square_quantile(share, int(n))) return;
        if (int(chosen.size()) < best_count || (int(chosen.size()) == best_count && nis >= best_nis)) return;
        best_count = int(chosen.size()), best_nis = nis;
    }
};

TEST(joint_compatibility_finds_the_best_of_all_pairings) {
    check::Random random{4};
    int partial = 0;
    for (int round = 0; round < 200; ++round) {
        const Slam slam = make_slam(random, 5);
        const SensorPose at = place_sensor(slam.pose(), {});
        const RangeBearingSensor sensor;
        std::vector<std::vector<Candidate>> candidates(4);
        for (auto& of_reading : candidates) {
            const int near = random.below(5);
            const Vector2 seen = predict_reading(at.see(slam.landmarks()[std::size_t(near)].point));
            const LandmarkReading reading{-1, seen[0] + random.uniform(-0.8, 0.8),
                                          seen[1] + random.uniform(-0.3, 0.3)};
            for (int j = 0; j < 5; ++j) {
                const Vector2 point = slam.landmarks()[std::size_t(j)].point;
                const ReadingModel model =
                    model_reading(read_numbers(reading, sensor), sensor, at, point,
                                  {point[0] - slam.pose().x, point[1] - slam.pose().y});
                JointInnovation alone;
                Matrix2 own = innovation_block(slam.covariance(), model, j, model, j);
                own[0] += model.noise[0], own[3] += model.noise[1];
                if (alone.append(model, nullptr, own) && alone.nis() < 40)
                    of_reading.push_back({j, model, alone.nis()});
            }
        }
        Exhaustive all{slam.covariance(), candidates, 0.99};
        std::vector<const Candidate*> chosen;
        all.visit(0, chosen);
        PairingSearch search(slam.covariance(), candidates, {0.99, 1000000, true});
        search.search_pairings();
        CHECK(search.count() == all.best_count);
        CHECK_NEAR(search.nis(), all.best_nis, 1e-8 * (1 + all.best_nis));
        partial += all.best_count > 0 && all.best_count < 4;
        PairingSearch capped(slam.covariance(), candidates, {0.99, 1, true});
        capped.search_pairings();
        CHECK(capped.count() <= all.best_count);
    }
    CHECK(partial > 20);
}

TEST(maps_that_are_shared_are_those_that_are_copied) {
    check::Random random{5};
    constexpr std::size_t particles = 7;
    LandmarkChunks shared(particles);
    std::vector<std::vector<double>> copies(particles, std::vector<double>(50));
    for (int step = 0; step < 400; ++step) {
        const std::size_t k = std::size_t(random.below(int(particles))), slot = std::size_t(random.below(50));
        shared.write(k, slot).point[0] = copies[k][slot] = random.uniform(-1, 1);
        if (step % 10 == 9) {
            std::vector<std::uint32_t> sources(particles);
            for (auto& source : sources) source = std::uint32_t(random.below(int(particles)));
            shared.select(sources);
            const auto before = copies;
            for (std::size_t p = 0; p < particles; ++p) copies[p] = before[sources[p]];
        }
        CHECK(shared.used() <= particles * 4);
        for (std::size_t p = 0; p < particles; ++p) {
            for (std::size_t s = 0; s < 50; ++s) CHECK_NEAR(shared.read(p, s).point[0], copies[p][s], 0);
        }
    }
}

// A check that throws on its n-th call.
struct Interrupted {};
int calls_left = -1;
void interrupt() {
    if (calls_left >= 0 && calls_left-- == 0) throw Interrupted();
}

TEST(an_update_that_was_interrupted_is_finished_by_the_next_call) {
    check::Random random{6};
    std::vector<LandmarkReading> all, some;
    for (int j = 0; j < 1500; ++j) all.push_back({j, random.uniform(1, 9), random.uniform(-3, 3)});
    some.assign(all.begin(), all.begin() + 5);
    Slam whole({}, {0, 0, 0}, {0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.001});
    whole.update(all);
    Slam stopped = whole;
    // Products are put off, so that the check comes in one of the next updates; that one uses no readings.
    bool was_stopped = false;
    for (int k = 0; k < 3; ++k) whole.update(some);
    for (int k = 0; k < 3; ++k) {
        cspace::set_interrupt_check(interrupt);
        calls_left = 0;
        cspace::interrupts::next_check = {};
        try {
            stopped.update(some);
        } catch (const Interrupted&) {
            was_stopped = true, --k;
        }
        cspace::set_interrupt_check(nullptr);
    }
    CHECK(was_stopped);
    whole.predict({}, {}), stopped.predict({}, {});
    for (int j = 0; j < 1500; j += 7) {
        const Matrix2 a = whole.covariance().block(j, 1499 - j), b = stopped.covariance().block(j, 1499 - j);
        for (std::size_t k = 0; k < 4; ++k) CHECK_NEAR(a[k], b[k], 0);
    }
}

}  // namespace
