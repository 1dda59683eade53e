// What a closed form of six joints yields: up to eight candidates, each with every joint's angle.
#pragma once

#include "cspace/math/lanes.hpp"

namespace cspace {

inline constexpr int max_branches = 8;

// The angles t_i of the Denavit–Hartenberg form, in (−π, π] up to one turn. `doubt` marks the poses (lanes)
// that the careful path has to look at again.
template <class V>
struct Branches {
    V t[max_branches][6];
    mask_of<V> ok[max_branches];
    mask_of<V> doubt;
};

// The same of one goal, its branches side by side: branch 2 k + i is lane k of t[i].
struct Abreast {
    Pack<4> t[2][6];
    Mask<4> ok[2];
    bool doubt;
};

}  // namespace cspace
