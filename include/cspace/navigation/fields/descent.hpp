// A robot that goes down a potential, step by step, until it arrives or rests; where it rests is named.
// Along walls it does not oscillate: each step uses the stiffness of the potential across.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/near_walls.hpp"
#include "cspace/navigation/fields/potential.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

// Directions in which free space begins at a point of its boundary.
//
// Where obstacles touch, free space has several sectors at one point, and the sum of their walls' normals may
// lead into an obstacle; so each triangle of free space at the point gives one direction that lies inside it.

// Between the directions to b and c.
inline Point bisecting_direction(Point a, Point b, Point c) {
    return distance(a, c) * (b - a) + distance(a, b) * (c - a);
}

// None where walls are farther away than the tolerance.
inline std::vector<Point> find_start_directions(const maps::FreeSpace& space, const maps::Settled& from,
                                                const NearWalls& walls, double tolerance) {
    std::vector<Point> found;
    const auto add = [&](Point direction) {
        if (squared_norm(direction) > 0) found.push_back(direction);
    };
    for (const maps::Index t : from.triangles) {
        const auto corner = [&](int i) { return space.mesh.point(space.mesh[t].corner[std::size_t(i)]); };
        const maps::Place place = space.mesh.place_in(t, from.at);
        const Point b = corner(maps::next_corner(place.index)),
                    c = corner(maps::previous_corner(place.index));
        if (place.kind == maps::Place::at_corner)
            add(bisecting_direction(from.at, b, c));
        else if (place.kind == maps::Place::on_edge && space.is_wall(t, place.index))
            add({b.y - c.y, c.x - b.x});
        else
            add(walls.inward(from.at, tolerance));
    }
    return found;
}

// The step down a slope that gives way least where the ground is stiff: −(λ I + H)⁻¹ g, of a given length.

// Gradient flow by the linearly implicit Euler rule with the time step 1 / λ: across a valley it goes to the
// bottom and no farther, along it as far as it may. λ is found by Newton's rule for 1 / |step| (Moré &
// Sorensen 1983, "Computing a trust region step"). Shorter than `longest` where the bottom is nearer.
inline Point damped_step(const Stiffness& h, Point slope, double longest) {
    const double mean = 0.5 * (h.xx + h.yy), half = 0.5 * (h.xx - h.yy);
    const double spread = std::hypot(half, h.xy);
    const double h1 = mean + spread, h2 = std::max(0.0, mean - spread);
    // The direction in which it is stiffest.
    Point n{1, 0};
    if (spread > 0) n = half > 0 ? Point{spread + half, h.xy} : Point{h.xy, spread - half};
    if (const double size = norm(n); size > 0) n = (1 / size) * n;
    const double g1 = dot(n, slope), g2 = cross(n, slope);
    constexpr double loose = 1e-3;  // of the length: the step is cut to it in the end
    double damping = std::max({0.0, std::abs(g1) / longest - h1, std::abs(g2) / longest - h2});
    Point step;
    for (int round = 0; round < 8; ++round) {
        const double a = damping + h1, b = damping + h2;
        step = {a > 0 ? g1 / a : 0, b > 0 ? g2 / b : 0};
        const double size = norm(step);
        if (!(size > longest * (1 + loose))) break;
        const double bent = (a > 0 ? step.x * step.x / a : 0) + (b > 0 ? step.y * step.y / b : 0);
        damping += (size / longest - 1) * size * size / bent;
    }
    if (const double size = norm(step); size > longest) step = (longest / size) * step;
    return Point{} - (step.x * n + step.y * Point{-n.y, n.x});
}

class DescentRun {
  public:
    DescentRun(const NearWalls& walls, const Potential& potential, double longest, std::int64_t budget)
        : walls_(walls), potential_(potential), longest_(longest), step_(longest), budget_(budget) {}

    // From a point of free space, or on its boundary: there the first step takes one of the directions that
    // lead into free space.
    DescentRoute run(Point start, const std::vector<Point>& inward) {
        at_ = start;
        descent_.route.path = {start};
        if (start == potential_.goal()) return finish(Rest::goal);
        if (!leave_wall(inward)) return finish(Rest::wall);
        descent_.values = {here_.value, here_.value};
        if (descent_.route.path.size() == 1) descent_.values.pop_back();
        InterruptPoll poll(8);
        while (descent_.route.stats.edges < budget_) {
            poll.step();
            if (arrives()) return finish(Rest::goal);
            if (!descend() && !fall_off()) return finish(name_of_rest());
        }
        return finish(Rest::budget);
    }

    // In distances of influence: shorter steps go nowhere, and closer to a wall is on it.
    static constexpr double least_step = 1e-7;

  private:
    static constexpr double rounding = 1e-13;    // of the potential: a gain that rounding may have made
    static constexpr double clear_gain = 1e-12;  // of the potential: a gain that leaves a saddle
    static constexpr double first_off = 1e-2;    // in distances of influence: the first try off a wall
    static constexpr double at_goal = 1e-3;      // in distances of influence: from here it goes straight
    static constexpr double rings[] = {1e-4, 1e-3, 1e-2, 5e-2};  // radii that look for a way off a saddle
    static constexpr double crease = 1e-3;      // of the clearance: walls as near as each other
    static constexpr double difference = 1e-4;  // of the clearance: half of the digits of a second derivative
    const NearWalls& walls_;
    const Potential& potential_;
    double longest_, step_;
    std::int64_t budget_;
    DescentRoute descent_;
    Point at_;
    Potential::Look here_;

    double scale() const { return potential_.gains().rho_0; }
    double shortest() const { return least_step * scale(); }
    double noise() const { return rounding * std::abs(here_.value); }

    Potential::Look look(Point p) {
        ++descent_.route.stats.edges;
        return potential_.look(p, std::min(2 * step_, 0.1 * scale()));
    }
    void go(Point to, const Potential::Look& seen) {
        at_ = to;
        here_ = seen;
        ++descent_.route.stats.nodes;
        descent_.route.path.push_back(to);
        descent_.values.push_back(seen.value);
    }
    // Off the wall, in the direction in which the potential is least.
    bool leave_wall(const std::vector<Point>& inward) {
        here_ = look(at_);
        if (here_.clearance > shortest()) return true;
        for (double away = first_off * scale(); away > shortest(); away *= 0.5) {
            Point best = at_;
            Potential::Look least;
            for (const Point direction : inward) {
                const Point to = at_ + (away / norm(direction)) * direction;
                const Potential::Look seen = look(to);
                if (!(seen.clearance > 0.5 * shortest()) || walls_.is_crossed(at_, to)) continue;
                if (best == at_ || seen.value < least.value) best = to, least = seen;
            }
            if (best == at_) continue;
            go(best, least);
            return true;
        }
        return false;
    }
    bool arrives() {
        const double left = distance(at_, potential_.goal());
        if (left == 0) return true;
        if (left > std::max(step_, at_goal * scale()) || walls_.is_crossed(at_, potential_.goal()))
            return false;
        const Potential::Look seen = look(potential_.goal());
        if (left > at_goal * scale() && !(seen.value < here_.value)) return false;
        go(potential_.goal(), seen);
        return true;
    }
    // A step that is clearly shorter than the clearance needs no exact test.
    bool is_crossed(Point to, double length) const {
        const double margin = tolerance::widening * (std::abs(at_.x) + std::abs(at_.y) + length);
        return length + margin >= here_.clearance && walls_.is_crossed(at_, to);
    }
    // A step down that lowers the potential by a tenth of what the slope promises.
    bool descend() {
        for (;; step_ *= 0.5) {
            here_ = look(at_);
            const double most = std::min(step_, 0.5 * here_.clearance);
            const Point step = damped_step(here_.stiffness, here_.slope, most);
            const double promised = -dot(step, here_.slope), length = norm(step);
            if (most < shortest() || !(promised > noise())) return false;
            const Point to = at_ + step;
            const Potential::Look seen = look(to);
            if (!(seen.value <= here_.value - 0.1 * promised) || is_crossed(to, length)) continue;
            go(to, seen);
            step_ = std::min(1.6 * most, longest_);
            return true;
        }
    }
    // Down in any direction, where the force vanishes.
    bool fall_off() {
        for (const double share : rings) {
            const double radius = share * std::min(here_.clearance, scale());
            Point best = at_;
            double least = here_.value - clear_gain * std::abs(here_.value);
            for (int k = 0; k < 32; ++k) {
                const double angle = std::numbers::pi * k / 16;
                const Point to = at_ + radius * Point{std::cos(angle), std::sin(angle)};
                const double value = look(to).value;
                if (value < least && !walls_.is_crossed(at_, to)) best = to, least = value;
            }
            if (best == at_) continue;
            step_ = radius;
            ++descent_.saddles;
            go(best, look(best));
            return true;
        }
        return false;
    }
    Rest name_of_rest() {
        if (here_.clearance <= 2 * shortest()) return Rest::wall;
        if (potential_.look(at_, crease * here_.clearance).is_crease) return Rest::crease;
        const double h = difference * here_.clearance;
        const auto slope = [&](double x, double y) { return potential_.look(at_ + Point{x, y}, 0).slope; };
        const Point by_x = (0.5 / h) * (slope(h, 0) - slope(-h, 0));
        const Point by_y = (0.5 / h) * (slope(0, h) - slope(0, -h));
        const double mixed = 0.5 * (by_x.y + by_y.x);
        return by_x.x > 0 && by_x.x * by_y.y > mixed * mixed ? Rest::minimum : Rest::saddle;
    }
    DescentRoute finish(Rest rest) {
        descent_.rest = rest;
        descent_.force = norm(here_.slope);
        const bool holds = rest == Rest::minimum || rest == Rest::crease;
        descent_.route.status = rest == Rest::goal ? Status::found
                                : holds            ? Status::local_minimum
                                                   : Status::undetermined;
        descent_.route.length = length_of(descent_.route.path);
        if (descent_.values.size() < descent_.route.path.size()) descent_.values.push_back(here_.value);
        return std::move(descent_);
    }
};

}  // namespace cspace::navigation
