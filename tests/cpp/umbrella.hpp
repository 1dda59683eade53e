// What both files of test_umbrella compute, each from its own inclusion of all headers.
#pragma once

#include <cspace/cspace.hpp>

namespace umbrella {

struct Answers {
    double tip, angle, singular, path;
};

inline cspace::ik::Chain planar_arm() {
    cspace::ik::Chain chain;
    chain.n = 2;
    for (int i = 0; i < chain.n; ++i) {
        chain.axis[i] = {0, 0, 1};
        chain.point[i] = {double(i), 0, 0};
    }
    chain.tip = {cspace::identity_pose().R, {2, 0, 0}};
    return chain;
}

static Answers answers() {
    using namespace cspace;
    const double q[] = {0, pi / 2};
    double J[] = {3, 0, 0, 4}, sigma[2];
    singular_values(J, 2, 2, sigma);
    const Vec3d z = {0, 0, 1}, x = {1, 0, 0}, y = {0, 1, 0};
    const maps::BitGrid grid(3, 4);
    navigation::GridScratch scratch;
    navigation::GridAnswer way;
    find_way(grid, {0, 0}, {2, 3}, {}, scratch, way);
    return {ik::forward_kinematics(planar_arm(), q).t.y, angle_of(ik::subproblem_1(z, x, y).theta), sigma[0],
            way.cost};
}

Answers answers_elsewhere();  // umbrella_again.cpp

}  // namespace umbrella
