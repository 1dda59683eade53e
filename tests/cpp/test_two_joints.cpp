// The configuration space of a planar arm with two joints against the distance between segments.
#include "check.hpp"
#include "cspace/planning/two_joints/bitmap.hpp"
#include "two_link_arms.hpp"

using namespace cspace;
using namespace cspace::planning::two_joints;

namespace {

constexpr double rounding = 1e-9;  // of a clearance: nearer to zero either verdict is right

}  // namespace

TEST(single_configurations_are_free_where_segments_are_apart) {
    check::Random random{1};
    int free = 0, blocked = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Space space(problem.arm, problem.obstacles);
        for (int k = 0; k < 200; ++k) {
            const double q_1 = random.uniform(-7, 7), q_2 = random.uniform(-7, 7);
            const double clearance = check::clearance(problem.arm, problem.obstacles, q_1, q_2);
            if (std::abs(clearance) < rounding) continue;
            const bool touches = space.blocks(q_1, q_2) != no_obstacle;
            CHECK(touches == (clearance < 0));
            touches ? ++blocked : ++free;
        }
    }
    CHECK(free > 10000 && blocked > 10000);
}

TEST(every_cell_of_a_bitmap_is_that_of_its_centre) {
    check::Random random{2};
    for (int trial = 0; trial < 40; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Space space(problem.arm, problem.obstacles);
        const int rows = 20 + random.below(60), columns = 20 + random.below(60);
        std::vector<char> cells(std::size_t(rows) * std::size_t(columns));
        draw_bitmap(space, rows, columns, cells.data(), [](std::int32_t) { return char(1); });
        const Cells along(problem.arm.joint_1, rows), across(problem.arm.joint_2, columns);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const double clearance =
                    check::clearance(problem.arm, problem.obstacles, along.center(i), across.center(j));
                if (std::abs(clearance) > rounding)
                    CHECK(bool(cells[std::size_t(i * columns + j)]) == (clearance < 0));
            }
    }
}

TEST(ends_of_arcs_touch_and_nothing_beyond_them_does) {
    check::Random random{3};
    constexpr double beside = 1e-6;
    int seen[3] = {};
    for (int trial = 0; trial < 2000; ++trial) {
        const check::Problem problem = check::random_problem(random, false);
        const Space space(problem.arm, {problem.obstacles.data(), 1});
        const std::vector<Piece> one(problem.obstacles.begin(), problem.obstacles.begin() + 1);
        const double q_1 = random.uniform(-pi, pi);
        if (space.blocks_link_1(q_1) != no_obstacle) continue;
        space.visit_link_2(q_1, [&](const BlockedInterval& blocked) {
            const auto clearance_at = [&](double q_2) {
                return check::clearance(problem.arm, one, q_1, q_2);
            };
            CHECK_NEAR(clearance_at(blocked.low), 0, 1e-7);
            CHECK_NEAR(clearance_at(blocked.high), 0, 1e-7);
            CHECK(clearance_at(blocked.low - beside) > 0);
            CHECK(clearance_at(blocked.high + beside) > 0);
            CHECK(blocked.high - blocked.low <= pi + rounding);
            ++seen[int(blocked.at_low.contact)], ++seen[int(blocked.at_high.contact)];
        });
    }
    for (const int count : seen) CHECK(count > 50);
}

TEST(a_base_inside_an_obstacle_leaves_nothing_free) {
    const Point corners[] = {{-1, -1}, {1, -1}, {0, 1}};
    const Piece piece = make_piece(corners, 0, 7);
    const Space space(Arm{}, {&piece, 1});
    CHECK(space.obstacle_of(space.buried_in()) == 7);
    CHECK(space.obstacle_of(space.blocks(0.3, 0.4)) == 7);
}

TEST(arms_without_a_first_or_second_link_are_segments) {
    const Point corner[] = {{1, 0}};
    const Piece disc = make_piece(corner, 0.5, 0);
    Arm arm;
    arm.length_1 = 0;
    const Space second(arm, {&disc, 1});
    arm.length_1 = 1, arm.length_2 = 0;
    const Space first(arm, {&disc, 1});
    for (double q_1 = -3; q_1 < 3; q_1 += 0.1)
        for (double q_2 = -3; q_2 < 3; q_2 += 0.1) {
            CHECK((first.blocks(q_1, q_2) != no_obstacle) == (std::abs(q_1) <= pi / 6));
            CHECK((second.blocks(q_1, q_2) != no_obstacle) == (std::abs(short_way(q_1 + q_2)) <= pi / 6));
        }
}
