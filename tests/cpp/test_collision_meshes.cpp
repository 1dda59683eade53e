// Laws of obstacles with trees: meshes, solids and point clouds against plain sums over all triangles and
// points, with a ball that prismatic joints move anywhere.
#include <memory>

#include "check.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::collision;
using Row = std::vector<double>;

constexpr double reach = 2;  // [m], of the ball

// Around contact, where floats may decide either way: the slack of the ball, and the rounding that it covers.
double band_of(const Checker& checker) { return 2.5 * double(checker.scene().margin); }

struct Obstacle {
    Row triangles, points;
    bool is_solid = true;
    double radius = 0;
};

void add_corner(Row& rows, const Vec3d& v) { rows.insert(rows.end(), {v.x, v.y, v.z}); }
Vec3d read_corner(const Row& rows, std::size_t i) { return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]}; }

// A ball among one obstacle.
std::unique_ptr<Checker> make_checker(const Obstacle& obstacle, double radius) {
    const Mat3d along_x = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};  // z becomes x, x becomes y
    std::vector<model::Joint> joints(3);
    for (int k = 0; k < 3; ++k) {
        joints[std::size_t(k)] = {identity_pose(), k - 1, k, 1, 0, true, 0};
        joints[std::size_t(k)].T_parent_joint.R = along_x;
    }
    const Row low(3, -reach), high(3, reach);
    const std::vector<Sphere> spheres = {{{0, 0, 0}, radius, 0}};
    const auto robot = std::make_shared<RobotData>(joints, 3, low, high, std::vector<int>{3}, spheres,
                                                   std::vector<std::pair<int, int>>{});
    const bool is_mesh = !obstacle.triangles.empty();
    const std::vector<int> mesh_sizes(is_mesh, int(obstacle.triangles.size() / 9));
    const std::vector<int> is_solid(is_mesh, obstacle.is_solid);
    const std::vector<int> cloud_sizes(!is_mesh, int(obstacle.points.size() / 3)), owners = { 0 };
    const Row radii(!is_mesh, obstacle.radius);
    Primitives given = {};
    given.triangles = obstacle.triangles, given.mesh_sizes = mesh_sizes, given.is_solid = is_solid;
    given.points = obstacle.points, given.cloud_sizes = cloud_sizes, given.cloud_radii = radii;
    given.owners = owners;
    return std::make_unique<Checker>(robot, std::make_shared<SceneData>(given), 0,
                                     std::vector<std::pair<int, int>>{});
}
// Coordinates of the ball: the joints move along x, y and z.
Row place_ball(const Vec3d& at) { return {at.x, at.y, at.z}; }

// The point of a triangle that is nearest, by the regions of its corners and sides (Ericson 2005, "Real-time
// collision detection", section 5.1.5).
Vec3d nearest_by_regions(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return a;
    if (d3 >= 0 && d4 <= d3) return b;
    if (d6 >= 0 && d5 <= d6) return c;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
    const double sum = va + vb + vc;
    return a + (vb / sum) * ab + (vc / sum) * ac;
}

// The signed distance by sums over all triangles; the solid is where the solid angles add up to a winding of
// one half at least (van Oosterom & Strackee 1983).
double distance_by_sums(const Obstacle& obstacle, const Vec3d& p) {
    double least = 1e300, angle = 0;
    for (std::size_t i = 0; i < obstacle.points.size() / 3; ++i)
        least = std::fmin(least, norm(p - read_corner(obstacle.points, i)) - obstacle.radius);
    for (std::size_t i = 0; i < obstacle.triangles.size() / 3; i += 3) {
        const Vec3d a = read_corner(obstacle.triangles, i), b = read_corner(obstacle.triangles, i + 1),
                    c = read_corner(obstacle.triangles, i + 2);
        const double area = norm(cross(b - a, c - a));
        if (area > 1e-13) least = std::fmin(least, norm(p - nearest_by_regions(p, a, b, c)));
        const Vec3d u = a - p, v = b - p, w = c - p;
        const double volume = dot(u, cross(v, w));
        const double rest =
            norm(u) * norm(v) * norm(w) + dot(u, v) * norm(w) + dot(v, w) * norm(u) + dot(w, u) * norm(v);
        angle += 2 * std::atan2(volume, rest);
    }
    const bool is_inside = obstacle.is_solid && !obstacle.triangles.empty() && angle > 6.28;
    return is_inside ? -least : least;
}

// Verdicts and clearances of a ball at places.
void check_places(const Obstacle& obstacle, double radius, const std::vector<Vec3d>& places) {
    const auto checker = make_checker(obstacle, radius);
    const auto memory = checker->borrow_workspace();
    Row all;
    for (const Vec3d& at : places) add_corner(all, at);
    std::vector<std::uint8_t> batch(places.size());
    checker->check_rows(all.data(), places.size(), batch.data(), 1);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Row q = place_ball(places[i]);
        const double expected = distance_by_sums(obstacle, places[i]) - radius;
        const Clearance found = checker->clearance(q.data());
        CHECK_NEAR(found.distance, expected, 1e-9);
        const bool touches = !checker->is_free(q.data(), *memory);
        CHECK(touches == bool(batch[i]));
        if (std::fabs(expected) > band_of(*checker)) CHECK(touches == (expected < 0));
    }
}

Obstacle random_star(check::Random& random) {
    check::RandomCell cell;
    check::add_mesh(random, cell, 0.5 * random.vector());
    return {cell.triangles, {}, true, 0};
}
// A box whose sides are cut into n × n squares of two triangles each; its corners have whole coordinates.
Obstacle make_box(int n, double side) {
    Obstacle box;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const auto corner = [&](int a, int b) {
                    const double u = side * (2.0 * a / n - 1), v = side * (2.0 * b / n - 1);
                    const double w = face < 3 ? side : -side;
                    const double given[] = {w, face < 3 ? u : v, face < 3 ? v : u};
                    return Vec3d{given[(3 - face % 3) % 3], given[(4 - face % 3) % 3],
                                 given[(5 - face % 3) % 3]};
                };
                const Vec3d a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                            d = corner(i, j + 1);
                for (const Vec3d& v : {a, b, c, a, c, d}) add_corner(box.triangles, v);
            }
    return box;
}
std::vector<Vec3d> random_places(check::Random& random, int n, double size) {
    std::vector<Vec3d> places;
    while (int(places.size()) < n) places.push_back(size * random.vector());
    return places;
}
// Places around the corners of a mesh, at about the radius of a ball.
std::vector<Vec3d> places_at_corners(check::Random& random, const Obstacle& mesh, double radius, int n) {
    std::vector<Vec3d> places;
    for (int i = 0; i < n; ++i) {
        const Vec3d corner =
            read_corner(mesh.triangles, std::size_t(random.below(int(mesh.triangles.size() / 3))));
        places.push_back(corner + (radius * (1 + 1e-2 * random.uniform(-1, 1))) * random.axis());
    }
    return places;
}

}  // namespace

TEST(balls_touch_solids_as_sums_over_triangles_say) {
    check::Random random{1};
    for (int k = 0; k < 60; ++k) {
        Obstacle star = random_star(random);
        star.is_solid = k % 3 != 0;
        const double radius = k % 2 ? 0.001 : random.uniform(0, 0.1);
        check_places(star, radius, random_places(random, 100, 0.7));
        check_places(star, radius, places_at_corners(random, star, radius, 100));
    }
}

TEST(triangles_without_area_change_nothing) {
    check::Random random{2};
    for (int k = 0; k < 40; ++k) {
        Obstacle star = random_star(random);
        // The side ab of a triangle is cut in two, and a flat triangle closes the cut.
        const Vec3d a = read_corner(star.triangles, 0), b = read_corner(star.triangles, 1),
                    c = read_corner(star.triangles, 2), m = a + random.uniform(0.1, 0.9) * (b - a);
        star.triangles.erase(star.triangles.begin(), star.triangles.begin() + 9);
        for (const Vec3d& v : {a, m, c, m, b, c, a, b, m}) add_corner(star.triangles, v);
        check_places(star, 0.002, random_places(random, 100, 0.7));
        check_places(star, 0.002, places_at_corners(random, star, 0.002, 100));
    }
}

TEST(rays_through_corners_and_along_sides_count_once) {
    check::Random random{3};
    for (const int n : {1, 2, 4}) {
        const Obstacle box = make_box(n, 0.5);
        std::vector<Vec3d> places;
        for (int i = -5; i <= 5; ++i)
            for (int j = -5; j <= 5; ++j)
                for (int k = -5; k <= 5; ++k) places.push_back({0.125 * i, 0.125 * j, 0.125 * k});
        check_places(box, 0.01, places);
        check_places(box, 0.0, random_places(random, 300, 0.6));
    }
}

TEST(far_corners_cost_no_accuracy_nearby) {
    check::Random random{8};
    Obstacle field = make_box(30, 0.5);
    for (std::size_t i = 0; i < field.triangles.size(); i += 3) field.triangles[i] += 1000;  // far away
    const Obstacle star = random_star(random);
    field.triangles.insert(field.triangles.end(), star.triangles.begin(), star.triangles.end());
    check_places(field, 0.01, random_places(random, 200, 0.7));
    check_places(field, 0.01, places_at_corners(random, star, 0.01, 200));
}

TEST(a_mesh_of_thousands_of_triangles) {
    check::Random random{4};
    Obstacle box = make_box(29, 0.3);  // 5,046 triangles
    check_places(box, 0.01, random_places(random, 200, 0.4));
    for (double& x : box.triangles) x *= 1 + 0.1 * std::sin(40 * x);
    check_places(box, 0.001, random_places(random, 100, 0.4));
    check_places(box, 0.02, places_at_corners(random, box, 0.02, 100));
}

TEST(a_ball_inside_a_surface_is_free_and_inside_its_solid_touches) {
    check::Random random{5};
    Obstacle shell = make_box(3, 1.0);
    Obstacle hollow = shell;  // with a hollow inside
    const Obstacle inner = make_box(2, 0.6);
    for (std::size_t i = 0; i < inner.triangles.size() / 3; i += 3)
        for (const std::size_t k : {i, i + 2, i + 1})
            add_corner(hollow.triangles, read_corner(inner.triangles, k));
    const Row q = place_ball({0.1, -0.2, 0.1});
    const auto is_free = [&](const Obstacle& obstacle) {
        const auto checker = make_checker(obstacle, 0.05);
        return checker->is_free(q.data(), *checker->borrow_workspace());
    };
    CHECK(!is_free(shell));
    CHECK(is_free(hollow));
    shell.is_solid = false;
    CHECK(is_free(shell));
    check_places(hollow, 0.05, random_places(random, 300, 1.2));
    check_places(shell, 0.05, random_places(random, 300, 1.2));
}

TEST(edges_of_a_ball_are_proved_as_dense_samples_say) {
    check::Random random{6};
    int proved = 0, blocked = 0, undecided = 0;
    for (int k = 0; k < 40; ++k) {
        const Obstacle star = random_star(random);
        const auto checker = make_checker(star, 0.01);
        const auto memory = checker->borrow_workspace();
        for (int i = 0; i < 20; ++i) {
            const Vec3d a = 0.7 * random.vector(), b = 0.7 * random.vector();
            const Verdict verdict = checker->prove_edge(place_ball(a).data(), place_ball(b).data(), *memory);
            double least = 1;
            for (int s = 0; s <= 300; ++s)
                least = std::fmin(least, distance_by_sums(star, a + (s / 300.0) * (b - a)) - 0.01);
            proved += verdict == Verdict::free, blocked += verdict == Verdict::blocked;
            undecided += verdict == Verdict::undecided;
            if (verdict == Verdict::free) CHECK(least > -1e-9);
            if (least < -band_of(*checker)) CHECK(verdict == Verdict::blocked);
        }
    }
    std::printf("%d proved, %d blocked, %d undecided\n", proved, blocked, undecided);
    CHECK(proved > 100 && blocked > 40 && undecided < 5);
}

TEST(balls_touch_clouds_as_their_nearest_points_say) {
    check::Random random{7};
    for (int k = 0; k < 40; ++k) {
        Obstacle cloud;
        const int n = k < 8 ? 1 + k : 1 + random.below(3000);
        for (int i = 0; i < n; ++i) add_corner(cloud.points, 0.5 * random.vector());
        for (int i = random.below(20); i > 0; --i) add_corner(cloud.points, read_corner(cloud.points, 0));
        if (k % 4 == 0) add_corner(cloud.points, {1e4, -2, 3});
        if (k % 5 == 0)
            for (std::size_t i = 2; i < cloud.points.size(); i += 3) cloud.points[i] = 0.1;
        cloud.radius = k % 3 == 0 ? 0 : 0.01;
        for (const double radius : {0.001, 0.05, 0.4})
            check_places(cloud, radius, random_places(random, 60, 1.0));
    }
}

TEST(balls_touch_dense_clouds_far_from_the_origin_too) {
    check::Random random{8};
    for (const double offset : {0.0, 1.0}) {
        Obstacle cloud;
        cloud.radius = 0.002;
        for (int i = 0; i < 20000; ++i) {
            Vec3d p = 0.6 * random.vector();
            (i % 3 == 0 ? p.x : i % 3 == 1 ? p.y : p.z) = 0.2 * double(i % 7);
            add_corner(cloud.points, p + Vec3d{offset, 0, offset});
        }
        for (const double radius : {0.0, 0.02, 0.07, 0.2}) {
            std::vector<Vec3d> places = random_places(random, 100, 0.9);
            for (Vec3d& at : places) at = at + Vec3d{offset, 0, offset};
            check_places(cloud, radius, places);
        }
    }
}
