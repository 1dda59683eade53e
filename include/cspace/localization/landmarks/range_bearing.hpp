// A sensor of ranges and bearings of landmarks: what it reads, and the derivatives in the axes of the map.
//
// Errors of a state are in axes of the map: δp and δθ of the pose, δl of a landmark. A landmark at h in the
// frame of the sensor then moves by M (δl − δp − J(l − p) δθ), with M the turn from the map to the sensor and
// J a quarter turn.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/localization/landmarks/options.hpp"

namespace cspace::localization {

using Vector2 = std::array<double, 2>;
using Matrix2 = std::array<double, 4>;  // row by row

// The turn and the position of the sensor in the map.
struct SensorPose {
    double x, y, c, s;
    Vector2 see(Vector2 point) const {
        const double dx = point[0] - x, dy = point[1] - y;
        return {c * dx + s * dy, c * dy - s * dx};
    }
    Vector2 place(Vector2 seen) const {
        return {x + c * seen[0] - s * seen[1], y + s * seen[0] + c * seen[1]};
    }
};
inline SensorPose place_mounted(const PlanarSpace::Pose& base, const PlanarSpace::Pose& mount) {
    const PlanarSpace::Pose at = PlanarSpace::compose(base, mount);
    return {at.x, at.y, at.c, at.s};
}
inline SensorPose place_sensor(const PlanarSpace::Pose& base, const std::array<double, 3>& mount) {
    return place_mounted(base, PlanarSpace::read_pose(mount.data()));
}

inline constexpr double log_turn = 1.8378770664093453;  // log 2π

// Density and gain of one reading: the inverse of S, νᵀ S⁻¹ ν, det S.
struct WeighedInnovation {
    Matrix2 inverse{};
    double nis = 0, determinant = 0;
    int count = 0;
    bool is_regular = false;

    // log N(ν; 0, S).
    double log_density() const { return -0.5 * (nis + std::log(determinant) + count * log_turn); }
};
inline WeighedInnovation weigh_innovation(const Vector2& v, const Matrix2& S, int count) {
    WeighedInnovation found;
    found.count = count;
    double& determinant = found.determinant = S[0];
    if (count == 2) {
        determinant = S[0] * S[3] - S[1] * S[2];
        found.inverse = {S[3] / determinant, -S[1] / determinant, -S[2] / determinant, S[0] / determinant};
    } else {
        found.inverse = {1 / S[0], 0, 0, 0};
    }
    found.is_regular = determinant > 0;
    found.nis = v[0] * v[0] * found.inverse[0] + v[0] * v[1] * (found.inverse[1] + found.inverse[2]) +
                v[1] * v[1] * found.inverse[3];
    return found;
}

inline constexpr double closest_landmark = 1e-3;  // [m]: nearer ones have the derivative that they have there

// Range and bearing of a point in the frame of the sensor, and their derivatives by it.
inline Vector2 predict_reading(Vector2 h) {
    return {std::sqrt(h[0] * h[0] + h[1] * h[1]), std::atan2(h[1], h[0])};
}
inline Matrix2 differentiate_reading(Vector2 h) {
    const double square = std::max(h[0] * h[0] + h[1] * h[1], closest_landmark * closest_landmark);
    const double range = std::sqrt(square);
    return {h[0] / range, h[1] / range, -h[1] / square, h[0] / square};
}

// The numbers of a reading that count, biases taken off.
struct MeasuredNumbers {
    Vector2 value{};
    int count = 0;                  // 1 or 2
    bool first_is_bearing = false;  // of one number
};
inline MeasuredNumbers read_numbers(const LandmarkReading& reading, const RangeBearingSensor& sensor) {
    MeasuredNumbers numbers;
    if (!std::isnan(reading.range))
        numbers.value[std::size_t(numbers.count++)] = reading.range - sensor.range_bias;
    if (!std::isnan(reading.bearing)) {
        numbers.first_is_bearing = numbers.count == 0;
        numbers.value[std::size_t(numbers.count++)] = reading.bearing - sensor.bearing_bias;
    }
    return numbers;
}
inline bool is_bearing(const MeasuredNumbers& numbers, int row) {
    return row == 1 || numbers.first_is_bearing;
}
inline double variance_of(const RangeBearingSensor& sensor, bool bearing) {
    const double sigma = bearing ? sensor.bearing_sigma : sensor.range_sigma;
    return sigma * sigma;
}

// Derivatives of the numbers of a reading: by the landmark (A), by the position (−A), by the heading (turn).
struct ReadingModel {
    int count = 0;
    Vector2 innovation{};  // measured less predicted
    Matrix2 A{};           // a row per number
    Vector2 turn{};
    Vector2 noise{};  // variances
};
// arm: from the position to the landmark, where the heading is linearised.
inline ReadingModel model_reading(const MeasuredNumbers& numbers, const RangeBearingSensor& sensor,
                                  const SensorPose& at, Vector2 landmark, Vector2 arm) {
    const Vector2 h = at.see(landmark), predicted = predict_reading(h);
    const Matrix2 G = differentiate_reading(h);
    ReadingModel model;
    model.count = numbers.count;
    for (int k = 0; k < numbers.count; ++k) {
        const bool bearing = is_bearing(numbers, k);
        const std::size_t g = bearing ? 2 : 0, row = std::size_t(k);
        double* A = model.A.data() + 2 * k;
        A[0] = G[g] * at.c - G[g + 1] * at.s, A[1] = G[g] * at.s + G[g + 1] * at.c;
        model.turn[row] = A[0] * arm[1] - A[1] * arm[0];  // −A J arm
        const double difference = numbers.value[row] - predicted[bearing];
        model.innovation[row] = bearing ? wrap_angle(difference) : difference;
        model.noise[row] = variance_of(sensor, bearing);
    }
    return model;
}

// Whether the sensor would see a landmark there.
inline bool is_in_view(const RangeBearingSensor& sensor, Vector2 seen) {
    const Vector2 reading = predict_reading(seen);
    return reading[0] <= sensor.most_range && std::fabs(reading[1]) <= sensor.half_view;
}

// A symmetric 2 × 2 matrix as xx, xy, yy.
using Symmetric2 = std::array<double, 3>;

// Where a reading of both numbers puts a landmark as seen from the sensor, and its covariance in axes of the
// map.
inline Vector2 locate_landmark(const MeasuredNumbers& numbers) {
    return {numbers.value[0] * std::cos(numbers.value[1]), numbers.value[0] * std::sin(numbers.value[1])};
}
inline Symmetric2 locate_covariance(const MeasuredNumbers& numbers, const RangeBearingSensor& sensor,
                                    const SensorPose& at) {
    const double range = std::max(numbers.value[0], closest_landmark), bearing = numbers.value[1];
    const double c = at.c * std::cos(bearing) - at.s * std::sin(bearing);
    const double s = at.s * std::cos(bearing) + at.c * std::sin(bearing);
    const double along = variance_of(sensor, false), across = range * range * variance_of(sensor, true);
    return {c * c * along + s * s * across, c * s * (along - across), s * s * along + c * c * across};
}

}  // namespace cspace::localization
