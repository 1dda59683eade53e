// Laws of cells: what is proved of a cell holds at every configuration in it, in double.
#include "check.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::collision;
using Row = std::vector<double>;

constexpr std::uint8_t touches = 1, is_proved = 2;

std::uint8_t settle(const check::RandomCell& cell, const Row& q, const Row& half) {
    std::uint8_t verdict = 0;
    cell.checker->check_cells(q.data(), 1, half.data(), &verdict, 1);
    return verdict;
}

// A configuration of a cell, in a corner of some coordinates more often than not.
Row within(check::Random& random, const Row& q, const Row& half) {
    Row place = q;
    for (std::size_t k = 0; k < q.size(); ++k)
        place[k] += half[k] * std::fmax(-1.0, std::fmin(1.0, random.uniform(-2, 2)));
    return place;
}

Row random_half(check::Random& random, std::size_t dof) {
    Row half(dof, 0.0);
    const double size = std::pow(10, random.uniform(-3, 0));
    for (double& h : half)
        if (random.uniform(0, 1) < 0.6) h = random.uniform(0, size);
    return half;
}

}  // namespace

TEST(what_is_proved_of_a_cell_holds_at_all_of_its_configurations) {
    check::Random random{1};
    int free = 0, blocked = 0, open = 0;
    for (int arm = 0; arm < 120; ++arm) {
        const double margin = arm % 4 == 0 ? 0.03 : 0.0;
        const auto cell = check::random_cell(random, 1 + random.below(9), margin);
        for (int i = 0; i < 40; ++i) {
            const Row q = cell.configuration(random), half = random_half(random, q.size());
            const std::uint8_t verdict = settle(cell, q, half);
            if (!(verdict & is_proved)) {
                ++open;
                continue;
            }
            const bool is_blocked = verdict & touches;
            (is_blocked ? blocked : free) += 1;
            for (int k = 0; k < 30; ++k) {
                const double distance =
                    cell.checker->clearance(within(random, q, half).data()).distance - margin;
                CHECK(is_blocked ? distance <= 0 : distance >= 0);
            }
        }
    }
    std::printf("%d free, %d blocked, %d open\n", free, blocked, open);
    CHECK(free > 500 && blocked > 300);
}

TEST(the_middle_of_a_cell_is_decided_as_alone_and_on_every_number_of_threads) {
    check::Random random{2};
    for (int arm = 0; arm < 40; ++arm) {
        const auto cell = check::random_cell(random, 1 + random.below(9));
        constexpr std::size_t rows = 5003;
        std::vector<double> all;
        for (std::size_t i = 0; i < rows; ++i) {
            const Row q = cell.configuration(random);
            all.insert(all.end(), q.begin(), q.end());
        }
        const Row half = random_half(random, cell.lower.size());
        std::vector<std::uint8_t> hits(rows), one(rows), several(rows);
        cell.checker->check_rows(all.data(), rows, hits.data(), 1);
        cell.checker->check_cells(all.data(), rows, half.data(), one.data(), 1);
        cell.checker->check_cells(all.data(), rows, half.data(), several.data(), 3);
        CHECK(one == several);
        for (std::size_t i = 0; i < rows; ++i) CHECK((one[i] & touches) == hits[i]);
    }
}

TEST(a_cell_of_one_configuration_is_proved_and_narrow_cells_are_nearly_all) {
    check::Random random{3};
    int all = 0, proved = 0;
    for (int arm = 0; arm < 60; ++arm) {
        const auto cell = check::random_cell(random, 1 + random.below(9));
        for (int i = 0; i < 40; ++i) {
            const Row q = cell.configuration(random);
            const double distance = cell.checker->clearance(q.data()).distance;
            if (std::fabs(distance) > 4 * double(cell.checker->scene().margin))
                CHECK(settle(cell, q, Row(q.size(), 0.0)) & is_proved);
            ++all;
            proved += (settle(cell, q, Row(q.size(), 1e-3)) & is_proved) != 0;
        }
    }
    std::printf("%d of %d\n", proved, all);
    CHECK(proved > 0.95 * all);
}
