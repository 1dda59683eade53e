// A robot in a scene: checks of configurations and of edges. What planners and the bindings call.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "collision_robot.hpp"
#include "collision_scene.hpp"
#include "cspace/collision/workspace.hpp"

namespace cspace::collision {

// The memory of one thread's checks.
class WorkspaceMemory {
  public:
    WorkspaceMemory(const Robot& robot, int n_primitives);
    Workspace w = {};

  private:
    struct Free {
        void operator()(std::byte* p) const;
    };
    std::unique_ptr<std::byte, Free> memory_;
};

// The least distance of a configuration from a contact.
struct Clearance {
    double distance;               // [m], negative in contact
    Contact nearest;               // other < 0: nothing to be near to
    std::vector<double> gradient;  // by the coordinates
    bool is_crease = false;        // another pair is as near, with another gradient
};

class Checker {
  public:
    // margin: by how much balls must keep away from obstacles and from each other [m]. allowed: pairs of a
    // link and an object that may touch.
    Checker(std::shared_ptr<const RobotData> robot, std::shared_ptr<const SceneData> scene, double margin,
            std::span<const std::pair<int, int>> allowed);

    const Robot& robot() const { return robot_->view(); }
    const Scene& scene() const { return scene_; }
    const SceneData& scene_data() const { return *data_; }
    const RobotData& robot_data() const { return *robot_; }
    int dof() const { return robot().n_coordinates; }
    // What touches before anything moves: a link of the base and an obstacle. other < 0: nothing.
    const Contact& base_contact() const { return base_contact_; }

    // A workspace of its own for each caller, given back when the pointer goes.
    struct GiveBack {
        const Checker* checker;
        void operator()(WorkspaceMemory* memory) const;
    };
    using Borrowed = std::unique_ptr<WorkspaceMemory, GiveBack>;
    Borrowed borrow_workspace() const;
    // Forgets what the checks before have found, so that those to come cost the same wherever they run.
    void reset_workspace(WorkspaceMemory& memory) const;
    // Whether 2π more in a coordinate changes nothing.
    bool has_period(int coordinate) const { return shifts_[std::size_t(coordinate)]; }

    // Whether checks are made for a configuration (dof,): its numbers are finite, not too large, and no
    // prismatic joint is beyond its limits.
    bool takes(const double* q) const { return robot_->takes(q); }
    // One configuration (dof,); false and w.contact if something touches.
    bool is_free(const double* q, WorkspaceMemory& memory) const;
    // Rows of configurations (n, dof): collides[i] is 1 where something touches. On so many threads (0: all).
    void check_rows(const double* q, std::size_t n, std::uint8_t* collides, int threads) const;
    // In double: the exact distance of the spheres. Margins do not count.
    Clearance clearance(const double* q) const;
    Verdict prove_edge(const double* from, const double* to, WorkspaceMemory& memory) const;
    // The same at samples, at most `resolution` apart (L2 norm of the coordinates): free or blocked.
    Verdict sample_edge(const double* from, const double* to, double resolution,
                        WorkspaceMemory& memory) const;
    // The same for coordinates that are floats within a turn or so.
    Verdict prove_edge(const float* from, const float* to, WorkspaceMemory& memory) const;
    Verdict sample_edge(const float* from, const float* to, float resolution, WorkspaceMemory& memory) const;

    // Rounds an edge to float, both ends shifted by the same multiples of 2π where a joint is far from zero.
    void round_edge(const double* from, const double* to, float* a, float* b) const;

  private:
    std::shared_ptr<const RobotData> robot_;
    std::shared_ptr<const SceneData> data_;
    std::vector<unsigned char> allowed_;
    Scene scene_;
    Contact base_contact_;
    std::vector<char> shifts_;  // coordinates whose joints have the period 2π
    mutable std::mutex busy_;
    mutable std::vector<std::unique_ptr<WorkspaceMemory>> spare_;

    void check_base();
};

}  // namespace cspace::collision
