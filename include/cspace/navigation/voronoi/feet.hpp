// How the feet of a disc that rolls along two walls go over from site to site.
#pragma once

#include "cspace/navigation/voronoi/first_touch.hpp"

namespace cspace::navigation::voronoi {

// A foot leaves its site where p crosses the line through q across s, in the direction of s.
struct Gate {
    Point q, s;
};
inline Gate forward_gate(const Sites& sites, Index a) {
    const Index e = sites.edge_of(a);
    return sites.is_edge(a) ? Gate{sites.end(e), sites.direction(e)}
                            : Gate{sites.begin(e), sites.direction(e)};
}
inline Gate backward_gate(const Sites& sites, Index b) {
    const Index e = sites.edge_of(b);
    return {sites.begin(e), -1.0 * sites.direction(sites.is_edge(b) ? e : sites.previous(e))};
}
// The first parameter from begin on at which a foot leaves its site.
inline double leaves(const Bisector& curve, double begin, Gate gate, Grain grain) {
    const Quadratic g = curve.along(gate.s, gate.q);
    constexpr double begins = 1e-3;  // of the grain: a foot that a step put on the end is on it
    const double slack = grain.at(curve.radius(begin)) * begins;
    if (std::abs(g.at(begin)) <= slack && g.slope(begin) > 0) return begin;
    double first = std::numeric_limits<double>::infinity();
    for (const double t : g.zeros())
        if (t >= begin && t < first && g.slope(t) > 0) first = t;
    return first;
}
inline Index site_after(const Sites& sites, Index a) {
    if (!sites.is_edge(a)) return sites.edge_of(a);
    const Index e = sites.after(a);
    return sites.turn_at(e) == Turn::around ? sites.size() + e : e;
}
inline Index site_before(const Sites& sites, Index b) {
    const Index e = sites.edge_of(b);
    return sites.is_edge(b) && sites.turn_at(e) == Turn::around ? sites.size() + e : sites.previous(e);
}
// The edge behind the corner in which an edge ends, or begins.
inline Index corner_after(const Sites& sites, Index a) {
    return sites.is_edge(a) && sites.turn_at(sites.after(a)) == Turn::corner ? sites.after(a) : none;
}
inline Index corner_before(const Sites& sites, Index b) {
    return sites.is_edge(b) && sites.turn_at(b) == Turn::corner ? sites.previous(b) : none;
}

}  // namespace cspace::navigation::voronoi
