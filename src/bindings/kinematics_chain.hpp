// The chain to a frame of a robot.
#pragma once

#include <nanobind/nanobind.h>

#include "kinematics.hpp"

// Throws a ValueError for a frame that is not there.
inline const cspace::model::Chain& chain_on(nanobind::handle robot, int frame) {
    if (!PyObject_TypeCheck(robot.ptr(), kinematics_type))
        throw nanobind::type_error("the first argument must be a robot");
    const auto& model = reinterpret_cast<KinematicsObject*>(robot.ptr())->model;
    if (!model || frame < 0 || frame >= model->n_frames())
        throw nanobind::value_error("unknown frame number");
    return model->chain(frame);
}
