#include "maps_polygon_world.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "cspace/maps/grid_outlines.hpp"
#include "cspace/maps/path_clearance.hpp"
#include "cspace/maps/rasterize.hpp"
#include "maps_polygon_state.hpp"

namespace cspace::maps {

namespace {

Outlines outlines_from(std::span<const Point> points, std::span<const std::int32_t> ends,
                       std::span<const std::int32_t> owners, Point low, Point high) {
    if (ends.size() != owners.size()) throw std::invalid_argument("ends and owners must have equal lengths");
    Outlines world;
    world.low = low, world.high = high;
    std::size_t begin = 0;
    for (std::size_t r = 0; r < ends.size(); ++r) {
        const auto end = std::size_t(ends[r]);
        if (end < begin || end > points.size() || owners[r] < 0)
            throw std::invalid_argument("ends must increase");
        world.add_ring(points.subspan(begin, end - begin), owners[r]);
        begin = end;
    }
    return world;
}

Outlines outlines_from(const BitGrid& grid, double side, Point origin) {
    Outlines world = outlines_of(grid);
    const auto moved = [&](Point p) { return origin + side * p; };
    visit_range(0, world.points.size(), [&](std::size_t i) { world.points[i] = moved(world.points[i]); });
    world.low = moved(world.low), world.high = moved(world.high);
    return world;
}

// So many zeros; polls, as the first touch of memory takes long.
std::vector<std::uint8_t> zero_bytes(std::size_t count) {
    constexpr std::size_t part = std::size_t(1) << 20;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(count);
    while (bytes.size() < count) {
        bytes.resize(std::min(count, bytes.size() + part));
        poll_interrupts();
    }
    return bytes;
}

}  // namespace

PolygonCore::State::State(Outlines outlines, double t) : world(std::move(outlines)), tolerance(t) {}

PolygonCore::PolygonCore(std::span<const Point> points, std::span<const std::int32_t> ends,
                         std::span<const std::int32_t> owners, Point low, Point high, double tolerance)
    : state_(new State(outlines_from(points, ends, owners, low, high), tolerance)) {}
PolygonCore::PolygonCore(CellBytes cells, double side, Point origin, double tolerance)
    : state_(new State(outlines_from(BitGrid(cells.data, cells.rows, cells.columns), side, origin),
                       tolerance)) {}

bool PolygonCore::complete() const { return state_->world.space.complete; }
int PolygonCore::components() const { return int(state_->world.space.components); }
std::tuple<Table<Point>, Table<std::int32_t>, Table<std::int32_t>, Table<std::int32_t>> PolygonCore::walls()
    const {
    const Boundary& b = state_->world.walls;
    return {{b.points}, {b.next}, {b.ring}, {b.component}};
}

std::pair<Table<Point>, std::vector<std::pair<int, int>>> PolygonCore::crossings() const {
    const FreeSpace& space = state_->world.space;
    const auto shared_owner = [&](Index one, Index other) {
        for (Index a = one; a != none; a = space.owners[std::size_t(a)].next)
            for (Index b = other; b != none; b = space.owners[std::size_t(b)].next)
                if (space.owners[std::size_t(a)].id == space.owners[std::size_t(b)].id)
                    return space.owners[std::size_t(a)].id;
        return none;
    };
    std::pair<Table<Point>, std::vector<std::pair<int, int>>> all;
    for (const auto& [at, one, other] : space.crossings) {
        const Index shared = shared_owner(one, other);
        const auto first_owner = [&](Index list) {
            return shared != none ? shared : space.owners[std::size_t(list)].id;
        };
        all.first.values.push_back(at);
        all.second.emplace_back(first_owner(one), first_owner(other));
    }
    return all;
}

std::vector<Table<Point>> PolygonCore::triangles() const {
    const FreeSpace& space = state_->world.space;
    std::vector<Table<Point>> all;
    for (Index t = 0; t < Index(space.mesh.triangles.size()); ++t) {
        if (!space.is_free(t)) continue;
        auto& corners = all.emplace_back().values;
        for (const Index v : space.mesh[t].corner) corners.push_back(space.mesh.point(v));
    }
    return all;
}
std::vector<Table<Point>> PolygonCore::convex_polygons() const {
    const ConvexMesh& mesh = state_->world.mesh();
    std::vector<Table<Point>> all;
    for (Index p = 0; p < mesh.size(); ++p) {
        auto& corners = all.emplace_back().values;
        for (Index e = mesh.begin(p); e < mesh.end(p); ++e)
            corners.push_back(mesh.point(mesh.corner[std::size_t(e)]));
    }
    return all;
}

std::vector<int> PolygonCore::components_at(Point p) const {
    std::vector<int> found;
    for (const Index t : state_->settle(p).triangles) {
        const Index c = state_->world.space.component[std::size_t(t)];
        if (std::find(found.begin(), found.end(), c) == found.end()) found.push_back(c);
    }
    return found;
}

int PolygonCore::obstacle_at(Point p) const {
    const PolygonWorld& world = state_->world;
    if (!world.is_inside_bounds(p)) return none;
    const Place place = world.space.mesh.locate(p, world.locator.near(p));
    return place.triangle == none ? none : world.space.obstacle[std::size_t(place.triangle)];
}

std::tuple<double, double, double> PolygonCore::nearest_wall(Point p) const {
    const Boundary& walls = state_->world.walls;
    std::pair<double, Point> best{std::numeric_limits<double>::infinity(), {}};
    for (Index e = 0; e < Index(walls.size()); ++e) {
        const Point foot = nearest_on(walls.begin(e), walls.end(e), p);
        if (const double d = distance(p, foot); d < best.first) best = {d, foot};
    }
    return {best.first, best.second.x, best.second.y};
}

double PolygonCore::path_clearance(std::span<const Point> path) const {
    return maps::path_clearance(path, state_->world.walls);
}

Table<std::uint8_t> PolygonCore::rasterize(double side, int rows, int columns) const {
    const PolygonWorld& world = state_->world;
    Table<std::uint8_t> blocked{zero_bytes(std::size_t(rows) * std::size_t(columns)), std::size_t(columns)};
    maps::rasterize_obstacles(world.space, world.outlines.low, side, rows, columns, state_->tolerance,
                              blocked.values.data());
    return blocked;
}

}  // namespace cspace::maps
