// The simulator's loop: a vehicle follows the runs of a track, one after the other, until it arrives or
// cannot.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/following/controllers.hpp"

namespace cspace::navigation {

enum class Outcome : std::int8_t { arrived, stuck, collision, timeout, missed };

struct FollowSettings {
    double time_step;   // [s]
    double time_limit;  // [s]
    double speed;       // [m/s], the fastest on the way
    double window;      // how far ahead of the last place the nearest one is looked for [m]
    double tolerance;   // distance from the end that counts as there [m]
    double patience;    // how long the vehicle may stay without getting ahead [s]
};

struct FollowStep {
    Motion motion;
    double offset;    // from the run, above zero to its left
    double progress;  // along all runs
};
struct FollowRecord {
    std::vector<FollowStep> steps;
    Outcome outcome = Outcome::timeout;
};

// The recorded state of the vehicle at one place and on its way there.
struct Follower {
    const Track& track;
    Motion now;
    std::size_t run = 0;
    double before = 0;  // the length of the runs behind
    Run::Place own{}, guided{};

    template <class Controller>
    void look(const Vehicle& vehicle, const Controller& controller, double from, double to) {
        own = track[run].nearest(place_of(now.pose), from, to);
        guided = track[run].nearest(controller.guided(vehicle, now), own.s, std::max(to, own.s));
    }
    bool on_last_run() const { return run + 1 == track.size(); }
    // How far the end of the run is along it, or also across, for who does not keep to the path. Places
    // beyond the end are none to come back from.
    double left(bool across) const {
        const double along = std::max(track[run].length() - own.s, 0.0);
        if (!across) return along;
        const double straight = distance(place_of(now.pose), track[run].end());
        return along > 0 ? std::max(std::hypot(along, own.offset), straight) : straight;
    }
    double progress() const { return before + own.s; }
};

// contact(from, speed, turn rate, time) returns whether the vehicle touches something on that arc; controller
// as in controllers.hpp. believe(time, pose) returns where the vehicle takes itself to be when it is at a
// pose: there it is steered from, while it moves and touches things where it is.
template <class Controller, class Contact, class Belief>
FollowRecord follow_track(const Vehicle& vehicle, const Motion& start, const Track& track,
                          Controller& controller, const FollowSettings& settings, const Contact& contact,
                          const Belief& believe) {
    constexpr double rest = 1e-3;     // [m/s], as good as standing
    constexpr double advance = 1e-4;  // [m] less than this is creeping on the spot
    constexpr double settled = 0.5;   // [s] without getting ahead, after which being there is enough
    const double dt = settings.time_step;
    FollowRecord record;
    Motion truth = start;
    Follower at{track, start};
    at.now.pose = believe(0.0, truth.pose);
    at.look(vehicle, controller, 0, track[0].length());
    double farthest = -1, farthest_time = 0;
    bool touched = contact(start.pose, 0.0, 0.0, 0.0);
    const auto finish = [&](Outcome outcome) {
        record.outcome = outcome;
        return record;
    };
    InterruptPoll poll(16);
    for (std::int64_t step = 0;; ++step) {
        poll.step();
        const double time = double(step) * dt;
        record.steps.push_back({truth, at.guided.offset, at.progress()});
        if (touched) return finish(Outcome::collision);
        const bool across = controller.leaves_path(vehicle);
        double left = at.left(across);
        const double missing = distance(place_of(truth.pose), track[at.run].end());
        if (left <= settings.tolerance && std::fabs(at.now.speed) <= rest) {
            if (at.on_last_run())
                return finish(missing <= settings.tolerance ? Outcome::arrived : Outcome::missed);
            at.before += track[at.run++].length();
            at.look(vehicle, controller, 0, settings.window);
            left = at.left(across);
        }
        if (at.progress() > farthest + advance) farthest = at.progress(), farthest_time = time;
        if (time - farthest_time >= settings.patience) {
            // Who comes no farther at the end is there, also where it cut the last corner of the path.
            const bool there =
                at.on_last_run() && at.left(false) <= settings.window && missing <= settings.tolerance;
            return finish(there ? Outcome::arrived : Outcome::stuck);
        }
        if (time >= settings.time_limit) return finish(Outcome::timeout);
        const bool rests = left <= settings.tolerance && time - farthest_time >= settled;
        const double fast =
            rests ? 0 : std::min(settings.speed, speed_to_stop(left, vehicle.acceleration, dt));
        const Command command = controller(vehicle, at.now, track[at.run], at.guided, fast, dt);
        const Motion next = step_vehicle(vehicle, truth, command, dt);
        touched = contact(truth.pose, next.speed, turn_rate(vehicle, next.speed, next.turn), dt);
        at.now = truth = next;
        at.now.pose = believe(time + dt, truth.pose);
        at.look(vehicle, controller, at.own.s, at.own.s + settings.window);
    }
}
// The same for a vehicle that knows where it is.
template <class Controller, class Contact>
FollowRecord follow_track(const Vehicle& vehicle, const Motion& start, const Track& track,
                          Controller& controller, const FollowSettings& settings, const Contact& contact) {
    const auto know = [](double, const CarPose& pose) { return pose; };
    return follow_track(vehicle, start, track, controller, settings, contact, know);
}

}  // namespace cspace::navigation
