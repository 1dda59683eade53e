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

    // The same checks, of a robot that may touch itself: for edges that are known to be free of that.
    std::unique_ptr<Checker> ignore_pairs() const;

    const Robot& robot() const { return view_; }
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
    // What touches at rows of configurations (n, dof), of several things always the same: the number of an
    // object, `itself` for two links, `nothing`.
    static constexpr std::int32_t nothing = -1, itself = -2;
    void find_objects(const double* q, std::size_t n, std::int32_t* objects, int threads) const;
    // Cells q ± half of configurations: rows q (n, dof), half (dof,). verdicts[i] is 1 where the middle of a
    // cell touches something, and 2 more where all of the cell is so.
    void check_cells(const double* q, std::size_t n, const double* half, std::uint8_t* verdicts,
                     int threads) const;
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
    Robot view_;
    std::vector<unsigned char> allowed_;
    Scene scene_;
    Contact base_contact_;
    std::vector<char> shifts_;  // coordinates whose joints have the period 2π
    mutable std::mutex busy_;
    mutable std::vector<std::unique_ptr<WorkspaceMemory>> spare_;

    Checker(const Checker& other, const Robot& view);
    void check_base();
    // Calls check(memory, columns, count, row) for eight rows after the other, rounded to float.
    template <class Check>
    void over_blocks(const double* q, std::size_t n, int threads, const Check& check) const;
    // The exact tests of kernels; owner: a checker.
    static bool reaches_primitive(const void* owner, int sphere, const float* frame, int primitive,
                                  float gap);
    static float measure_primitive(const void* owner, int sphere, const float* frame, int primitive,
                                   float* normal);
    static bool reaches_sphere(const void* owner, int sphere, const float* frame, int other,
                               const float* other_frame, float gap);
    static float measure_sphere(const void* owner, int sphere, const float* frame, int other,
                                const float* other_frame, float* normal);
};

}  // namespace cspace::collision
