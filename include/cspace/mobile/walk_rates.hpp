// The noise of a random walk, as plain data.
#pragma once

namespace cspace::mobile {

struct RandomWalk {
    // Per metre [m²/m, m²/m, rad²/m], per radian [rad²/rad], per second [m²/s, rad²/s].
    double distance = 0, side = 0, drift = 0, turn = 0, rest = 0, rest_turn = 0;
};

}  // namespace cspace::mobile
