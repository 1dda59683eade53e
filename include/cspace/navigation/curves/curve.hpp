// Curves for cars: arcs of one radius and straight pieces, driven forwards or backwards.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "cspace/math/wrapping.hpp"
#include "cspace/mobile/car_pose.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

using mobile::CarPose;

// A piece of a curve in units of its radius; a negative length is driven backwards.
struct Piece {
    int turn;  // +1 to the left, 0 straight on, −1 to the right, as seen when driving forwards
    double length;

    bool continues(const Piece& last) const { return turn == last.turn && (length < 0) == (last.length < 0); }
};

struct Curve {
    static constexpr int most = 5;
    int count = 0;
    Piece piece[most];

    // A piece too short to move the car is omitted, and one that continues the last is merged with it.
    void add(int turn, double length, double nothing) {
        if (std::fabs(length) <= nothing) return;
        if (count > 0 && Piece{turn, length}.continues(piece[count - 1]))
            piece[count - 1].length += length;
        else
            piece[count++] = {turn, length};
    }
    double length() const {
        double sum = 0;
        for (int i = 0; i < count; ++i) sum += std::fabs(piece[i].length);
        return sum;
    }
};

// What hybrid A* answers, and why.
enum class HybridReason : std::int8_t { found, no_gap, exhausted, budget };
struct CarRoute {
    Status status = Status::undetermined;
    HybridReason reason = HybridReason::exhausted;
    std::vector<Piece> pieces;
    Stats stats;
};

// The pose after a piece driven with a turning radius: a chord at half the turn.
inline CarPose drive_piece(const CarPose& from, const Piece& piece, double radius) {
    const double half = 0.5 * piece.turn * piece.length;
    const double chord = piece.turn == 0 ? piece.length : 2 * piece.turn * std::sin(half);
    const double along = from.theta + half;
    return {from.x + radius * chord * std::cos(along), from.y + radius * chord * std::sin(along),
            from.theta + 2 * half};
}

// A goal seen from a start with lengths in turning radii, and the ways between the circles of both: from the
// left or right circle of the start to the left or right one of the goal.
struct Task {
    struct Way {
        double length, angle;
    };
    double turn;      // from the heading of the start to that of the goal, in [−π, π]
    double distance;  // from start to goal
    Way way[2][2];    // [0 left, 1 right of the start][0 left, 1 right of the goal]
    double slack;     // what the rounding of the coordinates can amount to
};

inline Task task_between(const CarPose& start, const CarPose& goal, double radius) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double dx = (goal.x - start.x) / radius, dy = (goal.y - start.y) / radius;
    const double c = std::cos(start.theta), s = std::sin(start.theta);
    const double x = dx * c + dy * s, y = dy * c - dx * s;
    Task task;
    task.turn = wrap_angle(goal.theta - start.theta);
    task.distance = std::sqrt(x * x + y * y);
    const double far = std::max(std::max(std::fabs(start.x), std::fabs(start.y)),
                                std::max(std::fabs(goal.x), std::fabs(goal.y)));
    task.slack = 8 * epsilon * (4 + far / radius);
    const double ct = std::cos(task.turn), st = std::sin(task.turn);
    for (int from = 0; from < 2; ++from)
        for (int to = 0; to < 2; ++to) {
            const double a = to == 0 ? 1 : -1, b = from == 0 ? 1 : -1;
            const double wx = x - a * st, wy = y + a * ct - b;
            task.way[from][to] = {std::sqrt(wx * wx + wy * wy), std::atan2(wy, wx)};
        }
    return task;
}

// Poses along a curve for cars.

// A curve of any number of pieces, laid from a pose.
class LaidCurve {
  public:
    LaidCurve(const CarPose& start, std::vector<Piece> pieces, double radius)
        : pieces_(std::move(pieces)), radius_(radius), pose_{start}, s_{0} {
        for (const Piece& piece : pieces_) {
            pose_.push_back(drive_piece(pose_.back(), piece, radius));
            s_.push_back(s_.back() + std::fabs(piece.length));
        }
    }
    // The pose after a length s, in turning radii; beyond an end that of the end.
    CarPose at(double s) const {
        if (s >= s_.back()) return pose_.back();
        const auto after = std::upper_bound(s_.begin() + 1, s_.end(), s);
        const std::size_t k = std::size_t(after - s_.begin()) - 1;
        const Piece& piece = pieces_[k];
        return drive_piece(pose_[k], {piece.turn, std::copysign(std::max(s - s_[k], 0.0), piece.length)},
                           radius_);
    }

  private:
    std::vector<Piece> pieces_;
    double radius_;
    std::vector<CarPose> pose_;  // where each piece begins, and the end
    std::vector<double> s_;
};

}  // namespace cspace::navigation
