// A robot that goes down a potential, step by step, until it arrives or rests; where it rests is named.
// Along walls it does not oscillate: each step uses the stiffness of the potential across.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "cspace/navigation/fields/damped_step.hpp"
#include "cspace/navigation/fields/potential.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

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
        while (descent_.route.stats.edges < budget_) {
            if (arrives()) return finish(Rest::goal);
            if (!descend() && !fall_off()) return finish(name_of_rest());
        }
        return finish(Rest::budget);
    }

  private:
    const NearWalls& walls_;
    const Potential& potential_;
    double longest_, step_;
    std::int64_t budget_;
    DescentRoute descent_;
    Point at_;
    Potential::Look here_;

    double scale() const { return potential_.gains().rho_0; }
    double shortest() const { return 1e-7 * scale(); }
    // A gain that rounding may have made.
    double noise() const { return 1e-13 * std::abs(here_.value); }

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
        for (double away = 1e-2 * scale(); away > shortest(); away *= 0.5) {
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
        if (left > std::max(step_, 1e-3 * scale()) || walls_.is_crossed(at_, potential_.goal())) return false;
        const Potential::Look seen = look(potential_.goal());
        if (left > 1e-3 * scale() && !(seen.value < here_.value)) return false;
        go(potential_.goal(), seen);
        return true;
    }
    // A step that is clearly shorter than the clearance needs no exact test.
    bool is_crossed(Point to, double length) const {
        const double rounding = 1e-9 * (std::abs(at_.x) + std::abs(at_.y) + length);
        return length + rounding >= here_.clearance && walls_.is_crossed(at_, to);
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
        for (const double share : {1e-4, 1e-3, 1e-2, 5e-2}) {
            const double radius = share * std::min(here_.clearance, scale());
            Point best = at_;
            double least = here_.value - 1e-12 * std::abs(here_.value);
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
        if (potential_.look(at_, 1e-3 * here_.clearance).is_crease) return Rest::crease;
        const double h = 1e-4 * here_.clearance;
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
