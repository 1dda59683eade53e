// A triangulation of the plane's part that a world fills, some of its edges walls.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cspace/maps/outlines.hpp"
#include "cspace/math/predicates.hpp"

namespace cspace::maps {

inline constexpr Index none = -1;

constexpr int next_corner(int i) { return i == 2 ? 0 : i + 1; }
constexpr int previous_corner(int i) { return i == 0 ? 2 : i - 1; }

// Counterclockwise. Edge i lies opposite corner i and leads from corner next_corner(i) to corner
// previous_corner(i).
struct Triangle {
    std::array<Index, 3> corner;
    std::array<Index, 3> across;  // the triangle on the other side of each edge, or none
    std::array<Index, 3> owners;  // what each edge is part of: the head of a list, or none

    int place_of(Index vertex) const { return corner[0] == vertex ? 0 : corner[1] == vertex ? 1 : 2; }
    int edge_to(Index triangle) const { return across[0] == triangle ? 0 : across[1] == triangle ? 1 : 2; }
    Index begin(int edge) const { return corner[std::size_t(next_corner(edge))]; }
    Index end(int edge) const { return corner[std::size_t(previous_corner(edge))]; }
};

// Where a point lies: in a triangle, on its edge, or at its corner.
struct Place {
    Index triangle = none;
    enum Kind : std::int8_t { inside, on_edge, at_corner } kind = inside;
    int index = 0;  // of the edge or of the corner
};

struct Triangulation {
    std::vector<Point> points;
    std::vector<Triangle> triangles;
    std::vector<Index> triangle_at;  // of each point: one triangle that has it as a corner

    const Triangle& operator[](Index t) const { return triangles[std::size_t(t)]; }
    Triangle& operator[](Index t) { return triangles[std::size_t(t)]; }
    Point point(Index v) const { return points[std::size_t(v)]; }
    // The corner 0 of a triangle and the ways from there to the others.
    std::array<Point, 3> spanned(Index t) const {
        const auto& c = (*this)[t].corner;
        return {point(c[0]), point(c[1]) - point(c[0]), point(c[2]) - point(c[0])};
    }
    Point middle_of(Index t) const {
        const auto [a, b, c] = spanned(t);
        return a + (1.0 / 3) * (b + c);
    }

    // Where p lies, walking from a triangle near it. The walk tries the edges of each triangle in an order
    // that a small generator draws, so it cannot run in circles (Devillers, Pion & Teillaud 2002, "Walking in
    // a triangulation"). The triangle is none if p lies outside.
    Place locate(Point p, Index from) const {
        Index t = from, previous = none;
        for (std::uint32_t random = 1;;) {
            random = random * 1664525u + 1013904223u;
            const Triangle& tri = (*this)[t];
            int step = -1;
            for (int k = 0, i = int(random >> 24) % 3; k < 3; ++k, i = next_corner(i)) {
                if (tri.across[std::size_t(i)] == previous && previous != none) continue;
                const int side = orientation(point(tri.begin(i)), point(tri.end(i)), p);
                if (side < 0) {
                    step = i;
                    break;
                }
            }
            if (step < 0) return place_in(t, p);
            previous = t;
            t = tri.across[std::size_t(step)];
            if (t == none) return {};
        }
    }

    // The kind of place of a point that lies in the closed triangle.
    Place place_in(Index t, Point p) const {
        const Triangle& tri = (*this)[t];
        int zeros = 0, sum = 0;
        for (int i = 0; i < 3; ++i)
            if (orientation(point(tri.begin(i)), point(tri.end(i)), p) == 0) ++zeros, sum += i;
        if (zeros == 0) return {t, Place::inside, 0};
        if (zeros == 1) return {t, Place::on_edge, sum};
        return {t, Place::at_corner, 3 - sum};  // on the two edges that meet there
    }

    // Calls visit(triangle, place of the vertex in it) for the triangles around a vertex, counterclockwise
    // from one of them and, at the outer border, clockwise for those on its other side, until it answers
    // false.
    template <class Visit>
    void around(Index vertex, Visit visit) const {
        const Index first = triangle_at[std::size_t(vertex)];
        Index t = first;
        do {
            const int i = (*this)[t].place_of(vertex);
            if (!visit(t, i)) return;
            t = (*this)[t].across[std::size_t(next_corner(i))];
        } while (t != first && t != none);
        if (t == first) return;
        for (t = clockwise(first, vertex); t != none; t = clockwise(t, vertex))
            if (!visit(t, (*this)[t].place_of(vertex))) return;
    }

  private:
    Index clockwise(Index t, Index vertex) const {
        return (*this)[t].across[std::size_t(previous_corner((*this)[t].place_of(vertex)))];
    }
};

}  // namespace cspace::maps
