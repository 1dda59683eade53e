#include <cmath>

#include "check.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/harmonic.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

BitGrid random_grid(check::Random& random, int most, double share) {
    BitGrid grid(1 + random.below(most), 1 + random.below(most));
    for (int r = 0; r < grid.rows(); ++r)
        for (int c = 0; c < grid.columns(); ++c)
            if (random.uniform(0, 1) < share) grid.set(r, c, true);
    return grid;
}

}  // namespace

TEST(every_cell_is_the_mean_of_the_four_beside_it_and_descents_arrive) {
    check::Random random{1};
    for (int k = 0; k < 300; ++k) {
        BitGrid grid = random_grid(random, 40, random.uniform(0, 0.45));
        const Cell goal{random.below(grid.rows()), random.below(grid.columns())};
        grid.set(goal.row, goal.column, false);
        const HarmonicField field(grid, make_clearance(grid), goal, 1e-11, 400);
        CHECK(field.residual() <= 1e-11);
        CHECK(field.rests() == 0);
        CHECK(field.height(goal) == 0);
        for (int r = 0; r < grid.rows(); ++r)
            for (int c = 0; c < grid.columns(); ++c) {
                const double here = field.height({r, c});
                if (!std::isfinite(here) || (r == goal.row && c == goal.column)) continue;
                double mean = 0;
                for (const auto& [dr, dc] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
                    if (!grid.blocked(r + dr, c + dc))
                        mean += 0.25 * std::exp(here - field.height({r + dr, c + dc}));
                CHECK_NEAR(mean, 1, 1e-10);
                CHECK(field.descend({r, c}).found);
            }
    }
}

TEST(corridors_of_any_length_have_the_decay_that_is_known) {
    for (int wide = 1; wide <= 3; ++wide) {
        const BitGrid grid(wide, 2000);
        const HarmonicField field(grid, make_clearance(grid), {wide / 2, 0}, 1e-11, 400);
        CHECK(field.residual() <= 1e-11);
        CHECK(field.rests() == 0);
        const double rate = std::acosh(2 - std::cos(3.14159265358979323846 / (wide + 1)));
        CHECK_NEAR((field.height({wide / 2, 1900}) - field.height({wide / 2, 100})) / 1800, rate, 1e-9);
        CHECK(field.descend({0, 1999}).found);
    }
    // Of one cell: sinh((n − k) θ) / sinh(n θ), with 2 cosh θ = 4.
    const BitGrid grid(1, 20000);
    const HarmonicField field(grid, make_clearance(grid), {0, 0}, 1e-11, 400);
    const double theta = std::acosh(2.0);
    const auto log_sinh = [](double x) { return x + std::log1p(-std::exp(-2 * x)) - std::log(2.0); };
    for (const int k : {1, 100, 5000, 19999})
        CHECK_NEAR(field.height({0, k}), log_sinh(20000 * theta) - log_sinh((20000 - k) * theta), 1e-6);
}

TEST(what_is_not_connected_is_infinitely_high) {
    BitGrid grid(3, 5);
    for (int r = 0; r < 3; ++r) grid.set(r, 2, true);
    const HarmonicField field(grid, make_clearance(grid), {1, 0}, 1e-11, 400);
    CHECK(std::isinf(field.height({1, 4})));
    CHECK(std::isinf(field.height({1, 2})));
    CHECK(field.descend({1, 4}).cells.empty());
    CHECK(field.size() == 6);
    BitGrid alone(1, 1);
    const HarmonicField single(alone, make_clearance(alone), {0, 0}, 1e-11, 400);
    CHECK(single.descend({0, 0}).found);
}

TEST(a_check_that_throws_ends_the_solution) {
    const BitGrid grid(300, 300);
    const Clearance clearance = make_clearance(grid);
    static int checks = 0;
    set_interrupt_check([] {
        if (++checks == 3) throw checks;
    });
    bool ended = false;
    try {
        const HarmonicField field(grid, clearance, {0, 0}, 1e-11, 400);
    } catch (int) {
        ended = true;
    }
    set_interrupt_check(nullptr);
    CHECK(ended && checks == 3);
}
