#include "collision_checker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "kernels/collision.hpp"
#include "shapes_distance.hpp"

namespace cspace::collision {

namespace {

constexpr std::size_t lane_bytes = 8 * sizeof(float), alignment = 64;
constexpr int stack_size = 4096;

// Hands out pieces of one block of memory; with no block it only counts.
class Arena {
  public:
    explicit Arena(std::byte* memory) : memory_(memory) {}
    template <class T>
    void take(T*& pointer, std::size_t count, std::size_t size) {
        if (memory_) pointer = reinterpret_cast<T*>(memory_ + used_);
        used_ += (count * size + alignment - 1) / alignment * alignment;
    }
    std::size_t used() const { return used_; }

  private:
    std::byte* memory_;
    std::size_t used_ = 0;
};

std::size_t lay_out(const Robot& robot, int n_primitives, std::byte* memory, Workspace& w) {
    constexpr std::size_t frame = 12 * lane_bytes, rate = 6 * lane_bytes, place = 3 * lane_bytes;
    const std::size_t bodies = std::size_t(robot.n_bodies), links = std::size_t(robot.n_links);
    const std::size_t groups = std::size_t(robot.n_groups), spheres = std::size_t(robot.n_spheres);
    const std::size_t primitives = std::size_t(n_primitives), pairs = std::size_t(robot.n_pairs);
    Arena arena(memory);
    const auto bytes = [&](void*& pointer, std::size_t count, std::size_t size) {
        std::byte* at = static_cast<std::byte*>(pointer);
        arena.take(at, count, size);
        pointer = at;
    };
    bytes(w.frames, bodies, frame);
    bytes(w.rates, bodies, rate);
    bytes(w.body_places, bodies, place);
    bytes(w.link_places, links, place);
    bytes(w.sphere_places, spheres, place);
    const std::size_t stride = std::size_t(robot.body_stride);  // more than there are joints
    bytes(w.one_frames, bodies, 12 * sizeof(float));
    arena.take(w.joint_columns, 3 * stride, sizeof(float));
    arena.take(w.frame_columns, 12 * stride, sizeof(float));
    arena.take(w.ball_columns, 3 * stride, sizeof(float));
    arena.take(w.sphere_columns, 3 * std::size_t(robot.n_chunks), lane_bytes);
    arena.take(w.near_chunks, std::size_t(robot.n_chunks) + 1, sizeof(int));
    arena.take(w.near_lanes, std::size_t(robot.n_chunks) + 1, sizeof(unsigned));
    arena.take(w.body_stamps, bodies, sizeof(unsigned));
    arena.take(w.link_stamps, links, sizeof(unsigned));
    arena.take(w.group_stamps, groups, sizeof(unsigned));
    arena.take(w.near, (bodies + 1) * (primitives + 1), sizeof(int));
    arena.take(w.near_counts, bodies, sizeof(int));
    arena.take(w.near_body, primitives + 1, sizeof(int));
    arena.take(w.near_link, primitives + 1, sizeof(int));
    arena.take(w.near_group, primitives + 1, sizeof(int));
    arena.take(w.near_spheres, spheres + 1, sizeof(int));
    arena.take(w.kept_pairs, pairs + 1, sizeof(int));
    arena.take(w.kept_links, std::size_t(robot.n_link_pairs) + 1, sizeof(int));
    arena.take(w.order, bodies + pairs + 1, sizeof(int));
    arena.take(w.kappa, std::size_t(robot.body_stride) + 8, sizeof(float));
    arena.take(w.reach, std::size_t(robot.body_stride) + 8, sizeof(float));
    arena.take(w.pair_kappa, std::size_t(robot.pair_stride) + 8, sizeof(float));
    arena.take(w.pair_reach, std::size_t(robot.pair_stride) + 8, sizeof(float));
    arena.take(w.stack, stack_size, sizeof(Interval));
    w.near_stride = n_primitives + 1;
    w.stack_size = stack_size;
    return arena.used();
}

// R by rows, then p.
Posed read_frame(const float* f) {
    return {{{{f[0], f[1], f[2]}, {f[3], f[4], f[5]}, {f[6], f[7], f[8]}}}, {f[9], f[10], f[11]}};
}

void write_normal(const Vec3d& n, float* normal) {
    normal[0] = float(n.x), normal[1] = float(n.y), normal[2] = float(n.z);
}

}  // namespace

void WorkspaceMemory::Free::operator()(std::byte* p) const {
    ::operator delete(p, std::align_val_t(alignment));
}

WorkspaceMemory::WorkspaceMemory(const Robot& robot, int n_primitives) {
    const std::size_t size = lay_out(robot, n_primitives, nullptr, w);
    memory_.reset(static_cast<std::byte*>(::operator new(size, std::align_val_t(alignment))));
    lay_out(robot, n_primitives, memory_.get(), w);
    // The stack is last, and read where it was written.
    std::fill(memory_.get(), reinterpret_cast<std::byte*>(w.stack), std::byte(0));
    kernels::prepare_workspace(robot, w);
}

Checker::Checker(std::shared_ptr<const RobotData> robot, std::shared_ptr<const SceneData> scene,
                 double margin, std::span<const std::pair<int, int>> allowed)
    : robot_(std::move(robot)), data_(std::move(scene)), view_(robot_->view()), scene_(data_->view()) {
    scene_.margin = scene_.pair_margin = float(margin) + robot_->slack();
    scene_.exact = {this, &reaches_primitive, &measure_primitive, &reaches_sphere, &measure_sphere};
    if (!allowed.empty()) {
        allowed_.assign(std::size_t(this->robot().n_links) * std::size_t(scene_.n), 0);
        for (const auto& [link, object] : allowed)
            for (int i = 0; i < scene_.n; ++i)
                if (data_->owner(i) == object)
                    allowed_[std::size_t(link) * std::size_t(scene_.n) + std::size_t(i)] = 1;
        scene_.allowed = allowed_.data();
    }
    shifts_.assign(std::size_t(dof()), 1);
    for (int j = 0; j < this->robot().n_joints; ++j) {
        const Joint& joint = this->robot().joints[j];
        if (joint.is_prismatic || joint.ratio != std::round(joint.ratio))
            shifts_[std::size_t(joint.coordinate)] = 0;
    }
    check_base();
}

Checker::Checker(const Checker& other, const Robot& view)
    : robot_(other.robot_),
      data_(other.data_),
      view_(view),
      allowed_(other.allowed_),
      scene_(other.scene_),
      base_contact_(other.base_contact_),
      shifts_(other.shifts_) {
    scene_.exact.owner = this;
    if (scene_.allowed) scene_.allowed = allowed_.data();
}

std::unique_ptr<Checker> Checker::ignore_pairs() const {
    Robot view = view_;
    view.n_pairs = view.n_link_pairs = view.pair_stride = 0;
    return std::unique_ptr<Checker>(new Checker(*this, view));
}

bool Checker::reaches_primitive(const void* owner, int sphere, const float* frame, int primitive, float gap) {
    const Checker& checker = *static_cast<const Checker*>(owner);
    const shapes::Convex solid = checker.robot_->solid_of(sphere);
    return checker.data_->is_within(primitive, move_solid(read_frame(frame), solid), double(gap));
}
bool Checker::reaches_sphere(const void* owner, int sphere, const float* frame, int other,
                             const float* other_frame, float gap) {
    const RobotData& robot = *static_cast<const Checker*>(owner)->robot_;
    return shapes::is_within(move_solid(read_frame(frame), robot.solid_of(sphere)),
                             move_solid(read_frame(other_frame), robot.solid_of(other)), double(gap));
}

float Checker::measure_primitive(const void* owner, int sphere, const float* frame, int primitive,
                                 float* normal) {
    const Checker& checker = *static_cast<const Checker*>(owner);
    const shapes::Convex solid = move_solid(read_frame(frame), checker.robot_->solid_of(sphere));
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto found = checker.data_->distance(primitive, solid, infinity);
    const bool has_normal = found && checker.data_->is_convex(primitive);
    write_normal(has_normal ? found->normal : Vec3d{0, 0, 0}, normal);
    return found ? round_low(found->value) : 0.0f;
}
float Checker::measure_sphere(const void* owner, int sphere, const float* frame, int other,
                              const float* other_frame, float* normal) {
    const RobotData& robot = *static_cast<const Checker*>(owner)->robot_;
    const shapes::ConvexDistance found =
        shapes::measure_distance(move_solid(read_frame(frame), robot.solid_of(sphere)),
                                 move_solid(read_frame(other_frame), robot.solid_of(other)));
    write_normal(found.normal, normal);
    return round_low(found.value);
}

// The base does not move: it is checked once, here.
void Checker::check_base() {
    constexpr float base_frame[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const Robot& all = robot();
    const Body& base = all.bodies[0];
    base_contact_ = {};
    for (int l = base.first; l < base.first + base.count; ++l)
        for (int g = all.links[l].first; g < all.links[l].first + all.links[l].count; ++g)
            for (int s = all.groups[g].first; s < all.groups[g].first + all.groups[g].count; ++s)
                for (int i = 0; i < scene_.n; ++i) {
                    if (scene_.allowed && scene_.allowed[l * scene_.n + i]) continue;
                    if (kernels::ball_touches(scene_, i, all.spheres[s]) &&
                        (!all.sphere_solids || reaches_primitive(this, s, base_frame, i, scene_.margin))) {
                        base_contact_ = {l, i, false, 0};
                        return;
                    }
                }
}

Checker::Borrowed Checker::borrow_workspace() const {
    {
        const std::lock_guard<std::mutex> lock(busy_);
        if (!spare_.empty()) {
            WorkspaceMemory* memory = spare_.back().release();
            spare_.pop_back();
            return {memory, {this}};
        }
    }
    return {new WorkspaceMemory(robot(), scene_.n), {this}};
}
void Checker::reset_workspace(WorkspaceMemory& memory) const {
    memory.w.blocks = 0;
    kernels::prepare_workspace(robot(), memory.w);
}
void Checker::GiveBack::operator()(WorkspaceMemory* memory) const {
    const std::lock_guard<std::mutex> lock(checker->busy_);
    checker->spare_.emplace_back(memory);
}

void Checker::round_edge(const double* from, const double* to, float* a, float* b) const {
    for (int k = 0; k < dof(); ++k) {
        const double middle = 0.5 * (from[k] + to[k]);
        const bool is_far = std::fabs(middle) > pi && shifts_[std::size_t(k)];
        const double shift = is_far ? nearest_multiple(middle) : 0.0;
        a[k] = float(from[k] - shift), b[k] = float(to[k] - shift);
    }
}

bool Checker::is_free(const double* q, WorkspaceMemory& memory) const {
    if (base_contact_.other >= 0) {
        memory.w.contact = base_contact_;
        return false;
    }
    float a[most_coordinates], b[most_coordinates];
    round_edge(q, q, a, b);
    return !kernels::touches_something(robot(), scene_, memory.w, a);
}

template <class Check>
void Checker::over_blocks(const double* q, std::size_t n, int threads, const Check& check) const {
    constexpr std::size_t least_rows = 2048;
    const std::size_t width = std::size_t(dof());
    over_rows(n, threads, 8, least_rows, [&](std::size_t begin, std::size_t end) {
        const Borrowed memory = borrow_workspace();
        alignas(32) float columns[most_coordinates * 8];
        float a[most_coordinates], b[most_coordinates];
        for (std::size_t row = begin; row < end; row += 8) {
            const std::size_t count = std::min<std::size_t>(8, end - row);
            for (std::size_t i = 0; i < 8; ++i) {
                const double* from = q + (row + std::min(i, count - 1)) * width;
                round_edge(from, from, a, b);
                for (std::size_t k = 0; k < width; ++k) columns[8 * k + i] = a[k];
            }
            check(memory->w, columns, int(count), row);
            poll_interrupts();
        }
        return true;
    });
}

void Checker::check_rows(const double* q, std::size_t n, std::uint8_t* collides, int threads) const {
    if (base_contact_.other >= 0) return void(std::fill_n(collides, n, std::uint8_t(1)));
    over_blocks(q, n, threads, [&](Workspace& w, const float* columns, int count, std::size_t row) {
        const unsigned hit = kernels::check_rows(robot(), scene_, w, columns, count);
        for (int i = 0; i < count; ++i) collides[row + std::size_t(i)] = hit >> i & 1;
    });
}

void Checker::find_objects(const double* q, std::size_t n, std::int32_t* objects, int threads) const {
    constexpr std::size_t least_rows = 512;
    over_rows(n, threads, 1, least_rows, [&](std::size_t begin, std::size_t end) {
        const Borrowed memory = borrow_workspace();
        for (std::size_t row = begin; row < end; ++row) {
            reset_workspace(*memory);
            const bool free = is_free(q + row * std::size_t(dof()), *memory);
            const Contact& found = memory->w.contact;
            objects[row] = free ? nothing : found.is_pair ? itself : std::int32_t(data_->owner(found.other));
            poll_interrupts();
        }
        return true;
    });
}

void Checker::check_cells(const double* q, std::size_t n, const double* half, std::uint8_t* verdicts,
                          int threads) const {
    if (base_contact_.other >= 0) return void(std::fill_n(verdicts, n, std::uint8_t(3)));
    float widths[most_coordinates];
    constexpr float round_up = 1 + 1e-6f;
    for (int k = 0; k < dof(); ++k) widths[k] = float(half[k]) * round_up;
    over_blocks(q, n, threads, [&](Workspace& w, const float* columns, int count, std::size_t row) {
        const unsigned found =
            kernels::check_cells(robot(), scene_, w, columns, widths, robot_->slack(), count);
        for (int i = 0; i < count; ++i)
            verdicts[row + std::size_t(i)] = std::uint8_t((found >> i & 1) | (found >> (8 + i) & 1) << 1);
    });
}

Verdict Checker::prove_edge(const float* from, const float* to, WorkspaceMemory& memory) const {
    if (base_contact_.other >= 0) {
        memory.w.contact = base_contact_;
        return Verdict::blocked;
    }
    return Verdict(kernels::prove_edge(robot(), scene_, memory.w, from, to));
}
Verdict Checker::sample_edge(const float* from, const float* to, float resolution,
                             WorkspaceMemory& memory) const {
    if (base_contact_.other >= 0) {
        memory.w.contact = base_contact_;
        return Verdict::blocked;
    }
    float square = 0;
    for (int k = 0; k < dof(); ++k) square += (to[k] - from[k]) * (to[k] - from[k]);
    constexpr float most_blocks = 1e6f;
    const float blocks = std::min(std::sqrt(square) / (8 * resolution), most_blocks);
    const int whole = blocks > 1 ? int(blocks) : 1, n = whole + (float(whole) < blocks);
    return Verdict(kernels::sample_edge(robot(), scene_, memory.w, from, to, n));
}
Verdict Checker::prove_edge(const double* from, const double* to, WorkspaceMemory& memory) const {
    float a[most_coordinates], b[most_coordinates];
    round_edge(from, to, a, b);
    return prove_edge(a, b, memory);
}
Verdict Checker::sample_edge(const double* from, const double* to, double resolution,
                             WorkspaceMemory& memory) const {
    float a[most_coordinates], b[most_coordinates];
    round_edge(from, to, a, b);
    return sample_edge(a, b, float(resolution), memory);
}

}  // namespace cspace::collision
