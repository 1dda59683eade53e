// Voronoi diagrams of free space: every point of an arc as far from its two walls as from no nearer one, and
// all arcs there: as many cycles as holes, in worlds full of ties.
#include <cstdlib>
#include <numbers>

#include "check.hpp"
#include "cspace/navigation/voronoi/roadmap.hpp"
#include "plane_worlds.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation::voronoi;
using cspace::navigation::DiagramRoute;
using cspace::navigation::Status;

namespace {

// The distance to the walls by looking at all of them.
double slow_distance(const Sites& s, Point p) {
    double least = 1e300;
    for (Index e = 0; e < s.size(); ++e) {
        const double t = std::clamp(s.advance(e, p), 0.0, s.length[std::size_t(e)]);
        least = std::min(least, distance(p, s.begin(e) + t * s.direction(e)));
    }
    return least;
}

// How far arcs are from being right, in extents of the world.
double error_of(const Diagram& d) {
    double worst = 0;
    for (const Arc& arc : d.arcs)
        for (int i = 0; i <= 4; ++i) {
            const double t = arc.begin + (arc.end - arc.begin) * i / 4, r = arc.curve.radius(t);
            const Point p = arc.curve.at(t);
            worst = std::max(worst, std::abs(slow_distance(d.sites, p) - r));
            worst = std::max(worst, std::abs(d.sites.distance_to(arc.a, p) - r));
            worst = std::max(worst, std::abs(d.sites.distance_to(arc.b, p) - r));
            worst = std::max(worst, arc.curve.least_radius(arc.begin, arc.end) - r);
        }
    return worst / d.sites.extent;
}
bool is_whole(const Diagram& d) {
    return std::find(d.is_whole.begin(), d.is_whole.end(), 0) == d.is_whole.end();
}

Diagram diagram_of(const check::PlaneWorld& world, const Boundary& walls) {
    int parts = 0;
    for (const auto& t : world.triangles) parts = std::max(parts, t.part + 1);
    std::vector<Point> seeds(std::size_t(parts), Point{});
    for (int t = 0; t < int(world.triangles.size()); ++t)
        if (const auto& one = world.triangles[std::size_t(t)]; !one.blocked)
            seeds[std::size_t(one.part)] =
                (1.0 / 3) * (world.place(t, 0) + world.place(t, 1) + world.place(t, 2));
    Point low = walls.points[0], high = low;
    for (const Point p : walls.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return make_diagram(walls, seeds, 0.5 * (low + high));
}

struct Room : Outlines {
    Room(double width, double height) { high = {width, height}; }
    void block(double x, double y, double w, double h) {
        add_ring(std::vector<Point>{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, obstacles);
    }
    void wall(Point a, Point b) { add_ring(std::vector<Point>{a, b}, obstacles); }
};

std::vector<int> degrees(const Diagram& d) {
    std::vector<int> count(10, 0), degree(d.vertices.size(), 0);
    for (const Arc& arc : d.arcs) ++degree[std::size_t(arc.from)], ++degree[std::size_t(arc.to)];
    for (const int arcs : degree) ++count[std::size_t(std::min(arcs, 9))];
    return count;
}

DiagramRoute ask(const Roadmap& map, const PolygonWorld& world, Point a, Point b, bool widest) {
    const Settled from = world.settle(a, 0), to = world.settle(b, 0);
    return map.solve(from, to, world.shared_component(from, to), widest, 1e-3, nullptr);
}

}  // namespace

TEST(worlds_full_of_ties) {
    const char* wanted = std::getenv("CSPACE_CASES");
    const int cases = wanted ? std::atoi(wanted) : 2000;
    for (int i = 0; i < cases; ++i) {
        check::Random random{unsigned(i) + 1};
        const auto family = check::Family(i % int(check::Family::count));
        const check::PlaneWorld world = check::random_world(random, family, i % 10 ? 6 : 16);
        const Boundary walls = world.boundary(i % 2 == 0);
        if (walls.size() == 0) continue;
        const Diagram d = diagram_of(world, walls);
        const bool good = is_whole(d) && error_of(d) < 1e-9;
        if (!good) std::printf("world %d, family %d\n", i, int(family));
        CHECK(good);
    }
}

TEST(rooms) {
    const PolygonWorld square(Room(4, 4));
    const Roadmap map(square);
    CHECK((degrees(map.diagram()) == std::vector<int>{0, 4, 0, 0, 1, 0, 0, 0, 0, 0}));
    CHECK(ask(map, square, {2, 2}, {2, 2}, true).clearance == 2);

    Room cross(6, 6);  // two corridors that cross
    for (const double x : {0.0, 4.0})
        for (const double y : {0.0, 4.0}) cross.block(x, y, 2, 2);
    const PolygonWorld crossing(cross);
    const Roadmap roads(crossing);
    CHECK(is_whole(roads.diagram()) && error_of(roads.diagram()) < 1e-15);
    CHECK(degrees(roads.diagram())[4] == 1);
    CHECK_NEAR(ask(roads, crossing, {3, 0.5}, {3, 5.5}, true).clearance, 0.5, 1e-12);
    CHECK_NEAR(ask(roads, crossing, {3, 1}, {3, 5}, true).route.length, 4, 1e-12);
}

TEST(a_round_room_of_many_walls_is_a_star) {
    Room world(4, 4);
    std::vector<Point> outer{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, ring;
    for (int i = 0; i < 500; ++i) {
        const double angle = 2 * std::numbers::pi * i / 500;
        ring.push_back({2 + std::cos(angle), 2 + std::sin(angle)});
    }
    world.add_ring(outer, 0);
    world.add_ring(ring, 0);
    const PolygonWorld polygons(world);
    const Roadmap map(polygons);
    CHECK(is_whole(map.diagram()));
    CHECK_NEAR(error_of(map.diagram()), 0, 1e-12);
    CHECK(map.diagram().vertices.size() == 501);
}

TEST(walls_without_thickness_and_points_where_obstacles_touch) {
    Room world(10, 10);
    world.wall({2, 5}, {8, 5});
    world.wall({5, 2}, {5, 8});
    world.block(0, 0, 1, 1);
    world.block(1, 1, 1, 1);
    const PolygonWorld polygons(world);
    const Roadmap map(polygons);
    CHECK(is_whole(map.diagram()) && error_of(map.diagram()) < 1e-12);
    const DiagramRoute way = ask(map, polygons, {4, 4}, {6, 6}, true);
    CHECK(way.route.status == Status::found);
    CHECK(way.clearance == 1 && way.on_diagram >= 1);
}

TEST(the_wider_of_two_ways_and_the_shorter) {
    Room world(10, 10);
    world.block(2, 1, 6, 5);  // a gap of 1 below, of 4 above, of 2 at the sides
    const PolygonWorld polygons(world);
    const Roadmap map(polygons);
    const DiagramRoute wide = ask(map, polygons, {1, 1}, {9, 1}, true),
                       quick = ask(map, polygons, {1, 1}, {9, 1}, false);
    CHECK_NEAR(wide.on_diagram, 1, 1e-12);
    CHECK_NEAR(quick.on_diagram, 0.5, 1e-12);
    CHECK(quick.route.length < wide.route.length);
}
