// The centre of mass of a robot and its Jacobian.
//
// A joint moves all that it carries as one body: with the carried mass m, its first moment s = Σ mₖ pₖ and
// the total mass M, a revolute joint about d through o gives d × (s − m o) / M, a prismatic one gives m d
// / M.
#pragma once

#include "cspace/kinematics/jacobian.hpp"
#include "cspace/model/tree.hpp"

namespace cspace::kinematics::inline CSPACE_ISA {

// The first moment of the base and of the links fixed to it.
template <class V>
CSPACE_INLINE Vec3<V> base_moment(const model::Tree& tree, const Pose<V>& T_world_base) {
    return tree.bodies[0].mass * (T_world_base * fill_vec3<V>(tree.bodies[0].center));
}
// The centre of mass; moments[k] becomes the first moment Σ m p of all that joint k carries.
template <class V>
CSPACE_INLINE Vec3<V> center_of_mass(const model::Tree& tree, const Pose<V>& T_world_base,
                                     const Pose<V>* T_world_joint, Vec3<V>* moments) {
    for (int k = 0; k < tree.n_joints; ++k) {
        const model::Body& body = tree.bodies[k + 1];
        moments[k] = body.mass * (T_world_joint[k] * fill_vec3<V>(body.center));
    }
    Vec3<V> sum = base_moment(tree, T_world_base);
    for (int k = tree.n_joints - 1; k >= 0; --k) {
        const int parent = tree.joints[k].parent;
        Vec3<V>& below = parent < 0 ? sum : moments[parent];
        below = below + moments[k];
    }
    return (1.0 / tree.mass) * sum;
}

// The columns of the joints, from column `first` of J (3, columns) on.
template <class V>
CSPACE_INLINE void center_of_mass_columns(const model::Tree& tree, const Pose<V>* T_world_joint,
                                          const Vec3<V>* moments, V* J, int columns, int first) {
    for (int j = 0; j < 3 * columns; ++j) {
        if (j % columns >= first) J[j] = fill_lanes<V>(0.0);
    }
    for (int k = 0; k < tree.n_joints; ++k) {
        const model::Joint& joint = tree.joints[k];
        const Vec3<V> d = (joint.ratio / tree.mass) * matrix_column(T_world_joint[k].R, 2);
        const Vec3<V> lever = moments[k] - joint.carried_mass * T_world_joint[k].t;
        add_to_column(J, columns, first + joint.coordinate, 0,
                      joint.prismatic ? joint.carried_mass * d : cross(d, lever));
    }
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
