// A small arm whose configurations are places: a ball that slides in the plane.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "library/planning_arm.hpp"

namespace check {

// A ball that moves in the plane, among walls given as boxes (x, y, half sizes).
struct BallInPlane {
    std::unique_ptr<cspace::collision::Checker> checker;
    std::vector<double> lower = {-1, -1}, upper = {1, 1};

    explicit BallInPlane(const std::vector<std::array<double, 4>>& walls, double radius = 0.02) {
        // Turns the axes round: z to x, and once more to y.
        const cspace::Posed turn = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}, {0, 0, 0}};
        const cspace::model::Joint along_x = {turn, -1, 0, 1, 0, true, 0},
                                   along_y = {turn, 0, 1, 1, 0, true, 0};
        const std::vector<cspace::model::Joint> joints = {along_x, along_y};
        const std::vector<int> bodies = {2};
        const std::vector<cspace::collision::Sphere> spheres = {{{0, 0, 0}, radius, 0}};
        std::vector<double> boxes;
        std::vector<int> owners;
        for (const auto& w : walls) {
            boxes.insert(boxes.end(), {w[0], w[1], 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, w[2], w[3], 0.5});
            owners.push_back(int(owners.size()));
        }
        cspace::collision::Primitives given = {};
        given.boxes = boxes, given.owners = owners;
        checker = std::make_unique<cspace::collision::Checker>(
            std::make_shared<cspace::collision::RobotData>(joints, 2, lower, upper, bodies, spheres,
                                                           std::vector<std::pair<int, int>>{}),
            std::make_shared<cspace::collision::SceneData>(given), 0.0, std::vector<std::pair<int, int>>{});
    }
    // tree: the options of a tree, if there is to be one.
    template <class... Tree>
    cspace::planning::ArmPlan plan(const std::vector<double>& starts, const std::vector<double>& goals,
                                   const cspace::planning::ArmOptions& options = {},
                                   const Tree&... tree) const {
        return plan_arm(space(), {starts, goals}, options, tree...);
    }
    cspace::planning::ArmSpace space() const { return {*checker, lower, upper, {}}; }
};
// Four walls around (0.5, 0.5).
inline const std::vector<std::array<double, 4>> ring = {
    {0.5, 0.65, 0.15, 0.01}, {0.5, 0.35, 0.15, 0.01}, {0.65, 0.5, 0.01, 0.15}, {0.35, 0.5, 0.01, 0.15}};

}  // namespace check
