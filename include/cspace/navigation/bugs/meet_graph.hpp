// What a robot remembers that traces a Voronoi diagram: the meet points, the ways between them, and which of
// the gaps between the walls around a meet point it has not been through.
#pragma once

#include <algorithm>
#include <map>
#include <optional>

#include "cspace/navigation/bugs/boundary_tour.hpp"
#include "cspace/navigation/bugs/clearance_sensor.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// The boundary loops that a robot has followed all around, assembled from the corners that it passed.

class RingBook {
  public:
    void add(const Touch& corner) { after_.insert_or_assign(corner.in.name, corner); }
    void clear() { after_.clear(); }

    // Whether a point lies on a wall that the robot came by.
    bool is_on_wall(Point p) const {
        for (const auto& [name, corner] : after_)
            if (is_on(corner.in, p) || is_on(corner.out, p)) return true;
        return false;
    }

    // Where the line to the goal enters a whole ring that has the goal on its other side.
    std::optional<Touch> shuts_off(Point goal) const {
        std::map<int, bool> judged;
        for (const auto& [name, corner] : after_) {
            if (judged[name]) continue;
            Round round(goal, corner);
            const Touch* at = &corner;
            for (std::size_t walked = 0; at && walked <= after_.size(); ++walked) {
                judged[at->in.name] = true;
                const Wall piece = at->out;
                const auto next = after_.find(piece.name);
                at = next == after_.end() ? nullptr : &next->second;
                if (!at) break;
                round.add(piece, piece.begin, piece.end);
                round.add(*at);
                if (at->in.name != name) continue;
                if (round.shuts_off_goal()) return round.blocked.touch;
                break;
            }
        }
        return {};
    }

  private:
    std::map<int, Touch> after_;  // the corner at which each wall ends
};

// Between a foot and the one after it. Where it is wider than half a turn and the walls are as far as the
// robot keeps from them, no way leads into it but along the wall on its right.
struct Opening {
    bool rolls = false, taken = false;
    int way = -1;  // that leads into it along the wall on its right
};

struct MeetPoint {
    Point at;
    double clearance;
    std::vector<Foot> feet;
    std::vector<Opening> gaps;
};

struct MeetWay {
    int from, to, to_gap;
    std::vector<Point> path;
    double length;
    bool rolls;
    std::optional<std::size_t> low;  // the point of the path nearest to the goal, where the wall lies behind
};

struct Branch {
    int meet = -1, gap = -1;
};

class MeetGraph {
  public:
    std::vector<MeetPoint> meets;
    std::vector<MeetWay> ways;

    // Into the last gap the robot has looked already. keeps: how far it keeps from a single wall.
    int add(Point at, double clearance, const std::vector<Foot>& feet, Halt came, bool rolled, double keeps,
            Likeness like) {
        MeetPoint meet{at, clearance, feet, std::vector<Opening>(feet.size())};
        const bool is_far = clearance >= keeps * (1 - like.far);
        for (std::size_t k = 0; k < feet.size(); ++k)
            meet.gaps[k].rolls = came == Halt::meet && !rolled && is_far && is_wide(feet, k);
        if (came == Halt::limit) meet.gaps[0].rolls = true;
        if (rolled) meet.gaps.back().rolls = true;
        meets.push_back(std::move(meet));
        around_.emplace_back();
        return int(meets.size()) - 1;
    }
    void make_roll(int meet, int gap) { meets[std::size_t(meet)].gaps[std::size_t(gap)] = {true}; }
    void add_way(MeetWay way, int gap) {
        const int number = int(ways.size());
        around_[std::size_t(way.from)].push_back(number);
        around_[std::size_t(way.to)].push_back(number);
        MeetPoint &from = meets[std::size_t(way.from)], &to = meets[std::size_t(way.to)];
        from.gaps[std::size_t(gap)].way = number;
        if (!way.rolls) to.gaps[std::size_t(way.to_gap)].taken = true;
        ways.push_back(std::move(way));
    }

    // The meet point and gap at which a robot arrives that comes from between the last foot and the first;
    // if it can be, a gap that it does not know.
    Branch find(Point at, double clearance, const std::vector<Foot>& feet, Likeness like) const {
        const double near = like.share * clearance + like.fine;
        Branch best;
        double least = like.turn;
        for (int m = 0; m < int(meets.size()); ++m) {
            const MeetPoint& meet = meets[std::size_t(m)];
            if (std::abs(meet.at.x - at.x) > near || std::abs(meet.at.y - at.y) > near) continue;
            const std::size_t n = meet.feet.size();
            if (n < 3 && feet.size() > 2) continue;
            for (std::size_t k = 0; k < n; ++k) {
                const double off = norm(meet.feet[k].towards - feet.back().towards) +
                                   norm(meet.feet[(k + 1) % n].towards - feet.front().towards);
                const bool is_known = meet.gaps[k].taken && !meet.gaps[k].rolls;
                if (!(off < least) || (is_known && best.meet >= 0)) continue;
                if (!is_known) least = off;
                best = {m, int(k)};
            }
        }
        return best;
    }

    // More feet in a gap of a meet point, in their order.
    void refine(int meet, int gap, std::vector<Foot> more) {
        MeetPoint& m = meets[std::size_t(meet)];
        const auto n = std::ptrdiff_t(gap) + 1;
        const Foot& next = m.feet[std::size_t(n) % m.feet.size()];
        const bool closes = more.back().site == next.site;
        if (closes) more.pop_back();
        m.feet.insert(m.feet.begin() + n, more.begin(), more.end());
        m.gaps.insert(m.gaps.begin() + n, more.size(), Opening{});
        const bool rolls = m.gaps[std::size_t(gap)].rolls;
        for (std::size_t k = std::size_t(gap); k <= std::size_t(gap) + more.size(); ++k)
            m.gaps[k] = {rolls && !closes && k == std::size_t(gap) + more.size()};
        for (const int w : around_[std::size_t(meet)]) {
            MeetWay& way = ways[std::size_t(w)];
            if (way.to == meet && way.to_gap > gap - int(rolls)) way.to_gap += int(more.size());
        }
    }

    // Which gap to go into next: by the way there, and the straight line left from there.
    Branch next(int here, Point goal) {
        search(here, [&](int meet) { return distance(meets[std::size_t(meet)].at, goal); });
        if (found_ < 0) return {};
        const MeetPoint& meet = meets[std::size_t(found_)];
        Branch best{found_, -1};
        double ahead = -2;
        const Point to = goal - meet.at;
        for (std::size_t k = 0; k < meet.gaps.size(); ++k) {
            if (meet.gaps[k].taken) continue;
            const double along = dot(direction(meet, k), to) / std::max(norm(to), tolerance::nonzero);
            if (along > ahead) ahead = along, best.gap = int(k);
        }
        return best;
    }
    // The way to what next() found, or to a meet point.
    void go_back(int here, int there, std::vector<Point>& path) {
        search(here, [&](int) { return 0.0; }, there);
        std::vector<int> back;
        for (int m = there; m != here;) {
            const int w = int(known_.before(std::uint32_t(m)));
            back.push_back(w);
            const MeetWay& way = ways[std::size_t(w)];
            m = way.from == m ? way.to : way.from;
        }
        int at = here;
        for (auto w = back.rbegin(); w != back.rend(); ++w) {
            const MeetWay& way = ways[std::size_t(*w)];
            const bool forward = way.from == at;
            if (forward)
                path.insert(path.end(), way.path.begin() + 1, way.path.end());
            else
                path.insert(path.end(), way.path.rbegin() + 1, way.path.rend());
            at = forward ? way.to : way.from;
        }
    }

    // The closed curve along walls that begins with a way; empty where it does not close.
    std::vector<int> loop(int way) const {
        std::vector<int> found;
        for (int w = way; found.size() <= ways.size();) {
            found.push_back(w);
            const MeetWay& last = ways[std::size_t(w)];
            w = meets[std::size_t(last.to)].gaps[std::size_t(last.to_gap)].way;
            if (w < 0) return {};
            if (w == way) return found;
        }
        return {};
    }

  private:
    std::vector<std::vector<int>> around_;  // the ways at each meet point
    search::Ways known_{0};                 // before each meet point: the way to it
    int found_ = -1;

    static double angle_of(const std::vector<Foot>& feet, std::size_t k) {
        if (feet.size() == 1) return 2 * std::numbers::pi;
        return voronoi::turn_from(feet[k].towards, feet[(k + 1) % feet.size()].towards);
    }
    static bool is_wide(const std::vector<Foot>& feet, std::size_t k) {
        return angle_of(feet, k) > std::numbers::pi * (1 + tolerance::widening);
    }
    static Point direction(const MeetPoint& meet, std::size_t k) {
        const Point a = meet.feet[k].towards;
        const double half = meet.gaps[k].rolls ? 0.5 * std::numbers::pi : 0.5 * angle_of(meet.feet, k);
        const double c = std::cos(half), s = std::sin(half);
        return {c * a.x - s * a.y, s * a.x + c * a.y};
    }

    // Dijkstra's search from a meet point, until no other branch can be nearer, or a meet point is reached.
    template <class Left>
    void search(int here, Left left, int there = -1) {
        known_ = search::Ways(meets.size());
        search::PriorityQueue open;
        const auto offer = [&](int meet, double cost, std::uint32_t way) {
            const auto node = std::uint32_t(meet);
            if (known_.improve(node, cost, way)) open.push({cost, float(meet), node});
        };
        offer(here, 0, search::no_node);
        double best = std::numeric_limits<double>::infinity();
        found_ = -1;
        while (!open.empty()) {
            const std::uint32_t node = open.pop().node;
            if (!known_.settle(node)) continue;
            const int m = int(node);
            const double cost = known_.cost(node);
            if (cost >= best || m == there) break;
            const auto& gaps = meets[std::size_t(m)].gaps;
            const bool is_open =
                std::any_of(gaps.begin(), gaps.end(), [](const Opening& g) { return !g.taken; });
            if (there < 0 && is_open && cost + left(m) < best) best = cost + left(m), found_ = m;
            for (const int w : around_[std::size_t(m)]) {
                const MeetWay& way = ways[std::size_t(w)];
                offer(way.from == m ? way.to : way.from, cost + way.length, std::uint32_t(w));
            }
        }
    }
};

}  // namespace cspace::navigation
