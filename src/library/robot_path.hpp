// The path to a frame of a robot, reduced to the coordinates that move the frame.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "cspace/ik/numeric/path.hpp"

namespace cspace::ik {

// Coordinate j of the path is coordinate number[j] of the robot.
struct RobotPath {
    ik::Path path;
    int number[ik::max_joints];
    int coordinates;  // of the robot

    // Throws std::invalid_argument for a chain of more joints or coordinates than a path holds.
    explicit RobotPath(const model::Chain& chain) : coordinates(chain.n_coordinates) {
        if (chain.n > ik::max_path) throw std::invalid_argument("too many joints on the path");
        path.joints = chain.n;
        path.T_base_first = chain.T_base_first;
        path.cos_last = chain.cos_last;
        path.sin_last = chain.sin_last;
        for (int i = 0; i < chain.n; ++i) {
            path.joint[i] = chain.joints[i];
            int j = 0;
            while (j < path.n && number[j] != chain.joints[i].coordinate) ++j;
            if (j == ik::max_joints) throw std::invalid_argument("too many coordinates on the path");
            if (j == path.n) {
                number[path.n++] = chain.joints[i].coordinate;
                path.slides[j] = chain.joints[i].prismatic;
            }
            path.joint[i].coordinate = j;
        }
        path.length = length_of(path);
    }

    // The coordinate of the path that is coordinate `of_robot` of the robot, −1 if none is.
    int find(int of_robot) const {
        const int* const found = std::find(number, number + path.n, of_robot);
        return found == number + path.n ? -1 : int(found - number);
    }

    void gather(const double* of_robot, double* of_path) const {
        for (int j = 0; j < path.n; ++j) of_path[j] = of_robot[number[j]];
    }
    void scatter(const double* of_path, double* of_robot) const {
        for (int j = 0; j < path.n; ++j) of_robot[number[j]] = of_path[j];
    }
    // Rows of the robot's coordinates as rows of those of the path.
    std::vector<double> gather_rows(const double* rows, std::size_t count) const {
        std::vector<double> out(count * std::size_t(path.n));
        for (std::size_t k = 0; k < count; ++k)
            gather(rows + std::size_t(coordinates) * k, out.data() + std::size_t(path.n) * k);
        return out;
    }
};

}  // namespace cspace::ik
