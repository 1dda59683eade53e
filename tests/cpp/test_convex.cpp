// Distances of convex solids: against closed forms, against dense searches over directions, and laws.
#include <utility>

#include "check.hpp"
#include "cspace/shapes/convex_distance.hpp"
#include "cspace/shapes/distance.hpp"
#include "random.hpp"
#include "random_scenes.hpp"

using namespace cspace;
using namespace cspace::shapes;

namespace {

Posed random_pose(check::Random& random, double reach) {
    const auto part = [&] { return random.uniform(-reach, reach); };
    return {check::random_rotation(random), {part(), part(), part()}};
}
Convex random_solid(check::Random& random, double reach) {
    const Posed pose = random_pose(random, reach);
    const auto size = [&] { return random.uniform(0.02, 0.6); };
    switch (random.below(5)) {
        case 0:
            return make_box(pose, {size(), size(), size()});
        case 1:
            return make_cylinder(pose, size(), size());
        case 2:
            return make_ball(pose.t, size());
        case 3: {
            const Vec3d ends[] = {pose.t, pose * Vec3d{0, 0, size()}};
            return make_points(ends, 2, size());
        }
        default: {
            const Vec3d corners[] = {pose.t, pose * Vec3d{size(), 0, 0}, pose * Vec3d{size(), size(), 0}};
            return make_points(corners, 3, 0);
        }
    }
}
// How far two solids are apart along a direction; the distance is the maximum over all of them.
double separation(const Convex& a, const Convex& b, const Vec3d& n) {
    return dot(find_farthest(a, -n) - find_farthest(b, n), n) - a.radius - b.radius;
}
// Climbs from the best of many random directions.
double search_separation(check::Random& random, const Convex& a, const Convex& b) {
    double best = -1e30;
    Vec3d at = {0, 0, 1};
    for (int i = 0; i < 3000; ++i) {
        const Vec3d n = random.axis();
        if (const double s = separation(a, b, n); s > best) best = s, at = n;
    }
    for (double step = 0.2; step > 1e-10; step *= 0.7)
        for (int i = 0; i < 20; ++i) {
            Vec3d n = at + step * random.axis();
            n = (1 / norm(n)) * n;
            if (const double s = separation(a, b, n); s > best) best = s, at = n;
        }
    return best;
}

}  // namespace

TEST(the_distance_is_the_largest_separation) {
    check::Random random(1);
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
        const double reach = i % 2 ? 0.3 : 1.0;
        const Convex a = random_solid(random, reach), b = random_solid(random, reach);
        const ConvexDistance d = measure_distance(a, b);
        CHECK_NEAR(norm(d.normal), 1, 1e-9);
        CHECK_NEAR(separation(a, b, d.normal), d.value, 1e-8);
        const double searched = search_separation(random, a, b);
        CHECK(d.value >= searched - 1e-8);
        CHECK_NEAR(dot(d.first - d.second, d.normal), d.value, 1e-8);
        for (const double off : {-0.1, -1e-7, 1e-7, 0.1})
            if (d.value + off >= 0) CHECK(is_within(a, b, d.value + off) == (off > 0));
        inside += d.value < 0;
        const ConvexDistance back = measure_distance(b, a);
        CHECK_NEAR(back.value, d.value, 1e-8);
        const Vec3d apart = (1e-7 - d.value) * d.normal;  // out of each other along the normal
        if (d.value < 0) CHECK(!is_within(move_solid({identity_pose().R, apart}, a), b, 0));
    }
    CHECK(inside > 50);
}

TEST(points_agree_with_closed_forms) {
    check::Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const Posed pose = random_pose(random, 0.2);
        const Vec3d half = {random.uniform(0.01, 0.5), random.uniform(0.01, 0.5), random.uniform(0.01, 0.5)};
        const Vec3d point = random_pose(random, 0.8).t;
        const auto compare = [&](const Convex& solid, const Distance& expected) {
            const ConvexDistance d = measure_distance(make_ball(point, 0.01), solid);
            CHECK_NEAR(d.value, expected.value - 0.01, 1e-9);
            if (std::fabs(expected.value) > 1e-6 && expected.value > 0)
                CHECK_NEAR(dot(d.normal, expected.normal), 1, 1e-6);
        };
        compare(make_box(pose, half), distance_from_box(point, pose.t, pose.R, half));
        compare(make_cylinder(pose, half.x, half.z),
                distance_from_cylinder(point, pose.t, matrix_column(pose.R, 2), half.z, half.x));
        const Vec3d ends[] = {pose.t, pose * Vec3d{0, 0, half.z}};
        compare(make_points(ends, 2, half.x), distance_from_capsule(point, ends[0], ends[1], half.x));
    }
}

TEST(aligned_and_equal_solids) {
    const Posed here = identity_pose();
    for (const double x : {0.0, 0.5, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.5, 3.0}) {
        const Convex a = make_box({here.R, {x, 0, 0}}, {0.5, 0.5, 0.5}), b = make_box(here, {0.5, 0.5, 0.5});
        CHECK_NEAR(measure_distance(a, b).value, x - 1, 1e-9);
        const Convex c = make_cylinder({here.R, {x, 0, 0}}, 0.5, 0.7), d = make_cylinder(here, 0.5, 0.7);
        const double depth = measure_distance(c, d).value;  // on one axis no direction is the best
        CHECK_NEAR(depth, x - 1, x == 0 ? 0.01 : 1e-9);
        const Vec3d p = {x, 0, 0}, ends[] = {{0, 0, -1}, {0, 0, 1}}, moved[] = {{x, 0, -1}, {x, 0, 1}};
        CHECK_NEAR(measure_distance(make_ball(p, 0.2), make_ball({0, 0, 0}, 0.3)).value, x - 0.5, 1e-12);
        CHECK_NEAR(measure_distance(make_points(moved, 2, 0.1), make_points(ends, 2, 0.2)).value, x - 0.3,
                   1e-9);
    }
}
