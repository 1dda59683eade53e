// The angles of joint 1 at which the arc that a piece blocks appears, changes the kind or the place of a
// contact, or has an end that turns back. Between two of them each end of the arc is monotonic.
//
// All are closed forms. With the arm rigid in joint 2 and turned about the base, a contact is extreme where
// its point lies on the perpendicular of the link through the base (side on corner), or in line with base and
// tip (tip on corner or on side).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cspace/planning/two_joints/space.hpp"

namespace cspace::planning::two_joints {

// Angles of joint 1 in the plane, less than 2π apart or all.
struct AngleRange {
    double low, high;
};

// Half the width [rad] of the range around a critical angle: far above the rounding of the angle itself, far
// below what a picture or a robot resolves.
inline constexpr double critical_margin = 1e-10;

namespace detail {

// Rounding of a cosine or a sine that is a quotient of sums of squares, relative to the sum of their sizes.
inline constexpr double quotient_rounding = 1e-14;

class CriticalAngles {
  public:
    CriticalAngles(const Arm& arm, const Piece& piece) : arm_(arm), piece_(piece) {
        if (arm.length_1 == 0 || arm.length_2 == 0) return;  // arcs do not change along joint 1
        for (std::size_t i = 0; i < piece.size(); ++i) {
            meet_corner(i);
            turn_back_at_corner(i);
            if (piece.has_sides()) meet_side(i), turn_back_at_side(i);
        }
    }
    std::vector<AngleRange> found;

  private:
    const Arm& arm_;
    const Piece& piece_;

    // The elbow where a corner or a side comes into reach of the tip, or of the elbow itself, and where the
    // kind of a contact changes.
    void meet_corner(std::size_t i) {
        const double r = piece_.radius, length = arm_.length_2;
        const Point corner = piece_.corners[i];
        meet_circle(corner, length + r);
        if (r == 0) return;
        meet_circle(corner, r);
        meet_circle(corner, std::hypot(length, r));
        if (!piece_.has_sides()) return;
        for (const std::size_t side : {i, piece_.previous(i)})
            meet_circle(corner + r * piece_.normals[side], length);
    }
    void meet_side(std::size_t i) {
        const Point n = piece_.normals[i];
        const double offset = dot(n, piece_.corners[i]) + piece_.radius;
        meet_line(n, offset);
        meet_line(n, offset + arm_.length_2);
    }
    void turn_back_at_corner(std::size_t i) {
        const double r = piece_.radius, away = norm(piece_.corners[i]),
                     bearing = bearing_of(piece_.corners[i]);
        for (const double side : {-1.0, 1.0}) {
            turn_back_side(bearing - side * pi / 2, r - side * away);
            if (r > 0) turn_back_side(bearing - side * pi / 2, -r - side * away);
        }
        turn_back_tip(bearing, away + r);
        if (r > 0) turn_back_tip(away > r ? bearing : bearing + pi, std::abs(away - r));
    }
    void turn_back_at_side(std::size_t i) {
        const Point n = piece_.normals[i];
        const double offset = dot(n, piece_.corners[i]) + piece_.radius;
        const double foot = -dot(piece_.corners[i], piece_.direction(i));  // of the base, along the side
        const double slack = critical_margin * (arm_.length_1 + arm_.length_2);
        if (foot < -slack || foot > piece_.lengths[i] + slack) return;
        turn_back_tip(offset > 0 ? bearing_of(n) : bearing_of(n) + pi, std::abs(offset));
    }

    static double bearing_of(Point p) { return std::atan2(p.y, p.x); }
    void add(double low, double high) { found.push_back({low - critical_margin, high + critical_margin}); }
    void add_all() { found.push_back({0, turn}); }

    // The angles in [0, π] whose cosine is a quotient, up to its rounding; false if there are none.
    static bool find_arccosine(double part, double size, double whole, AngleRange& angles) {
        const double cosine = part / whole, error = quotient_rounding * (1 + size / whole);
        if (!(cosine - error <= 1) || !(cosine + error >= -1)) return false;
        angles = {std::acos(std::min(cosine + error, 1.0)), std::acos(std::max(cosine - error, -1.0))};
        return true;
    }
    // The elbow on a circle around a point.
    void meet_circle(Point center, double radius) {
        const double a = arm_.length_1, d = norm(center), bearing = bearing_of(center);
        if (d == 0) return;
        AngleRange angles;
        const double part = (a - radius) * (a + radius) + d * d;
        if (find_arccosine(part, a * a + d * d + radius * radius, 2 * a * d, angles))
            add_mirrored(bearing, angles);
    }
    // The elbow on a line.
    void meet_line(Point normal, double offset) {
        AngleRange angles;
        if (find_arccosine(offset, std::abs(offset), arm_.length_1, angles))
            add_mirrored(bearing_of(normal), angles);
    }
    void add_mirrored(double bearing, AngleRange angles) {
        add(bearing + angles.low, bearing + angles.high);
        add(bearing - angles.high, bearing - angles.low);
    }
    // Link 2 in a direction, the line through it at a distance from the base whose sine of joint 2 is a
    // quotient by link 1.
    void turn_back_side(double direction, double distance) {
        AngleRange beside;  // from π/2
        if (!find_arccosine(distance, std::abs(distance), arm_.length_1, beside)) return;
        add(direction - pi / 2 + beside.low, direction - pi / 2 + beside.high);
        add(direction - pi / 2 - beside.high, direction - pi / 2 - beside.low);
    }
    // The tip in a direction from the base, at a distance.
    void turn_back_tip(double direction, double distance) {
        const double a = arm_.length_1, b = arm_.length_2, squares = a * a + b * b;
        AngleRange bend;  // of joint 2
        if (!find_arccosine(distance * distance - squares, distance * distance + squares, 2 * a * b, bend))
            return;
        const auto tip_at = [&](double angle) { return Point{a + b * std::cos(angle), b * std::sin(angle)}; };
        const double nearest = std::min(norm(tip_at(bend.low)), norm(tip_at(bend.high)));
        const double change = bend.high - bend.low;
        if (!(change * b < nearest)) return add_all();
        const double at = bearing_of(tip_at(0.5 * (bend.low + bend.high))), off = change * b / nearest;
        for (const double side : {-1.0, 1.0}) add(direction - side * at - off, direction - side * at + off);
    }
};

}  // namespace detail

// Ranges of angles of joint 1 in the plane.
inline std::vector<AngleRange> find_critical_angles(const Arm& arm, const Piece& piece) {
    return detail::CriticalAngles(arm, piece).found;
}

}  // namespace cspace::planning::two_joints
