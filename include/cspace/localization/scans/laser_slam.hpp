// Laser SLAM on a pose graph: each scan is matched against the last ones, loops are found by matching against
// those of earlier passes, and the graph is optimized whenever some were accepted.
//
// Scan matching: Olson 2009. Consistent loops: Mangelson et al. 2018. Weights of loops while driving: dynamic
// covariance scaling (Agarwal et al. 2013).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cspace/localization/graph/optimizer.hpp"
#include "cspace/localization/scans/correlative_search.hpp"
#include "cspace/localization/scans/field_of_view.hpp"
#include "cspace/localization/scans/loop_consistency.hpp"
#include "cspace/localization/scans/refine_pose.hpp"
#include "cspace/localization/scans/thin_points.hpp"

namespace cspace::localization {

struct SlamOptions {
    double resolution = 0.05;  // of the fields [m]
    double sigma = 0.08;       // of a point in them [m]
    FieldOfView view;
    bool finds_loops = true;
};

enum class LoopVerdict : std::uint8_t { accepted, ambiguous, inconsistent, alone, clipped };

// A relative pose between two scans.
struct ScanEdge {
    int from, to;
    PlanarSpace::Pose z;
    PlanarSquare covariance;  // of the twist at `to`
    double score = 0;         // 0: the odometry alone
    double second = 0;
};

namespace slam {

inline constexpr int submap_scans = 30;                        // that a new scan is matched against
inline constexpr double least_move = 0.05, least_turn = 0.05;  // [m, rad] between the scans of a submap
inline constexpr double least_score = 0.3;                     // of a match against the last scans
inline constexpr double least_seen = 0.3;  // share of the points in view of other scans, or all are used
// The window of a match, and the deviation of its prior: what odometry may be off at rest and per metre or
// radian.
inline constexpr double window_rest = 0.15, window_share = 0.3;
inline constexpr double turn_rest = 0.12, turn_share = 0.4;
inline constexpr double prior_rest = 0.05, prior_share = 0.15;
// Where that finds nothing, the window is so much larger, and the score has to be better.
inline constexpr double wide_reach = 0.5, wide_turn = 0.6, least_wide_score = 0.5;
// Deviation of an odometry step that no scan confirms.
inline constexpr double blind_share = 0.15;
// Loops: the scans to either side of a candidate, and how far along the drive it must be.
inline constexpr int loop_scans = 12;
inline constexpr std::size_t loop_beams = 90;
inline constexpr int loop_gap = 60;       // scans of submaps: nearer ones repeat the matches of the drive
inline constexpr int pass_gap = 30;       // between two passes of one place
inline constexpr double loop_step = 0.3;  // [m or rad] from one search of loops to the next
inline constexpr double loop_reach = 2.5, loop_turn = 0.45;     // the window [m, rad]
inline constexpr double least_radius = 1.0, most_radius = 3.0;  // of the search for candidates [m]
inline constexpr double radius_deviations = 3;
inline constexpr double least_loop_score = 0.65;
// After a drive without loops the search is as wide as its drift, less often, and asks for more.
inline constexpr double widest_reach = 12, widest_turn = 1;  // [m, rad]
inline constexpr double wide_step = 1.5;                     // [m or rad]
inline constexpr double least_far_score = 0.75;
inline constexpr double consistent_square =
    21.1;                                  // the quantile of 99.99 % of χ² with three degrees of freedom
inline constexpr int fewest_agreeing = 2;  // loops before any of them counts
inline constexpr int fewest_far = 3;       // the same, of loops of wide searches alone
inline constexpr int optimize_gap = 10;    // scans between two optimizations
inline constexpr int optimize_steps = 3;
inline constexpr double loop_scaling = 9;  // φ of dynamic covariance scaling while driving

}  // namespace slam

template <class Kernels, class Fronts>
class LaserSlam {
  public:
    using Pose = PlanarSpace::Pose;

    // points: in base, of all scans; first (n + 1): where those of each scan begin. steps (n − 1): the
    // odometry between scans as twists.
    LaserSlam(std::vector<Point> points, std::vector<std::int32_t> first,
              std::vector<PlanarSpace::Twist> steps, const SlamOptions& options)
        : points_(std::move(points)),
          first_(std::move(first)),
          steps_(std::move(steps)),
          options_(options),
          stamp_(options.resolution, options.sigma) {
        if (scans() == 0) return;
        poses_.push_back({}), matched_.push_back({});
        chain_.add_pose({}, {});
        keep_scan(0);
    }

    int scans() const { return int(first_.size()) - 1; }
    int done() const { return int(poses_.size()); }
    // Works on so many scans more; false when all are done.
    bool advance(int count) {
        for (; count > 0 && done() < scans(); --count) {
            match_next();
            if (options_.finds_loops) search_loops(done() - 1);
            poll_interrupts();
        }
        if (done() < scans()) return true;
        if (has_news_) optimize();
        return false;
    }

    const std::vector<Pose>& poses() const { return poses_; }
    const std::vector<Pose>& matched() const { return matched_; }
    const std::vector<ScanEdge>& edges() const { return edges_; }
    const std::vector<ScanEdge>& loops() const { return loops_; }
    std::vector<LoopVerdict> verdicts() const {
        std::vector<LoopVerdict> found;
        for (std::size_t k = 0; k < loops_.size(); ++k)
            found.push_back(faults_[k] != LoopVerdict::accepted ? faults_[k]
                            : is_used_[k]                       ? LoopVerdict::accepted
                            : supporters(k)                     ? LoopVerdict::inconsistent
                                                                : LoopVerdict::alone);
        return found;
    }
    int tried() const { return tried_; }
    int optimizations() const { return optimizations_; }

  private:
    std::span<const Point> scan(int k) const {
        const auto from = std::size_t(first_[std::size_t(k)]), to = std::size_t(first_[std::size_t(k) + 1]);
        return std::span(points_).subspan(from, to - from);
    }
    void keep_scan(int k) { kept_.push_back(k), moved_ = turned_ = 0; }

    // A field of kept scans, where the points of a scan may lie within a window about a pose.
    void lay_field(std::span<const Point> points, const Pose& guess, const SearchWindow& window,
                   std::size_t begin, std::size_t end) {
        Box box{{guess.x, guess.y}, {guess.x, guess.y}};
        double far = 0;
        for (const Point p : points) box.include(place_point(guess, p)), far = std::max(far, norm(p));
        const double margin = window.reach + window.turn * far + options_.resolution;
        placed_.clear();
        for (std::size_t k = begin; k < end; ++k) {
            const Pose& pose = poses_[std::size_t(kept_[k])];
            for (const Point p : scan(kept_[k])) placed_.push_back(place_point(pose, p));
        }
        const Box marks = placed_.empty() ? box : bounds_of(placed_);
        const double bell = (stamp_.radius() + 1) * options_.resolution;
        const Point low = box.low - Point{margin, margin}, high = box.high + Point{margin, margin};
        box.low = {std::max(low.x, marks.low.x - bell), std::max(low.y, marks.low.y - bell)};
        box.high = {std::min(high.x, marks.high.x + bell), std::min(high.y, marks.high.y + bell)};
        clear_field(field_, box, options_.resolution);
        for (const Point p : placed_) stamp_.stamp_point(field_, p);
        poll_interrupts();
    }

    // The points of a scan at a pose that lie in the field of view of one of the kept scans from `begin` to
    // `end`, the newest one first; all of them where these are few.
    std::span<const Point> choose_seen(std::span<const Point> points, const Pose& pose, std::size_t begin,
                                       std::size_t end) {
        if (options_.view.is_whole()) return points;
        seen_.clear();
        for (const Point p : points) {
            const Point place = place_point(pose, p);
            bool is_seen = false;
            for (std::size_t k = end; k > begin && !is_seen; --k)
                is_seen = options_.view.contains(poses_[std::size_t(kept_[k - 1])], place);
            if (is_seen) seen_.push_back(p);
        }
        const bool are_few = double(seen_.size()) < slam::least_seen * double(points.size());
        return are_few ? points : std::span<const Point>(seen_);
    }
    // Whether a scan fits near the guess nearly as well as at a peak apart from it, by the points that lie in
    // view at each. By all points a peak may be that place alone where most of them meet the map.
    bool is_rivalled(std::span<const Point> points, const Pose& guess, const Pose& peak, std::size_t begin,
                     std::size_t end) {
        if (std::hypot(peak.x - guess.x, peak.y - guess.y) <= 2 * search::apart) return false;
        const double best = measure_score(field_, choose_seen(points, peak, begin, end), peak);
        const SearchPeak near = search_.find_peak(field_, choose_seen(points, guess, begin, end), guess,
                                                  {search::apart, search::apart_turn});
        return near.is_found && !near.is_clipped && near.score >= search::ambiguous_share * best;
    }

    void match_next() {
        const int k = done();
        const PlanarSpace::Twist& step = steps_[std::size_t(k) - 1];
        const double length = std::hypot(step[0], step[1]), turn = std::fabs(step[2]);
        const Pose guess = PlanarSpace::move(poses_.back(), step.data());
        const SearchWindow window{slam::window_rest + slam::window_share * length,
                                  slam::turn_rest + slam::turn_share * turn};
        const double place = slam::prior_rest + slam::prior_share * length;
        const double heading = slam::prior_rest + slam::prior_share * turn;
        const std::size_t begin = kept_.size() - std::min(kept_.size(), std::size_t(slam::submap_scans));
        const std::span<const Point> seen = choose_seen(scan(k), guess, begin, kept_.size());
        // Fewer points are fewer independent beams beside the prior.
        const double share =
            double(std::max(seen.size(), std::size_t(1))) / double(std::max(scan(k).size(), std::size_t(1)));
        const double weight = 1 / (2 * search::independent_beams * share);
        lay_field(scan(k), guess, window, begin, kept_.size());
        SearchPeak peak =
            search_.find_peak(field_, seen, guess, window,
                              {weight / (place * place), weight / (heading * heading)}, slam::least_score);
        if (!peak.is_found) {  // did the wheels slip?
            const SearchWindow wide{window.reach + slam::wide_reach, window.turn + slam::wide_turn};
            lay_field(scan(k), guess, wide, begin, kept_.size());
            const SearchPeak other =
                search_.find_peak(field_, scan(k), guess, wide, {}, slam::least_wide_score);
            if (other.is_found && !other.is_ambiguous) peak = other;
        }
        ScanEdge edge{k - 1, k, {}, {}, 0, 0};
        Pose pose = guess;
        if (peak.is_found) {
            pose = refine_pose(field_, choose_seen(scan(k), peak.pose, begin, kept_.size()), peak.pose);
            edge.covariance = peak.covariance, edge.score = peak.score, edge.second = peak.second;
        } else {
            const double x = slam::prior_rest + slam::blind_share * length;
            const double t = slam::prior_rest + slam::blind_share * turn;
            edge.covariance = {x * x, 0, 0, 0, x * x, 0, 0, 0, t * t};
        }
        edge.z = PlanarSpace::between(poses_.back(), pose);
        edges_.push_back(edge);
        const auto log = PlanarSpace::logarithm(edge.z);
        matched_.push_back(PlanarSpace::move(matched_.back(), log.data()));
        chain_.add_pose(matched_.back(), edge.covariance);
        poses_.push_back(pose);
        const double moved = std::hypot(edge.z.x, edge.z.y), turned = std::fabs(log[2]);
        moved_ += moved, turned_ += turned, since_search_ += moved + turned;
        if (moved_ >= slam::least_move || turned_ >= slam::least_turn) keep_scan(k);
    }

    // How loops are searched at a scan.
    struct LoopSearch {
        double radius;  // the largest about the scan in which others are tried [m]
        SearchWindow window;
        double least_score;
        bool is_far;
    };
    LoopSearch plan_search(int k) const {
        const PlanarSquare M = chain_.stretch(last_loop_, k, chain_.pose(k));
        const double drift = slam::radius_deviations * longest_deviation(M);
        if (drift <= slam::loop_reach || since_far_ < slam::wide_step)
            return {slam::most_radius, {slam::loop_reach, slam::loop_turn}, slam::least_loop_score, false};
        const double reach = std::min(drift, slam::widest_reach);
        const double turn = slam::radius_deviations * std::sqrt(M[8]);
        return {reach,
                {reach, std::clamp(turn, slam::loop_turn, slam::widest_turn)},
                slam::least_far_score,
                true};
    }
    static double longest_deviation(const PlanarSquare& M) {
        const double mean = (M[0] + M[4]) / 2, half = std::hypot((M[0] - M[4]) / 2, M[1]);
        return std::sqrt(mean + half);
    }

    // The nearest kept scan of each earlier pass, as places among the kept ones.
    std::vector<std::size_t> find_candidates(int k, double most_radius) const {
        std::vector<std::size_t> nearest;
        if (kept_.size() <= slam::loop_gap) return nearest;
        const Pose& here = poses_[std::size_t(k)];
        double least = 0;
        std::size_t last = 0;
        for (std::size_t c = 0; c < kept_.size() - slam::loop_gap; ++c) {
            const Pose& there = poses_[std::size_t(kept_[c])];
            const double d = std::hypot(there.x - here.x, there.y - here.y);
            if (d > most_radius || d > radius_of(kept_[c], k)) continue;
            if (nearest.empty() || c - last > slam::pass_gap) {
                nearest.push_back(c), least = d;
            } else if (d < least) {
                nearest.back() = c, least = d;
            }
            last = c;
        }
        return nearest;
    }
    double radius_of(int from, int to) const {
        const PlanarSquare M = chain_.stretch(from, to, chain_.pose(to));
        return std::max(slam::radius_deviations * longest_deviation(M), slam::least_radius);
    }

    void search_loops(int k) {
        if (kept_.back() != k || since_search_ < slam::loop_step) return;
        since_far_ += since_search_, since_search_ = 0;
        thin_points(scan(k), slam::loop_beams, thin_);
        const LoopSearch plan = plan_search(k);
        const SearchWindow& window = plan.window;
        if (plan.is_far) since_far_ = 0;
        for (std::size_t c : find_candidates(k, plan.radius)) {
            ++tried_;
            const std::size_t begin = c - std::min(c, std::size_t(slam::loop_scans));
            const std::size_t end =
                std::min(kept_.size() - slam::loop_gap, c + std::size_t(slam::loop_scans) + 1);
            const Pose& guess = poses_[std::size_t(k)];
            lay_field(thin_, guess, window, begin, end);
            const SearchPeak peak = search_.find_peak(field_, thin_, guess, window, {}, plan.least_score);
            if (!peak.is_found) continue;
            const Pose pose = refine_pose(field_, scan(k), peak.pose);
            const int from = kept_[c];
            const bool is_ambiguous = peak.is_ambiguous || is_rivalled(thin_, guess, peak.pose, begin, end);
            add_loop({from, k, PlanarSpace::between(poses_[std::size_t(from)], pose), peak.covariance,
                      peak.score, peak.second},
                     peak.is_clipped ? LoopVerdict::clipped
                     : is_ambiguous  ? LoopVerdict::ambiguous
                                     : LoopVerdict::accepted,
                     plan.is_far);
        }
        if (has_news_ && k - last_optimized_ >= slam::optimize_gap) optimize();
    }
    // fault: of its match alone.
    void add_loop(const ScanEdge& loop, LoopVerdict fault, bool is_far) {
        const int node = agreement_.size();
        loops_.push_back(loop), faults_.push_back(fault), is_far_.push_back(is_far), is_used_.push_back(0);
        agreement_.add_node();
        if (fault != LoopVerdict::accepted) return;
        const ClosedLoop made{loop.from, loop.to, loop.z, loop.covariance};
        for (int other = 0; other < node; ++other) {
            const ScanEdge& there = loops_[std::size_t(other)];
            if (faults_[std::size_t(other)] != LoopVerdict::accepted) continue;
            const double error = chain_.cycle_error(made, {there.from, there.to, there.z, there.covariance});
            if (error <= slam::consistent_square) agreement_.join(node, other);
        }
        has_news_ = true;
    }
    int supporters(std::size_t k) const {
        int count = 0;
        for (int other = 0; other < agreement_.size(); ++other) count += agreement_.are_joined(int(k), other);
        return count;
    }

    void optimize() {
        has_news_ = false, last_optimized_ = done() - 1;
        std::vector<char> clique = agreement_.find_clique();
        int all = 0, far = 0;
        for (std::size_t k = 0; k < clique.size(); ++k) all += clique[k], far += clique[k] && is_far_[k];
        if (all < (far == all ? slam::fewest_far : slam::fewest_agreeing)) return;
        is_used_.assign(clique.begin(), clique.end());
        for (std::size_t k = 0; k < clique.size(); ++k)
            if (clique[k]) last_loop_ = std::max(last_loop_, loops_[k].to);
        PoseGraph<PlanarSpace> graph;
        graph.start.poses = poses_;
        const auto add = [&](const ScanEdge& edge, bool is_trusted) {
            graph.edges.push_back({edge.from, edge.to, edge.z, inverse_covariance(edge.covariance)});
            graph.is_trusted.push_back(is_trusted);
        };
        for (const ScanEdge& edge : edges_) add(edge, true);
        for (std::size_t k = 0; k < loops_.size(); ++k)
            if (is_used_[k]) add(loops_[k], false);
        graph.is_held.assign(poses_.size(), 0), graph.is_held[0] = 1;
        GraphOptimizer<PlanarSpace, Fronts> optimizer(graph, {});
        optimizer.use_factors(std::vector<char>(graph.factors(), 1));
        optimizer.weights().kernel = RobustKernel::dcs;
        optimizer.weights().width = slam::loop_scaling;
        GraphState<PlanarSpace> state = graph.start;
        for (int step = 0; step < slam::optimize_steps; ++step)
            if (optimizer.take_step(state) < options_.resolution / full_score) break;
        poses_ = state.poses;
        ++optimizations_;
    }

    std::vector<Point> points_;
    std::vector<std::int32_t> first_;
    std::vector<PlanarSpace::Twist> steps_;
    SlamOptions options_;
    PointStamp stamp_;
    maps::ByteField field_;
    CorrelativeSearch<Kernels> search_;
    std::vector<Pose> poses_, matched_;
    std::vector<int> kept_;
    std::vector<ScanEdge> edges_, loops_;
    std::vector<LoopVerdict> faults_;
    std::vector<char> is_used_, is_far_;
    std::vector<Point> thin_, placed_, seen_;
    LoopConsistency chain_;
    AgreementGraph agreement_;
    double moved_ = 0, turned_ = 0, since_search_ = 0, since_far_ = 0;
    int tried_ = 0, optimizations_ = 0, last_optimized_ = 0, last_loop_ = 0;
    bool has_news_ = false;
};

}  // namespace cspace::localization
