#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "check.hpp"
#include "cspace/navigation/grid/search.hpp"
#include "random.hpp"

using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

struct Map {
    int rows, columns;
    std::vector<std::uint8_t> blocked;
    bool is_blocked(int r, int c) const {
        return r < 0 || r >= rows || c < 0 || c >= columns || blocked[std::size_t(r * columns + c)];
    }
    bool is_blocked(Cell c) const { return is_blocked(c.row, c.column); }
    BitGrid grid() const { return {blocked.data(), rows, columns}; }
};

Map random_map(check::Random& random, int rows, int columns, double share) {
    Map map = {rows, columns, {}};
    for (int k = 0; k < rows * columns; ++k) map.blocked.push_back(random.uniform(0, 1) < share);
    return map;
}
Cell random_free(check::Random& random, const Map& map) {
    for (;;) {
        const Cell c = {random.below(map.rows), random.below(map.columns)};
        if (!map.is_blocked(c)) return c;
    }
}

bool may_step(const Map& map, Corners rule, Cell c, int dr, int dc) {
    if (map.is_blocked(c.row + dr, c.column + dc)) return false;
    if (dr == 0 || dc == 0) return true;
    const int beside = map.is_blocked(c.row + dr, c.column) + map.is_blocked(c.row, c.column + dc);
    switch (rule) {
        case Corners::never:
            return beside == 0;
        case Corners::one:
            return beside < 2;
        case Corners::always:
            return true;
        default:
            return false;
    }
}

// The lengths of the shortest ways from a cell, by going over all steps until nothing gets shorter.
std::vector<double> lengths_from(const Map& map, Corners rule, Cell start) {
    std::vector<double> length(map.blocked.size(), std::numeric_limits<double>::infinity());
    length[std::size_t(start.row * map.columns + start.column)] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (int r = 0; r < map.rows; ++r)
            for (int c = 0; c < map.columns; ++c)
                for (int dr = -1; dr <= 1; ++dr)
                    for (int dc = -1; dc <= 1; ++dc) {
                        if (map.is_blocked(r, c) || !may_step(map, rule, {r, c}, dr, dc)) continue;
                        const double one = length[std::size_t(r * map.columns + c)] + std::hypot(dr, dc);
                        double& other = length[std::size_t((r + dr) * map.columns + c + dc)];
                        if (one < other - 1e-9) other = one, changed = true;
                    }
    }
    return length;
}

// The length of a way over steps that are allowed; NaN if one is not.
double walked(const Map& map, Corners rule, const std::vector<Cell>& cells) {
    double sum = 0;
    for (std::size_t k = 1; k < cells.size(); ++k) {
        Cell at = cells[k - 1];
        const int down = cells[k].row - at.row, along = cells[k].column - at.column;
        const int dr = (down > 0) - (down < 0), dc = (along > 0) - (along < 0);
        if (down && along && std::abs(down) != std::abs(along)) return NAN;
        while (!(at == cells[k])) {
            if (!may_step(map, rule, at, dr, dc)) return NAN;
            at = {at.row + dr, at.column + dc};
            sum += std::hypot(dr, dc);
        }
    }
    return sum;
}

const Corners all_rules[] = {Corners::never, Corners::one, Corners::always, Corners::four};

void compare(const Map& map, check::Random& random, int goals) {
    const BitGrid grid = map.grid();
    GridScratch scratch;
    GridAnswer answer;
    for (Corners rule : all_rules) {
        const Cell start = random_free(random, map);
        const std::vector<double> truth = lengths_from(map, rule, start);
        for (int k = 0; k < goals; ++k) {
            const Cell goal = random_free(random, map);
            const double best = truth[std::size_t(goal.row * map.columns + goal.column)];
            GridQuery query;
            query.corners = rule;
            query.metric = rule == Corners::four ? Metric::manhattan : Metric::octile;
            const auto ask = [&](GridPlanner planner, double g_weight, double h_weight, double factor) {
                query.planner = planner;
                query.g_weight = g_weight;
                query.h_weight = h_weight;
                query.bound = factor;
                find_way(grid, start, goal, query, scratch, answer);
                CHECK(answer.found == std::isfinite(best));
                if (!answer.found) return;
                CHECK(answer.cells.front() == start && answer.cells.back() == goal);
                const double length = walked(map, rule, answer.cells);
                CHECK(length >= best - 1e-9 && length <= factor * best + 1e-9);
            };
            constexpr double any = 1e9;
            ask(GridPlanner::best_first, 1, 1, 1);
            ask(GridPlanner::best_first, 1, 0, 1);
            ask(GridPlanner::best_first, 1, 2, 2);
            ask(GridPlanner::best_first, 0, 1, any);
            ask(GridPlanner::focal, 1, 1, 1.5);
            ask(GridPlanner::focal, 1, 1, 1.0);
            ask(GridPlanner::jump_points, 1, 1, 1);
            ask(GridPlanner::jump_points, 1, 0, 1);
            ask(GridPlanner::waves, 1, 0, rule == Corners::four ? 1 : any);
            if (rule != Corners::four) {
                query.metric = Metric::euclidean;
                ask(GridPlanner::best_first, 1, 1, 1);
                ask(GridPlanner::jump_points, 1, 1, 1);
            }
        }
    }
}

TEST(small_grids_under_every_rule) {
    check::Random random{1};
    for (int k = 0; k < 600; ++k) {
        Map map = random_map(random, 1 + random.below(12), 1 + random.below(12), random.uniform(0, 0.6));
        map.blocked[0] = 0;
        compare(map, random, 4);
    }
}
// What the cheapest ways from a cell cost, by going over all steps until nothing gets cheaper.
std::vector<double> costs_from(const Map& map, const std::vector<double>& costs, Corners rule, Cell start) {
    std::vector<double> least(map.blocked.size(), std::numeric_limits<double>::infinity());
    least[std::size_t(start.row * map.columns + start.column)] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (int k = 0; k < 9 * map.rows * map.columns; ++k) {
            const int r = k / 9 / map.columns, c = k / 9 % map.columns, dr = k % 9 / 3 - 1, dc = k % 3 - 1;
            if (map.is_blocked(r, c) || !may_step(map, rule, {r, c}, dr, dc)) continue;
            const std::size_t a = std::size_t(r * map.columns + c),
                              b = a + std::size_t(dr * map.columns + dc);
            const double over = least[a] + 0.5 * (costs[a] + costs[b]) * std::hypot(dr, dc);
            if (over < least[b] - 1e-9) least[b] = over, changed = true;
        }
    }
    return least;
}
// Costs that are often equal, or far from each other.
TEST(cheapest_ways_under_every_rule) {
    check::Random random{14};
    GridScratch scratch;
    GridAnswer answer;
    for (int k = 0; k < 1500; ++k) {
        Map map = random_map(random, 1 + random.below(11), 1 + random.below(11), random.uniform(0, 0.5));
        map.blocked[0] = 0;
        const BitGrid grid = map.grid();
        std::vector<double> costs;
        const int kinds = 1 + random.below(3);
        for (std::size_t i = 0; i < map.blocked.size(); ++i)
            costs.push_back(k % 3 ? 1 + random.below(kinds) : std::pow(10.0, random.uniform(0, 4)));
        for (const Corners rule : all_rules) {
            const Cell start = random_free(random, map), goal = random_free(random, map);
            const double best =
                costs_from(map, costs, rule, start)[std::size_t(goal.row * map.columns + goal.column)];
            GridQuery query;
            query.corners = rule;
            query.metric = rule == Corners::four ? Metric::manhattan : Metric::octile;
            query.costs = costs.data();
            query.least_cost = *std::min_element(costs.begin(), costs.end());
            for (const double h_weight : {0.0, 1.0, 1.5}) {
                query.h_weight = h_weight;
                find_way(grid, start, goal, query, scratch, answer);
                CHECK(answer.found == std::isfinite(best));
                if (!answer.found) continue;
                CHECK(answer.cost >= best * (1 - 1e-12) &&
                      answer.cost <= std::max(1.0, h_weight) * best * (1 + 1e-12));
                CHECK(std::isfinite(walked(map, rule, answer.cells)));
            }
        }
    }
}
// Around a cell one of several equally long ways is enough: on an empty grid nearly no cell waits twice.
TEST(no_cell_waits_twice_where_ways_are_equally_long) {
    const BitGrid grid(60, 80);
    GridScratch scratch;
    GridAnswer answer;
    GridQuery query;
    query.h_weight = 0;
    find_way(grid, {30, 40}, {59, 79}, query, scratch, answer);
    CHECK(answer.found && answer.effort.pushed <= 60 * 80);
}
TEST(grids_wider_than_a_word) {
    check::Random random{2};
    for (int k = 0; k < 12; ++k) {
        Map map = random_map(random, 3 + random.below(140), 3 + random.below(140), random.uniform(0, 0.45));
        map.blocked[0] = 0;
        compare(map, random, 6);
    }
}

TEST(rows_and_columns_agree_with_the_bytes) {
    check::Random random{3};
    for (int size : {1, 2, 61, 62, 63, 64, 65, 126, 127, 200}) {
        Map map = random_map(random, size, 1 + random.below(200), 0.4);
        for (auto& byte : map.blocked) byte = std::uint8_t(byte * (1 + random.below(255)));
        BitGrid grid = map.grid();
        std::size_t count = 0;
        for (int r = 0; r < map.rows; ++r)
            for (int c = 0; c < map.columns; ++c) count += map.is_blocked(r, c);
        CHECK(grid.count_blocked() == count);
        for (int again = 0; again < 2; ++again) {
            for (int r = -1; r <= map.rows; ++r)
                for (int c = -1; c <= map.columns; ++c) {
                    CHECK(grid.blocked(r, c) == map.is_blocked(r, c));
                    const std::uint64_t word = grid.column(c)[(r + 1) >> 6];
                    CHECK((word >> ((r + 1) & 63) & 1) == map.is_blocked(r, c));
                }
            for (int k = 0; k < 300; ++k) {
                const int r = random.below(map.rows), c = random.below(map.columns);
                auto& byte = map.blocked[std::size_t(r * map.columns + c)];
                byte = !byte;
                grid.set(r, c, byte);
                unsigned around = 0;
                for (int d = 8; d >= 0; --d)
                    around = 2 * around + map.is_blocked(r + d / 3 - 1, c + d % 3 - 1);
                CHECK(grid.around(r, c) == around);
            }
        }
    }
}

// Whether the line between two centres meets the inside of a blocked cell, or a corner that the rule closes:
// cell by cell, in whole numbers of half cells.
bool sees_slowly(const Map& map, Corners rule, Cell a, Cell b) {
    const long dy = b.row - a.row, dx = b.column - a.column;
    const auto side = [&](long y, long x) {  // of the point (y, x) in half cells
        const long cross = dx * (y - 2 * a.row - 1) - dy * (x - 2 * a.column - 1);
        return (cross > 0) - (cross < 0);
    };
    for (int r = std::min(a.row, b.row); r <= std::max(a.row, b.row); ++r)
        for (int c = std::min(a.column, b.column); c <= std::max(a.column, b.column); ++c) {
            int left = 0, right = 0;
            for (int k = 0; k < 4; ++k) {
                const int s = side(2 * r + 2 * (k / 2), 2 * c + 2 * (k % 2));
                left += s > 0, right += s < 0;
            }
            if (left && right && map.is_blocked(r, c)) return false;
        }
    for (int r = std::min(a.row, b.row) + 1; r <= std::max(a.row, b.row); ++r)
        for (int c = std::min(a.column, b.column) + 1; c <= std::max(a.column, b.column); ++c) {
            if (side(2 * r, 2 * c) != 0) continue;
            const bool rising = (dx > 0) == (dy > 0);
            const int beside = rising ? map.is_blocked(r, c - 1) + map.is_blocked(r - 1, c)
                                      : map.is_blocked(r, c) + map.is_blocked(r - 1, c - 1);
            if (rule == Corners::never ? beside > 0 : rule == Corners::one && beside == 2) return false;
        }
    return true;
}

TEST(sight_lines_are_exact) {
    check::Random random{4};
    int seen = 0;
    for (int k = 0; k < 20000; ++k) {
        const Map map =
            random_map(random, 1 + random.below(20), 1 + random.below(90), random.uniform(0, 0.15));
        const BitGrid grid = map.grid();
        const Cell a = {random.below(map.rows), random.below(map.columns)},
                   b = {random.below(map.rows), random.below(map.columns)};
        if (map.is_blocked(a) || map.is_blocked(b)) continue;
        for (Corners rule : {Corners::never, Corners::one, Corners::always}) {
            const bool truth = sees_slowly(map, rule, a, b);
            CHECK(can_see(grid, rule, a, b) == truth);
            CHECK(can_see(grid, rule, b, a) == truth);
            seen += truth;
        }
    }
    CHECK(seen > 1000);
}

TEST(any_angle_ways_keep_in_sight_and_are_shorter_than_by_steps) {
    check::Random random{5};
    double by_steps = 0, by_sight = 0;
    GridScratch scratch;
    GridAnswer answer;
    for (int k = 0; k < 1500; ++k) {
        Map map = random_map(random, 2 + random.below(30), 2 + random.below(30), random.uniform(0, 0.4));
        map.blocked[0] = 0;
        const BitGrid grid = map.grid();
        for (Corners rule : {Corners::never, Corners::one, Corners::always}) {
            const Cell start = random_free(random, map), goal = random_free(random, map);
            GridQuery query;
            query.corners = rule;
            find_way(grid, start, goal, query, scratch, answer);
            const bool found = answer.found;
            const double steps = answer.least;
            query.metric = Metric::euclidean;
            for (GridPlanner planner : {GridPlanner::theta_star, GridPlanner::lazy_theta_star}) {
                query.planner = planner;
                find_way(grid, start, goal, query, scratch, answer);
                CHECK(answer.found == found);
                if (!found) continue;
                double length = 0;
                for (std::size_t i = 1; i < answer.cells.size(); ++i) {
                    const Cell a = answer.cells[i - 1], b = answer.cells[i];
                    CHECK(sees_slowly(map, rule, a, b));
                    length += straight_distance(b.row - a.row, b.column - a.column);
                }
                CHECK_NEAR(length, answer.least, 1e-9);
                CHECK(length >= straight_distance(goal.row - start.row, goal.column - start.column) - 1e-9);
                by_steps += steps;
                by_sight += length;
            }
        }
    }
    CHECK(by_sight < 0.99 * by_steps);
}

// Rising, falling and scattered priorities, some beyond the last bucket.
TEST(buckets_keep_the_order_of_a_heap) {
    check::Random random{6};
    cspace::search::BucketQueue queue;
    for (int round = 0; round < 60; ++round) {
        queue.begin(random.uniform(0.01, 2));
        cspace::search::PriorityQueue heap;
        double last = random.uniform(0, 100);
        const double reach = round % 3 ? 10 : 1e6;
        for (int k = 0; k < 3000; ++k) {
            if (random.uniform(0, 1) < 0.55) {
                const double low = round % 2 ? 0 : -5;
                const cspace::search::Waiting entry = {last + random.uniform(low, reach),
                                                       float(random.below(3)), 0};
                queue.push(entry);
                heap.push(entry);
            } else if (!heap.empty()) {
                const cspace::search::Waiting a = queue.pop(), b = heap.pop();
                CHECK(a.priority == b.priority && a.tie == b.tie);
                last = a.priority;
            }
            CHECK(queue.empty() == heap.empty());
        }
    }
}

TEST(steps_compare_exactly) {
    CHECK((Steps{0, 0} < Steps{1, 0}));
    CHECK((Steps{7, 0} < Steps{0, 5}));  // 49 < 50
    CHECK((Steps{0, 5} < Steps{8, 0}));  // 50 < 64
    CHECK((Steps{1393, 0} < Steps{0, 985}) != (Steps{0, 985} < Steps{1393, 0}));
    CHECK((Steps{0, 985} < Steps{1394, 0}));
    CHECK((Steps{1607521, 0} < Steps{0, 1136689}));  // 1607521² = 2 · 1136689² - 1
    CHECK(!(Steps{3, 4} < Steps{3, 4}));
}

}  // namespace
