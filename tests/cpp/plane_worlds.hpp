// Worlds with a known answer: triangulated patches of which some triangles are blocked and some sides are
// walls without thickness. Which triangles hang together is counted, so reachability needs no geometry.
#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/math/predicates.hpp"
#include "random.hpp"

namespace check {

using cspace::Point;

struct PlaneWorld {
    struct Triangle {
        int corner[3];
        int across[3];  // the triangle beyond side k, from corner k to k + 1; −1 beyond the border
        bool wall[3];
        bool blocked;
        int part;
    };
    std::vector<Point> points;
    std::vector<Triangle> triangles;
    int columns = 0, rows = 0;

    PlaneWorld(int columns, int rows, Random& random) : columns(columns), rows(rows) {
        for (int r = 0; r <= rows; ++r)
            for (int c = 0; c <= columns; ++c) points.push_back({4.0 * c, 4.0 * r});
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c) {
                const int a = r * (columns + 1) + c, b = a + 1, d = a + columns + 1, e = d + 1;
                if (random.below(2)) {
                    add(a, b, e);
                    add(a, e, d);
                } else {
                    add(a, b, d);
                    add(b, e, d);
                }
            }
        std::map<std::pair<int, int>, std::pair<int, int>> sides;
        for (int t = 0; t < int(triangles.size()); ++t)
            for (int k = 0; k < 3; ++k) sides[{tip(t, k), tip(t, k + 1)}] = {t, k};
        for (int t = 0; t < int(triangles.size()); ++t)
            for (int k = 0; k < 3; ++k) {
                const auto twin = sides.find({tip(t, k + 1), tip(t, k)});
                triangles[std::size_t(t)].across[k] = twin == sides.end() ? -1 : twin->second.first;
            }
    }

    int tip(int t, int k) const { return triangles[std::size_t(t)].corner[k % 3]; }
    Point place(int t, int k) const { return points[std::size_t(tip(t, k))]; }

    void block_cell(int c, int r) {
        if (c < 0 || r < 0 || c >= columns || r >= rows) return;
        for (int k = 0; k < 2; ++k) triangles[std::size_t(2 * (r * columns + c) + k)].blocked = true;
    }
    void build_wall(int t, int k) {
        Triangle& one = triangles[std::size_t(t)];
        one.wall[k] = true;
        if (one.across[k] < 0) return;
        Triangle& two = triangles[std::size_t(one.across[k])];
        for (int j = 0; j < 3; ++j)
            if (two.across[j] == t) two.wall[j] = true;
    }

    // Whether no triangle is turned over or thinner than rounding.
    bool is_upright() const {
        for (int t = 0; t < int(triangles.size()); ++t) {
            const Point a = place(t, 0), u = place(t, 1) - a, v = place(t, 2) - a;
            if (cross(u, v) <= 1e-9 * (squared_norm(u) + squared_norm(v))) return false;
        }
        return true;
    }

    void find_parts() {
        int parts = 0;
        for (Triangle& t : triangles) t.part = -1;
        for (int seed = 0; seed < int(triangles.size()); ++seed) {
            if (triangles[std::size_t(seed)].blocked || triangles[std::size_t(seed)].part >= 0) continue;
            std::vector<int> open{seed};
            triangles[std::size_t(seed)].part = parts;
            while (!open.empty()) {
                const int t = open.back();
                open.pop_back();
                for (int k = 0; k < 3; ++k) {
                    const int other = beyond(t, k);
                    if (other < 0 || triangles[std::size_t(other)].part >= 0) continue;
                    triangles[std::size_t(other)].part = parts;
                    open.push_back(other);
                }
            }
            ++parts;
        }
    }

    // The parts of free space in whose closure the point lies.
    std::vector<int> parts_at(Point p) const {
        std::vector<int> parts;
        for (int t = 0; t < int(triangles.size()); ++t) {
            bool inside = !triangles[std::size_t(t)].blocked;
            for (int k = 0; inside && k < 3; ++k)
                inside = cspace::orientation(place(t, k), place(t, k + 1), p) >= 0;
            if (inside) parts.push_back(triangles[std::size_t(t)].part);
        }
        return parts;
    }
    bool connected(Point a, Point b) const {
        for (int i : parts_at(a))
            for (int j : parts_at(b))
                if (i == j) return true;
        return false;
    }

    // The rings of walls; with merge, pieces on one line become one.
    cspace::maps::Boundary boundary(bool merge) const {
        cspace::maps::Boundary all;
        std::map<std::pair<int, int>, int> ring_of;
        int rings = 0;
        for (int t = 0; t < int(triangles.size()); ++t)
            for (int k = 0; k < 3; ++k) {
                if (!is_boundary(t, k) || ring_of.count({t, k})) continue;
                std::vector<Point> ring;
                std::pair<int, int> at{t, k};
                do {
                    ring_of[at] = rings;
                    ring.push_back(place(at.first, at.second));
                    at = next(at.first, at.second);
                } while (at != std::pair{t, k});
                if (merge) merge_straight(ring);
                const int first = int(all.points.size()), n = int(ring.size());
                for (int i = 0; i < n; ++i) {
                    all.points.push_back(ring[std::size_t(i)]);
                    all.next.push_back(first + (i + 1) % n);
                    all.ring.push_back(rings);
                }
                all.component.push_back(triangles[std::size_t(t)].part);
                ++rings;
            }
        return all;
    }

    // Whether the point lies inside a blocked triangle, further than a margin from its sides.
    bool is_deep_in_wall(Point p, double margin) const {
        for (int t = 0; t < int(triangles.size()); ++t) {
            bool inside = triangles[std::size_t(t)].blocked;
            for (int k = 0; inside && k < 3; ++k) {
                const Point a = place(t, k), d = place(t, k + 1) - a;
                inside = cross(d, p - a) > margin * norm(d);
            }
            if (inside) return true;
        }
        return false;
    }

  private:
    void add(int a, int b, int c) {
        triangles.push_back({{a, b, c}, {-1, -1, -1}, {false, false, false}, false, -1});
    }
    bool is_boundary(int t, int k) const { return !triangles[std::size_t(t)].blocked && beyond(t, k) < 0; }
    // The free triangle that can be entered through side k, or −1.
    int beyond(int t, int k) const {
        const Triangle& one = triangles[std::size_t(t)];
        if (one.wall[k] || one.across[k] < 0 || triangles[std::size_t(one.across[k])].blocked) return -1;
        return one.across[k];
    }
    std::pair<int, int> next(int t, int k) const {
        int side = (k + 1) % 3;
        while (!is_boundary(t, side)) {
            const int other = triangles[std::size_t(t)].across[side];
            int j = 0;
            while (triangles[std::size_t(other)].across[j] != t) ++j;
            t = other;
            side = (j + 1) % 3;
        }
        return {t, side};
    }
    static void merge_straight(std::vector<Point>& ring) {
        for (std::size_t i = 0; i < ring.size() && ring.size() > 2;) {
            const Point a = ring[(i + ring.size() - 1) % ring.size()], v = ring[i],
                        b = ring[(i + 1) % ring.size()];
            if (cspace::orientation(a, v, b) == 0 && cspace::is_between(a, v, b) && a != b)
                ring.erase(ring.begin() + std::ptrdiff_t(i));
            else
                ++i;
        }
    }
};

// The families: scattered triangles, thin walls, both, mazes, spirals, combs, traps, nested rings, chequers.
enum class Family { scattered, thin_walls, mixed, maze, spiral, comb, trap, rings, chequers, count };

inline void fill_maze(PlaneWorld& world, Random& random) {
    const int cells = world.columns * world.rows;
    std::vector<int> part(std::size_t(cells), 0);
    std::iota(part.begin(), part.end(), 0);
    const auto root = [&](int c) {
        while (part[std::size_t(c)] != c) c = part[std::size_t(c)];
        return c;
    };
    std::vector<std::pair<int, int>> sides;
    for (int t = 0; t < int(world.triangles.size()); ++t)
        for (int k = 0; k < 3; ++k) {
            const int other = world.triangles[std::size_t(t)].across[k];
            if (other > t && other / 2 != t / 2) sides.push_back({t, k});
        }
    for (std::size_t i = sides.size(); i > 1; --i)
        std::swap(sides[i - 1], sides[std::size_t(random.below(int(i)))]);
    const int spare = random.below(4);  // walls left out, so that there are ways around; or one too many
    int left_out = 0;
    for (const auto& [t, k] : sides) {
        const int a = root(t / 2), b = root(world.triangles[std::size_t(t)].across[k] / 2);
        if (a != b && random.below(60) > 0)
            part[std::size_t(a)] = b;
        else if (left_out++ >= spare)
            world.build_wall(t, k);
    }
}

inline void fill_spiral(PlaneWorld& world) {
    int c = -1, r = 1, dc = 1, dr = 0;
    int steps[2] = {world.columns - 1, world.rows - 2};
    for (int turn = 0; steps[turn % 2] > 0; ++turn) {
        for (int s = 0; s < steps[turn % 2]; ++s) {
            c += dc;
            r += dr;
            world.block_cell(c, r);
        }
        steps[turn % 2] -= 2;
        const int old = dc;
        dc = -dr;
        dr = old;
    }
}

inline void fill_cells(PlaneWorld& world, Family family, Random& random) {
    const int w = world.columns, h = world.rows, one = random.below(w), gap = random.below(4);
    for (int r = 0; r < h; ++r)
        for (int c = 0; c < w; ++c) {
            bool block = false;
            const int ring = std::min({c, r, w - 1 - c, h - 1 - r});
            if (family == Family::comb) block = c % 2 == 1 && (c % 4 == 1 ? r > 0 : r < h - 1);
            if (family == Family::trap) block = ring == 1 && c > 1 + gap / 2;
            if (family == Family::rings) block = ring % 2 == 1 && !(gap > 0 && c == one);
            if (family == Family::chequers) block = (c + r) % 2 == 0 && random.below(8) > 0;
            if (block) world.block_cell(c, r);
        }
}

inline void fill_at_random(PlaneWorld& world, Family family, Random& random) {
    const double blocked = random.uniform(0, 0.6), walls = random.uniform(0, 0.6);
    for (int t = 0; t < int(world.triangles.size()); ++t) {
        if (family != Family::thin_walls && random.uniform(0, 1) < blocked)
            world.triangles[std::size_t(t)].blocked = true;
        for (int k = 0; family != Family::scattered && k < 3; ++k)
            if (random.uniform(0, 1) < 0.5 * walls) world.build_wall(t, k);
    }
}

// Moves corners by whole numbers, shears and scales, as long as no triangle turns over.
inline void deform(PlaneWorld& world, Random& random) {
    const std::vector<Point> before = world.points;
    if (random.below(2))
        for (Point& p : world.points) p = {p.x + random.below(3) - 1, p.y + random.below(3) - 1};
    const int a = 1 + random.below(2), b = random.below(3) - 1, c = random.below(3) - 1,
              d = 1 + random.below(2);
    if (random.below(2))
        for (Point& p : world.points) p = {a * p.x + b * p.y, c * p.x + d * p.y};
    const double scales[] = {1, 1, 1, 0.1, 1.0 / 3, 1e5, 1e-5}, scale = scales[random.below(7)];
    const double offset = random.below(4) ? 0 : random.uniform(-1e3, 1e3);
    for (Point& p : world.points) p = {scale * p.x + scale * offset, scale * p.y};
    if (!world.is_upright()) world.points = before;
}

inline PlaneWorld random_world(Random& random, Family family, int largest) {
    PlaneWorld world(2 + random.below(largest - 1), 2 + random.below(largest - 1), random);
    switch (family) {
        case Family::maze:
            fill_maze(world, random);
            break;
        case Family::spiral:
            fill_spiral(world);
            break;
        case Family::comb:
        case Family::trap:
        case Family::rings:
        case Family::chequers:
            fill_cells(world, family, random);
            break;
        default:
            fill_at_random(world, family, random);
    }
    deform(world, random);
    world.find_parts();
    return world;
}

// A corner, a point of a side, or a point of a triangle.
inline Point random_point(const PlaneWorld& world, Random& random) {
    const int t = random.below(int(world.triangles.size()));
    const Point a = world.place(t, 0), b = world.place(t, 1), c = world.place(t, 2);
    switch (random.below(4)) {
        case 0:
            return a;
        case 1:
            return {(a.x + b.x) / 2, (a.y + b.y) / 2};
        case 2:
            return {(2 * a.x + b.x + c.x) / 4, (2 * a.y + b.y + c.y) / 4};
        default: {
            const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
            return a + u * (b - a) + v * (c - a);
        }
    }
}

}  // namespace check
