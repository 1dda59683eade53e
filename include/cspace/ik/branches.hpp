// Results of a closed form for six joints: up to eight candidates, each with the angles of all joints.
#pragma once

#include "cspace/math/lanes.hpp"

namespace cspace::ik {

inline constexpr int max_branches = 8;

// The angles t_i of the Denavit–Hartenberg form, in (−π, π] up to a multiple of 2π. `doubt` marks the poses
// (lanes) that the careful solver must check again.
template <class V>
struct Branches {
    V t[max_branches][6];
    mask_of<V> ok[max_branches];
    mask_of<V> doubt;
};

// The same for one goal, with its branches on lanes: branch 2 k + i is lane k of t[i].
struct Abreast {
    Pack<4> t[2][6];
    Mask<4> ok[2];
    bool doubt;
};

}  // namespace cspace::ik
