// Voronoi Bug: a robot without a map traces the generalised Voronoi diagram by what it senses (Choset and
// Burdick 1995, "Sensor based planning, part II: incremental construction of the generalized Voronoi graph";
// Choset et al. 2005, "Principles of robot motion", chapter 5), until the goal is in view.
//
// It keeps a little less than its range from walls. Where no wall is that near, it flies straight at the
// goal; where one is, it rolls along it at that distance; where two are, it traces the points as near to
// both. All of these curves that hang together it explores branch by branch, with a graph of the points where
// they meet. A point at most that far from walls is in view from where the ray from its nearest wall through
// it comes to the curves, so if none of the curves shows the goal, it lies beyond a closed curve along which
// the robot rolls, or beyond walls.
//
// Beyond one such curve it lies if the way to it is free: then the robot leaves from the point of the curve
// nearest to the goal, and earlier from any point next to the goal that is nearer than where it last met
// walls. Else it is unreachable, and a boundary loop around it, or around the robot, is the proof.
#pragma once

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/bugs/clearance_robot.hpp"
#include "cspace/navigation/bugs/meet_graph.hpp"
#include "cspace/navigation/bugs/scan_robot.hpp"
#include "cspace/navigation/bugs/walk_log.hpp"

namespace cspace::navigation {

// What it did, in the order of the planner's words: up to the diagram, along it, along a wall, back where it
// has been, straight at the goal.
enum class Move : std::int8_t { away, trace, roll, back, go };

// path[first] to path[last] of the walk.
struct Leg {
    Move move;
    std::size_t first, last;
    double clearance;  // the least along the curve [m]; NaN where none is known
};

struct Exploration {
    Route route;  // of its price, nodes are meet points and edges the branches that it took
    std::vector<Leg> legs;
    std::vector<Point> meets;  // where three walls or more are nearest
    std::int64_t branches = 0, dead_ends = 0;
    std::int64_t scans = 0;                                      // of a sensor with noise
    double clearance = std::numeric_limits<double>::infinity();  // least on the curves that it followed [m]
    Touch witness;  // unreachable: where the line to the goal enters a wall that shuts the goal off
};

namespace voronoi_bug_limits {
constexpr std::int64_t most_branches = 20'000;
constexpr std::size_t most_feet = 1'000;            // of a meet point: with more, something is taken twice
constexpr double nearer = 1 - tolerance::widening;  // a distance counts as less by more than rounding
constexpr double thin = 1e-6;  // a curve around less per length and range has nothing inside
}  // namespace voronoi_bug_limits

template <ClearanceSensor Robot>
class VoronoiBug {
  public:
    VoronoiBug(Robot& robot, Point goal) : robot_(robot), goal_(goal), like_(robot.likeness()) {
        note(robot.position());
    }

    Exploration run() {
        if (robot_.position() == goal_ || look()) return go();
        Halt end = begin();
        for (double nearest = std::numeric_limits<double>::infinity();;) {
            if (end == Halt::open) end = fly();
            if (end == Halt::goal) return go();
            if (end == Halt::lost || trip_.branches > voronoi_bug_limits::most_branches)
                return finish(Status::undetermined);
            if (look()) return go();
            nearest = std::min(nearest, distance(robot_.position(), goal_));
            end = explore(end, nearest * voronoi_bug_limits::nearer);
            if (end == Halt::meet) end = judge(nearest);
            if (end == Halt::lost && robot_.again()) {
                nearest = std::numeric_limits<double>::infinity();
                end = begin();
            }
            if (end == Halt::corner) return finish(Status::unreachable);
        }
    }

  private:
    Robot& robot_;
    Point goal_;
    Likeness like_;
    Exploration trip_;
    MeetGraph graph_;
    RingBook rings_;

    void note(Point p) {
        if (trip_.route.path.empty() || trip_.route.path.back() != p) trip_.route.path.push_back(p);
    }
    bool look() {
        const double far = distance(robot_.position(), goal_);
        return far <= robot_.range() && robot_.sees(goal_) >= far;
    }
    Exploration finish(Status status) {
        trip_.route.status = status;
        trip_.route.length = length_of(trip_.route.path);
        return std::move(trip_);
    }
    // Straight to the goal, which is in view.
    Exploration go() {
        const std::size_t first = trip_.route.path.size() - 1;
        const bool arrived =
            robot_.position() == goal_ || robot_.advance({robot_.position(), goal_}, trip_.route.path);
        note(robot_.position());
        add_leg(Move::go, first);
        return finish(arrived ? Status::found : Status::undetermined);
    }
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    void add_leg(Move move, std::size_t first, double clearance = unknown) {
        if (first + 1 < trip_.route.path.size())
            trip_.legs.push_back({move, first, trip_.route.path.size() - 1, clearance});
    }
    void take(Move move, const std::vector<Point>& path, double clearance = unknown) {
        const std::size_t first = trip_.route.path.size() - 1;
        for (const Point p : path) note(p);
        add_leg(move, first, clearance);
    }

    Halt begin() {
        Log log;
        const Halt end = robot_.begin(log);
        for (const Touch& corner : log.corners) rings_.add(corner);
        take(Move::away, log.path);
        return end;
    }
    Halt fly() {
        Log log;
        const Aim aim{goal_, 0, {}, true};
        const Halt end = robot_.fly(aim, log);
        take(Move::go, log.path, robot_.keeps());
        return end;
    }

    // Through all branches that hang together with the place where the robot stands: goal if it is in view,
    // open if it leaves a wall for the goal, meet if all of them are exhausted.
    Halt explore(Halt end, double nearer) {
        graph_ = {};
        rings_.clear();
        Aim aim{goal_, nearer, {}, true};
        if (robot_.feet().size() == 1) aim.mark = robot_.position();
        int here = add_meet(end, false);
        if (robot_.clearance() == 0) graph_.meets[0].gaps[1].taken = true;  // the corner behind
        for (;;) {
            poll_interrupts();
            const Branch branch = graph_.next(here, goal_);
            if (branch.meet < 0) return here_ = here, Halt::meet;
            walk_back(here, branch.meet);
            here = branch.meet;
            if (++trip_.branches > voronoi_bug_limits::most_branches) return Halt::lost;
            end = follow(here, branch.gap, aim);
            if (end == Halt::told) return Halt::goal;
            if (end == Halt::goal) aim.stops = false;
            if (end == Halt::low) return Halt::open;
            if (end == Halt::lost) return Halt::lost;
        }
    }
    int here_ = 0;

    int add_meet(Halt came, bool rolled) {
        if (robot_.feet().size() > 2) trip_.meets.push_back(robot_.position());
        ++trip_.route.stats.nodes;
        return graph_.add(robot_.position(), robot_.clearance(), robot_.feet(), came, rolled, robot_.keeps(),
                          like_);
    }
    void walk_back(int here, int there) {
        if (here == there) return;
        std::vector<Point> path;
        graph_.go_back(here, there, path);
        take(Move::back, path);
        robot_.stand_at(graph_.meets[std::size_t(there)].at);
    }

    // Into a gap of a meet point, up to the next one.
    Halt follow(int& here, int gap, const Aim& aim) {
        MeetPoint& meet = graph_.meets[std::size_t(here)];
        meet.gaps[std::size_t(gap)].taken = true;
        const bool rolls = meet.gaps[std::size_t(gap)].rolls;
        const Foot right = meet.feet[std::size_t(gap)],
                   left = meet.feet[(std::size_t(gap) + 1) % meet.feet.size()];
        Log log;
        log.path = {meet.at};
        log.least = meet.clearance;
        const auto looks = [&] { return look(); };
        const Halt end =
            rolls ? robot_.roll(right, aim, log, looks) : robot_.trace(right, left, aim, log, looks);
        ++trip_.route.stats.edges;
        for (const Touch& corner : log.corners) rings_.add(corner);
        trip_.clearance = std::min(trip_.clearance, log.least);
        take(rolls ? Move::roll : Move::trace, log.path, log.least);
        if (end == Halt::told || end == Halt::low || end == Halt::lost) return end;
        if (look()) return Halt::told;
        if (end == Halt::corner) ++trip_.dead_ends;
        if (end == Halt::corner || end == Halt::goal) {
            graph_.meets[std::size_t(here)].gaps[std::size_t(gap)].taken = end == Halt::corner;
            come_back(log.path);
        } else {
            arrive(here, gap, end, rolls, std::move(log));
        }
        return end;
    }
    void come_back(const std::vector<Point>& path) {
        take(Move::back, {path.rbegin(), path.rend()});
        robot_.stand_at(path.front());
    }
    bool is_at(const MeetPoint& meet, const std::vector<Point>& path) const {
        const double near = like_.share * meet.clearance + like_.fine;
        return distance(meet.at, robot_.position()) <= near && length_of(path) <= like_.loop * near;
    }
    // Where a branch ends as it begins, its meet point has more to it than was seen there.
    void look_closer(int here, int gap, Halt end, bool rolls) {
        const std::vector<Foot>& feet = robot_.feet();
        if (end == Halt::limit)
            graph_.make_roll(here, gap);
        else if (feet.size() > (rolls ? 1 : 2) &&
                 graph_.meets[std::size_t(here)].feet.size() < voronoi_bug_limits::most_feet)
            graph_.refine(here, gap, {feet.begin() + 1, feet.end() - (rolls ? 0 : 1)});
        robot_.stand_at(graph_.meets[std::size_t(here)].at);
    }
    void arrive(int& here, int gap, Halt end, bool rolls, Log log) {
        if (end != Halt::mark && is_at(graph_.meets[std::size_t(here)], log.path))
            return look_closer(here, gap, end, rolls);
        Branch to = graph_.find(robot_.position(), robot_.clearance(), robot_.feet(), like_);
        if (end == Halt::mark && to.meet < 0) to = {0, 0};
        if (to.meet < 0) to = {add_meet(end, rolls), int(robot_.feet().size()) - 1};
        log.path.push_back(graph_.meets[std::size_t(to.meet)].at);
        const double length = length_of(log.path);
        graph_.add_way({here, to.meet, to.gap, std::move(log.path), length, rolls, log.low}, gap);
        here = to.meet;
        take(rolls ? Move::roll : Move::trace, {graph_.meets[std::size_t(here)].at}, robot_.clearance());
        robot_.stand_at(graph_.meets[std::size_t(here)].at);
    }

    // Nothing of what hangs together shows the goal: open if it lies beyond a curve along walls, from whose
    // point nearest to the goal the robot leaves, corner if walls shut it off, else lost.
    Halt judge(double& nearest) {
        int best = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int w = 0; w < int(graph_.ways.size()); ++w) {
            if (!graph_.ways[std::size_t(w)].rolls) continue;
            const std::vector<int> loop = graph_.loop(w);
            if (loop.empty() || *std::min_element(loop.begin(), loop.end()) != w || !has_beyond(loop))
                continue;
            for (const int k : loop) {
                const MeetWay& way = graph_.ways[std::size_t(k)];
                if (!way.low || !(distance(way.path[*way.low], goal_) < least)) continue;
                least = distance(way.path[*way.low], goal_);
                best = k;
            }
        }
        if (best >= 0) {
            leave(graph_.ways[std::size_t(best)]);
            nearest = least;
            return Halt::open;
        }
        if (rings_.is_on_wall(goal_)) return Halt::lost;
        const std::optional<Touch> shut = rings_.shuts_off(goal_);
        if (!shut) return Halt::lost;
        trip_.witness = *shut;
        return Halt::corner;
    }
    // Whether the goal lies on the side of a closed curve, the left one, that the robot has not been to.
    bool has_beyond(const std::vector<int>& loop) const {
        double area = 0, length = 0;
        int turns = 0;
        for (const int w : loop) {
            const std::vector<Point>& path = graph_.ways[std::size_t(w)].path;
            length += graph_.ways[std::size_t(w)].length;
            for (std::size_t i = 1; i < path.size(); ++i) {
                const Point a = path[i - 1], b = path[i];
                area += cross(a - goal_, b - goal_);
                turns += turn_around(goal_, a, b);
            }
        }
        const bool is_thin = std::abs(area) <= voronoi_bug_limits::thin * robot_.keeps() * length;
        return !is_thin && turns == (area > 0 ? 1 : 0);
    }
    void leave(const MeetWay& way) {
        walk_back(here_, way.from);
        const std::vector<Point> path(way.path.begin(), way.path.begin() + std::ptrdiff_t(*way.low) + 1);
        take(Move::back, path);
        robot_.stand_at(path.back());
    }
};

template <ClearanceSensor Robot>
Exploration voronoi_bug(Robot& robot, Point goal) {
    return from_every_side(robot, [&](Robot& r) { return VoronoiBug<Robot>(r, goal).run(); });
}

// In a polygon world. Where the robot loses its way by rounding, one that tells lengths apart otherwise
// tries.
inline Exploration voronoi_bug(const Walls& walls, const voronoi::Sites& sites, Point start, Point goal,
                               double range) {
    Exploration exploration;
    for (const voronoi::Grain& grain : voronoi::grains) {
        ClearanceRobot robot(walls, sites, start, range, grain);
        exploration = voronoi_bug(robot, goal);
        if (exploration.route.status != Status::undetermined) break;
    }
    return exploration;
}

// The same by a sensor with noise: its verdict is never that the goal is unreachable, since a gap may not
// have been seen.
inline Exploration voronoi_bug(const Walls& walls, Point start, Point goal, double range, Noise noise) {
    ScanRobot robot(walls, start, range, noise);
    Exploration exploration = voronoi_bug(robot, goal);
    exploration.scans = robot.scans();
    return exploration;
}

}  // namespace cspace::navigation
