// A point robot that glides between walls by how far they are: the clearance sensor of a polygon world.
//
// All that it reacts to lies on the edge of a disc around it that is free of walls, so it is in view, and no
// farther than its range.
#pragma once

#include "cspace/navigation/bugs/clearance_sensor.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/voronoi/feet.hpp"
#include "cspace/navigation/voronoi/rolling.hpp"

namespace cspace::navigation {

class ClearanceRobot : public RangeRobot {
  public:
    using Index = voronoi::Index;
    // It keeps a little less than its range from walls, so as not to lose them; no round part of it, so that
    // in worlds of round numbers no gap is twice that wide.
    static constexpr double kept_share = 0.99658;
    static constexpr double beside =
        1e-11;  // so near to a wall, in sizes of the world, rounding hides the side
    // How it tells places apart, the length in sizes of the world: ten times and more what the curves lose.
    static constexpr Likeness like{1e-6, 1e-9, 1e-5, 1e-9, 2};
    static constexpr int most_steps = 10'000;  // along one curve
    static constexpr double folded = 1e-6;     // sum of two normals that point against each other
    static constexpr double at_range = 1e-12;  // of how far it keeps: what rounding makes of reaching it
    static constexpr double touches2 = 1e-9;   // of a square: a curve that touches the goal's circle meets it
    static constexpr double on_mark = 1e-7;    // of how far it keeps: it has come by its mark

    ClearanceRobot(const Walls& walls, const voronoi::Sites& sites, Point start, double range,
                   voronoi::Grain grain)
        : RangeRobot(walls, start, range),
          s_(sites),
          grain_(voronoi::grain_in(sites, grain)),
          contacts_(sites, grain_),
          keeps_(kept_share * range) {}

    Likeness likeness() const { return {like.share, like.fine * s_.extent, like.turn, like.far, like.loop}; }
    bool again() { return false; }
    double keeps() const { return keeps_; }
    double clearance() const { return radius_; }
    const std::vector<Foot>& feet() const { return feet_; }

    Halt begin(Log& log) {
        if (s_.size() == 0) return Halt::open;
        const Point from = local(at_);
        voronoi::Retraction up;
        if (!place_.is_open()) {
            if (is_tapered(place_)) return begin_in_corner(log);
            up = away_from_wall(from);
        } else {
            const voronoi::Nearest near = voronoi::nearest_site(s_, from);
            if (near.site == voronoi::none) return Halt::lost;
            if (near.distance > keeps_) return Halt::open;
            const Index wall = near.distance <= beside * s_.extent ? wall_behind() : voronoi::none;
            up = wall == voronoi::none ? voronoi::retract_point(s_, from) : away_from(wall, from);
        }
        const bool is_far = up.b == voronoi::none || up.radius >= keeps_ * (1 - tolerance::widening);
        if (is_far && !std::isfinite(keeps_)) return Halt::lost;
        const Point away = (1 / distance(up.foot, up.at)) * (up.at - up.foot);
        const Point to = is_far ? up.foot + keeps_ * away : up.at;
        const Point target = to + s_.origin;
        if (!advance({at_, target}, log.path)) return Halt::lost;
        log.note(target);
        place_ = {};
        radius_ = is_far ? keeps_ : up.radius;
        feet_ =
            is_far ? std::vector<Foot>{contacts_.contact(up.a, to)} : contacts_.everywhere(to, up.a, up.b);
        return finish(is_far ? Halt::limit : Halt::meet, log);
    }

    template <class Look>
    Halt trace(Foot right, Foot left, const Aim& aim, Log& log, Look look) {
        Index a = right.site, b = left.site;
        pass(a, log);
        pass(b, log);
        for (Index joints = 0; joints <= 2 * s_.size() + 8; ++joints) {
            Halt cause{};
            const voronoi::ArcPiece arc = next_arc(a, b, aim, cause);
            if (arc.cause == voronoi::ArcEnd::corner) return end_in_corner(arc, a, log, look);
            if (slide(arc.curve, arc.begin, arc.end, log, look)) return Halt::told;
            if (arc.cause == voronoi::ArcEnd::lost) return Halt::lost;
            Point p = arc.curve.at(arc.end);
            if (arc.cause == voronoi::ArcEnd::vertex) {
                feet_ = contacts_.around(p, a, b, arc.third);
                return arrive(p, Halt::meet, log);
            }
            if (arc.cause == voronoi::ArcEnd::bound) {
                feet_ = {contacts_.contact(a, p), contacts_.contact(b, p)};
                return arrive(p, cause, log);
            }
            if (arc.turns_a) pass(a = site_after(s_, a), log);
            if (arc.turns_b) pass(b = site_before(s_, b), log);
            if (a == b) return Halt::lost;
        }
        return Halt::lost;
    }

    template <class Look>
    Halt roll(Foot foot, const Aim& aim, Log& log, Look look) {
        Index a = foot.site;
        pass(a, log);
        double rolled = 0;
        for (Index joints = 0; joints <= 2 * s_.size() + 8; ++joints) {
            const Point p = local(at_), away = -1.0 * s_.towards(a, p);
            std::optional<Halt> end;
            if (s_.is_edge(a)) {
                const double left = s_.length[std::size_t(a)] - s_.advance(a, p);
                const Point on = p + (keeps_ - s_.height(a, p)) * away;
                end = roll_along(voronoi::StraightWay{on, s_.direction(a)}, a, std::max(left, 0.0), aim, log,
                                 look, rolled);
            } else {
                const Index e = s_.edge_of(a);
                double turn = voronoi::turn_from(s_.normal(e), away);
                if (turn > 1.5 * std::numbers::pi) turn = 0;
                end =
                    roll_along(voronoi::RoundWay{s_.begin(e), away, keeps_}, a, turn, aim, log, look, rolled);
            }
            if (end) return *end;
            if (corner_after(s_, a) != voronoi::none) {
                feet_ = contacts_.ahead(local(at_), a, corner_after(s_, a));
                return finish(Halt::meet, log);
            }
            pass(a = site_after(s_, a), log);
        }
        return Halt::lost;
    }

    Halt fly(const Aim& aim, Log& log) {
        const Point from = local(at_), to = local(aim.goal);
        const double far = distance(from, to), end = std::max(far - keeps_, 0.0);
        if (!(far > 0)) return Halt::goal;
        const voronoi::StraightWay way{from, (1 / far) * (to - from)};
        const voronoi::FirstMeeting met = voronoi::first_meeting(s_, grain_, way, keeps_, voronoi::none, end);
        move_to(way.at(met.at));
        log.note(at_);
        if (met.site == voronoi::none) return Halt::goal;
        radius_ = keeps_;
        feet_ = {contacts_.contact(met.site, way.at(met.at))};
        return finish(Halt::limit, log);
    }

  private:
    const voronoi::Sites& s_;
    voronoi::Grain grain_;
    voronoi::Contacts contacts_;
    double keeps_, radius_ = 0;
    std::vector<Foot> feet_;

    Point local(Point p) const { return p - s_.origin; }
    void move_to(Point p) { stand_at(p + s_.origin); }
    Halt arrive(Point p, Halt cause, Log& log) {
        move_to(p);
        if (!log.path.empty()) log.path.back() = at_;  // as polished
        radius_ = s_.distance_to(feet_[0].site, p);
        return finish(cause, log);
    }
    Halt finish(Halt cause, Log& log) {
        log.least = std::min(log.least, radius_);
        for (const Foot& foot : feet_) pass_ends(foot.site, log);
        return cause;
    }

    Touch corner_at(Index e) const {
        return {walls_->begin(e), walls_->wall(s_.previous(e)), walls_->wall(e)};
    }
    // Notes the corner under a foot.
    void pass(Index site, Log& log) const {
        pass_ends(site, log);
        if (s_.is_edge(site) && s_.turn_at(site) == voronoi::Turn::straight)
            log.corners.push_back(corner_at(site));
    }
    void pass_ends(Index site, Log& log) const {
        if (!s_.is_edge(site)) return log.corners.push_back(corner_at(s_.edge_of(site)));
        const double along = s_.advance(site, local(at_)), near = 1e3 * grain_.at(radius_);
        if (along <= near) log.corners.push_back(corner_at(site));
        if (along >= s_.length[std::size_t(site)] - near) log.corners.push_back(corner_at(s_.after(site)));
    }

    bool is_tapered(const Place& place) const {
        return place.is_corner() && s_.turn_at(place.out) == voronoi::Turn::corner;
    }
    Halt begin_in_corner(Log& log) {
        const Point p = local(at_);
        radius_ = 0;
        feet_ = {contacts_.contact(place_.out, p), contacts_.contact(place_.in, p)};
        log.corners.push_back(corner_at(place_.out));
        return Halt::corner;
    }
    // The wall that a robot is in front of that stands as near to it as rounding; none if it is not sure.
    Index wall_behind() const {
        Index nearest = voronoi::none;
        double least = beside * s_.extent;
        walls_->at(at_, [&](int e) {
            const double off = std::abs(s_.height(e, local(at_)));
            if (!(off <= least) || !s_.is_beside(e, local(at_), 0)) return;
            if (orientation(walls_->begin(e), walls_->end(e), at_) <= 0) return;
            least = off;
            nearest = e;
        });
        return nearest;
    }
    voronoi::Retraction away_from(Index wall, Point from) const {
        return voronoi::retract_along(s_, wall, from, s_.normal(wall), s_.rounding());
    }
    // From a place on a wall straight into free space.
    voronoi::Retraction away_from_wall(Point from) const {
        const Index e = place_.out;
        if (!place_.is_corner() || s_.turn_at(e) != voronoi::Turn::around) return away_from(e, from);
        const Point both = s_.normal(e) + s_.normal(place_.in);
        const Point away = norm(both) > folded ? (1 / norm(both)) * both : s_.direction(place_.in);
        return voronoi::retract_along(s_, s_.size() + e, from, away, s_.rounding());
    }

    // The arc of two sites from here on, up to where the robot ends it: at the limit or at the goal.
    voronoi::ArcPiece next_arc(Index a, Index b, const Aim& aim, Halt& cause) const {
        return voronoi::next_piece(s_, grain_, a, b, local(at_), [&](const voronoi::ArcPiece& arc) {
            const double limit = reaches_limit(arc);
            cause = Halt::limit;
            if (!aim.stops) return limit;
            const double goal = comes_to(arc, local(aim.goal));
            if (goal < limit) cause = Halt::goal;
            return std::min(limit, goal);
        });
    }

    double reaches_limit(const voronoi::ArcPiece& arc) const {
        const double far = std::numeric_limits<double>::infinity();
        if (!std::isfinite(keeps_)) return far;
        voronoi::Quadratic over = arc.curve.radius_form;
        over.c0 -= arc.curve.is_squared ? keeps_ * keeps_ : keeps_;
        const double tiny = at_range * (arc.curve.is_squared ? keeps_ * keeps_ : keeps_);
        if (over.at(arc.begin) >= -tiny && over.slope(arc.begin) * keeps_ >= -tiny) return arc.begin;
        double first = far;
        for (const double t : over.zeros())
            if (t > arc.begin && t < first && over.slope(t) > 0) first = t;
        return first;
    }
    // Where a point is no farther than the walls.
    static double comes_to(const voronoi::ArcPiece& arc, Point goal) {
        const voronoi::Quadratic gap = arc.curve.against_point(goal);
        double first = std::numeric_limits<double>::infinity();
        const double touching = -gap.c1 / (2 * gap.c2);  // of a goal on a wall, rounding hides the zeros
        if (touching >= arc.begin &&
            gap.at(touching) <= touches2 * squared_norm(arc.curve.at(touching) - goal))
            first = touching;
        for (const double t : gap.zeros())
            if (t >= arc.begin && t < first && distance(arc.curve.at(t), goal) <= 2 * arc.curve.radius(t))
                first = t;
        return first;
    }

    // Up to where the corner is in view.
    template <class Look>
    Halt end_in_corner(const voronoi::ArcPiece& arc, Index a, Log& log, Look look) {
        const Index corner = s_.after(a);
        const double far = distance(local(at_), s_.begin(corner));
        log.corners.push_back(corner_at(corner));
        if (far > keeps_) {
            const double stop = arc.curve.parameter(s_.begin(corner)) - keeps_;
            if (slide(arc.curve, arc.begin, std::max(stop, arc.begin), log, look)) return Halt::told;
        }
        feet_ = {contacts_.contact(a, local(at_)), contacts_.contact(corner, local(at_))};
        return Halt::corner;
    }

    // Moves along an arc. A chord stays in the free disc around its one end.
    template <class Look>
    bool slide(const voronoi::Bisector& curve, double t0, double t1, Log& log, Look look) {
        const bool bends = norm(curve.p2) > 0;
        const double least = curve.least_radius(t0, t1);
        log.least = std::min(log.least, least);
        for (double t = t0; t < t1;) {
            const double r = std::max(curve.radius(t), like.fine * s_.extent);
            double step = 0.25 * r / norm(curve.velocity(t));
            step = std::max(step, (t1 - t0) / (bends ? most_steps : 32));
            t = t + step < t1 ? t + step : t1;
            move_to(curve.at(t));
            if (bends || t == t1) log.note(at_);
            radius_ = curve.radius(t);
            if (!look()) continue;
            log.note(at_);
            return true;
        }
        return false;
    }

    // Nothing where the foot comes to the end of its site.
    template <class Way, class Look>
    std::optional<Halt> roll_along(const Way& way, Index a, double end, const Aim& aim, Log& log, Look look,
                                   double& rolled) {
        radius_ = keeps_;
        log.least = std::min(log.least, keeps_);
        const voronoi::FirstMeeting met = voronoi::first_meeting(s_, grain_, way, keeps_, a, end);
        const Point goal = local(aim.goal);
        double stop = met.at;
        Halt cause = met.site == voronoi::none ? Halt::told : Halt::meet;
        const auto offer = [&](double t, Halt reason) {
            if (t >= 0 && t < stop) stop = t, cause = reason;
        };
        if (const double t = way.meets_point(0.5 * (keeps_ + range()), goal); aim.stops && std::isfinite(t))
            offer(t, Halt::goal);
        if (aim.mark) {
            const double t = way.nearest(local(*aim.mark)), off = on_mark * keeps_ + like.fine * s_.extent;
            const bool is_before = met.site == voronoi::none || way.length(met.at - t) > 2 * off;
            if (is_before && rolled + way.length(t) > 2 * off && way.length(t) > -off &&
                distance(way.at(t), local(*aim.mark)) < off)
                offer(std::max(t, 0.0), Halt::mark);
        }
        const double near = grain_.at(keeps_), nearest = way.nearest(goal),
                     low = std::clamp(nearest, 0.0, stop);
        const Point there = way.at(low);
        const bool is_low =
            way.length(std::abs(nearest - low)) <= near && dot(goal - there, s_.towards(a, there)) < 0;
        const double far = distance(there, goal);
        if (is_low && far < aim.nearer) stop = low, cause = Halt::low;
        const int steps = std::clamp(int(std::ceil(way.length(stop) / (0.25 * keeps_))), 1, most_steps);
        bool low_noted = !is_low || cause == Halt::low;
        for (int i = 1; i <= steps; ++i) {
            const double t = i == steps ? stop : stop * i / steps;
            if (!low_noted && t >= low) {
                low_noted = true;
                if (!log.low || far < distance(local(log.path[*log.low]), goal)) {
                    log.low = log.path.size();
                    log.path.push_back(there + s_.origin);
                }
            }
            move_to(way.at(t));
            if (!s_.is_edge(a) || i == steps) log.note(at_);
            if (!look()) continue;
            log.note(at_);
            return Halt::told;
        }
        rolled += way.length(stop);
        if (cause == Halt::told) return {};
        const Point p = local(at_);
        feet_ = cause == Halt::meet ? contacts_.ahead(p, a, met.site)
                                    : std::vector<Foot>{contacts_.contact(a, p)};
        return finish(cause, log);
    }
};

}  // namespace cspace::navigation
