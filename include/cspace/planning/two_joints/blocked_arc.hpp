// The directions in which a segment from a given point touches a convex piece: one arc, shorter than half a
// turn, because the part of the piece within reach is convex.
//
// Each end of the arc is the extreme of three kinds of contact (Lozano-Pérez 1983, "Spatial planning: a
// configuration space approach", for polygons): the side of the link on a corner, the tip of the link on a
// corner, the tip on a side. A corner with a radius is round.
#pragma once

#include <cmath>
#include <cstdint>

#include "cspace/math/wrapping.hpp"
#include "cspace/planning/two_joints/piece.hpp"

namespace cspace::planning::two_joints {

enum class Contact : std::uint8_t { side_on_corner, tip_on_corner, tip_on_side };

// Where the link touches: the name of the corner or of the side.
struct Feature {
    Contact contact = Contact::side_on_corner;
    std::int32_t name = no_name;
    static constexpr std::int32_t no_name = -1;  // for a bound of several contacts
    friend constexpr bool operator==(const Feature&, const Feature&) = default;
};

struct ArcEnd {
    Point toward;  // of any length
    Feature feature;
};

// Directions from clockwise to counterclockwise; none where the piece is out of reach.
struct BlockedArc {
    bool is_empty = true;
    ArcEnd clockwise, counterclockwise;
};

namespace detail {

// How far beyond the end of a side, relative to the link, a contact may lie by rounding.
inline constexpr double beyond_end = 1e-12;

constexpr Point turned_left(Point p) { return {-p.y, p.x}; }

// A tangent from the start of the segment to the piece, on one side: side = 1 counterclockwise.
struct Tangent {
    Point toward;
    double squared_length = 0;
    std::size_t corner = 0;
};
inline Tangent find_tangent(const Piece& piece, Point start, double side) {
    const double r = piece.radius;
    Tangent best;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Point w = piece.corners[i] - start;
        const double squared = std::max(squared_norm(w) - r * r, 0.0);
        const Point toward = r > 0 ? std::sqrt(squared) * w + side * r * turned_left(w) : w;
        const double past = side * cross(best.toward, toward);
        if (i == 0 || past > 0 || (past == 0 && squared < best.squared_length)) best = {toward, squared, i};
    }
    return best;
}

// Collects where the circle of the tip meets the border of a piece, and keeps the extreme one on each side.
class TipContacts {
  public:
    TipContacts(const Piece& piece, Point start, double length)
        : piece_(piece), start_(start), length_(length), slack_(beyond_end * length) {
        for (std::size_t i = 0; i < piece.size(); ++i) {
            if (piece.has_sides()) meet_side(i);
            if (piece.radius > 0) meet_corner(i);
        }
    }
    bool found = false;
    ArcEnd clockwise, counterclockwise;

  private:
    const Piece& piece_;
    const Point start_;
    const double length_, slack_;

    void meet_side(std::size_t i) {
        const Point n = piece_.normals[i], u = piece_.direction(i), w = piece_.corners[i] - start_;
        const double away = dot(n, w) + piece_.radius;
        const double squared = length_ * length_ - away * away;
        if (squared < 0) return;
        const double half = std::sqrt(squared), begin = dot(w, u);
        for (const double along : {-half, half})
            if (along >= begin - slack_ && along <= begin + piece_.lengths[i] + slack_)
                add(away * n + along * u, {Contact::tip_on_side, piece_.side_names[i]});
    }
    void meet_corner(std::size_t i) {
        const Point w = piece_.corners[i] - start_;
        const double squared = squared_norm(w), d = std::sqrt(squared), l = length_, r = piece_.radius;
        // The foot of the common chord lies beyond the corner by this part of the way to it; differences of
        // lengths, not of squares, because the radius may be tiny.
        const double beyond = ((l - d) * (l + d) - r * r) / (2 * squared);
        const double chord = (r + (l - d)) * (r - (l - d)) * (l + d + r) * (l + d - r);
        if (!(chord >= 0)) return;
        const double half = std::sqrt(chord) / (2 * squared);
        for (const double along : {-half, half}) {
            const Point away = beyond * w + along * turned_left(w);
            if (is_round(i, away)) add(w + away, {Contact::tip_on_corner, piece_.corner_names[i]});
        }
    }
    // Whether a direction lies between the normals of the sides that meet in a corner.
    bool is_round(std::size_t i, Point away) const {
        return !piece_.has_sides() || (cross(piece_.normals[piece_.previous(i)], away) >= -slack_ &&
                                       cross(away, piece_.normals[i]) >= -slack_);
    }
    void add(Point tip, Feature feature) {
        if (!found || cross(tip, clockwise.toward) > 0) clockwise = {tip, feature};
        if (!found || cross(counterclockwise.toward, tip) > 0) counterclockwise = {tip, feature};
        found = true;
    }
};

}  // namespace detail

// Of a segment of a length from a start outside the piece.
inline BlockedArc find_blocked_arc(const Piece& piece, Point start, double length) {
    const double reach = length + piece.radius + piece.extent;
    if (squared_norm(piece.center - start) > reach * reach) return {};
    const detail::Tangent low = detail::find_tangent(piece, start, -1),
                          high = detail::find_tangent(piece, start, 1);
    const auto on_corner = [&](const detail::Tangent& t) {
        return ArcEnd{t.toward, {Contact::side_on_corner, piece.corner_names[t.corner]}};
    };
    const bool low_is_near = low.squared_length <= length * length;
    const bool high_is_near = high.squared_length <= length * length;
    if (low_is_near && high_is_near) return {false, on_corner(low), on_corner(high)};
    const detail::TipContacts tip(piece, start, length);
    if (!tip.found) {  // out of reach; where a tangent is not, rounding has hidden the contacts of the tip
        if (!low_is_near && !high_is_near) return {};
        return {false, on_corner(low), on_corner(high)};
    }
    return {false, low_is_near ? on_corner(low) : tip.clockwise,
            high_is_near ? on_corner(high) : tip.counterclockwise};
}

// The angles of an arc: where it begins, and how wide it is.
struct Angles {
    double begin = 0, width = 0;
    double end() const { return begin + width; }
};
inline Angles angles_of(const BlockedArc& arc) {
    const Point from = arc.clockwise.toward, to = arc.counterclockwise.toward;
    return {std::atan2(from.y, from.x), std::atan2(std::max(cross(from, to), 0.0), dot(from, to))};
}

}  // namespace cspace::planning::two_joints
