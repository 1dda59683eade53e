// The path to a frame of a robot, for numeric methods.
#pragma once

#include <nanobind/nanobind.h>

#include "cspace/ik/numeric/path.hpp"
#include "robot.hpp"

// A path with those coordinates alone that move the frame; coordinate j of the path is number[j] of the
// robot.
struct RobotPath {
    cspace::ik::Path path;
    int number[cspace::ik::max_joints];
    int coordinates;  // of the robot

    void gather(const double* of_robot, double* of_path) const {
        for (int j = 0; j < path.n; ++j) of_path[j] = of_robot[number[j]];
    }
    void scatter(const double* of_path, double* of_robot) const {
        for (int j = 0; j < path.n; ++j) of_robot[number[j]] = of_path[j];
    }
};

// The reduced path to a frame of a robot; throws a ValueError for a frame that is not there.
inline const cspace::Chain& chain_on(nanobind::handle robot, int frame) {
    if (!PyObject_TypeCheck(robot.ptr(), robot_type)) throw nanobind::type_error("a robot comes first");
    const auto& model = reinterpret_cast<RobotObject*>(robot.ptr())->model;
    if (!model || frame < 0 || frame >= model->n_frames()) throw nanobind::value_error("no such frame");
    return model->chain(frame);
}

// Throws a ValueError for a frame that is not there, or one moved by more joints than a path holds.
inline RobotPath path_on(nanobind::handle robot, int frame) {
    using namespace cspace;
    const Chain& chain = chain_on(robot, frame);
    if (chain.n > ik::max_path) throw nanobind::value_error("too many joints on the path");
    RobotPath on;
    on.coordinates = chain.n_coordinates;
    ik::Path& path = on.path;
    path.joints = chain.n;
    path.T_base_first = chain.T_base_first;
    path.cos_last = chain.cos_last;
    path.sin_last = chain.sin_last;
    for (int i = 0; i < chain.n; ++i) {
        path.joint[i] = chain.joints[i];
        int j = 0;
        while (j < path.n && on.number[j] != chain.joints[i].coordinate) ++j;
        if (j == ik::max_joints) throw nanobind::value_error("too many coordinates on the path");
        if (j == path.n) {
            on.number[path.n++] = chain.joints[i].coordinate;
            path.slides[j] = chain.joints[i].prismatic;
        }
        path.joint[i].coordinate = j;
    }
    path.length = length_of(path);
    return on;
}
