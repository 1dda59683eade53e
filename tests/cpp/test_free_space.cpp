// Triangulations of worlds: valid, with every outline an edge, and free where no obstacle is.
#include <random>

#include "check.hpp"
#include "cspace/maps/free_space.hpp"

using namespace cspace;
using namespace cspace::maps;

namespace {

struct World : Outlines {
    World() { high = {100, 100}; }
    void add(const std::vector<Point>& ring, Index owner) { add_ring(ring, owner); }
    FreeSpace space() const { return make_free_space(*this); }
};

double doubled_area(const Triangulation& mesh, const Triangle& t) {
    const Point a = mesh.point(t.corner[0]), b = mesh.point(t.corner[1]), c = mesh.point(t.corner[2]);
    return cross(b - a, c - a);
}

void check_valid(const Triangulation& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        CHECK(orientation(mesh.point(t.corner[0]), mesh.point(t.corner[1]), mesh.point(t.corner[2])) == 1);
        sum += doubled_area(mesh, t);
        for (int e = 0; e < 3; ++e) {
            const Index u = t.across[std::size_t(e)];
            if (u == none) continue;
            const int f = mesh[u].edge_to(Index(i));
            CHECK(mesh[u].across[std::size_t(f)] == Index(i));
            CHECK(mesh[u].begin(f) == t.end(e) && mesh[u].end(f) == t.begin(e));
            CHECK(mesh[u].owners[std::size_t(f)] == t.owners[std::size_t(e)]);
        }
    }
    const Point diagonal = mesh.points[2] - mesh.points[0];
    CHECK_NEAR(sum, 2 * diagonal.x * diagonal.y, 1e-9 * sum);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const Triangle& t = mesh[mesh.triangle_at[v]];
        CHECK(t.corner[std::size_t(t.place_of(Index(v)))] == Index(v));
    }
}

double free_area(const FreeSpace& space) {
    double sum = 0;
    for (std::size_t t = 0; t < space.mesh.triangles.size(); ++t)
        if (space.is_free(Index(t))) sum += doubled_area(space.mesh, space.mesh.triangles[t]) / 2;
    return sum;
}

std::vector<Point> box(double x, double y, double w, double h) {
    return {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
}

// Whether a point lies in the obstacles, by counting crossings of a ray.
bool is_covered(const World& world, Point p) {
    std::vector<int> odd(1000, 0);
    for (const auto& [from, to, owner] : world.edges) {
        const Point a = world.points[std::size_t(from)], b = world.points[std::size_t(to)];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
            odd[std::size_t(owner)] ^= 1;
    }
    return std::find(odd.begin(), odd.end(), 1) != odd.end();
}

void check_world(const World& world, std::mt19937& random, bool sample = true) {
    const FreeSpace space = world.space();
    CHECK(space.complete);
    check_valid(space.mesh);
    std::uniform_real_distribution<double> x(world.low.x, world.high.x), y(world.low.y, world.high.y);
    for (int i = 0; sample && i < 50; ++i) {
        const Point p{x(random), y(random)};
        CHECK(space.is_free(space.mesh.locate(p, 0).triangle) == !is_covered(world, p));
    }
    const Boundary boundary = boundary_of(space);
    std::vector<int> entered(boundary.size(), 0);
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const Index next = boundary.next[i];
        CHECK(next != none && boundary.ring[i] == boundary.ring[std::size_t(next)]);
        if (next != none) ++entered[std::size_t(next)];
    }
    for (const int times : entered) CHECK(times == 1);
    double area = 0;  // the rings surround free space
    for (Index i = 0; i < Index(boundary.size()); ++i)
        area += cross(boundary.begin(i) - world.low, boundary.end(i) - world.low) / 2;
    CHECK_NEAR(area, free_area(space), 1e-9 * (world.high.x - world.low.x) * (world.high.y - world.low.y));
}

}  // namespace

TEST(an_empty_world_is_free) {
    const FreeSpace space = World{}.space();
    CHECK(space.components == 1);
    CHECK_NEAR(free_area(space), 1e4, 1e-9);
}

TEST(holes_and_what_stands_in_them) {
    World world;
    world.add(box(10, 10, 50, 50), 0);
    world.add(box(20, 20, 30, 30), 0);  // a hole
    world.add(box(30, 30, 10, 10), 1);  // an obstacle in it
    const FreeSpace space = world.space();
    CHECK(space.components == 2);
    CHECK_NEAR(free_area(space), 1e4 - 2500 + 900 - 100, 1e-9);
    CHECK(boundary_of(space).component.size() == 4);
}

TEST(obstacles_that_touch_leave_no_way_between_them) {
    World world;  // two boxes that meet in a point, and reach from wall to wall
    world.add(box(0, 0, 50, 50), 0);
    world.add(box(50, 50, 50, 50), 1);
    CHECK(world.space().components == 2);
    World shared;  // two that share a side
    shared.add(box(0, 20, 50, 10), 0);
    shared.add(box(50, 20, 50, 10), 1);
    CHECK(shared.space().components == 2);
    CHECK_NEAR(free_area(shared.space()), 9000, 1e-9);
}

TEST(walls_without_thickness_divide) {
    World world;
    world.add({{0, 50}, {100, 50}}, 0);
    CHECK(world.space().components == 2);
    World short_wall;
    short_wall.add({{20, 50}, {80, 50}}, 0);
    const FreeSpace space = short_wall.space();
    CHECK(space.components == 1);
    const Boundary boundary = boundary_of(space);
    CHECK(boundary.size() == 6 && boundary.component.size() == 2);
}

TEST(random_worlds_of_all_kinds) {
    std::mt19937 random(7);
    const auto whole = [&](int most) { return double(random() % unsigned(most + 1)); };
    for (int trial = 0; trial < 3000; ++trial) {
        World world;
        const int side = trial % 3 == 0 ? 6 : trial % 3 == 1 ? 20 : 100;
        world.high = {double(side), double(side)};
        const int obstacles = 1 + int(random() % 6);
        for (int o = 0; o < obstacles; ++o) {
            std::vector<Point> ring;
            const int corners = 2 + int(random() % 6);
            for (int i = 0; i < corners; ++i)
                ring.push_back(trial % 2 ? Point{whole(side), whole(side)}
                                         : Point{whole(1000000) * side / 1e6, whole(1000000) * side / 1e6});
            world.add(ring, o);
        }
        check_world(world, random);
    }
}

TEST(far_from_the_origin_and_large) {
    std::mt19937 random(8);
    for (int trial = 0; trial < 300; ++trial) {
        World world;
        const double shift = trial % 2 ? 1e6 : 1e9;
        world.low = {shift, shift}, world.high = {shift + 10, shift + 10};
        for (int o = 0; o < 5; ++o) {
            std::vector<Point> ring;
            for (int i = 0; i < 4; ++i)
                ring.push_back(
                    {shift + double(random() % 1000) / 100, shift + double(random() % 1000) / 100});
            world.add(ring, o);
        }
        check_world(world, random, false);
    }
}
