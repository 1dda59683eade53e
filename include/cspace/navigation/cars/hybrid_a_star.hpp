// Hybrid A* (Dolgov, Thrun, Montemerlo & Diebel 2010): best-first search over poses that a car can drive to,
// one kept for each box of a lattice of places and headings, so that every way found is one of arcs. From
// time to time a Dubins or Reeds–Shepp curve to the goal is tried; at the end, such curves cut corners.
#pragma once

#include <limits>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "cspace/maps/grid_inflation.hpp"
#include "cspace/navigation/cars/car_world.hpp"
#include "cspace/navigation/curves/dubins.hpp"
#include "cspace/navigation/curves/reeds_shepp.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// How far a disc would have to go that covers no more than the vehicle does: a bound from below for the
// vehicle with its turning circle, and where even the disc cannot pass, a proof.

class HolonomicDistance {
  public:
    // The disc is the largest in the vehicle; its centre passes through cells alone of which some part is far
    // enough from everything blocked, from a cell to one of the eight around it. turn: of the vehicle's
    // circle [m].
    HolonomicDistance(const CarWorld& world, const Footprint& body, double turn, const CarPose& goal)
        : grid_(closed(world, body)),
          frame_(world.frame()),
          middle_(body.middle()),
          farther_(std::hypot(1.0, body.middle() / turn)),
          length_(grid_.numbers(), none) {
        search::Heap<search::Waiting> queue;
        const maps::Cell from = cell_of(goal);
        if (grid_.blocked(from)) return;
        length_[grid_.number(from)] = 0;
        queue.push({0, 0, grid_.number(from)});
        while (!queue.empty()) {
            const search::Waiting next = queue.pop();
            if (float(next.priority) > length_[next.node]) continue;
            spread(next.node, queue);
        }
    }

    bool reaches(const CarPose& pose) const { return length_[grid_.number(cell_of(pose))] < none; }

    // No path of the disc from here is shorter [m]: one that is straight within each cell is at most 8 %
    // longer than the free one, and at most two cells are lost at its ends.
    double at_least(const CarPose& pose) const {
        const float cells = length_[grid_.number(cell_of(pose))];
        return cells < none ? frame_.resolution * std::max(0.0, (double(cells) - 2 * std::numbers::sqrt2) /
                                                                    (detour * farther_))
                            : std::numeric_limits<double>::infinity();
    }

  private:
    static constexpr std::size_t most_parts = std::size_t(1) << 24;
    static constexpr float none = std::numeric_limits<float>::infinity();
    static constexpr double detour = 1.0823922002923938;  // 1 / cos(π / 8)

    // Cells are cut into k × k parts, as many as a limit on their number allows; all points of a part lie
    // within half a diagonal of its centre.
    static maps::BitGrid closed(const CarWorld& world, const Footprint& body) {
        const maps::BitGrid& grid = world.grid();
        const std::size_t cells = std::size_t(grid.rows()) * std::size_t(grid.columns());
        const int k = cells * 16 <= most_parts ? 4 : cells * 4 <= most_parts ? 2 : 1;
        const double radius = k * body.inner_radius() / world.frame().resolution - 0.5 * std::numbers::sqrt2;
        if (radius <= 0) return grid;
        const maps::BitGrid parts = maps::inflate_grid(cut(grid, k), radius, true);
        maps::BitGrid open(grid.rows(), grid.columns());
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column)
                if (grid.blocked(row, column) || !has_open_part(parts, k, row, column))
                    open.set(row, column, true);
        return open;
    }
    static maps::BitGrid cut(const maps::BitGrid& grid, int k) {
        maps::BitGrid parts(k * grid.rows(), k * grid.columns());
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column) {
                if (!grid.blocked(row, column)) continue;
                for (int i = 0; i < k; ++i)
                    for (int j = 0; j < k; ++j) parts.set(k * row + i, k * column + j, true);
            }
        return parts;
    }
    static bool has_open_part(const maps::BitGrid& parts, int k, int row, int column) {
        for (int i = 0; i < k; ++i)
            for (int j = 0; j < k; ++j)
                if (!parts.blocked(k * row + i, k * column + j)) return true;
        return false;
    }
    maps::Cell cell_of(const CarPose& pose) const {
        return frame_.nearest_cell(
            grid_, {pose.x + middle_ * std::cos(pose.theta), pose.y + middle_ * std::sin(pose.theta)});
    }
    void spread(std::uint32_t node, search::Heap<search::Waiting>& queue) {
        const maps::Cell at = grid_.cell(node);
        for (int dr = -1; dr <= 1; ++dr)
            for (int dc = -1; dc <= 1; ++dc) {
                const maps::Cell next{at.row + dr, at.column + dc};
                if ((dr == 0 && dc == 0) || grid_.blocked(next)) continue;
                const float length = length_[node] + (dr && dc ? std::numbers::sqrt2_v<float> : 1.0f);
                float& known = length_[grid_.number(next)];
                if (length < known) known = length, queue.push({length, 0, grid_.number(next)});
            }
    }

    maps::BitGrid grid_;
    maps::GridFrame frame_;
    double middle_, farther_;
    std::vector<float> length_;
};

struct HybridSettings {
    double radius;        // smallest turning radius [m]
    bool reverses;        // whether the car drives backwards
    double box;           // side of a box of the lattice [m]
    int headings;         // of the lattice
    double reverse_cost;  // of a metre driven backwards; forwards it is 1
    double gear_cost;     // of a change of direction [m]
    std::int64_t most;    // poses settled before giving up
    double weight;        // of what is left beside what is driven
};

class HybridAStar {
  public:
    HybridAStar(const CarWorld& world, const Footprint& body, const CarPose& start, const CarPose& goal,
                const HybridSettings& settings)
        : world_(world),
          body_(body),
          goal_(goal),
          set_(settings),
          ahead_(world, body, settings.radius, goal) {
        step_ = std::max(1.5 * set_.box / set_.radius, 2 * std::numbers::pi / set_.headings);
        nodes_.push_back({start, -1, {0, 0}, 0, false});
    }

    CarRoute find() {
        CarRoute route;
        if (!ahead_.reaches(nodes_[0].pose)) {
            route.status = Status::unreachable;
            route.reason = HybridReason::no_gap;
            return route;
        }
        search::Heap<search::Waiting> queue;
        search::Effort effort;
        queue.push({left(nodes_[0].pose), 0, 0});
        best_[key(nodes_[0].pose)] = 0;
        const std::uint32_t last = search::best_first(*this, queue, effort);
        route.stats = {std::int64_t(effort.settled), edges_};
        route.reason = last == search::no_node ? HybridReason::exhausted
                       : arrives_              ? HybridReason::found
                                               : HybridReason::budget;
        if (arrives_) {
            route.status = Status::found;
            for (std::uint32_t k = last; nodes_[k].parent >= 0; k = std::uint32_t(nodes_[k].parent))
                route.pieces.push_back(nodes_[k].piece);
            std::reverse(route.pieces.begin(), route.pieces.end());
            route.pieces.insert(route.pieces.end(), end_.piece, end_.piece + end_.count);
            cut_corners(route.pieces);
        }
        return route;
    }

    // The space of best_first.
    bool settle(std::uint32_t node) {
        if (nodes_[node].settled || best_[key(nodes_[node].pose)] != node) return false;
        ++settled_;
        return nodes_[node].settled = true;
    }
    // From time to time, and the oftener the nearer, a curve to the goal is tried.
    bool is_goal(std::uint32_t node) {
        if (--wait_ <= 0) {
            const CarPose& pose = nodes_[node].pose;
            end_ = curve(pose, goal_);
            arrives_ = is_clear(pose, end_);
            wait_ = left(pose) / (2 * set_.radius);
        }
        return arrives_ || settled_ > set_.most;
    }
    void expand(std::uint32_t node, search::Heap<search::Waiting>& queue) {
        for (const int turn : {0, 1, -1}) {
            try_piece(node, {turn, step_}, queue);
            if (set_.reverses) try_piece(node, {turn, -step_}, queue);
        }
    }

  private:
    struct Node {
        CarPose pose;
        std::int32_t parent;
        Piece piece;  // that led here
        double cost;  // to come here [m]
        bool settled;
    };

    void try_piece(std::uint32_t at, const Piece& piece, search::Heap<search::Waiting>& queue) {
        ++edges_;
        const Node from = nodes_[at];
        const CarPose pose = drive_piece(from.pose, piece, set_.radius);
        double cost = from.cost + cost_of(piece);
        if (from.parent >= 0 && (from.piece.length < 0) != (piece.length < 0)) cost += set_.gear_cost;
        const std::uint64_t box = key(pose);
        const auto known = best_.find(box);
        if (known != best_.end()) {
            const Node& other = nodes_[known->second];
            if (other.settled || other.cost <= cost + rounding) return;
        }
        const double more = left(pose);
        if (more == std::numeric_limits<double>::infinity()) return;
        if (!world_.is_way_clear(body_, from.pose, piece, set_.radius)) return;
        const std::uint32_t number = std::uint32_t(nodes_.size());
        nodes_.push_back({pose, std::int32_t(at), piece, cost, false});
        best_[box] = number;
        queue.push({cost + set_.weight * more, float(more), number});
    }

    double cost_of(const Piece& piece) const {
        return std::fabs(piece.length) * set_.radius * (piece.length < 0 ? set_.reverse_cost : 1);
    }

    // What is left at least: the way of a disc around obstacles, and the curve without them.
    double left(const CarPose& pose) const {
        const double free = set_.reverses ? reeds_shepp_distance(pose, goal_, set_.radius)
                                          : dubins_distance(pose, goal_, set_.radius);
        return std::max(free, ahead_.at_least(pose));
    }
    Curve curve(const CarPose& from, const CarPose& to) const {
        return set_.reverses ? reeds_shepp_curve(from, to, set_.radius) : dubins_curve(from, to, set_.radius);
    }
    bool is_clear(CarPose from, const Curve& way) const {
        for (int i = 0; i < way.count; ++i) {
            if (!world_.is_way_clear(body_, from, way.piece[i], set_.radius)) return false;
            from = drive_piece(from, way.piece[i], set_.radius);
        }
        return true;
    }
    // The box of a pose: of place and heading.
    std::uint64_t key(const CarPose& pose) const {
        const maps::GridFrame& frame = world_.frame();
        const double turn = 2 * std::numbers::pi, theta = wrap_above(pose.theta, 0);
        const auto x = std::uint64_t((pose.x - frame.origin.x) / set_.box + 1);
        const auto y = std::uint64_t((pose.y - frame.origin.y) / set_.box + 1);
        const auto h = std::uint64_t(theta / turn * set_.headings + 0.5) % std::uint64_t(set_.headings);
        return (x << 40 | y << 16) + h;
    }

    // Of every two poses of the way the farthest apart first: a cheaper curve without contact takes its
    // place.
    void cut_corners(std::vector<Piece>& pieces) const {
        std::vector<CarPose> pose{nodes_[0].pose};
        std::vector<double> cost{0};  // up to each pose, with a change of gear there
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            pose.push_back(drive_piece(pose.back(), pieces[k], set_.radius));
            const bool changes =
                k + 1 < pieces.size() && (pieces[k].length < 0) != (pieces[k + 1].length < 0);
            cost.push_back(cost.back() + cost_of(pieces[k]) + (changes ? set_.gear_cost : 0));
        }
        std::vector<Piece> made;
        CarPose here = pose[0];
        for (std::size_t at = 0; at + 1 < pose.size();) {
            Curve way;
            std::size_t to = pose.size() - 1;
            for (; to > at + 1; --to) {
                way = curve(here, pose[to]);
                if (cost_of(way) < cost[to] - cost[at] - rounding && is_clear(here, way)) break;
            }
            if (to == at + 1) {
                way = Curve{};
                way.piece[way.count++] = pieces[at];
            }
            for (int i = 0; i < way.count; ++i)
                join(made, way.piece[i]), here = drive_piece(here, way.piece[i], set_.radius);
            at = to;
        }
        pieces = std::move(made);
    }
    double cost_of(const Curve& way) const {
        double sum = 0;
        for (int i = 0; i < way.count; ++i) {
            sum += cost_of(way.piece[i]);
            if (i > 0 && (way.piece[i].length < 0) != (way.piece[i - 1].length < 0)) sum += set_.gear_cost;
        }
        return sum;
    }

    static void join(std::vector<Piece>& pieces, const Piece& next) {
        if (!pieces.empty() && next.continues(pieces.back()))
            pieces.back().length += next.length;
        else
            pieces.push_back(next);
    }

    static constexpr double rounding = 1e-9;  // [m]
    const CarWorld& world_;
    Footprint body_;
    CarPose goal_;
    HybridSettings set_;
    HolonomicDistance ahead_;
    double step_ = 0;  // of a piece, in turning radii
    double wait_ = 0;  // poses until the next curve to the goal is tried
    bool arrives_ = false;
    Curve end_;  // the last curve that was tried
    std::int64_t edges_ = 0, settled_ = 0;
    std::vector<Node> nodes_;
    std::unordered_map<std::uint64_t, std::uint32_t> best_;
};

}  // namespace cspace::navigation
