// The last centimetre of the matches of a drive: Gauss–Newton on the field, linear between the centers of cells, with
// points far from walls weighted by their score.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/localization/scans/scan_field.hpp"

namespace cspace::localization {

// A score from 0 to 1 and its derivatives by place [1/m].
struct LinearValue {
    double value = 0, dx = 0, dy = 0;
};
inline LinearValue interpolate_linearly(const maps::ByteField& field, Point p) {
    const double across = (p.x - field.frame.origin.x) / field.frame.resolution - 0.5;
    const double up = (p.y - field.frame.origin.y) / field.frame.resolution - 0.5;
    if (!(across >= 0 && up >= 0 && across < field.columns - 1 && up < field.rows - 1))
        return {double(field.outside) / full_score, 0, 0};
    const int column = int(across), row = int(up);
    const double u = across - column, v = up - row;
    const std::uint8_t* at =
        field.scores.data() + std::size_t(row) * std::size_t(field.columns) + std::size_t(column);
    const double a = at[0], b = at[1], c = at[field.columns], d = at[field.columns + 1];
    constexpr double scale = 1.0 / full_score;
    const double slope = scale / field.frame.resolution;
    return {scale * ((1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d)),
            slope * ((1 - v) * (b - a) + v * (d - c)), slope * ((1 - u) * (c - a) + u * (d - b))};
}

namespace refine_linear {

inline constexpr int most_steps = 12;
inline constexpr double small_step = 1e-5;                      // [m, rad]: a hundredth of a millimetre
inline constexpr double longest_step = 0.05, most_turn = 0.02;  // of one iteration [m], [rad]
// Of the curvature, for directions that no point measures [1/m², 1/rad² per point].
inline constexpr double damping = 0.1;
inline constexpr double most_shift = 0.15,
                        most_total_turn = 0.05;  // beyond them it has left its peak [m], [rad]

}  // namespace refine_linear

// The pose near a start where the points score most; the start where it would leave its peak.
inline PlanarSpace::Pose refine_linearly(const maps::ByteField& field, std::span<const Point> points,
                                     const PlanarSpace::Pose& start) {
    PlanarSpace::Pose pose = start;
    for (int step = 0; step < refine_linear::most_steps; ++step) {
        double H[6] = {}, g[3] = {};  // xx, xy, xt, yy, yt, tt
        for (const Point p : points) {
            const LinearValue at = interpolate_linearly(field, place_point(pose, p));
            if (at.dx == 0 && at.dy == 0) continue;
            // In the frame of base, where a twist moves the point by v + ω × p.
            const double x = pose.c * at.dx + pose.s * at.dy, y = pose.c * at.dy - pose.s * at.dx;
            const double t = p.x * y - p.y * x, w = at.value, rest = w * (1 - at.value);
            g[0] += rest * x, g[1] += rest * y, g[2] += rest * t;
            H[0] += w * x * x, H[1] += w * x * y, H[2] += w * x * t;
            H[3] += w * y * y, H[4] += w * y * t, H[5] += w * t * t;
        }
        const double added = refine_linear::damping * double(points.size());
        H[0] += added, H[3] += added, H[5] += added;
        double twist[3];
        // LDLᵀ of three rows.
        const double a = H[1] / H[0], b = H[2] / H[0];
        const double d = H[3] - a * H[1], e = (H[4] - a * H[2]) / d;
        const double f = H[5] - b * H[2] - e * e * d;
        const double u = g[1] - a * g[0], v = g[2] - b * g[0] - e * u;
        twist[2] = v / f, twist[1] = u / d - e * twist[2];
        twist[0] = g[0] / H[0] - a * twist[1] - b * twist[2];
        const double length = std::hypot(twist[0], twist[1]);
        const double scale =
            std::max({1.0, length / refine_linear::longest_step, std::fabs(twist[2]) / refine_linear::most_turn});
        for (double& x : twist) x /= scale;
        pose = PlanarSpace::move(pose, twist);
        if (length + std::fabs(twist[2]) < refine_linear::small_step) break;
    }
    const PlanarSpace::Pose moved = PlanarSpace::between(start, pose);
    const bool has_left = std::hypot(moved.x, moved.y) > refine_linear::most_shift ||
                          std::fabs(std::atan2(moved.s, moved.c)) > refine_linear::most_total_turn;
    return has_left ? start : pose;
}

}  // namespace cspace::localization
