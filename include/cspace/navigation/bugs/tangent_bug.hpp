// Tangent Bug (Kamon, Rimon and Rivlin 1998, "TangentBug: a range-sensor-based navigation algorithm"):
// towards the goal, around what is in view by the nodes of the local tangent graph (where the view jumps);
// where all of them lie further from the goal, along the wall until a point comes into view that is nearer to
// the goal than all of the wall followed so far. Range 0 leaves touch alone.
//
// The robot senses where it stops: at nodes and at corners. A boundary loop that it has followed all around
// without leaving is judged as Bug 1 judges it, so the verdict does not depend on how far the sensor sees.
#pragma once

#include <optional>

#include "cspace/navigation/bugs/sensors.hpp"
#include "cspace/navigation/bugs/walk_log.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

namespace tangent_bug_limits {
constexpr double nearer = 1 - tolerance::widening;  // a distance counts as less by more than rounding
constexpr int most_stops = 100'000;  // a robot that sees a hand's breadth in a hall comes by with fewer
}  // namespace tangent_bug_limits

template <RangeSensor Robot>
class TangentBug {
  public:
    // hand: which stays on the wall; without one, that which turns the robot to the better node in view
    TangentBug(Robot& robot, Point goal, std::optional<Hand> hand)
        : walker_(robot),
          robot_(robot),
          goal_(goal),
          hand_(hand),
          slack_(rounding_of(std::max(std::abs(goal.x), std::abs(goal.y)))) {}

    WalkLog run() {
        double before = std::numeric_limits<double>::infinity();
        for (bool patient = false;;) {
            const Stage way = approach();
            if (way == Stage::arrived) return walker_.finish(Status::found);
            // Each wall is met nearer to the goal than the last; where rounding denies it, all around that
            // wall.
            const bool nearer = is_nearer(robot_.position(), before);
            if (way == Stage::tired || (patient && !nearer)) return walker_.finish(Status::undetermined);
            patient = !nearer;
            before = to_goal(robot_.position());
            const Stage end = follow(hand_ ? *hand_ : better_hand(), patient);
            if (end == Stage::arrived) return walker_.finish(Status::found);
            if (end == Stage::shut) return walker_.finish(Status::unreachable);
            if (seen_nearer_) go(*seen_nearer_);
        }
    }

  private:
    enum class Stage { arrived, stopped, left, shut, tired };

    Walker<Robot> walker_;
    Robot& robot_;
    Point goal_;
    std::optional<Hand> hand_;
    double slack_;  // what rounding does to a distance from the goal
    std::vector<Seen> seen_;
    std::optional<Point> seen_nearer_;  // what made it leave the wall that it followed
    std::vector<int> left_;             // corners that it left straight towards the goal
    int stops_ = 0;

    double to_goal(Point p) const { return distance(p, goal_); }
    bool is_nearer(Point p, double limit) const {
        return to_goal(p) < limit * tangent_bug_limits::nearer - slack_;
    }
    bool go(Point target) { return walker_.advance({robot_.position(), target}); }

    // Towards the goal until the robot arrives or touches a wall that it cannot get around in view.
    Stage approach() {
        using namespace tangent_bug_limits;
        for (;;) {
            if (++stops_ > most_stops) return Stage::tired;
            const Point here = robot_.position();
            const double far = to_goal(here), free = robot_.sees(goal_);
            if (far == 0) return Stage::arrived;
            if (free >= far || robot_.range() == 0) return go(goal_) ? Stage::arrived : Stage::stopped;
            if (free >= robot_.range()) {
                if (walker_.approach(goal_)) return Stage::arrived;
            } else {
                const std::optional<Point> node = best_node(far);
                if (!node) return go(goal_) ? Stage::arrived : Stage::stopped;
                go(*node);
            }
            if (!is_nearer(robot_.position(), far)) return go(goal_) ? Stage::arrived : Stage::stopped;
        }
    }

    // The node over which the way to the goal would be shortest, of those less far from the goal than a
    // limit.
    std::optional<Point> best_node(double limit) {
        const Point here = robot_.position();
        robot_.look(seen_);
        std::optional<Point> best;
        double shortest = std::numeric_limits<double>::infinity();
        for (const Seen& s : seen_) {
            const double way = distance(here, s.at) + to_goal(s.at);
            if (!s.is_edge || !is_nearer(s.at, limit) || way > shortest) continue;
            if (best && way == shortest && !is_left_of(s.at, *best)) continue;
            shortest = way;
            best = s.at;
        }
        return best;
    }

    // Of two ways of one length the left one is taken: which wall was named first is nothing a robot sees.
    bool is_left_of(Point p, Point other) const {
        return orientation(robot_.position(), goal_, p) > orientation(robot_.position(), goal_, other);
    }

    Hand better_hand() {
        const std::optional<Point> node = best_node(std::numeric_limits<double>::infinity());
        return node && orientation(robot_.position(), goal_, *node) < 0 ? Hand::left : Hand::right;
    }

    // Along the wall until something nearer to the goal comes into view than the wall so far, or all around.
    Stage follow(Hand hand, bool patient) {
        const Touch hit = robot_.touch();
        double nearest = to_goal(hit.at);
        seen_nearer_.reset();
        Round round(goal_, hit);
        const auto leaves_piece = [&](const Wall& piece, Point from, Point end) -> std::optional<Point> {
            const Point foot = nearest_on(from, end, goal_);
            if (!patient && leaves_from(piece, from, foot, nearest))
                return where_as_near(from, foot, nearest);
            nearest = std::min(nearest, to_goal(foot));
            return {};
        };
        const auto leaves = [&] { return !patient && leaves_corner(nearest); };
        switch (walker_.follow(hand, goal_, &round, leaves_piece, leaves)) {
            case FollowEnd::goal:
                return Stage::arrived;
            case FollowEnd::left:
                return Stage::left;
            case FollowEnd::whole:
                break;
        }
        if (round.shuts_off_goal()) {
            walker_.log.witness = round.blocked.touch;
            return Stage::shut;
        }
        walker_.go_to(round.free.touch, 2 * round.free.along <= round.length() ? hand : other_hand(hand));
        return Stage::left;
    }

    // Whether the goal lies in front of the piece and the robot comes nearer to it there than before.
    bool leaves_from(const Wall& piece, Point from, Point foot, double nearest) const {
        return foot != from && orientation(piece.begin, piece.end, goal_) > 0 &&
               !is_next_to(foot, piece.begin) && !is_next_to(foot, piece.end) && is_nearer(foot, nearest);
    }

    // The first point on the way to the foot that is as near to the goal as the wall so far.
    Point where_as_near(Point from, Point foot, double nearest) const {
        if (to_goal(from) <= nearest) return foot;
        const double height = to_goal(foot), before = std::sqrt(nearest * nearest - height * height);
        const Point p = foot + before / distance(from, foot) * tangent_bug_limits::nearer * (from - foot);
        return distance(p, from) <= slack_ || is_next_to(p, from) ? foot : p;
    }

    bool leaves_corner(double nearest) {
        using namespace tangent_bug_limits;
        const Touch corner = robot_.touch();
        const double far = to_goal(corner.at);
        if (far * nearer <= nearest && way_towards(corner, goal_) == Way::free &&
            std::find(left_.begin(), left_.end(), corner.out.name) == left_.end()) {
            left_.push_back(corner.out.name);
            return true;
        }
        if (robot_.range() == 0) return false;
        seen_nearer_ = nearest_in_view(nearest);
        return seen_nearer_.has_value();
    }

    // The point in view nearest to the goal, if it is nearer than a limit.
    std::optional<Point> nearest_in_view(double limit) {
        const Point here = robot_.position();
        std::optional<Point> best;
        const auto offer = [&](Point p) {
            if (!is_nearer(p, limit) || robot_.sees(p) < distance(here, p) * tangent_bug_limits::nearer)
                return;
            limit = to_goal(p);
            best = p;
        };
        const double far = to_goal(here), free = robot_.sees(goal_);
        if (free >= far) return goal_;
        offer(here + (free / far) * (goal_ - here));
        robot_.look(seen_);
        for (const Seen& s : seen_) {
            offer(s.at);
            const Point foot = nearest_on(s.wall.begin, s.wall.end, goal_);
            if (distance(here, foot) <= robot_.range()) offer(foot);
        }
        return best;
    }
};

template <RangeSensor Robot>
WalkLog tangent_bug(Robot& robot, Point goal, std::optional<Hand> hand = {}) {
    return from_every_side(robot, [&](Robot& r) { return TangentBug<Robot>(r, goal, hand).run(); });
}

}  // namespace cspace::navigation
