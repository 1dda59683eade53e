// The Voronoi diagram of free space as a graph: where three walls or more are nearest, and what joins them.
#pragma once

#include <vector>

#include "cspace/navigation/voronoi/bisector.hpp"
#include "cspace/navigation/voronoi/edge_tree.hpp"

namespace cspace::navigation::voronoi {

struct Vertex {
    Point at;
    double radius;     // its distance from the walls [m]
    Index component;   // of free space
    Index degree = 0;  // one at a corner of free space, two where an arc changes its kind, else three or more
};

struct Arc {
    Index from, to;  // vertices
    Index a, b;      // the sites that it is as far from, a to the right
    Bisector curve;
    double begin, end;  // parameters
    double least;       // its smallest distance from the walls [m]
    double length;      // [m]
};

struct Diagram {
    Sites sites;
    EdgeTree tree;
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

inline Nearest nearest_site(const Sites& sites, const EdgeTree& tree, Point p) {
    Nearest best;
    best.distance = 4 * sites.extent;
    const double slack = 1e-12 * sites.extent;
    tree.visit_shrinking(
        p, EitherSide{}, [&] { return std::pair{p, best.distance + slack}; },
        [&](Index e) {
            const double s = sites.advance(e, p), h = sites.height(e, p);
            if (s >= -slack && s <= sites.length[std::size_t(e)] + slack && h >= -slack && h < best.distance)
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
inline Retraction retract_along(const Sites& sites, const EdgeTree& tree, Index site, Point foot, Point away,
                                double least) {
    Retraction up;
    up.a = site;
    up.foot = foot;
    const double slack = 1e-12 * sites.extent;
    double radius = 4 * sites.extent;
    const auto at = [&] { return up.foot + radius * away; };
    const Index own = sites.edge_of(site), own_before = sites.previous(own), own_after = sites.after(own);
    const bool is_edge = sites.is_edge(site);
    const auto is_own = [&](Index e) {
        if (e == own) return true;
        if (e == own_before) return !is_edge || sites.turn_at(own) != Turn::corner;
        return is_edge && e == own_after && sites.turn_at(own_after) != Turn::corner;
    };
    const auto consider = [&](double t, Index other) {
        if (t >= least && t < radius) radius = t, up.b = other;
    };
    tree.visit_shrinking(
        foot + least * away, EitherSide{}, [&] { return std::pair{at(), radius}; },
        [&](Index e) {
            const Point q = sites.begin(e);
            if (!is_own(e) && q != up.foot && sites.end(e) != up.foot) {
                const double t = sites.height(e, up.foot) / (1 - dot(sites.normal(e), away));
                const double s = sites.advance(e, up.foot + t * away);
                if (s >= -slack && s <= sites.length[std::size_t(e)] + slack) consider(t, e);
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

inline Retraction retract(const Sites& sites, const EdgeTree& tree, Point p) {
    const Nearest near = nearest_site(sites, tree, p);
    if (near.site == none) return {};
    const double least = near.distance * (1 - 1e-9) - 1e-13 * sites.extent;
    Retraction up =
        retract_along(sites, tree, near.site, near.foot, -1.0 * sites.towards(near.site, p), least);
    up.clearance = near.distance;
    return up;
}

}  // namespace cspace::navigation::voronoi
