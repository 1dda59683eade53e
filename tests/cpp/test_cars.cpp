// Vehicles on grids: contact against corners and samples, rays, hybrid A*, coverage and the simulator.
#include "check.hpp"
#include "cspace/navigation/cars/hybrid_a_star.hpp"
#include "cspace/navigation/coverage/cover.hpp"
#include "cspace/navigation/curves/curve.hpp"
#include "cspace/navigation/following/dynamic_window.hpp"
#include "cspace/navigation/following/follow.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::navigation;
using check::Random;

namespace {

maps::BitGrid random_grid(Random& random, int rows, int columns, double density) {
    maps::BitGrid grid(rows, columns);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (random.uniform(0, 1) < density) grid.set(row, column, true);
    return grid;
}

bool is_blocked(const maps::BitGrid& grid, const maps::GridFrame& frame, Point p) {
    const maps::Cell cell{int(std::floor((p.y - frame.origin.y) / frame.resolution)),
                          int(std::floor((p.x - frame.origin.x) / frame.resolution))};
    return !grid.contains(cell) || grid.blocked(cell);
}

}  // namespace

TEST(a_footprint_is_clear_where_none_of_its_points_is_blocked) {
    Random random{1};
    int clear = 0, touching = 0, unseen = 0;
    for (int repeat = 0; repeat < 3000; ++repeat) {
        const maps::BitGrid grid = random_grid(random, 12 + random.below(70), 12 + random.below(70), 0.03);
        const maps::GridFrame frame{random.uniform(0.1, 1), {random.uniform(-3, 3), random.uniform(-3, 3)}};
        const CarWorld world(grid, frame);
        const double side = frame.resolution * std::min(grid.rows(), grid.columns());
        const double grown = random.below(2) ? random.uniform(0, 0.1) * side : 0;
        const Footprint body{random.uniform(0, 0.1) * side, random.uniform(0, 0.3) * side,
                             random.uniform(0, 0.15) * side, grown};
        const CarPose pose{frame.origin.x + random.uniform(0, frame.resolution * grid.columns()),
                           frame.origin.y + random.uniform(0, frame.resolution * grid.rows()),
                           random.uniform(-7, 7)};
        bool found = false;  // a point of a grid over the footprint that is blocked
        const int n = 60;
        for (int i = 0; i <= n && !found; ++i)
            for (int j = 0; j <= n && !found; ++j)
                for (int k = 0; k < (grown > 0 ? 16 : 1); ++k) {
                    const double u = -body.rear + (body.rear + body.front) * i / n;
                    const double v = body.half_width * (2.0 * j / n - 1), a = k * 0.39269908169872414;
                    const double c = std::cos(pose.theta), s = std::sin(pose.theta), r = 0.999 * grown;
                    found = found || is_blocked(grid, frame,
                                                {pose.x + u * c - v * s + r * std::cos(a),
                                                 pose.y + u * s + v * c + r * std::sin(a)});
                }
        const bool is_clear = world.is_clear(body, pose);
        if (is_clear) CHECK(!found);
        clear += is_clear;
        touching += !is_clear;
        unseen += !is_clear && !found;  // contacts that lie between the samples
    }
    CHECK(clear > 300 && touching > 300);
    CHECK(20 * unseen < touching);
}

TEST(rays_stop_where_points_along_them_are_blocked) {
    Random random{2};
    for (int repeat = 0; repeat < 2000; ++repeat) {
        const maps::BitGrid grid = random_grid(random, 1 + random.below(80), 1 + random.below(80), 0.05);
        const maps::GridFrame frame{0.5, {-1, 2}};
        const Point from{-1 + random.uniform(0, 0.5 * grid.columns()),
                         2 + random.uniform(0, 0.5 * grid.rows())};
        const double angle = random.uniform(-4, 4);
        const Point along{std::cos(angle), std::sin(angle)};
        const double range = cast_ray(grid, frame, from, along, 1e9);
        CHECK(is_blocked(grid, frame, from + (range + 1e-9) * along));
        for (int k = 0; k < 200 && range > 0; ++k)
            CHECK(!is_blocked(grid, frame, from + (range * (k / 200.0)) * along));
    }
}

TEST(ways_of_hybrid_a_star_meet_their_goals_without_contact) {
    Random random{3};
    int found = 0;
    for (int repeat = 0; repeat < 30; ++repeat) {
        const maps::BitGrid grid = random_grid(random, 60, 60, 0.01);
        const maps::GridFrame frame{0.5, {0, 0}};
        const CarWorld world(grid, frame);
        const Footprint body{0.5, 2.5, 0.7, 0};
        const HybridSettings settings{3, repeat % 2 == 0, 0.5, 72, 1.2, 1.5, 20000, 1.2};
        CarPose ends[2];
        for (CarPose& pose : ends) do
                pose = {random.uniform(0, 30), random.uniform(0, 30), random.uniform(-4, 4)};
            while (!world.is_clear(body, pose));
        const CarRoute route = HybridAStar(world, body, ends[0], ends[1], settings).find();
        if (route.status != Status::found) continue;
        ++found;
        double length = 0;
        for (const Piece& piece : route.pieces) length += std::fabs(piece.length);
        const LaidCurve curve(ends[0], route.pieces, settings.radius);
        const CarPose last = curve.at(length);
        CHECK_NEAR(last.x, ends[1].x, 1e-9);
        CHECK_NEAR(last.y, ends[1].y, 1e-9);
        CHECK_NEAR(wrap_angle(last.theta - ends[1].theta), 0, 1e-9);
        for (double s = 0; s < length; s += 0.01) {
            CarPose pose = curve.at(s);
            Footprint inside{body.rear - 1e-3, body.front - 1e-3, body.half_width - 1e-3, 0};
            CHECK(world.is_clear(inside, pose));
        }
    }
    CHECK(found > 15);
}

TEST(coverage_leaves_no_cell_in_reach) {
    Random random{4};
    for (int repeat = 0; repeat < 200; ++repeat) {
        maps::BitGrid grid = random_grid(random, 1 + random.below(40), 1 + random.below(40), 0.2);
        const maps::Cell start{random.below(grid.rows()), random.below(grid.columns())};
        grid.set(start.row, start.column, false);
        const Coverage made = cover_cells(grid, start, random.below(4), random.below(2) == 0);
        std::int64_t swept = 0;
        for (const std::uint32_t passes : made.passes) swept += passes > 0;
        CHECK(swept == made.reached);
        for (std::size_t k = 1; k < made.path.size(); ++k) {
            const maps::Cell a = made.path[k - 1], b = made.path[k];
            CHECK(std::abs(a.row - b.row) + std::abs(a.column - b.column) == 1);
            CHECK(!grid.blocked(b));
        }
    }
}

TEST(a_dynamic_window_never_touches) {
    Random random{5};
    for (int repeat = 0; repeat < 4; ++repeat) {
        maps::BitGrid grid = random_grid(random, 60, 100, 0.01);
        for (int row = 20; row < 40; ++row)
            for (int column = 0; column < 16; ++column) grid.set(row, column, false);
        const maps::GridFrame frame{0.1, {0, 0}};
        const CarWorld world(grid, frame);
        const Point points[2] = {{0.8, 3}, {9, 3}};
        const Track track{Run(points, 2, 1)};
        const Vehicle vehicle{0, 1, 0, 0.8, 1.5, 3};
        const FollowSettings settings{0.05, 30, 1, 3, 0.2, 5};
        DynamicWindow window(&grid, frame, {0.3, 1.5, 3, 180, 0.3, 0.7, 0.1});
        const Footprint body{0, 0, 0, 0.25};
        const auto contact = [](const CarPose&, double, double, double) { return false; };
        const FollowRecord run = follow_track(vehicle, {{0.8, 3, 0}, 0, 0}, track, window, settings, contact);
        for (const FollowStep& step : run.steps) CHECK(world.is_clear(body, step.motion.pose));
    }
}
