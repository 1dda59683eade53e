// Particles of Monte Carlo localisation: draws, whole-number weights, systematic draws, bins, modes, moves.
#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "cspace/localization/particles/beam_scores.hpp"
#include "cspace/localization/particles/cell_rows.hpp"
#include "cspace/localization/particles/integer_weights.hpp"
#include "cspace/localization/particles/modes.hpp"
#include "cspace/localization/particles/move.hpp"
#include "cspace/localization/particles/systematic.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::localization;

namespace {

TEST(headings) {
    for (const double angle : {0.0, 1.0, -1.0, 3.1, -3.1, 7.0, -100.0}) {
        const double back = angle_of(heading_of(angle));
        CHECK(std::fabs(std::remainder(back - angle, 2 * 3.14159265358979323846)) < 2 * heading_unit);
    }
    CHECK(angle_of(heading_of(3.14159265358979323846)) > 3.14);
    CHECK(Heading(heading_of(2.0) + heading_of(-2.0)) == 0u);
}

TEST(words_of_draws) {
    const FourWords drawn = draw_words({{0, 0, 0, 0}}, {{0, 0}});
    const std::uint32_t expected[] = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
    CHECK(std::equal(expected, expected + 4, drawn.word));
    for (const std::uint32_t word : {0u, ~0u, 1u << 31}) {
        const float u = uniform_float(word);
        CHECK(u > 0 && u < 1);
        CHECK(std::fabs(log_float(u) - std::log(u)) <= 2e-7 * std::fabs(std::log(u)) + 1e-7);
    }
}

TEST(rows_of_cells) {
    check::Random random{5};
    for (int count = 1; count < 60; ++count) {
        std::vector<std::vector<double>> given(3);
        for (auto& row : given)
            for (int i = 0; i < count; ++i) row.push_back(random.uniform(0, 1));
        const double* rows[] = {given[0].data(), given[1].data(), given[2].data()};
        const double weights[] = {0.2, 0.5, 0.3};
        std::vector<double> mixed(static_cast<std::size_t>(count));
        mix_number_rows(rows, weights, 3, mixed.data(), count);
        std::vector<std::int32_t> sums;
        std::vector<double> made(mixed.size());
        const double factors[] = {1, 0.5, 0.25};
        double expected = 0;
        for (std::size_t i = 0; i < mixed.size(); ++i) {
            sums.push_back(7 + std::int32_t(i) % 3);
            const double x = 0.2 * given[0][i] + 0.5 * given[1][i] + 0.3 * given[2][i];
            CHECK(std::fabs(mixed[i] - x) < 1e-15);
            expected += (0.9 * given[0][i] + given[1][i]) * factors[i % 3] * given[2][i];
        }
        const CellWeights cells{factors, 7, 0.9, given[1].data(), given[2].data()};
        const double total = weigh_number_row(cells, given[0].data(), sums.data(), made.data(), count);
        CHECK(std::fabs(total - expected) < 1e-13 * (1 + expected));
        CHECK(std::fabs(sum_number_row(made.data(), count) - expected) < 1e-13 * (1 + expected));
        scale_number_row(2, 0.3, made.data(), count);
        for (std::size_t i = 0; i < made.size(); ++i) CHECK(made[i] == 0 || made[i] >= 0.3);
    }
    std::vector<std::uint8_t> bytes(80);
    std::vector<std::uint16_t> sums(40, 9);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::uint8_t(3 * i);
    add_byte_rows(bytes.data(), 40, sums.data(), 20, 2, 1, 5);
    for (std::size_t i = 0; i < 20; ++i)
        for (std::size_t row = 0; row < 2; ++row)
            CHECK(sums[20 * row + i] == (i < 16 ? 9 + bytes[40 * row + i] - 5 : 9));
}

TEST(weights) {
    const WeightTable table;
    CHECK(table.weight_of(0) >= 0xfffffffeu);
    CHECK(table.weight_of(least_log) == 0);
    for (int k = 0; k < 24'000'000; k += 99'991) {
        const double exact = std::exp(-k / log_units) * 4294967295.0;
        CHECK(std::fabs(table.weight_of(-k) - exact) <= 2 + 1e-6 * exact);
    }
}

TEST(systematic_draws) {
    check::Random rng{3};
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<std::uint64_t> weights;
        std::uint64_t total = 0, bound = 0;
        for (int k = 0; k < 20; ++k) total += weights.emplace_back(std::uint64_t(rng.uniform(0, 4e9)));
        const std::size_t n = 1 + std::size_t(rng.uniform(0, 500));
        SystematicDraws draws(total, n, std::uint64_t(rng.uniform(0, 1e18)));
        std::size_t made = 0;
        for (const std::uint64_t weight : weights) {
            const std::size_t copies = draws.count_below(bound += weight);
            made += copies;
            CHECK(std::fabs(double(copies) - double(n) * double(weight) / double(total)) < 1 + 1e-6);
        }
        CHECK(made == n);
    }
    CHECK(count_for_bins(1, 0.05, 2.326) == 0);
    CHECK(std::lround(count_for_bins(100, 0.05, 2.326)) == 1346);
}

TEST(bins_and_modes) {
    BinTable bins;
    for (int k = 0; k < 3000; ++k) CHECK(bins.number_of({k % 60 - 30, k / 60, k % 7}) == k);
    CHECK(bins.find({-30, 0, 0}) == 0 && bins.find({-30, 0, 1}) == -1);
    std::vector<double> x, y;
    std::vector<Heading> headings;
    for (int k = 0; k < 100; ++k) {
        x.push_back(k < 70 ? 1 + 1e-3 * k : 9), y.push_back(2);
        headings.push_back(heading_of(k % 2 ? 3.14 : -3.14));
    }
    const std::vector<std::uint32_t> weights(100, 1u << 30);
    const auto modes = find_pose_modes({x, y, headings, weights});
    CHECK(modes.size() == 2);
    CHECK(modes[0].weight == 70ull << 30);
    CHECK(std::fabs(std::fabs(modes[0].pose[2]) - 3.14159265358979323846) < 1e-6);
    CHECK(std::fabs(modes[1].pose[0] - 9) < 1e-12);
    CHECK(find_pose_modes({}).empty());
}

TEST(moves) {
    double x[8] = {}, y[8] = {};
    Heading headings[8] = {};
    for (int k = 0; k < 8; ++k) headings[k] = heading_of(0.5 * k);
    MotionStep step = {0.5f, 0.1f, std::cos(0.3f), std::sin(0.3f), heading_of(0.3), {}, {{1, 2}}, 0};
    move_particles_by(step, 0, 8, x, y, headings);
    for (int k = 0; k < 8; ++k) {
        const double c = std::cos(0.5 * k), s = std::sin(0.5 * k);
        CHECK(std::fabs(x[k] - (0.5 * c - 0.1 * s)) < 1e-6 && std::fabs(y[k] - (0.5 * s + 0.1 * c)) < 1e-6);
        CHECK(std::fabs(std::remainder(angle_of(headings[k]) - 0.5 * k - 0.3, 6.283185307179586)) < 1e-6);
    }
    // Extreme noise stays a number.
    for (float& noise : step.noise) noise = 1e6f;
    move_particles_by(step, 0, 8, x, y, headings);
    for (int k = 0; k < 8; ++k) CHECK(std::isfinite(x[k]) && std::isfinite(y[k]));
}

TEST(scores) {
    std::vector<std::uint8_t> scores(6 * 7, 1);
    for (int row = 1; row < 5; ++row)
        for (int column = 1; column < 6; ++column) scores[std::size_t(7 * row + column)] = 100;
    const ScoreCells map = {scores.data(), 4, 5, 7, 10, 20, 2};
    double x[8] = {10.1, 12.4, 9.9, 12.6, 10.1, 1e300, -1e300, std::nan("")};
    double y[8] = {20.1, 21.9, 20.1, 21.9, 22.1, 20, 20, 20};
    const Heading headings[8] = {};
    const float beam_x[] = {0}, beam_y[] = {0};
    std::int32_t sums[8];
    sum_beam_scores(map, x, y, headings, 8, beam_x, beam_y, 1, sums);
    const std::int32_t expected[] = {100, 100, 1, 1, 1, 1, 1};
    CHECK(std::equal(expected, expected + 7, sums));
}

}  // namespace
