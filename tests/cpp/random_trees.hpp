// Random trees of joints with masses, and what tests of their dynamics need besides.
#pragma once

#include <cmath>
#include <new>
#include <random>
#include <vector>

#include "cspace/dynamics/make_links.hpp"
#include "cspace/model/robot_model.hpp"
#include "cspace/spatial/rotation.hpp"

namespace random_trees {
using namespace cspace;

struct Random {
    std::mt19937_64 generator{11};
    double operator()(double low = -1.0, double high = 1.0) {
        return std::uniform_real_distribution<double>(low, high)(generator);
    }
};

inline Posed random_pose(Random& random) {
    const Vec3d a{random(), random(), random()};
    const double angle = random(-3.0, 3.0);
    return {spatial::rotation_about((1.0 / norm(a)) * a, std::cos(angle), std::sin(angle)),
            {random(), random(), random()}};
}

// A tree of n joints, of which the last shares the coordinate of the first where `shares`.
inline model::RobotModel random_robot(Random& random, int n, bool shares) {
    std::vector<model::Joint> joints;
    std::vector<model::Body> bodies;
    for (int k = 0; k <= n; ++k) {
        const double a = random(0.1, 0.5), b = random(0.1, 0.5), c = random(0.1, 0.5);
        bodies.push_back(
            {{random(), random(), random()}, random(0.5, 2.0), {a + b, 0.01, 0.02, a + c, 0.03, b + c}});
        if (k == n) break;
        const int parent = k == 0 ? -1 : int(random(0.0, k + 0.999)) - 1;
        const bool follows = shares && k == n - 1;
        joints.push_back({random_pose(random), parent, follows ? 0 : k, follows ? -0.7 : 1.0, 0.1,
                          random() > 0.4, 0.0, 0.05, 0.02, 0.03});
    }
    return {joints, {}, bodies, shares ? n - 1 : n};
}

struct Memory {
    explicit Memory(std::size_t bytes) : start(::operator new(bytes, std::align_val_t(64))) {}
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory() { ::operator delete(start, std::align_val_t(64)); }
    void* start;
};

inline std::vector<double> random_numbers(Random& random, std::size_t n) {
    std::vector<double> numbers(n);
    for (double& x : numbers) x = random(-2.0, 2.0);
    return numbers;
}

}  // namespace random_trees
