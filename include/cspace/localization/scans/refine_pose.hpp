// The last centimetre of a scan match: Gauss–Newton on the field, interpolated between the centers of cells.
//
// Each point sees a bell f = exp(−d²/2σ²) of its distance d from a wall, with the curvature f/σ² across the
// wall. Steps of these curvatures are those of reweighted least squares with the weights f (Holland & Welsch
// 1977).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/localization/scans/scan_field.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::localization {

// A score from 0 to 1 and its derivatives by place [1/m].
struct FieldValue {
    double value = 0, dx = 0, dy = 0;
};

// Weights of four neighbours, and their derivatives (Catmull & Rom 1974): linear ones would draw every peak
// to the center of a cell.
struct CubicWeights {
    double value[4], slope[4];

    explicit CubicWeights(double t) {
        value[0] = t * (t * (1 - 0.5 * t) - 0.5), slope[0] = t * (2 - 1.5 * t) - 0.5;
        value[1] = t * t * (1.5 * t - 2.5) + 1, slope[1] = t * (4.5 * t - 5);
        value[2] = t * (t * (2 - 1.5 * t) + 0.5), slope[2] = t * (4 - 4.5 * t) + 0.5;
        value[3] = t * t * (0.5 * t - 0.5), slope[3] = t * (1.5 * t - 1);
    }
};

inline FieldValue interpolate_field(const maps::ByteField& field, Point p) {
    const double across = (p.x - field.frame.origin.x) / field.frame.resolution - 0.5;
    const double up = (p.y - field.frame.origin.y) / field.frame.resolution - 0.5;
    if (!(across >= 1 && up >= 1 && across < field.columns - 2 && up < field.rows - 2))
        return {double(field.outside) / full_score, 0, 0};
    const int column = int(across), row = int(up);
    const CubicWeights x(across - column), y(up - row);
    const std::uint8_t* at =
        field.scores.data() + std::size_t(row - 1) * std::size_t(field.columns) + std::size_t(column - 1);
    FieldValue sum;
    for (int k = 0; k < 4; ++k, at += field.columns) {
        const double a = at[0], b = at[1], c = at[2], d = at[3];
        const double value = a * x.value[0] + b * x.value[1] + c * x.value[2] + d * x.value[3];
        sum.value += y.value[k] * value, sum.dy += y.slope[k] * value;
        sum.dx += y.value[k] * (a * x.slope[0] + b * x.slope[1] + c * x.slope[2] + d * x.slope[3]);
    }
    constexpr double scale = 1.0 / full_score;
    const double slope = scale / field.frame.resolution;
    return {std::clamp(scale * sum.value, 0.0, 1.0), slope * sum.dx, slope * sum.dy};
}

// The mean score of a scan at a pose.
inline double measure_score(const maps::ByteField& field, std::span<const Point> points,
                            const PlanarSpace::Pose& pose) {
    double sum = 0;
    for (const Point p : points) sum += interpolate_field(field, place_point(pose, p)).value;
    return points.empty() ? 0 : sum / double(points.size());
}

namespace refine {

inline constexpr int most_steps = 12;
inline constexpr double small_step = 1e-5;                      // [m, rad]: a hundredth of a millimetre
inline constexpr double longest_step = 0.05, most_turn = 0.02;  // of one iteration [m], [rad]
// Of the curvature, for directions that no point measures [1/m², 1/rad² per point].
inline constexpr double damping = 0.1;
inline constexpr double least_slope = 1e-4;  // squared [1/m²]: flatter places have no direction
inline constexpr double steep_low = 0.2, steep_high = 0.9;  // scores between which the width of bells shows
inline constexpr int most_halvings = 4;                     // of a step that lowers the score
inline constexpr double most_shift = 0.15,
                        most_total_turn = 0.05;  // beyond them it has left its peak [m], [rad]

}  // namespace refine

// The derivatives of the sum of the scores by a twist of base, and a curvature that steps divide them by.
struct ScoreModel {
    double score = 0, g[3] = {}, H[3][3] = {};  // H: its upper triangle
};
inline ScoreModel model_score(const maps::ByteField& field, std::span<const Point> points,
                              const PlanarSpace::Pose& pose) {
    ScoreModel model;
    double slopes = 0, squares = 0;
    for (const Point p : points) {
        const FieldValue at = interpolate_field(field, place_point(pose, p));
        model.score += at.value;
        // In the frame of base, where a twist moves the point by v + ω × p.
        const double x = pose.c * at.dx + pose.s * at.dy, y = pose.c * at.dy - pose.s * at.dx;
        const double t = p.x * y - p.y * x, slope = x * x + y * y;
        if (!(slope > refine::least_slope)) continue;
        model.g[0] += x, model.g[1] += y, model.g[2] += t;
        const double w = at.value / slope;  // times the slope of the distance from the wall, of length 1
        model.H[0][0] += w * x * x, model.H[0][1] += w * x * y, model.H[0][2] += w * x * t;
        model.H[1][1] += w * y * y, model.H[1][2] += w * y * t, model.H[2][2] += w * t * t;
        if (at.value < refine::steep_low || at.value > refine::steep_high) continue;
        slopes += slope, squares += -2 * std::log(at.value) * at.value * at.value;
    }
    // |∇f|² = f² d²/σ⁴ with d²/σ² = −2 log f: 1/σ² from the points on the slopes of bells.
    const double cell = 1 / (field.frame.resolution * field.frame.resolution);
    const double curvature = squares > 0 ? slopes / squares : cell;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) model.H[i][j] *= curvature;
        model.H[i][i] += refine::damping * double(points.size());
    }
    return model;
}
// H⁻¹ g.
inline PlanarSpace::Twist solve_model(ScoreModel model) {
    PlanarSpace::Twist twist = {model.g[0], model.g[1], model.g[2]};
    solve_positive(model.H, 3, twist.data());
    const double length = std::hypot(twist[0], twist[1]);
    const double scale =
        std::max({1.0, length / refine::longest_step, std::fabs(twist[2]) / refine::most_turn});
    for (double& x : twist) x /= scale;
    return twist;
}

// The pose near a start where the points score most; the start where it would leave its peak.
inline PlanarSpace::Pose refine_pose(const maps::ByteField& field, std::span<const Point> points,
                                     const PlanarSpace::Pose& start) {
    PlanarSpace::Pose pose = start;
    ScoreModel model = model_score(field, points, pose);
    for (int step = 0; step < refine::most_steps; ++step) {
        PlanarSpace::Twist twist = solve_model(model);
        bool is_better = false;
        for (int halving = 0; halving < refine::most_halvings && !is_better; ++halving) {
            const PlanarSpace::Pose trial = PlanarSpace::move(pose, twist.data());
            const ScoreModel there = model_score(field, points, trial);
            is_better = there.score > model.score;
            if (is_better) pose = trial, model = there;
            if (!is_better)
                for (double& x : twist) x *= 0.5;
        }
        if (!is_better || std::hypot(twist[0], twist[1]) + std::fabs(twist[2]) < refine::small_step) break;
    }
    const PlanarSpace::Pose moved = PlanarSpace::between(start, pose);
    const bool has_left = std::hypot(moved.x, moved.y) > refine::most_shift ||
                          std::fabs(std::atan2(moved.s, moved.c)) > refine::most_total_turn;
    return has_left ? start : pose;
}

}  // namespace cspace::localization
