// The owner of a robot's collision data: bodies, links and groups of spheres with balls around them, levers.
#pragma once

#include <span>
#include <vector>

#include "cspace/collision/robot.hpp"
#include "cspace/model/tree.hpp"
#include "cspace/shapes/plain.hpp"

namespace cspace::collision {

struct Sphere {
    Vec3d center;  // in the frame of its body [m]
    double radius;
    int link;
    int solid = -1;  // the convex solid that it helps to cover, or −1 if it counts itself
};

// From 16 numbers: 0 for a box, 1 a cylinder, 2 a capsule; half sides of a box, or radius twice and half
// length; the pose in the frame of its body, R by rows, then p. A capsule lies along z like a cylinder.
shapes::Convex read_solid(const double* row);

class RobotData {
  public:
    // The joints of a robot, their axes along z; coordinates within lower … upper (prismatic travel bounds
    // levers); per link its body (0 the base, k + 1 what joint k carries); spheres sorted by link; pairs of
    // links that are checked against each other; convex solids in the frames of the bodies of their spheres,
    // which cover them. Throws std::invalid_argument for more coordinates than
    // most_coordinates, links whose bodies do not ascend, spheres that do not follow their links, and numbers
    // out of range.
    RobotData(std::span<const model::Joint> joints, int n_coordinates, std::span<const double> lower,
              std::span<const double> upper, std::span<const int> link_bodies,
              std::span<const Sphere> spheres, std::span<const std::pair<int, int>> pairs,
              std::span<const shapes::Convex> solids = {});

    const Robot& view() const { return view_; }
    // What rounding to float may cost: added to every radius [m].
    float slack() const { return slack_; }
    // What was given, in double.
    std::span<const model::Joint> given_joints() const { return given_joints_; }
    std::span<const Sphere> given_spheres() const { return given_spheres_; }
    std::span<const std::pair<int, int>> given_pairs() const { return given_pairs_; }
    std::span<const shapes::Convex> given_solids() const { return given_solids_; }
    // The solid that a sphere of the view covers, or itself, in the frame of its body.
    shapes::Convex solid_of(int sphere) const;
    // Whether each coordinate is inside the range that checks are made for.
    bool takes(const double* q) const {
        for (std::size_t k = 0; k < range_.size(); ++k)
            if (!(q[k] >= range_[k].first && q[k] <= range_[k].second)) return false;
        return true;
    }

  private:
    Robot view_ = {};
    float slack_ = 0;
    std::vector<model::Joint> given_joints_;
    std::vector<Sphere> given_spheres_;
    std::vector<std::pair<int, int>> given_pairs_;
    std::vector<shapes::Convex> given_solids_;
    std::vector<std::pair<double, double>> range_;  // of each coordinate
    std::vector<Joint> joints_;
    std::vector<Body> bodies_;
    std::vector<Link> links_;
    std::vector<Group> groups_;
    std::vector<Ball> spheres_, solid_balls_;
    std::vector<int> sphere_solids_;  // none where no sphere covers a solid
    std::vector<float> inner_radii_;
    std::vector<BodyPair> pairs_;
    std::vector<LinkPair> link_pairs_;
    std::vector<float> levers_, pair_levers_;
    struct Columns {
        std::vector<float> x, y, z, r;
        void assign(std::span<const Ball> balls, int padded_size);
        BallColumns view() const { return {x.data(), y.data(), z.data(), r.data()}; }
    };
    Columns body_columns_, sphere_columns_;
    std::vector<Chunk> chunks_;
    std::vector<BodyChunks> body_chunks_;
    std::vector<int> sphere_links_, pair_numbers_;
    std::vector<unsigned char> pair_lanes_;

    void check_order(std::span<const model::Joint> joints, std::span<const int> link_bodies,
                     std::span<const Sphere> spheres, std::span<const std::pair<int, int>> pairs) const;
    void add_solids();
    void add_links(std::span<const int> link_bodies, std::span<const Sphere> spheres);
    void add_pairs(std::span<const std::pair<int, int>> pairs);
    void add_columns();
    void bound_levers(std::span<const model::Joint> joints, std::span<const double> lower,
                      std::span<const double> upper);
};

}  // namespace cspace::collision
