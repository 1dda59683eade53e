// A navigation function of a star or sphere world, and the way down it: V falls at every step, and no step
// touches a wall.
#pragma once

#include <memory>
#include <optional>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/single_minimum.hpp"
#include "cspace/navigation/fields/star_world.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

class NavigationFunction {
  public:
    struct Limits {
        std::int64_t squares = 400'000, steps = 20'000;
    };
    // kappa: zero for the least power of two that is proven to leave a single minimum.
    NavigationFunction(SphereWorld discs, std::optional<StarWorld> stars, Point goal, double kappa,
                       Limits limits)
        : discs_(std::move(discs)), stars_(std::move(stars)), limits_(limits), goal_(goal) {
        const Point to = to_model(goal);
        if (discs_.clearance(to) > tolerance::widening * discs_.room.radius) {
            if (kappa > 0)
                tuned_ = {kappa, MinimumProof(SpherePotential(discs_, to, kappa)).run(limits.squares)};
            else
                tuned_ = tune_kappa(discs_, to, limits.squares);
        }
        potential_ = std::make_unique<SpherePotential>(discs_, to, std::max(tuned_.kappa, 1.0));
    }

    // Zero where the goal touches a wall, or no kappa was proven.
    double kappa() const { return tuned_.kappa; }
    const SingleMinimum& proof() const { return tuned_.proof; }
    bool is_proven() const { return tuned_.proof.verdict == SingleMinimum::proven; }
    const SphereWorld& discs() const { return discs_; }
    Point goal() const { return goal_; }
    Point to_model(Point p) const { return stars_ ? stars_->to_model(p) : p; }
    Point from_model(Point p) const { return stars_ ? stars_->from_model(p) : p; }

    // V at a point of free space: −∞ at the goal, +∞ on walls.
    double log_odds(Point p) const {
        const Point q = to_model(p);
        if (q == potential_->goal()) return -std::numeric_limits<double>::infinity();
        if (!(discs_.clearance(q) > 0)) return std::numeric_limits<double>::infinity();
        return potential_->value(q);
    }
    double phi(double v) const { return potential_->phi(v); }

    DescentRoute descend(Point start) const {
        DescentRoute made;
        const Point from = to_model(start);
        Point at = off_walls(from);
        made.route.path = {start};
        made.values = {log_odds(start)};
        if (!(at == from)) note(made, from_model(at), potential_->value(at));
        InterruptPoll poll(16);
        for (; made.route.stats.nodes < limits_.steps; ++made.route.stats.nodes) {
            poll.step();
            const double left = distance(at, potential_->goal());
            if (left <= at_goal * discs_.clearance(potential_->goal()) &&
                is_open(made.route.path.back(), goal_)) {
                note(made, goal_, -std::numeric_limits<double>::infinity());
                made.route.status = Status::found;
                break;
            }
            if (!step(at, made)) break;
        }
        if (made.route.status != Status::found) made.route.status = Status::undetermined;
        made.route.length = length_of(made.route.path);
        return made;
    }

  private:
    static constexpr double at_goal = 1e-4;     // of the goal's clearance: from here it goes straight
    static constexpr double off_wall = 1e-7;    // of the room: on a wall the slope is not defined
    static constexpr double valley = 2e-3;      // of the room: shorter steps along the slope take too many
    static constexpr double resting = 1e-6;     // of what is near: Newton's step has come to a saddle
    static constexpr double flat = 1e-12;       // of the stiffness: a curvature that is only rounding
    static constexpr double off_saddle = 1e-3;  // of the clearance: where the slope is felt again
    SphereWorld discs_;
    std::optional<StarWorld> stars_;
    Limits limits_;
    Point goal_;
    Tuned tuned_;
    std::unique_ptr<SpherePotential> potential_;

    static void note(DescentRoute& made, Point p, double value) {
        made.route.path.push_back(p);
        made.values.push_back(value);
    }
    bool is_open(Point p, Point q) const {
        if (stars_) return stars_->is_open(p, q);
        for (const Disc& disc : discs_.obstacles)
            if (distance(disc.center, nearest_on(p, q, disc.center)) <= disc.radius) return false;
        return true;  // the room is convex
    }
    // A point on a wall, moved a little along the ray from the centre of its disc.
    Point off_walls(Point p) const {
        const double room = discs_.room.radius, least = off_wall * room;
        const auto at_radius = [&](const Disc& disc, double radius) {
            return disc.center + (radius / distance(p, disc.center)) * (p - disc.center);
        };
        if (room - distance(p, discs_.room.center) < least) return at_radius(discs_.room, room - least);
        for (const Disc& disc : discs_.obstacles)
            if (distance(p, disc.center) - disc.radius < least) return at_radius(disc, disc.radius + least);
        return p;
    }
    bool step(Point& at, DescentRoute& made) const {
        const Point slope = potential_->slope(at);
        const double steep = norm(slope),
                     near = std::min(discs_.clearance(at), distance(at, potential_->goal()));
        const double length = std::min(0.25 * steep / potential_->stiffness(at), 0.05 * discs_.room.radius);
        if (length < valley * discs_.room.radius) {
            const Point down = across_valley(at, slope);
            const double far = norm(down);
            if (far < resting * near) return leave_saddle(at, made);
            const double most = std::min(0.3 * near, 0.02 * discs_.room.radius);
            if (go(at, (1 / far) * down, std::min(far, most), made)) return true;
        }
        const Point ahead = at - (0.5 * length / steep) * slope;
        Point turned = slope;
        if (discs_.clearance(ahead) > 0) turned = potential_->slope(ahead);
        return go(at, (-1 / norm(turned)) * turned, length, made) ||
               go(at, (-1 / steep) * slope, length, made) || leave_saddle(at, made);
    }
    // In narrow valleys, where steps along the slope would be short: Newton's step with the sizes of
    // curvatures, which leads down along every axis (Dauphin et al. 2014).
    Point across_valley(Point at, Point slope) const {
        const Curvature bend = potential_->curvature(at);
        const Point u = bend.down(), v{-u.y, u.x};
        const double least = flat * potential_->stiffness(at);
        const double along = -dot(slope, u) / std::max(std::abs(bend.along(u)), least);
        const double across = -dot(slope, v) / std::max(std::abs(bend.along(v)), least);
        return along * u + across * v;
    }
    // Where V is flat: to the side on which it falls, that of the goal where it falls on both.
    bool leave_saddle(Point& at, DescentRoute& made) const {
        Point down = potential_->curvature(at).down();
        if (dot(down, potential_->goal() - at) < 0) down = -1.0 * down;
        const double length = off_saddle * discs_.clearance(at);
        ++made.saddles;
        return go(at, down, length, made) || go(at, -1.0 * down, length, made);
    }
    // As far along a direction, or half of that, …, as V falls and no wall is touched.
    bool go(Point& at, Point direction, double length, DescentRoute& made) const {
        const double here = potential_->value(at);
        for (int halvings = 0; halvings < 40; ++halvings, length *= 0.5) {
            ++made.route.stats.edges;
            const Point to = at + length * direction;
            if (!(discs_.clearance(to) > 0)) continue;
            const double value = potential_->value(to);
            const Point p = from_model(to);
            if (!(value < here) || !is_open(made.route.path.back(), p)) continue;
            note(made, p, value);
            at = to;
            return true;
        }
        return false;
    }
};

}  // namespace cspace::navigation
