// Covers by spheres: distances and windings against slow oracles, covers and their bounds against samples.
#include <cstdint>
#include <map>
#include <utility>

#include "check.hpp"
#include "cspace/shapes/cover.hpp"
#include "library/shapes_cover.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::shapes;

namespace {

using Face = std::array<std::int32_t, 3>;
struct Mesh {
    std::vector<Vec3d> vertices;
    std::vector<Face> faces;
    TriangleSurface surface() const {
        Watch watch;
        return {vertices, faces, watch};
    }
    SurfaceData data(bool solid) const { return {vertices, faces, solid}; }
};

// An octahedron whose triangles are divided into four, its corners moved to random distances from the middle.
Mesh star(check::Random& random, int divisions, double least, double most) {
    Mesh mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int i = 0; i < divisions; ++i) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [at, added] =
                middles.insert({{std::min(a, b), std::max(a, b)}, int(mesh.vertices.size())});
            if (added) mesh.vertices.push_back(mesh.vertices[std::size_t(a)] + mesh.vertices[std::size_t(b)]);
            return at->second;
        };
        std::vector<Face> parts;
        for (const auto& [a, b, c] : mesh.faces) {
            const int x = middle(a, b), y = middle(b, c), z = middle(c, a);
            for (const Face& f : {Face{a, x, z}, Face{x, b, y}, Face{z, y, c}, Face{x, y, z}})
                parts.push_back(f);
        }
        mesh.faces = parts;
    }
    for (Vec3d& v : mesh.vertices) v = (random.uniform(least, most) / norm(v)) * v;
    return mesh;
}
Mesh box(const Vec3d& half) {
    Mesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.vertices.push_back(
            {k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
    mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}
// A ring of square section around z: a solid with a hole.
Mesh ring(int sides, double radius, double half) {
    Mesh mesh;
    for (int i = 0; i < sides; ++i) {
        const double angle = 6.283185307179586 * i / sides;
        for (int k = 0; k < 4; ++k) {
            const double r = radius + (k == 0 || k == 3 ? -half : half), z = k < 2 ? -half : half;
            mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
            const int next = (i + 1) % sides;
            const int a = 4 * i + k, b = 4 * i + (k + 1) % 4, c = 4 * next + k, d = 4 * next + (k + 1) % 4;
            mesh.faces.push_back({a, c, b}), mesh.faces.push_back({b, c, d});
        }
    }
    return mesh;
}
std::vector<Mesh> solids(check::Random& random) {
    return {star(random, 0, 0.05, 0.2), star(random, 2, 0.1, 0.12),    star(random, 2, 0.06, 0.14),
            box({0.1, 0.05, 0.02}),     box({0.15, 0.15, 0.001}),      ring(24, 0.1, 0.02),
            ring(7, 0.05, 0.03),        star(random, 3, 0.15, 0.15001)};
}
Mesh open_half(Mesh mesh) {
    mesh.faces.resize(mesh.faces.size() / 2);
    return mesh;
}

// The distance of a point from a triangle by its nearest point in barycentric coordinates, found by the
// least of the plane's, the sides' and the corners'.
double slow_distance(const Triangle& t, const Vec3d& p) {
    double best = infinite;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d side = t[(k + 1) % 3] - t[k];
        const double s = std::clamp(dot(p - t[k], side) / dot(side, side), 0.0, 1.0);
        best = std::min(best, norm(p - (t[k] + s * side)));
    }
    const Vec3d u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
    const double a = (vv * dot(u, w) - uv * dot(v, w)) / det, b = (uu * dot(v, w) - uv * dot(u, w)) / det;
    if (a >= 0 && b >= 0 && a + b <= 1) best = std::min(best, norm(w - (a * u + b * v)));
    return best;
}
double slow_distance(const Mesh& mesh, const Vec3d& p) {
    double best = infinite;
    for (const auto& [a, b, c] : mesh.faces)
        best = std::min(best, slow_distance({mesh.vertices[std::size_t(a)], mesh.vertices[std::size_t(b)],
                                             mesh.vertices[std::size_t(c)]},
                                            p));
    return best;
}
double slow_winding(const Mesh& mesh, const Vec3d& p) {
    double total = 0;
    for (const auto& [i, j, k] : mesh.faces) {
        const Vec3d a = mesh.vertices[std::size_t(i)] - p, b = mesh.vertices[std::size_t(j)] - p,
                    c = mesh.vertices[std::size_t(k)] - p;
        const double la = norm(a), lb = norm(b), lc = norm(c);
        total +=
            std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return total / 6.283185307179586;
}
Vec3d place_on(const Mesh& mesh, check::Random& random) {
    const auto& [a, b, c] = mesh.faces[std::size_t(random.below(int(mesh.faces.size())))];
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3d &p = mesh.vertices[std::size_t(a)], &q = mesh.vertices[std::size_t(b)],
                &r = mesh.vertices[std::size_t(c)];
    return p + u * (q - p) + v * (r - p);
}
double gap_of(const std::vector<SphereRow>& spheres, const Vec3d& p) {
    double gap = infinite;
    for (const SphereRow& s : spheres) gap = std::min(gap, norm(p - Vec3d{s[0], s[1], s[2]}) - s[3]);
    return gap;
}

}  // namespace

TEST(nearest_places_and_windings_are_those_of_slow_oracles) {
    check::Random random{1};
    for (const Mesh& mesh : solids(random)) {
        const TriangleSurface surface = mesh.surface();
        for (int i = 0; i < 300; ++i) {
            const Vec3d p = 0.2 * random.vector();
            const auto near = surface.nearest(p);
            CHECK_NEAR(std::sqrt(near.square), slow_distance(mesh, p), 1e-12);
            CHECK_NEAR(norm(near.place - p), std::sqrt(near.square), 1e-12);
            if (near.square > 1e-12) CHECK(surface.winding(p) == std::lround(slow_winding(mesh, p)));
        }
    }
}

TEST(windings_are_right_where_rays_meet_corners_and_sides) {
    const TriangleSurface surface = box({1, 1, 1}).surface();
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z)
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != 2) {
                    const bool inside = std::max({std::abs(x), std::abs(y), std::abs(z)}) < 2;
                    CHECK(surface.winding({x / 2.0, y / 2.0, z / 2.0}) == int(inside));
                }
}

TEST(parts_of_triangles_are_small_and_tile_them) {
    check::Random random{9};
    for (int round = 0; round < 40; ++round) {
        const Vec3d a = random.vector(), b = random.vector();
        const double height = std::pow(10, random.uniform(-8, 0));
        const Triangle t = {a, b, a + random.uniform(0, 1) * (b - a) + height * random.axis()};
        const double side = random.uniform(0.01, 0.2);
        Watch watch;
        double area = 0;
        const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
        for (const Triangle& part : split_triangles(std::span(&t, 1), side, 1 << 20, watch)) {
            const Vec3d n = cross(part[1] - part[0], part[2] - part[0]);
            area += area_of(part);
            CHECK(std::sqrt(find_long_side(part).square) <= side);
            CHECK(dot(n, normal) >= -1e-12 * dot(normal, normal));
            for (const Vec3d& p : part) {  // it and the sides make up the triangle
                const double sum =
                    area_of({t[0], t[1], p}) + area_of({t[1], t[2], p}) + area_of({t[2], t[0], p});
                CHECK(sum <= area_of(t) * (1 + 1e-9) + 1e-15);
            }
        }
        CHECK_NEAR(area, area_of(t), 1e-9 * area_of(t) + 1e-15);
    }
    const Triangle needle = {Vec3d{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}};
    Watch watch;
    CHECK(split_triangles(std::span(&needle, 1), 0.001, 1 << 20, watch).size() < 8000);  // halves: 50,000
}

TEST(chosen_sets_hold_every_item_and_none_is_redundant) {
    check::Random random{2};
    for (int round = 0; round < 50; ++round) {
        const std::uint32_t items = 60;
        ItemSets sets;
        std::vector<int> held(items, 0);
        for (int k = 0; k < 80; ++k) {
            const auto begin = std::uint32_t(random.below(int(items)));
            const auto end = std::min(items, begin + 1 + std::uint32_t(random.below(8)));
            sets.add(std::array{Run{begin, end}});
            for (std::uint32_t i = begin; i < end; ++i) ++held[i];
        }
        Watch watch;
        SetCover cover(sets, std::vector<std::uint32_t>(items, 1), watch);
        const auto chosen = cover.choose();
        std::vector<int> count(items, 0);
        for (const auto k : chosen)
            for (std::uint32_t i = sets[k][0].begin; i < sets[k][0].end; ++i) ++count[i];
        for (std::size_t i = 0; i < items; ++i) {
            CHECK((count[i] > 0) == (held[i] > 0));
            CHECK(count[i] == int(cover.counts()[i]));
        }
        for (const auto k : chosen) {
            bool needed = false;
            for (std::uint32_t i = sets[k][0].begin; i < sets[k][0].end; ++i) needed |= count[i] == 1;
            CHECK(needed);
        }
        // The fewest intervals: from the left, always the one that reaches farthest.
        std::size_t fewest = 0;
        for (std::uint32_t at = 0; at < items;) {
            std::uint32_t farthest = at;
            for (std::size_t k = 0; k < sets.size(); ++k)
                if (sets[k][0].begin <= at) farthest = std::max(farthest, sets[k][0].end);
            if (farthest > at) ++fewest;
            at = std::max(farthest, at + 1);
        }
        CHECK(chosen.size() >= fewest && 3 * fewest >= 2 * chosen.size());
    }
}

TEST(covers_hold_samples_of_the_solid_and_stick_out_no_farther_than_stated) {
    check::Random random{3};
    for (const Mesh& mesh : solids(random))
        for (const double within : {0.04, 0.012}) {
            const FoundCover found = find_cover(mesh.data(true), within, true, infinite);
            CHECK(found.outcome == CoverOutcome::found && found.uncovered_depth <= 0);
            CHECK(found.stick_out > 0 && found.stick_out <= within);
            for (int i = 0; i < 2000; ++i) {
                const Vec3d p = i % 2 ? place_on(mesh, random) : 0.2 * random.vector();
                if (i % 2 || slow_winding(mesh, p) > 0.5) CHECK(gap_of(found.spheres.values, p) <= 0);
            }
            for (const SphereRow& s : found.spheres.values)
                for (int i = 0; i < 20; ++i) {
                    const Vec3d p = Vec3d{s[0], s[1], s[2]} + s[3] * random.axis();
                    if (slow_distance(mesh, p) > found.stick_out) CHECK(slow_winding(mesh, p) > 0.5);
                }
        }
}

TEST(open_surfaces_are_covered_as_surfaces) {
    check::Random random{4};
    for (Mesh mesh : solids(random)) {
        mesh = open_half(mesh);
        const FoundCover found = find_cover(mesh.data(false), 0.02, true, infinite);
        CHECK(found.outcome == CoverOutcome::found && found.uncovered_depth <= 0 && found.stick_out <= 0.02);
        for (int i = 0; i < 1000; ++i) CHECK(gap_of(found.spheres.values, place_on(mesh, random)) <= 0);
        for (const SphereRow& s : found.spheres.values) {
            const Vec3d p = Vec3d{s[0], s[1], s[2]} + s[3] * random.axis();
            CHECK(slow_distance(mesh, p) <= found.stick_out);
        }
    }
}

TEST(without_the_inside_the_surface_is_covered_with_no_more_spheres) {
    const Mesh mesh = box({0.2, 0.2, 0.2});
    check::Random random{5};
    const FoundCover shell = find_cover(mesh.data(true), 0.02, false, infinite);
    const FoundCover solid = find_cover(mesh.data(true), 0.02, true, infinite);
    CHECK(shell.uncovered_depth <= 0 && shell.spheres.values.size() <= solid.spheres.values.size());
    for (int i = 0; i < 1000; ++i) CHECK(gap_of(shell.spheres.values, place_on(mesh, random)) <= 0);
}

TEST(what_spheres_leave_inside_is_found_and_covered) {
    const Mesh mesh = box({0.1, 0.1, 0.1});
    const TriangleSurface surface = mesh.surface();
    std::vector<Ball> balls;  // along the surface only
    for (int x = -10; x <= 10; ++x)
        for (int y = -10; y <= 10; ++y)
            for (int z = -10; z <= 10; ++z)
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 10)
                    balls.push_back({0.01 * Vec3d{double(x), double(y), double(z)}, 0.012});
    Watch watch;
    CoverCheck check(surface, balls, {0.001, 0.002, 1 << 24}, watch);
    CHECK(check.check_surface(0.001).upper <= 0);
    const Bounds depth = check.check_inside();  // the middle is 0.1 − 0.012 away
    CHECK(depth.lower <= 0.088 && 0.088 <= depth.upper && depth.upper - depth.lower <= 0.002);
    CHECK(check.check_share().upper <= 0);
    double volume = 0;
    for (const Box& cell : check.find_open_cells(0.01)) {
        const Vec3d side = cell.high - cell.low;
        volume += side.x * side.y * side.z;
    }
    CHECK(volume > 0.9 * 0.176 * 0.176 * 0.176 && volume < 1.1 * 0.18 * 0.18 * 0.18);
}

TEST(bounds_of_given_spheres_hold_what_samples_show) {
    check::Random random{6};
    for (const Mesh& mesh : solids(random)) {
        std::vector<SphereRow> spheres;
        for (int k = 0; k < 12; ++k) {
            const Vec3d c = 0.8 * place_on(mesh, random);
            spheres.push_back({c.x, c.y, c.z, random.uniform(0.01, 0.08)});
        }
        const double tolerance = 1e-3;
        const MeasuredCover found = measure_cover(mesh.data(true), spheres, true, tolerance, infinite);
        CHECK(found.outcome == CoverOutcome::found);
        const auto [low, high] = found.uncovered_depth;
        CHECK(low <= high && high - low <= tolerance * 1.01);
        CHECK(found.stick_out[1] - found.stick_out[0] <= tolerance * 1.01);
        double deepest = 0, farthest = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3d p = i % 2 ? place_on(mesh, random) : 0.2 * random.vector();
            if (i % 2 || slow_winding(mesh, p) > 0.5) deepest = std::max(deepest, gap_of(spheres, p));
        }
        for (const SphereRow& s : spheres)
            for (int i = 0; i < 200; ++i) {
                const Vec3d p = Vec3d{s[0], s[1], s[2]} + s[3] * random.axis();
                if (slow_winding(mesh, p) < 0.5) farthest = std::max(farthest, slow_distance(mesh, p));
            }
        CHECK(deepest <= high && deepest >= low - 0.02);
        CHECK(farthest <= found.stick_out[1] && farthest >= found.stick_out[0] - 0.02);
        int outside = 0;
        const int samples = 4000;
        std::vector<double> areas;
        double whole = 0;
        const TriangleSurface surface = mesh.surface();
        for (const Triangle& t : surface.triangles()) areas.push_back(whole += area_of(t));
        for (int i = 0; i < samples; ++i) {
            const auto k = std::size_t(
                std::lower_bound(areas.begin(), areas.end(), random.uniform(0, whole)) - areas.begin());
            const Triangle& t = surface.triangles()[k];
            double u = random.uniform(0, 1), v = random.uniform(0, 1);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            outside += gap_of(spheres, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0])) > 0;
        }
        const double share = double(outside) / samples;
        CHECK(share >= found.uncovered_share[0] - 0.03 && share <= found.uncovered_share[1] + 0.03);
    }
}

TEST(a_mesh_scaled_by_a_power_of_two_has_the_same_cover_scaled) {
    check::Random random{7};
    Mesh mesh = star(random, 2, 0.06, 0.14);
    const FoundCover once = find_cover(mesh.data(true), 0.01, true, infinite);
    const double scale = 1024;  // metres as millimetres, nearly
    for (Vec3d& v : mesh.vertices) v = scale * v;
    const FoundCover again = find_cover(mesh.data(true), 0.01 * scale, true, infinite);
    CHECK(once.spheres.values.size() == again.spheres.values.size());
    for (std::size_t k = 0; k < once.spheres.values.size(); ++k)
        for (std::size_t i = 0; i < 4; ++i)
            CHECK(scale * once.spheres.values[k][i] == again.spheres.values[k][i]);
}

TEST(dirty_surfaces_are_covered) {
    check::Random random{8};
    Mesh mesh = star(random, 1, 0.1, 0.12);
    const auto n = std::int32_t(mesh.vertices.size());
    mesh.vertices.push_back({0.5, 0, 0}), mesh.vertices.push_back({0.5, 0, 0.1});
    mesh.vertices.push_back({0.5, 0, 0.05});
    mesh.vertices.push_back(mesh.vertices[0]);
    mesh.faces.push_back({n, n + 1, n + 2});  // on one line
    mesh.faces.push_back({0, n + 3, 5});      // two corners in one place
    const FoundCover found = find_cover(mesh.data(false), 0.02, true, infinite);
    CHECK(found.outcome == CoverOutcome::found && found.uncovered_depth <= 0 && found.stick_out <= 0.02);
    CHECK(gap_of(found.spheres.values, {0.5, 0, 0.07}) <= 0);
}

TEST(searches_end_with_the_time_and_refuse_too_many_pieces) {
    const Mesh mesh = box({1, 1, 1});
    CHECK(find_cover(mesh.data(true), 0.05, true, 0).outcome == CoverOutcome::out_of_time);
    CHECK(find_cover(mesh.data(true), 1e-4, true, infinite).outcome == CoverOutcome::too_fine);
    const std::vector<SphereRow> spheres = {{0, 0, 0, 1}};
    CHECK(measure_cover(mesh.data(true), spheres, true, 1e-6, 0).outcome == CoverOutcome::out_of_time);
}
