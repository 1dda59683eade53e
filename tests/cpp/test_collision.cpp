// Laws of collision checks: verdicts against distances in double, proofs against dense samples.
#include <array>
#include <stdexcept>

#include "check.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::collision;
using Row = std::vector<double>;

// Around contact, where floats may decide either way: the slack of the robot, and the rounding that it
// covers. The checks have no other margin.
double band_of(const check::RandomCell& cell) { return 2.5 * double(cell.checker->scene().margin); }

Row between(const Row& a, const Row& b, double share) {
    Row q = a;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] += share * (b[k] - a[k]);
    return q;
}

}  // namespace

TEST(a_verdict_is_the_sign_of_the_clearance_alone_and_in_a_batch) {
    check::Random random{1};
    int touching = 0;
    for (int arm = 0; arm < 200; ++arm) {
        const auto cell = check::random_cell(random, 1 + random.below(10), 0, arm % 2);
        const auto memory = cell.checker->borrow_workspace();
        constexpr std::size_t rows = 37;
        std::vector<double> all;
        std::array<std::uint8_t, rows> batch{};
        std::array<bool, rows> single{};
        for (std::size_t i = 0; i < rows; ++i) {
            const Row q = cell.configuration(random);
            all.insert(all.end(), q.begin(), q.end());
            single[i] = !cell.checker->is_free(q.data(), *memory);
            const double distance = cell.checker->clearance(q.data()).distance;
            touching += single[i];
            if (std::fabs(distance) > band_of(cell)) CHECK(single[i] == (distance < 0));
        }
        for (const int threads : {1, 3}) {
            cell.checker->check_rows(all.data(), rows, batch.data(), threads);
            for (std::size_t i = 0; i < rows; ++i) CHECK(bool(batch[i]) == single[i]);
        }
    }
    CHECK(touching > 200);
}

TEST(no_configuration_of_a_proved_edge_touches_anything) {
    check::Random random{2};
    int proved = 0, blocked = 0, undecided = 0;
    for (int arm = 0; arm < 80; ++arm) {
        const auto cell = check::random_cell(random, 1 + random.below(9), 0, arm % 2);
        const auto memory = cell.checker->borrow_workspace();
        for (int i = 0; i < 40; ++i) {
            const Row a = cell.configuration(random);
            const Row b = between(a, cell.configuration(random), random.uniform(0, 1) < 0.5 ? 0.2 : 1.0);
            const Verdict verdict = cell.checker->prove_edge(a.data(), b.data(), *memory);
            CHECK(cell.checker->prove_edge(b.data(), a.data(), *memory) == verdict);
            proved += verdict == Verdict::free, blocked += verdict == Verdict::blocked;
            undecided += verdict == Verdict::undecided;
            if (verdict == Verdict::free) {
                for (int k = 0; k <= 200; ++k)
                    CHECK(cell.checker->clearance(between(a, b, k / 200.0).data()).distance > 0);
                const double s = random.uniform(0, 0.5), t = random.uniform(0.5, 1);
                const Row c = between(a, b, s), d = between(a, b, t);
                CHECK(cell.checker->prove_edge(c.data(), d.data(), *memory) == Verdict::free);
                CHECK(cell.checker->sample_edge(a.data(), b.data(), 0.01, *memory) == Verdict::free);
            }
            if (verdict == Verdict::blocked) {
                cell.checker->prove_edge(a.data(), b.data(), *memory);
                const double where = 0.5 * (double(memory->w.contact.at) + 1);
                CHECK(cell.checker->clearance(between(a, b, where).data()).distance < band_of(cell));
                CHECK(where >= 0 && where <= 1);
            }
        }
    }
    std::printf("%d proved, %d blocked, %d undecided\n", proved, blocked, undecided);
    CHECK(proved > 300 && blocked > 300 && undecided < 10);
}

TEST(samples_are_the_same_both_ways_and_include_the_ends) {
    check::Random random{3};
    for (int arm = 0; arm < 60; ++arm) {
        const auto cell = check::random_cell(random, 1 + random.below(9));
        const auto memory = cell.checker->borrow_workspace();
        for (int i = 0; i < 30; ++i) {
            const Row a = cell.configuration(random), b = cell.configuration(random);
            const Verdict verdict = cell.checker->sample_edge(a.data(), b.data(), 1.0 / 32, *memory);
            CHECK(cell.checker->sample_edge(b.data(), a.data(), 1.0 / 32, *memory) == verdict);
            if (verdict != Verdict::free) continue;
            CHECK(cell.checker->is_free(a.data(), *memory));
            CHECK(cell.checker->is_free(b.data(), *memory));
            CHECK(cell.checker->prove_edge(a.data(), a.data(), *memory) == Verdict::free);
        }
    }
}

TEST(a_margin_keeps_spheres_that_far_away) {
    for (int arm = 0; arm < 40; ++arm) {
        check::Random one{std::uint64_t(100 + arm)}, other{std::uint64_t(100 + arm)};
        const int n = 1 + arm % 7;
        const auto bare = check::random_cell(one, n), wide = check::random_cell(other, n, 0.02);
        const auto memory = wide.checker->borrow_workspace(), bare_memory = bare.checker->borrow_workspace();
        for (int i = 0; i < 30; ++i) {
            const Row q = bare.configuration(one);
            const double distance = bare.checker->clearance(q.data()).distance;
            const bool is_free = wide.checker->is_free(q.data(), *memory);
            if (std::fabs(distance - 0.02) > band_of(bare)) CHECK(is_free == (distance > 0.02));
            if (is_free) CHECK(bare.checker->is_free(q.data(), *bare_memory));
        }
    }
}

TEST(the_gradient_of_the_clearance_is_its_difference_quotient) {
    check::Random random{5};
    int tested = 0;
    for (int arm = 0; arm < 60; ++arm) {
        const auto cell = check::random_cell(random, 1 + random.below(9));
        for (int i = 0; i < 10; ++i) {
            Row q = cell.configuration(random);
            const Clearance here = cell.checker->clearance(q.data());
            if (here.nearest.other < 0 || here.is_crease) continue;
            const double h = 1e-6;
            for (std::size_t k = 0; k < q.size(); ++k) {
                const double kept = q[k];
                q[k] = kept + h;
                const Clearance after = cell.checker->clearance(q.data());
                q[k] = kept - h;
                const Clearance before = cell.checker->clearance(q.data());
                q[k] = kept;
                const auto same = [&](const Clearance& c) {
                    return c.nearest.link == here.nearest.link && c.nearest.other == here.nearest.other;
                };
                if (!same(after) || !same(before)) continue;
                const double forward = (after.distance - here.distance) / h,
                             back = (here.distance - before.distance) / h;
                if (std::fabs(forward - back) > 1e-3) continue;  // another sphere of the same link takes over
                CHECK_NEAR(here.gradient[k], (forward + back) / 2, 1e-5);
                ++tested;
            }
        }
    }
    CHECK(tested > 500);
}

TEST(numbers_that_do_not_fit_are_refused) {
    const auto is_refused = [](int coordinates, std::vector<model::Joint> joints, std::vector<int> bodies,
                               std::vector<Sphere> spheres, std::vector<std::pair<int, int>> pairs) {
        const Row limits(std::size_t(coordinates), 1.0);
        try {
            RobotData(joints, coordinates, limits, limits, bodies, spheres, pairs);
        } catch (const std::invalid_argument&) {
            return true;
        }
        return false;
    };
    const model::Joint joint = {identity_pose(), -1, 0, 1, 0, false, 0};
    model::Joint orphan = joint, foreign = joint;
    orphan.parent = 0, foreign.coordinate = 1;
    const Sphere first = {{0, 0, 0}, 0.1, 0}, second = {{0, 0, 0}, 0.1, 1};
    CHECK(!is_refused(1, {joint}, {0, 1}, {first, second}, {{0, 1}}));
    CHECK(is_refused(65, {joint}, {0, 1}, {first, second}, {{0, 1}}));
    CHECK(is_refused(1, {orphan}, {0, 1}, {first, second}, {{0, 1}}));
    CHECK(is_refused(1, {foreign}, {0, 1}, {first, second}, {{0, 1}}));
    CHECK(is_refused(1, {joint}, {1, 0}, {first, second}, {{0, 1}}));
    CHECK(is_refused(1, {joint}, {0, 2}, {first, second}, {{0, 1}}));
    CHECK(is_refused(1, {joint}, {0, 1}, {second, first}, {{0, 1}}));
    CHECK(is_refused(1, {joint}, {0, 1}, {first, second}, {{0, 2}}));
    CHECK(is_refused(1, {joint}, {1, 1}, {first, second}, {{0, 1}}));
}
