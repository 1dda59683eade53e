// The Voronoi diagram of free space as a graph: where three walls or more are nearest, and what joins them.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "cspace/navigation/voronoi/sites.hpp"

namespace cspace::navigation::voronoi {

// The curve of equal distance between two sites: a line or a parabola, with the distance in closed form.
//
// It is followed with the foot on the first site to the right and the foot on the second to the left; both
// feet move along their rings, the first forward, the second backward.

struct Quadratic {
    double c0 = 0, c1 = 0, c2 = 0;
    double at(double t) const { return c0 + t * (c1 + t * c2); }
    double slope(double t) const { return c1 + 2 * t * c2; }
    // Its zeros; those that do not exist are not finite.
    std::array<double, 2> zeros() const {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const double square = c1 * c1 - 4 * c2 * c0;
        if (!(square >= 0)) return {nan, nan};
        const double q = -0.5 * (c1 + std::copysign(std::sqrt(square), c1));
        return {q / c2, c0 / q};
    }
};

struct Bisector {
    Point p0, p1, p2;       // the point at t: p0 + t p1 + t² p2
    Quadratic radius_form;  // the distance at t, or its square
    bool is_squared = false;
    bool has_focus = false;
    Point focus;  // a site that is a point

    Point at(double t) const { return p0 + t * p1 + (t * t) * p2; }
    Point velocity(double t) const { return p1 + (2 * t) * p2; }
    double radius(double t) const {
        const double r = radius_form.at(t);
        return is_squared ? std::sqrt(std::max(r, 0.0)) : r;
    }
    double parameter(Point p) const { return dot(p - p0, p1); }  // |p1| = 1, and p2 stands across it

    // n · (p(t) − q) for a fixed n.
    Quadratic along(Point n, Point q) const { return {dot(n, p0 - q), dot(n, p1), dot(n, p2)}; }

    // Zero where a line is as near as the sites; its points x have n · (x − q) = 0.
    Quadratic against_line(Point n, Point q) const {
        const Quadratic h = along(n, q), &r = radius_form;
        if (!is_squared) return {h.c0 - r.c0, h.c1 - r.c1, h.c2 - r.c2};
        return {h.c0 * h.c0 - r.c0, 2 * h.c0 * h.c1 - r.c1, h.c1 * h.c1 - r.c2};
    }
    // Zero where a point is as near as the sites.
    Quadratic against_point(Point q) const {
        if (has_focus) return along(-2.0 * (q - focus), 0.5 * (q + focus));
        const Point from = p0 - q;
        const double r0 = radius_form.c0, r1 = radius_form.c1;
        return {dot(from, from) - r0 * r0, 2 * (dot(from, p1) - r0 * r1), 1 - r1 * r1};
    }
    // The smallest distance between two parameters.
    double least_radius(double t0, double t1) const {
        const bool apex = has_focus && t0 < 0 && t1 > 0;
        return apex ? radius(0) : std::min(radius(t0), radius(t1));
    }
    double length(double t0, double t1) const {
        const double k = 2 * norm(p2);  // |velocity|² = 1 + k² t²
        if (k == 0) return t1 - t0;
        const auto part = [k](double t) {
            return 0.5 * (t * std::sqrt(1 + k * k * t * t) + std::asinh(k * t) / k);
        };
        return part(t1) - part(t0);
    }
};

// Of the sites a, to the right, and b, to the left, through a point as near to one as to the other.
inline Bisector bisector_of(const Sites& sites, Index a, Index b, Point through) {
    Bisector curve;
    if (sites.is_edge(a) && sites.is_edge(b)) {
        const Point way = sites.direction(a) - sites.direction(b);
        const double size = norm(way);
        curve.p0 = through;
        curve.p1 = (1 / size) * way;
        curve.radius_form = {0.5 * (sites.height(a, through) + sites.height(b, through)),
                             dot(sites.normal(a), curve.p1), 0};
        return curve;
    }
    curve.has_focus = true;
    if (!sites.is_edge(a) && !sites.is_edge(b)) {
        const Point p = sites.begin(sites.edge_of(a)), q = sites.begin(sites.edge_of(b));
        const double half = 0.5 * distance(p, q);
        const Point way = (0.5 / half) * (p - q);
        curve.focus = p;
        curve.p0 = 0.5 * (p + q);
        curve.p1 = {-way.y, way.x};
        curve.radius_form = {half * half, 0, 1};
        curve.is_squared = true;
        return curve;
    }
    const Index edge = sites.is_edge(a) ? a : b;
    const Point axis = sites.normal(edge);
    curve.focus = sites.begin(sites.edge_of(edge == a ? b : a));
    curve.p1 = edge == a ? sites.direction(edge) : -1.0 * sites.direction(edge);
    const double h = sites.height(edge, curve.focus);
    curve.p0 = curve.focus - (0.5 * h) * axis;
    curve.p2 = (0.5 / h) * axis;
    curve.radius_form = {0.5 * h, 0, 0.5 / h};
    return curve;
}

// The end of one arc at a corner of free space, of two where an arc changes its kind, else of three or more.
struct Vertex {
    Point at;
    double radius;    // its distance from the walls [m]
    Index component;  // of free space
};

struct Arc {
    Index from, to;  // vertices
    Index a, b;      // the sites that it is as far from, a to the right
    Bisector curve;
    double begin, end;  // parameters
};

struct Diagram {
    Sites sites;
    std::vector<Vertex> vertices;
    std::vector<Arc> arcs;
    std::vector<std::uint8_t> is_whole;  // of each component: false where rounding has lost arcs

    Point place(Point p) const { return p + sites.origin; }
};

// The nearest site to a point of free space, by the walls that face it.
struct Nearest {
    Index site = none;
    double distance = std::numeric_limits<double>::infinity();
    Point foot;
};

inline Nearest nearest_site(const Sites& sites, Point p) {
    Nearest best;
    best.distance = 4 * sites.extent;
    const double slack = sites.rounding();
    sites.tree.visit_shrinking(
        p, EitherSide{}, [&] { return std::pair{p, best.distance + slack}; },
        [&](Index e) {
            const double h = sites.height(e, p);
            if (h >= -slack && h < best.distance && sites.is_beside(e, p, slack))
                best = {e, std::max(h, 0.0), p - h * sites.normal(e)};
            if (sites.turn_at(e) != Turn::around || !sites.is_in_cone(e, p, slack)) return;
            const double d = distance(p, sites.begin(e));
            if (d < best.distance) best = {sites.size() + e, d, sites.begin(e)};
        });
    return best;
}

// Where the clearance is largest on the ray away from the nearest wall: a point of the diagram.
struct Retraction {
    Index a = none, b = none;  // what is nearest there
    Point foot, at;
    double clearance = 0, radius = 0;  // at the point itself, and on the diagram
};

// The same on a ray from the foot of a site, from a distance on.
inline Retraction retract_along(const Sites& sites, Index site, Point foot, Point away, double least) {
    Retraction up;
    up.a = site;
    up.foot = foot;
    const double slack = sites.rounding();
    double radius = 4 * sites.extent;
    const auto at = [&] { return up.foot + radius * away; };
    const auto consider = [&](double t, Index other) {
        if (t >= least && t < radius) radius = t, up.b = other;
    };
    sites.tree.visit_shrinking(
        foot + least * away, EitherSide{}, [&] { return std::pair{at(), radius}; },
        [&](Index e) {
            const Point q = sites.begin(e);
            if (!sites.belongs(e, site) && q != up.foot && sites.end(e) != up.foot) {
                const double t = sites.height(e, up.foot) / (1 - dot(sites.normal(e), away));
                if (sites.is_beside(e, up.foot + t * away, slack)) consider(t, e);
            }
            const Point to = q - up.foot;
            const double ahead = dot(to, away);
            if (sites.turn_at(e) == Turn::around && ahead > 0 && sites.size() + e != up.a)
                consider(squared_norm(to) / (2 * ahead), sites.size() + e);
        });
    up.at = at();
    up.radius = radius;
    return up;
}

inline Retraction retract_point(const Sites& sites, Point p) {
    const Nearest near = nearest_site(sites, p);
    if (near.site == none) return {};
    constexpr double finest = 1e-13;  // of the extent: the rounding of a single coordinate
    const double least = near.distance * (1 - tolerance::widening) - finest * sites.extent;
    Retraction up = retract_along(sites, near.site, near.foot, -1.0 * sites.towards(near.site, p), least);
    up.clearance = near.distance;
    return up;
}

}  // namespace cspace::navigation::voronoi
