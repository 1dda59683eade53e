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
inline double leaving_parameter(const Sites& sites, const Bisector& curve, double begin, Gate gate,
                                Grain grain) {
    const Quadratic g = curve.along(gate.s, gate.q);
    constexpr double begins = 1e-3;  // of the grain: a foot that a step put on the end is on it
    const double slack = std::max(grain.at(curve.radius(begin)) * begins, 2 * sites.spacing);
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

// What ends an arc of two sites.
enum class ArcEnd : std::int8_t {
    lost,    // nothing: rounding hides it
    vertex,  // a third site
    corner,  // the corner between the two
    joint,   // a foot goes over to its next site
    bound,   // what the caller has set
};
struct ArcPiece {
    Bisector curve;
    double begin = 0, end = 0;
    ArcEnd cause = ArcEnd::lost;
    Index third = none;  // of a vertex
    bool turns_a = false, turns_b = false;
};

// The arc of a, whose foot moves forward, and b, whose foot moves backward, from a point on. bound(piece)
// gives the parameter up to which it is asked for.
template <class Bound>
ArcPiece next_piece(const Sites& s, Grain grain, Index a, Index b, Point from, const Bound& bound) {
    ArcPiece arc;
    arc.curve = bisector_of(s, a, b, from);
    arc.begin = arc.end = arc.curve.parameter(from);
    if (!std::isfinite(arc.begin) || !std::isfinite(squared_norm(arc.curve.p2))) return arc;
    const double end_a = leaving_parameter(s, arc.curve, arc.begin, forward_gate(s, a), grain),
                 end_b = leaving_parameter(s, arc.curve, arc.begin, backward_gate(s, b), grain);
    const double own = std::min({end_a, end_b, arc.begin + 4 * s.extent}), end = std::min(own, bound(arc));
    FirstTouch touch(s, grain, arc.curve, a, b, arc.begin, end);
    touch.find();
    arc.end = touch.at();
    arc.third = touch.site();
    if (arc.third != none) {
        arc.cause = ArcEnd::vertex;
    } else if (end < own) {
        arc.cause = ArcEnd::bound;
    } else if (s.is_edge(a) && s.is_edge(b) && s.after(a) == b && s.turn_at(b) == Turn::corner) {
        arc.cause = ArcEnd::corner;
        arc.end = arc.curve.parameter(s.begin(b));
    } else {
        arc.turns_a = end_a <= arc.end, arc.turns_b = end_b <= arc.end;
        const Index corner = arc.turns_a ? corner_after(s, a) : none,
                    other = arc.turns_b ? corner_before(s, b) : none;
        arc.third = corner != none ? corner : other;
        if (arc.turns_a || arc.turns_b) arc.cause = arc.third != none ? ArcEnd::vertex : ArcEnd::joint;
    }
    return arc;
}

}  // namespace cspace::navigation::voronoi
