// A point robot that glides between walls by scans with noise: predictor and corrector towards points as far
// from two of them. It knows where it is, and feels walls that it touches.
#pragma once

#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/scan_feet.hpp"

namespace cspace::navigation {

class ScanRobot : public ContactRobot {
  public:
    static constexpr std::int64_t most_looks = 6'000;
    static constexpr double stride = 0.25;  // of the distance from walls, that it moves between two scans
    static constexpr int most_rounds = 4;
    static constexpr int most_tries = 40;  // goals that seem to be in view, and are not

    ScanRobot(const Walls& walls, Point start, double range, Noise noise)
        : ContactRobot(walls, start),
          scanner_(walls, range, noise),
          range_(range),
          keeps_(std::isfinite(range) ? 0.95 * range - 3 * noise.deviation : range) {}

    double range() const { return range_; }
    Likeness likeness() const { return {0.25, 0, 2, Scan::slack, 6}; }
    bool again() {
        keeps_ *= 0.8;
        return ++rounds_ < most_rounds && !is_tired();
    }
    double keeps() const { return keeps_; }
    double clearance() const { return clearance_; }
    const std::vector<Foot>& feet() const { return feet_; }
    std::int64_t scans() const { return scanner_.scans(); }

    // It takes a goal for visible that reads as far as it is, and goes there to make sure.
    double sees(Point target) {
        if (seen_from_ == at_) return seen_;
        look();
        const double far = distance(at_, target);
        seen_from_ = at_;
        seen_ = std::nextafter(far, 0);
        if (!(far > 0)) return seen_ = far;
        if (far > range_ || is_tried()) return seen_;
        const double reading = scanner_.read(at_, (1 / far) * (target - at_));
        if (reading < far - Scan::trust * scan_.deviation - tolerance::widening * far) return seen_;
        std::vector<Point> way;
        const Position end = follow_line({at_, target}, at_, place_, way);
        if (end.at == target) return seen_ = far;
        tried_.push_back(at_);
        detour_.insert(detour_.end(), way.begin(), way.end());
        detour_.push_back(end.at);
        detour_.insert(detour_.end(), way.rbegin(), way.rend());
        detour_.push_back(at_);
        return seen_;
    }

    Halt begin(Log& log) {
        flush(log);
        look();
        if (!place_.is_open() && !leave_wall(log)) return Halt::lost;
        for (int moves = 0; moves < most_moves; ++moves) {
            look();
            if (scan_.least >= keeps_)
                return moves == 0 ? Halt::open : halt({nearest_foot()}, Halt::limit, log);
            const std::vector<Near> all = nearest_runs(1);
            if (all.size() > 1) return halt(feet_of(all, 0), Halt::meet, log);
            const int away = Scan::beam_of(-1.0 * all[0].towards);
            const int other = scan_.nearest(away - 2 * Scan::apart, away + 2 * Scan::apart);
            const double room = std::min(scan_.at(other), keeps_ + scan_.least) - scan_.least;
            if (room <= scan_.tolerance(scan_.least)) {
                const std::vector<Near> both = nearest_runs(2);
                if (both.size() > 1) return halt(feet_of(both, 0), Halt::meet, log);
                return halt({Foot{next_name_++, all[0].towards}, Foot{next_name_++, Scan::direction(other)}},
                            Halt::meet, log);
            }
            if (!step(at_ + std::max(0.5 * room, 0.01 * scan_.least) * Scan::direction(away), log))
                return halt({nearest_foot()}, Halt::lost, log);
        }
        return Halt::lost;
    }

    template <class Look>
    Halt trace(Foot right_foot, Foot left_foot, const Aim&, Log& log, Look see) {
        Pair feet{right_foot.towards, left_foot.towards};
        double before = std::numeric_limits<double>::infinity(), pace = stride;
        for (int moves = 0; moves < most_moves; ++moves) {
            if (is_tired()) return Halt::lost;
            look();
            if (moves > 0 && glimpses(see, log)) return Halt::told;
            if (is_closed(feet)) return end_branch(log);
            const Point from = at_;
            Pair moved = feet;
            const std::vector<Near> ring = glide(moved, pace, log);
            const double apart = ring.empty() ? 0 : reading(moved);
            if (ring.size() < 2 || apart > 0.5 * (keeps_ + range_)) {
                pace *= 0.5;
                if (pace < 0.02 || !step(from, log)) return end_branch(log);
                continue;
            }
            pace = std::min(2 * pace, stride);
            log.least = std::min(log.least, scan_.least);
            feet = {ring.front().towards, ring.back().towards};
            if (ring.size() > 2) {
                settle(ring, apart, log);
                if (glimpses(see, log)) return Halt::told;
                return halt(settled_, Halt::meet, log);
            }
            if (apart >= keeps_ && apart > before) {
                if (glimpses(see, log)) return Halt::told;
                return halt(feet_of(ring, 0), Halt::limit, log);
            }
            before = apart;
        }
        return end_branch(log);
    }

    template <class Look>
    Halt roll(Foot foot, const Aim& aim, Log& log, Look see) {
        Point right = foot.towards;
        double rolled = 0, nearing = -1;
        for (int moves = 0; moves < 16 * most_moves; ++moves) {
            if (is_tired()) return Halt::lost;
            const Point last = at_, ahead{-right.y, right.x}, foot_at = at_ + keeps_ * right;
            if (!step(at_ + rolling * stride * keeps_ * ahead, log)) return end_branch(log);
            look();
            right = foot_near(right, foot_at, ahead, false);
            const double off = scan_.smooth(right) - keeps_;
            if (!step(at_ + std::clamp(off, -stride * keeps_, stride * keeps_) * right, log))
                return end_branch(log);
            look();
            if (glimpses(see, log)) return Halt::told;
            right = foot_near(right, at_ + keeps_ * right, ahead, false);
            const double height = scan_.smooth(right);
            if (height >= range_) return end_branch(log);
            log.least = std::min(log.least, scan_.least);
            rolled += distance(last, at_);
            const double limit = std::max(height, keeps_) + scan_.tolerance(keeps_);
            const std::vector<Near> ring = arc(right, -1.0 * right, limit);
            if (ring.size() > 1 && std::abs(height - keeps_) <= scan_.tolerance(keeps_))
                return halt(feet_of(ring, 0), Halt::meet, log);
            right = ring.front().towards;
            const double near = rolling * stride * keeps_;
            if (aim.mark && rolled > 8 * near && distance(at_, *aim.mark) <= 2 * near)
                return halt({Foot{next_name_++, right}}, Halt::mark, log);
            const double nearer = distance(last, aim.goal) - distance(at_, aim.goal);
            if (nearing > 0 && nearer <= 0 && dot(aim.goal - at_, right) < 0) {
                if (distance(at_, aim.goal) < aim.nearer - near)
                    return halt({nearest_foot()}, Halt::low, log);
                if (!log.low || distance(at_, aim.goal) < distance(log.path[*log.low], aim.goal))
                    log.low = log.path.size() - 1;
            }
            nearing = nearer;
        }
        return end_branch(log);
    }

    Halt fly(const Aim& aim, Log& log) {
        for (;;) {
            if (is_tired()) return Halt::lost;
            look();
            const double far = distance(at_, aim.goal);
            if (sees(aim.goal) >= far) return Halt::goal;
            flush(log);
            const Point ahead = (1 / far) * (aim.goal - at_);
            const std::vector<Near> all = nearest_runs(1);
            if (scan_.least <= keeps_ && !all.empty() && dot(all[0].towards, ahead) > 0.02)
                return halt(feet_of(all, Scan::beam_of(-1.0 * ahead)),
                            all.size() > 1 ? Halt::meet : Halt::limit, log);
            const double free = std::max(scan_.least - keeps_, stride * keeps_);
            if (!step(at_ + std::min(far, free) * ahead, log))
                return halt({nearest_foot()}, Halt::limit, log);
        }
    }

  private:
    static constexpr int most_moves = 4'000;
    static constexpr double rolling = 0.5;  // of its stride, along a single wall

    // The directions of the walls on both sides.
    struct Pair {
        Point right, left;
    };

    Scanner scanner_;
    Scan scan_;
    double range_, keeps_, clearance_ = 0, seen_ = 0;
    std::vector<Foot> feet_, settled_;
    std::optional<Point> scanned_from_, seen_from_;
    std::vector<Point> tried_, detour_;
    std::int64_t looks_ = 0;
    int rounds_ = 0;
    voronoi::Index next_name_ = 0;

    bool is_tired() const { return looks_ > most_looks; }
    void look() {
        if (scanned_from_ == at_) return;
        scanner_.look(at_, scan_);
        scanned_from_ = at_;
        ++looks_;
    }
    // Where it has tried in vain, it tries again only from elsewhere.
    bool is_tried() const {
        if (int(tried_.size()) >= most_tries) return true;
        for (const Point& p : tried_)
            if (distance(p, at_) <= 0.5 * scan_.least) return true;
        return false;
    }
    template <class Look>
    bool glimpses(Look see, Log& log) {
        const bool is_seen = see();
        flush(log);
        return is_seen;
    }
    void flush(Log& log) {
        log.note(at_);
        for (const Point& p : detour_) log.note(p);
        detour_.clear();
    }

    // From where it touches walls into the middle of the widest way that it feels to be free.
    bool leave_wall(Log& log) {
        const auto free = [&](int beam) { return std::min({scan_.at(beam), keeps_, walls_->extent()}); };
        std::vector<Point> touched;
        const auto leads_away = [&](int beam) {
            const Point to = at_ + 0.01 * free(beam) * Scan::direction(beam);
            return to != at_ && follow_line({at_, to}, at_, place_, touched).at == to;
        };
        int first = 0, best = 0, longest = 0;
        while (first < Scan::beams && leads_away(first)) ++first;
        for (int k = first, run = 0; k < first + Scan::beams; ++k) {
            run = leads_away(k) ? run + 1 : 0;
            if (run > longest) longest = run, best = k;
        }
        const int beam = best - longest / 2;
        for (const double share : {0.3, 0.1, 0.03, 0.01})
            if (longest > 0 && step(at_ + share * free(beam) * Scan::direction(beam), log)) return true;
        return false;
    }

    // Straight to a place; where a wall is touched on the way, back again.
    bool step(Point to, Log& log) {
        const Point from = at_;
        log.note(from);
        const Place was = place_;
        const bool arrived = advance({at_, to}, log.path);
        log.note(at_);
        if (arrived) return true;
        log.note(from);
        at_ = from;
        place_ = was;
        return false;
    }
    Halt halt(std::vector<Foot> feet, Halt cause, Log& log) {
        look();
        log.note(at_);
        feet_ = std::move(feet);
        clearance_ = scan_.least;
        log.least = std::min(log.least, clearance_);
        return cause;
    }
    Halt end_branch(Log& log) {
        log.note(at_);
        clearance_ = scan_.least;
        return Halt::corner;
    }

    // All that is as near as the nearest wall, as far as readings tell, times a share.
    std::vector<Near> nearest_runs(double share) const {
        return scan_.within(scan_.least + share * scan_.tolerance(scan_.least));
    }
    Foot nearest_foot() {
        const std::vector<Near> all = nearest_runs(1);
        return {next_name_++, all.empty() ? Point{1, 0} : all[0].towards};
    }
    // Counterclockwise from a beam on.
    static void sort_from(int beam, std::vector<Near>& runs) {
        std::sort(runs.begin(), runs.end(), [&](const Near& a, const Near& b) {
            return Scan::ahead(beam, Scan::beam_of(a.towards)) < Scan::ahead(beam, Scan::beam_of(b.towards));
        });
    }
    // In their order from a beam on, counterclockwise.
    std::vector<Foot> feet_of(std::vector<Near> runs, int from) {
        if (from != 0) sort_from(from, runs);
        std::vector<Foot> feet;
        for (const Near& run : runs) feet.push_back({next_name_++, run.towards});
        return feet;
    }

    static Point between(Point right, Point left) {
        const double half = 0.5 * voronoi::turn_from(right, left), c = std::cos(half), s = std::sin(half);
        return {c * right.x - s * right.y, s * right.x + c * right.y};
    }

    double reading(const Pair& feet) const {
        return std::max(scan_.smooth(feet.right), scan_.smooth(feet.left));
    }
    // Whether all that lies ahead is in view.
    bool is_closed(const Pair& feet) const {
        const int right = Scan::beam_of(feet.right);
        return scan_.is_closed(right, right + Scan::ahead(right, Scan::beam_of(feet.left)));
    }
    // A step between two walls, and back to where they are as near. Gives all that is as near there ahead,
    // from the wall on the right to that on the left; nothing where it was stopped.
    std::vector<Near> glide(Pair& feet, double pace, Log& log) {
        const Point ahead = between(feet.right, feet.left);
        const Point right_at = at_ + scan_.at(Scan::beam_of(feet.right)) * feet.right;
        const Point left_at = at_ + scan_.at(Scan::beam_of(feet.left)) * feet.left;
        if (!step(at_ + pace * std::max(scan_.least, scan_.deviation) * ahead, log)) return {};
        for (int corrections = 0; corrections < 4; ++corrections) {
            look();
            feet = {foot_near(feet.right, right_at, ahead, false),
                    foot_near(feet.left, left_at, ahead, true)};
            if (!scan_.returns(Scan::beam_of(feet.right)) || !scan_.returns(Scan::beam_of(feet.left)))
                return {};
            const Point across = feet.right - feet.left;
            const double width = norm(across), off = scan_.smooth(feet.right) - scan_.smooth(feet.left);
            if (std::abs(off) <= 0.3 * scan_.tolerance(scan_.least) || width < 0.05) break;
            const double by = std::clamp(off / width, -stride * scan_.least, stride * scan_.least);
            if (!step(at_ + (by / width) * across, log)) break;
        }
        look();
        const double apart = reading(feet);
        return arc(feet.right, feet.left, apart + scan_.tolerance(apart));
    }

    // Where the wall under a foot is nearest after a move: the foot of a wall keeps its direction, that of a
    // corner its place.
    Point foot_near(Point towards, Point was_at, Point ahead, bool is_left) const {
        constexpr int behind = Scan::beams / 30, before = Scan::beams / 14;
        const int now = Scan::beam_of(was_at - at_), old = Scan::beam_of(towards);
        const auto signed_from = [](int a, int b) {
            const int n = Scan::ahead(a, b);
            return n > Scan::beams / 2 ? n - Scan::beams : n;
        };
        const int turned = signed_from(old, now);
        int first = old + std::min(turned, 0) - (is_left ? before : behind);
        int last = old + std::max(turned, 0) + (is_left ? behind : before);
        const int heading = old + signed_from(old, Scan::beam_of(ahead));
        if (is_left)
            first = std::max(first, std::min(heading, last));
        else
            last = std::min(last, std::max(heading, first));
        return Scan::direction(scan_.nearest(first, last));
    }

    // The walls within a distance, counterclockwise from that under one direction to that under another.
    std::vector<Near> arc(Point right, Point left, double limit) const {
        const std::vector<Near> all = scan_.within(limit);
        const int r = Scan::beam_of(right), gap = Scan::ahead(r, Scan::beam_of(left));
        const auto holds = [](const Near& run, int beam) {
            return Scan::ahead(Scan::wrapped(run.first), beam) <= run.last - run.first;
        };
        std::vector<Near> ring;
        std::optional<Near> first, last;
        for (const Near& run : all) {
            const bool is_first = holds(run, r), is_last = holds(run, r + gap);
            if (is_first) first = run;
            if (is_last) last = run;
            if (!is_first && !is_last && Scan::ahead(r, Scan::beam_of(run.towards)) < gap)
                ring.push_back(run);
        }
        if (!first) first = Near{r, r, right};
        sort_from(r, ring);
        ring.insert(ring.begin(), *first);
        if (last && last->first != first->first) ring.push_back(*last);
        return ring;
    }

    // To where the outer two of the walls and one between them are as near.
    void settle(std::vector<Near> ring, double apart, Log& log) {
        const Point before = at_;
        const auto names = [&] { settled_ = feet_of(ring, 0); };
        names();
        for (int moves = 0; moves < 4; ++moves) {
            const auto read = [&](const Near& n) { return scan_.smooth(scan_.nearest(n.first, n.last)); };
            const Near &a = ring.front(), &c = ring.back();
            std::size_t middle = 1;
            double best = -1;
            for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
                const double far =
                    std::min(norm(ring[k].towards - a.towards), norm(ring[k].towards - c.towards));
                if (far > best) best = far, middle = k;
            }
            const Near& b = ring[middle];
            const Point u = b.towards - a.towards, v = c.towards - a.towards;
            const double p = read(b) - read(a), q = read(c) - read(a);
            if (std::abs(cross(u, v)) < 0.02) return;
            const Point by = solve_two(u, v, p, q);
            if (norm(by) <= 0.2 * scan_.tolerance(apart)) return;
            const Point to = at_ + std::min(1.0, 0.5 * stride * apart / norm(by)) * by;
            if (distance(to, before) > stride * apart || !step(to, log)) return;
            look();
            const double limit = std::max({scan_.smooth(a.towards), scan_.smooth(c.towards), scan_.least});
            const std::vector<Near> next = arc(a.towards, c.towards, limit + scan_.tolerance(limit));
            if (next.size() < 3) return;
            ring = next;
            names();
        }
    }
};

}  // namespace cspace::navigation
