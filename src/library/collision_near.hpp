// The primitives of a scene near a point.
#pragma once

#include <algorithm>

#include "collision_scene.hpp"
#include "cspace/collision/boxes.hpp"

namespace cspace::collision {

// Calls visit(primitive) for those whose boxes are within limit() of a point; it may shrink meanwhile.
template <class Limit, class Visit>
void visit_near(const SceneData& data, const Vec3d& point, const Limit& limit, const Visit& visit) {
    const auto is_near = [&](const float* low, const float* high) {
        const double at[] = {point.x, point.y, point.z}, reach = limit();
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double beyond = std::max({double(low[k]) - at[k], at[k] - double(high[k]), 0.0});
            square += beyond * beyond;
        }
        return square == 0 || (reach > 0 && square <= reach * reach);
    };
    visit_boxes(data.view(), is_near, [&](int primitive, bool) { visit(primitive); });
}

}  // namespace cspace::collision
