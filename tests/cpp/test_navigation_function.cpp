#include "check.hpp"
#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/fields/navigation_function.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

SphereWorld random_discs(check::Random& random, int most) {
    SphereWorld world{{{0, 0}, 10}, {}};
    for (int tries = 0; tries < most; ++tries) {
        const Disc disc{{random.uniform(-8, 8), random.uniform(-8, 8)}, random.uniform(0.3, 1.8)};
        if (world.clearance(disc.center) > disc.radius + 0.1) world.obstacles.push_back(disc);
    }
    return world;
}
Point pick(check::Random& random, const SphereWorld& world, double clearance) {
    for (;;) {
        const Point p{random.uniform(-10, 10), random.uniform(-10, 10)};
        if (world.clearance(p) > clearance) return p;
    }
}

// Stars of random radii, one in each cell of a raster at most.
PolygonWorld random_stars(check::Random& random, int count) {
    Outlines world;
    world.low = {0, 0}, world.high = {10, 10};
    for (int k = 0; k < count; ++k) {
        const Point at{1.25 + 2.5 * (k % 4), 1.25 + 2.5 * (k / 4)};
        const int corners = 5 + random.below(8);
        std::vector<Point> ring;
        for (int i = 0; i < corners; ++i) {
            const double angle = 6.283185307179586 * i / corners;
            ring.push_back(at + random.uniform(0.2, 1.1) * Point{std::cos(angle), std::sin(angle)});
        }
        world.add_ring(ring, k);
    }
    return PolygonWorld(std::move(world));
}
bool cuts(Point a, Point b, Point p, Point q) {
    return orientation(a, b, p) * orientation(a, b, q) < 0 && orientation(p, q, a) * orientation(p, q, b) < 0;
}

}  // namespace

TEST(bounds_of_a_summand_hold) {
    check::Random random{1};
    for (int k = 0; k < 20000; ++k) {
        const bool is_room = k % 3 == 0;
        const LogTerm term{{0, 0}, k % 3 == 1 ? 0 : random.uniform(0.5, 2), k % 3 == 1 ? 7.0 : -1.0, is_room};
        const Point m{random.uniform(-3, 3), random.uniform(-3, 3)};
        const double h = random.uniform(0, 0.5), rho = norm(m), angle = random.uniform(0, 6.3);
        if (!term.is_regular(rho, h)) continue;
        const Point p = m + random.uniform(0, h) * Point{std::cos(angle), std::sin(angle)};
        const double moved = distance(p, m);
        CHECK(norm(term.slope(p) - term.slope(m)) <=
              moved * term.most_curvature(rho, h) * (1 + 1e-9) + 1e-12);
        CHECK(norm(term.slope(p)) >= term.least_slope(rho, h) * (1 - 1e-9));
        const Curvature a = term.curvature(p), b = term.curvature(m);
        const Point u{std::cos(5 * angle), std::sin(5 * angle)};
        CHECK(std::abs(a.along(u) - b.along(u)) <= moved * term.most_third(rho, h) * (1 + 1e-9) + 1e-10);
    }
}

TEST(sphere_worlds_have_one_minimum_and_a_saddle_for_each_disc) {
    check::Random random{2};
    for (int k = 0; k < 60; ++k) {
        const SphereWorld world = random_discs(random, k % 30);
        const Point goal = pick(random, world, 0.1);
        const NavigationFunction function(world, std::nullopt, goal, 0, {});
        CHECK(function.is_proven());
        CHECK(function.proof().saddles.size() == world.obstacles.size());
        for (int j = 0; j < 20; ++j) {
            const Point start = pick(random, world, 0);
            const auto made = function.descend(start);
            CHECK(made.route.status == Status::found);
            for (std::size_t i = 1; i < made.values.size(); ++i) CHECK(made.values[i] < made.values[i - 1]);
        }
    }
}

TEST(a_wall_of_discs_with_a_low_power_has_a_minimum_behind_it) {
    SphereWorld world{{{0, 0}, 10}, {}};
    for (int k = -3; k <= 3; ++k) world.obstacles.push_back({{0, 1.7 * k}, 0.8});
    const SpherePotential low(world, {8, 0}, 2);
    CHECK(MinimumProof(low).run(400'000).verdict == SingleMinimum::refuted);
    const Tuned found = tune_kappa(world, {8, 0}, 400'000);
    CHECK(found.kappa > 2);
    CHECK(found.proof.saddles.size() == 7);
}

TEST(no_minimum_is_overlooked) {
    // Where the proof says that none is there, descents from many places all come to the goal, also without
    // the step that leaves saddles; where it says that one is, some do not.
    check::Random random{3};
    int refuted = 0;
    for (int k = 0; k < 200; ++k) {
        const SphereWorld world = random_discs(random, 25);
        const Point goal = pick(random, world, 0.1);
        const NavigationFunction function(world, std::nullopt, goal, std::exp2(k % 6), {});
        int caught = 0;
        for (int j = 0; j < 30; ++j)
            caught += function.descend(pick(random, world, 0.01)).route.status != Status::found;
        if (function.is_proven()) CHECK(caught == 0);
        refuted += function.proof().verdict == SingleMinimum::refuted && caught > 0;
    }
    CHECK(refuted > 20);
}

TEST(the_map_of_a_star_world_is_a_homeomorphism_and_descents_arrive) {
    check::Random random{4};
    for (int k = 0; k < 60; ++k) {
        const PolygonWorld world = random_stars(random, 1 + k % 14);
        const auto pick_free = [&] {
            for (;;) {
                const Point p{random.uniform(0, 10), random.uniform(0, 10)};
                if (world.settle(p, 0).is_free()) return p;
            }
        };
        const Point goal = pick_free();
        const StarWorld stars(world.walls,
                              world.space.component[std::size_t(world.settle(goal, 0).triangles[0])]);
        CHECK(stars.fault == StarWorld::none);
        if (stars.fault != StarWorld::none) continue;
        const SphereWorld model = stars.model();
        for (int j = 0; j < 500; ++j) {
            const Point p = pick_free(), q = stars.to_model(p);
            CHECK(model.clearance(q) > -1e-12);
            CHECK_NEAR(distance(stars.from_model(q), p), 0, 1e-12);
        }
        for (const Point corner : world.walls.points)
            CHECK_NEAR(model.clearance(stars.to_model(corner)), 0, 1e-12);
        const NavigationFunction function(model, stars, goal, 0, {});
        CHECK(function.is_proven());
        for (int j = 0; j < 10; ++j) {
            const auto made = function.descend(pick_free());
            CHECK(made.route.status == Status::found);
            for (std::size_t i = 1; i < made.values.size(); ++i) CHECK(made.values[i] < made.values[i - 1]);
            for (std::size_t i = 1; i < made.route.path.size(); ++i)
                for (std::int32_t e = 0; e < std::int32_t(world.walls.size()); ++e)
                    CHECK(!cuts(world.walls.begin(e), world.walls.end(e), made.route.path[i - 1],
                                made.route.path[i]));
        }
    }
}

TEST(kernels_are_found_where_there_are_any) {
    Point found;
    CHECK(kernel_point({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, found));  // an L
    CHECK(found.x < 1 && found.y < 1);
    CHECK(!kernel_point({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}}, found));  // a U
}
