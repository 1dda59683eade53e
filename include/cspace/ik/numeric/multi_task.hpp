// Several weighted tasks on several frames: the velocities, or the configuration, with the smallest weighted
// error within the limits.
//
// Each task has an error e(q), its Jacobian J = −∂e/∂q, and weights: the step Δq minimises ½ Σ |W (J Δq −
// gain · e)|² + ½ λ |Δq|² within the bounds of the limits (a quadratic program, box_qp.hpp).
//
// Not for kernels: it uses the standard library.
#pragma once

#include "cspace/ik/numeric/error.hpp"
#include "cspace/kinematics/center_of_mass.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/math/box_qp.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/model/robot_model.hpp"

namespace cspace::ik {

enum class TaskKind : int { pose, position, direction, center_of_mass };

struct FrameTask {
    TaskKind kind;
    int frame;         // unused by the centre of mass
    double gain;       // share of the error that one step takes away
    double weight[6];  // pose: of [Δp; rotation vector] in the axes of the target; else the first three
    Posed target;      // position, centre of mass: its t; direction: its t, a unit vector in the base
    Vec3d point;       // position: a point of the frame; direction: a unit vector of the frame
};
// Coordinates with preferred values.
struct PostureTask {
    const double* q;       // (n,)
    const double* weight;  // (n,)
    double gain;
};
// The error of a task: lengths of its weighted parts.
struct TaskError {
    double position, rotation;  // [m, rad]
};

struct TaskProblem {
    const model::RobotModel* model;
    bool floating;
    std::vector<FrameTask> tasks;
    std::vector<PostureTask> postures;
    const double* lower;  // (n,) limits of the coordinates, or null
    const double* upper;
};

// A configuration, and the errors and Jacobians of the tasks there.
struct TaskPlace {
    std::vector<double> q;  // (n,)
    Posed T_world_base;
    double cost = 0;  // ½ Σ |W e|²
    std::vector<TaskError> errors;
    std::vector<double> H, g;             // of the frames: Σ Jᵀ W² J and Σ Jᵀ W² gain · e
    std::vector<double> stiffness, pull;  // the same of the postures, whose Jᵀ W² J is diagonal
};

struct TaskWork {
    std::vector<double> s, c, J;
    std::vector<kinematics::Axis<double>> axes;
    std::vector<Posed> T_world_joint;
    std::vector<Vec3d> moments;
};

struct TaskEnd {
    int steps;
    bool settled;  // no step nearby is better
};

namespace multi_task {
inline constexpr double first_mu = 0.1, least_mu = 1e-9, largest_mu = 1e9, gained = 0.3, lost = 4.0;
inline constexpr double floor = 1e-13;  // of the damping, so that there is always one best step
inline constexpr double stride = 1.0;   // largest change of a joint, or of the turn of a base, in one step
}  // namespace multi_task

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline int dof_of(const TaskProblem& problem) {
    return problem.model->n_coordinates() + (problem.floating ? 6 : 0);
}

inline TaskWork task_work(const TaskProblem& problem) {
    const model::Tree tree = problem.model->tree();
    const std::size_t joints = std::size_t(tree.n_joints) + 4;
    TaskWork work;
    work.s.resize(joints);
    work.c.resize(joints);
    work.J.resize(6 * std::size_t(dof_of(problem)));
    work.axes.resize(joints);
    work.T_world_joint.resize(joints);
    work.moments.resize(joints);
    return work;
}

// The pose of a frame. work.J receives the Jacobian of its point p, rows [v; ω] in the world.
inline Posed measure_frame(const TaskProblem& problem, const TaskPlace& at, int frame, const Vec3d& p,
                           TaskWork& work) {
    const model::Chain& chain = problem.model->chain(frame);
    const int dof = dof_of(problem), first = problem.floating ? 6 : 0;
    const Posed T = kinematics::place_axes(chain, at.T_world_base * chain.T_base_first, at.q.data(),
                                           work.s.data(), work.c.data(), work.axes.data());
    kinematics::joint_columns(chain, work.axes.data(), T * p, work.J.data(), dof, first);
    if (problem.floating) kinematics::base_columns(T * p - at.T_world_base.t, work.J.data(), dof, 6);
    return T;
}

// The centre of mass. The first three rows of work.J receive its Jacobian.
inline Vec3d measure_center(const TaskProblem& problem, const TaskPlace& at, TaskWork& work) {
    const model::Tree tree = problem.model->tree();
    const int dof = dof_of(problem), first = problem.floating ? 6 : 0;
    kinematics::joint_poses(tree, at.q.data(), at.T_world_base, work.T_world_joint.data());
    const Vec3d center =
        kinematics::center_of_mass(tree, at.T_world_base, work.T_world_joint.data(), work.moments.data());
    kinematics::center_of_mass_columns(tree, work.T_world_joint.data(), work.moments.data(), work.J.data(),
                                       dof, first);
    if (problem.floating) kinematics::base_columns(center - at.T_world_base.t, work.J.data(), dof, 3);
    return center;
}

// Adds the rows `from` to `from + 2` of the Jacobian, rotated into the axes of Q, with their error and
// weights. Returns the length of the weighted part of the error.
inline double add_rows(const Mat3d& Q, const Vec3d& error, const double* weight, double gain, int from,
                       const TaskWork& work, int dof, TaskPlace& at) {
    double counted = 0;
    std::vector<double> row(static_cast<std::size_t>(dof));
    for (int k = 0; k < 3; ++k) {
        const double w2 = weight[k] * weight[k];
        if (!(w2 > 0)) continue;
        const Vec3d axis = matrix_column(Q, k);
        const double e = dot(axis, error);
        counted += e * e;
        at.cost += 0.5 * w2 * e * e;
        for (int j = 0; j < dof; ++j)
            row[std::size_t(j)] = dot(axis, kinematics::get_column(work.J.data(), dof, j, from));
        for (int i = 0; i < dof; ++i) {
            const double wi = w2 * row[std::size_t(i)];
            if (wi == 0) continue;
            at.g[std::size_t(i)] += wi * gain * e;
            double* H = at.H.data() + std::size_t(i) * std::size_t(dof);
            for (int j = 0; j < dof; ++j) H[j] += wi * row[std::size_t(j)];
        }
    }
    return std::sqrt(counted);
}

// The rotation vector that takes the unit vector a to d by the shortest rotation.
inline Vec3d turn_between(const Vec3d& a, const Vec3d& d) {
    constexpr double aligned = 1e-12;  // sine below which rounding decides the axis
    const Vec3d across = cross(a, d);
    const double s = norm(across), c = dot(a, d);
    if (s > aligned) return (std::atan2(s, c) / s) * across;
    return c > 0 ? across : pi * any_perpendicular(a);
}

inline TaskError add_task(const TaskProblem& problem, const FrameTask& task, TaskWork& work, TaskPlace& at) {
    const int dof = dof_of(problem);
    const Mat3d I = identity_pose().R;
    const double* w = task.weight;
    switch (task.kind) {
        case TaskKind::center_of_mass: {
            const Vec3d miss = task.target.t - measure_center(problem, at, work);
            return {add_rows(I, miss, w, task.gain, 0, work, dof, at), 0};
        }
        case TaskKind::position: {
            const Posed T = measure_frame(problem, at, task.frame, task.point, work);
            return {add_rows(I, task.target.t - T * task.point, w, task.gain, 0, work, dof, at), 0};
        }
        case TaskKind::direction: {
            const Posed T = measure_frame(problem, at, task.frame, {0, 0, 0}, work);
            const Vec3d a = T.R * task.point;
            // A turn about the direction itself does not count.
            for (int j = 0; j < dof; ++j) {
                const Vec3d h = kinematics::get_column(work.J.data(), dof, j, 3);
                kinematics::put_column(work.J.data(), dof, j, 3, h - dot(a, h) * a);
            }
            return {0, add_rows(I, turn_between(a, task.target.t), w, task.gain, 3, work, dof, at)};
        }
        default: {
            const Posed T = measure_frame(problem, at, task.frame, {0, 0, 0}, work);
            const Mat3d& Q = task.target.R;
            const Vec3d turn = spatial::rotvec_of_rotation(Q * transpose(T.R));
            const double away = add_rows(Q, task.target.t - T.t, w, task.gain, 0, work, dof, at);
            if (w[3] != w[4] || w[4] != w[5]) {
                // Unequal weights see how the rotation vector itself changes (see error.hpp).
                const LogRate<double> rate = log_rate(-turn);
                for (int j = 0; j < dof; ++j)
                    kinematics::put_column(work.J.data(), dof, j, 3,
                                           rate * kinematics::get_column(work.J.data(), dof, j, 3));
            }
            return {away, add_rows(Q, turn, w + 3, task.gain, 3, work, dof, at)};
        }
    }
}

// Evaluates the tasks at at.q and at.T_world_base.
inline void measure_tasks(const TaskProblem& problem, TaskWork& work, TaskPlace& at) {
    const std::size_t dof = std::size_t(dof_of(problem)), first = problem.floating ? 6 : 0;
    at.cost = 0;
    at.H.assign(dof * dof, 0.0);
    at.g.assign(dof, 0.0);
    at.stiffness.assign(dof, 0.0);
    at.pull.assign(dof, 0.0);
    at.errors.clear();
    for (const FrameTask& task : problem.tasks) at.errors.push_back(add_task(problem, task, work, at));
    for (const PostureTask& posture : problem.postures) {
        for (std::size_t j = first; j < dof; ++j) {
            const double e = posture.q[j - first] - at.q[j - first];
            const double w2 = posture.weight[j - first] * posture.weight[j - first];
            at.cost += 0.5 * w2 * e * e;
            at.pull[j] += w2 * posture.gain * e;
            at.stiffness[j] += w2;
        }
    }
}

// The step (dof,) that minimises the task error, with or without posture tasks, in the box given by qp.lower
// and qp.upper. False where the numbers are not finite.
inline bool best_step(const TaskPlace& at, double damping, bool postures, BoxQp& qp, double* step) {
    qp.H = at.H;
    qp.g = at.g;
    for (std::size_t j = 0; j < std::size_t(qp.n); ++j) {
        qp.H[j * std::size_t(qp.n) + j] += damping + (postures ? at.stiffness[j] : 0);
        qp.g[j] += postures ? at.pull[j] : 0;
        step[j] = 0;
    }
    return solve_box_qp(qp, step) >= 0;
}

// The state after a step. The base rotates and translates in the world.
inline void move_by(const TaskProblem& problem, const TaskPlace& from, const double* step, TaskPlace& to) {
    const std::size_t first = problem.floating ? 6 : 0;
    to.q = from.q;
    to.T_world_base = from.T_world_base;
    for (std::size_t j = 0; j < to.q.size(); ++j) {
        to.q[j] += step[first + j];
        if (problem.lower) to.q[j] = std::clamp(to.q[j], problem.lower[j], problem.upper[j]);
    }
    if (!problem.floating) return;
    const Vec3d w = {step[3], step[4], step[5]};
    to.T_world_base.t = to.T_world_base.t + Vec3d{step[0], step[1], step[2]};
    to.T_world_base.R = spatial::rotation_of_rotvec(w) * to.T_world_base.R;
}

// Inverse kinematics with several weighted tasks: Levenberg–Marquardt steps, each a quadratic program within
// the limits.
//
// Not for kernels: it uses the standard library.

// The bounds of the next step from q: coordinate j moves by most(j) at most, and not past its limits. From
// outside them it comes back in.
template <class Most>
inline void bound_step(const TaskProblem& problem, const double* q, const Most& most, BoxQp& qp) {
    const std::size_t first = problem.floating ? 6 : 0;
    for (std::size_t j = 0; j < std::size_t(qp.n); ++j) {
        const double high = most(j), low = -high;
        const bool limited = j >= first && problem.lower;
        qp.lower[j] = limited ? std::clamp(problem.lower[j - first] - q[j - first], low, high) : low;
        qp.upper[j] = limited ? std::clamp(problem.upper[j - first] - q[j - first], low, high) : high;
        qp.upper[j] = std::max(qp.lower[j], qp.upper[j]);
    }
}
inline double longest_stride(std::size_t) { return multi_task::stride; }

// Second-order correction after a step (Nocedal & Wright 2006, section 18.3). A soft posture task makes a
// curved valley, on whose floor the frame tasks are satisfied. The shortest step for the frame tasks alone
// returns to the floor.
inline void back_to_the_valley(const TaskProblem& problem, TaskWork& work, BoxQp& qp, double* step,
                               TaskPlace& there, TaskPlace& spare) {
    bound_step(problem, there.q.data(), longest_stride, qp);
    if (!best_step(there, multi_task::floor, false, qp, step)) return;
    move_by(problem, there, step, spare);
    measure_tasks(problem, work, spare);
    if (spare.cost < there.cost) std::swap(there, spare);
}

// Minimises the task error locally, from at.q (within the limits) and at.T_world_base. settled: a step this
// small ends the descent [rad, m].
inline TaskEnd solve_tasks(const TaskProblem& problem, int most_steps, double settled, TaskPlace& at) {
    TaskWork work = task_work(problem);
    BoxQp qp(dof_of(problem));
    TaskPlace there, spare;
    std::vector<double> step(std::size_t(qp.n));
    double mu = multi_task::first_mu;
    measure_tasks(problem, work, at);
    InterruptPoll poll(8);
    for (int k = 0; k < most_steps; ++k) {
        poll.step();
        bound_step(problem, at.q.data(), longest_stride, qp);
        if (!best_step(at, 2 * mu * at.cost + multi_task::floor, true, qp, step.data())) return {k, false};
        double reach = 0;
        for (const double d : step) reach = std::max(reach, std::fabs(d));
        move_by(problem, at, step.data(), there);
        measure_tasks(problem, work, there);
        if (there.cost >= at.cost && !problem.postures.empty())
            back_to_the_valley(problem, work, qp, step.data(), there, spare);
        const bool better = there.cost < at.cost;
        if (better) std::swap(at, there);
        if (reach <= settled) return {k + 1, true};
        mu = better ? std::max(multi_task::gained * mu, multi_task::least_mu) : multi_task::lost * mu;
        if (mu > multi_task::largest_mu) return {k + 1, true};
    }
    return {most_steps, false};
}

}  // namespace cspace::ik::inline CSPACE_ISA
