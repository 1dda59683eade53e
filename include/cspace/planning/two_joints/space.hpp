// The configuration space of a planar arm with two revolute joints among convex pieces.
//
// In a row of the space, at one angle of joint 1, each piece blocks one arc of directions of link 2; link 1
// blocks whole rows. Angles of joints are coordinates q; directions in the plane are q · sign + offset.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "cspace/math/wrapping.hpp"
#include "cspace/planning/two_joints/blocked_arc.hpp"

namespace cspace::planning::two_joints {

inline constexpr double turn = 2 * pi;
inline constexpr std::int32_t no_obstacle = -1;

struct Joint {
    double sign = 1, offset = 0;  // the angle in the plane is sign · q + offset
    double lower = -pi, upper = pi;
    bool wraps = true;  // lower and upper are the same place then, one turn apart

    double angle(double q) const { return sign * q + offset; }
    double coordinate(double angle) const { return sign * (angle - offset); }
    double width() const { return upper - lower; }
};

struct Arm {
    Point base;
    double length_1 = 1, length_2 = 1, radius = 0;
    Joint joint_1, joint_2;

    Point elbow(double q_1) const {
        const double angle = joint_1.angle(q_1);
        return base + length_1 * Point{std::cos(angle), std::sin(angle)};
    }
};

// An interval of a joint's coordinate, and what blocks it.
struct BlockedInterval {
    double low, high;
    std::int32_t piece;
    Feature at_low = {}, at_high = {};
};

class Space {
  public:
    Space(const Arm& arm, std::span<const Piece> obstacles) : arm_(arm) {
        const double reach = arm.length_1 + arm.length_2;
        for (const Piece& obstacle : obstacles) {
            const Piece piece = obstacle.moved(-1 * arm.base).grown(arm.radius);
            if (norm(piece.center) - piece.extent > piece.radius + reach) continue;
            if (contains_point(piece, {})) buried_in_ = std::int32_t(pieces_.size());
            pieces_.push_back(piece);
        }
        arm_.base = {};
        name_corners(pieces_);
        if (buried_in_ == no_obstacle) find_link_1();
    }

    const Arm& arm() const { return arm_; }
    // What may touch the arm: each grown by the radius of the links, the base at the origin.
    const std::vector<Piece>& pieces() const { return pieces_; }
    std::int32_t obstacle_of(std::int32_t piece) const {
        return piece < 0 ? no_obstacle : pieces_[std::size_t(piece)].obstacle;
    }
    // The piece that covers the base, or none: then nothing is free.
    std::int32_t buried_in() const { return buried_in_; }
    // What link 1 touches, within one turn of joint 1 from each low end.
    const std::vector<BlockedInterval>& link_1() const { return link_1_; }

    // A piece that link 1 touches, or none.
    std::int32_t blocks_link_1(double q_1) const {
        if (buried_in_ != no_obstacle) return buried_in_;
        for (const BlockedInterval& blocked : link_1_) {
            const double middle = 0.5 * (blocked.low + blocked.high);
            if (std::abs(short_way(q_1 - middle)) <= 0.5 * (blocked.high - blocked.low)) return blocked.piece;
        }
        return no_obstacle;
    }
    // Calls visit(interval of q₂) for every piece that link 2 touches in a row that link 1 leaves free. Each
    // is narrower than a turn, and stands for all that are multiples of a turn away.
    template <class Visit>
    void visit_link_2(double q_1, const Visit& visit) const {
        if (arm_.length_2 == 0) return;  // the elbow is a part of link 1
        const Point elbow = arm_.elbow(q_1);
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            const BlockedArc arc = find_blocked_arc(pieces_[k], elbow, arm_.length_2);
            if (!arc.is_empty) visit(interval_of_link_2(arc, q_1, std::int32_t(k)));
        }
    }
    // An arc of directions of link 2 as coordinates of joint 2.
    BlockedInterval interval_of_link_2(const BlockedArc& arc, double q_1, std::int32_t piece) const {
        return interval_of(arc, arm_.joint_2, arm_.joint_1.angle(q_1), piece);
    }
    // A piece that the arm touches, or none.
    std::int32_t blocks(double q_1, double q_2) const {
        std::int32_t found = blocks_link_1(q_1);
        if (found != no_obstacle) return found;
        visit_link_2(q_1, [&](const BlockedInterval& blocked) {
            if (wrap_above(q_2, blocked.low) <= blocked.high) found = blocked.piece;
        });
        return found;
    }

  private:
    Arm arm_;
    std::vector<Piece> pieces_;
    std::vector<BlockedInterval> link_1_;
    std::int32_t buried_in_ = no_obstacle;

    void find_link_1() {
        if (arm_.length_1 == 0) return;  // the elbow is the base
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            const BlockedArc arc = find_blocked_arc(pieces_[k], arm_.base, arm_.length_1);
            if (!arc.is_empty) link_1_.push_back(interval_of(arc, arm_.joint_1, 0, std::int32_t(k)));
        }
    }
    static BlockedInterval interval_of(const BlockedArc& arc, const Joint& joint, double before,
                                       std::int32_t piece) {
        const Angles angles = angles_of(arc);
        if (joint.sign > 0) {
            const double low = joint.coordinate(angles.begin - before);
            return {low, low + angles.width, piece, arc.clockwise.feature, arc.counterclockwise.feature};
        }
        const double high = joint.coordinate(angles.begin - before);
        return {high - angles.width, high, piece, arc.counterclockwise.feature, arc.clockwise.feature};
    }
};

}  // namespace cspace::planning::two_joints
