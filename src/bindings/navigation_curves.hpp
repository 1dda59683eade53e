// Poses of cars as the bindings take them.
#pragma once

#include <span>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/curves/curve.hpp"
#include "navigation_route.hpp"

using PoseRow = Array<const double, nanobind::shape<3>>;
using Poses = Array<const double, nanobind::shape<-1, 3>>;

inline cspace::navigation::CarPose pose_of(const PoseRow& row) {
    return {row.data()[0], row.data()[1], row.data()[2]};
}
inline std::span<const cspace::navigation::CarPose> poses_of(const Poses& rows) {
    return {reinterpret_cast<const cspace::navigation::CarPose*>(rows.data()), rows.shape(0)};
}
