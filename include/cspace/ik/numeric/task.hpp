// The task of a numeric method: the weights of the pose error, its tolerances, and the limit of iterations.
#pragma once

#include "cspace/ik/numeric/path.hpp"

namespace cspace::ik {

enum class Method : unsigned char {
    levenberg_marquardt,  // damped, descends from any start
    newton,               // undamped: quick near a solution, erratic far from one
};

enum class Ending : unsigned char {
    reached,
    stalled,    // a local minimum of the error, or nothing gained any more
    exhausted,  // the iterations ran out
    unknown,    // not tried yet
};

// The pose error in the axes of the goal is [Δp; rotation vector]. Row k counts where weight[k] > 0.
struct Task {
    double weight[6] = {1, 1, 1, 1, 1, 1};
    double tolerance = 1e-9;  // of the length of Δp [m] and of the angle [rad], their counted parts
    int most_steps = 60;
    Method method = Method::levenberg_marquardt;
    bool limited = false;
    double lower[max_joints] = {}, upper[max_joints] = {};  // of the coordinates, where limited
};

}  // namespace cspace::ik
