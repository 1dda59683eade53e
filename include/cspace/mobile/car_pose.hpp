// The pose of a vehicle of the plane.
#pragma once

namespace cspace::mobile {

// The pose of a car: the middle of its rear axle [m] and its heading [rad].
struct CarPose {
    double x, y, theta;
};

}  // namespace cspace::mobile
