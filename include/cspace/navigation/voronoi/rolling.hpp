// Where a disc of one size first touches a wall: on a straight way, and rolling around a corner.
#pragma once

#include "cspace/math/wrapping.hpp"
#include "cspace/navigation/voronoi/contacts.hpp"

namespace cspace::navigation::voronoi {

// Walls into which it would come by less than this part of its radius are none to it.
inline constexpr double grazing = 5e-13;

// Its middle at p + t d, d of length one.
struct StraightWay {
    Point p, d;

    Point at(double t) const { return p + t * d; }
    double length(double t) const { return t; }
    // When it comes to touch the line through q with the normal n, or the point q, not just grazing; or NaN.
    double meets_line(double radius, Point n, Point q) const {
        constexpr double closing = 1e-9;  // sine: along a wall it never touches it
        const double speed = dot(n, d);
        return speed < -closing ? (radius - dot(n, p - q)) / speed : std::nan("");
    }
    double meets_point(double radius, Point q) const {
        const double ahead = dot(q - p, d), off = cross(d, q - p), half = radius * radius - off * off;
        return half > 2 * grazing * radius * radius ? ahead - std::sqrt(half) : std::nan("");
    }
    double nearest(Point q) const { return dot(q - p, d); }
};

// Its middle at a distance from a corner, from the direction `start` clockwise by the angle t.
struct RoundWay {
    Point corner, start;
    double radius;

    Point at(double t) const {
        const double c = std::cos(t), s = std::sin(t);
        return corner + radius * Point{c * start.x + s * start.y, c * start.y - s * start.x};
    }
    double length(double t) const { return radius * t; }
    double meets_line(double, Point n, Point q) const {
        const double c = 1 - dot(n, corner - q) / radius;
        return c > -1 + grazing ? nearest_turn(turn_from(n, start) + std::acos(c)) : std::nan("");
    }
    double meets_point(double reach, Point q) const {
        const Point to = q - corner;
        const double far = norm(to);
        const double c = (far * far + (radius - reach) * (radius + reach)) / (2 * radius * far);
        return c < 1 - grazing ? nearest_turn(turn_from(to, start) - std::acos(c)) : std::nan("");
    }
    double nearest(Point q) const { return nearest_turn(turn_from(q - corner, start)); }

  private:
    // Of angles that are the same direction, that next to half a turn or less.
    static double nearest_turn(double t) { return wrap_above(t, -pi / 2); }
};

struct FirstMeeting {
    double at;  // or the requested end
    Index site = none;
};

// along: the site that the disc rolls along, or none.
template <class Way>
FirstMeeting first_meeting(const Sites& sites, Grain grain, const Way& way, double radius, Index along,
                           double end) {
    FirstMeeting first{end};
    const double slack = grain.at(radius) / std::max(way.length(1), tolerance::nonzero),
                 margin = 1e3 * grain.at(radius);
    const auto offer = [&](double t, Index site) {
        if (!(t >= -slack && t < first.at)) return;
        first = {std::max(t, 0.0), site};
    };
    const auto consider = [&](Index e) {
        const Point q = sites.begin(e);
        if (along == none || !sites.belongs(e, along)) {
            const double t = way.meets_line(radius, sites.normal(e), q);
            if (std::isfinite(t) && sites.height(e, way.at(t)) > 0 && sites.is_beside(e, way.at(t), margin))
                offer(t, e);
        }
        if (sites.turn_at(e) != Turn::around || (along != none && sites.ends(q, along))) return;
        const double t = way.meets_point(radius, q);
        if (std::isfinite(t) && sites.is_in_cone(e, way.at(t), margin)) offer(t, sites.size() + e);
    };
    const Point center = way.at(0.5 * end);
    const double reach = (radius + 0.5 * way.length(end)) * (1 + tolerance::widening) + margin;
    sites.tree.visit_disc(center, reach, EitherSide{}, [&](Index e) { return consider(e), true; });
    return first;
}

}  // namespace cspace::navigation::voronoi
