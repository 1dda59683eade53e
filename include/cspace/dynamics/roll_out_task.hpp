// What roll-outs are given: what acts on a robot, a control, a method, and arrays for states and records.
//
// Plain data, which all instruction sets share.
#pragma once

#include <cstddef>

#include "cspace/dynamics/multibody.hpp"
#include "cspace/kinematics/closed_loops.hpp"
#include "cspace/model/chain.hpp"

namespace cspace::dynamics {

// What the world does to the robot at a frame: force and torque (6,) at its origin.
struct FrameWrench {
    model::Chain chain;  // to the frame
    const double* wrench;
    std::size_t stride;  // from row to row; 0: one for all
};

// What acts on a robot at every time.
struct Mechanics {
    Multibody bodies;
    Vec3d gravity;
    bool floating;
    const double *damping, *dry;  // of the coordinates (dof,), zero for a base; null: none rubs
    double friction_speed;        // where dry friction has 76 % of its value
    const FrameWrench* wrenches;
    int n_wrenches;
    const kinematics::ClosedLoops* loops;  // that stay closed, or null
    bool in_tip;  // wrenches are in the axes of their frames, otherwise in those of the base
    CSPACE_INLINE int first() const { return floating ? 6 : 0; }
    CSPACE_INLINE int dof() const { return first() + bodies.n_coordinates; }
};

// Values of every row, `stride` apart; 0: one row for all. Null for none.
struct RowValues {
    const double* values;
    std::size_t stride;
};

enum class ControlLaw { given, pd, computed_torque };

struct Control {
    ControlLaw law;
    RowValues torques;    // given (dof,); null for zero
    RowValues kp, kd;     // (n,)
    RowValues goal;       // of pd (n,)
    bool carries_weight;  // of pd: gravity is compensated
    RowValues motion;     // of computed torque (steps, 3, n): q, q̇ and q̈ at the steps from `begin` on
    long long begin;
    const double *damping, *dry;  // of the joints (n,), cancelled by computed torque
};

enum class Method { runge_kutta, variational, adaptive };
// How a row stands: before its end, after its duration, at a limit of a joint, without a next state, or cut
// off by a time limit.
enum Status : int { running, ended, at_limit, broken, out_of_time };

// The recorded states of each row: q (rows, count, n), qd, tau (rows, count, dof), energy (rows, count),
// centroidal momentum (rows, count, 6), and the poses of a floating base (rows, count, 4, 4), or null.
struct Records {
    double *q, *qd, *tau, *energy, *momentum, *T;
    std::size_t count;
};

// The steps of the adaptive method, each `width` numbers: when it begins, its length, q, qd and the pose at
// its beginning, and the coefficients (4, dof) of displacement and of change of velocity. values (8 rows,
// room, width), count (8,).
struct PieceBuffer {
    double* values;
    int* count;
    int room;
};

struct RollOut {
    Mechanics mechanics;
    Control control;
    Method method;
    double duration, dt, tolerance;
    long long steps, every;       // of dt, the last up to the duration; every so many states are recorded
    bool keeps_pieces;            // of the adaptive method
    bool is_held;                 // what acts is held over each step, so that no adaptive one is longer
    const double *lower, *upper;  // where a motion ends (n,), or null
    double *q, *qd, *T;           // the state of each row
    std::size_t T_stride;         // 0: one pose for all rows, of a base that does not float
    double* tau;                  // (rows, dof): what the control said last
    int *status, *joint;          // of each row; the joint at its limit
    int* rank;                    // of K of each row, the largest so far at closed loops; null without loops
    double* stopped;              // when it did
    double *time, *length;        // of the adaptive method: the time of each row and its next step
    long long* next;              // and the step of its next record
    Records records;

    CSPACE_INLINE double find_time(long long k) const { return k == steps ? duration : double(k) * dt; }
    // Of the state at the beginning of step k; −1: it is not recorded.
    CSPACE_INLINE long long find_record(long long k) const {
        if (k == steps) return (k + every - 1) / every;
        return k % every ? -1 : k / every;
    }
    CSPACE_INLINE int piece_width() const {
        return 2 + mechanics.bodies.n_coordinates + 9 * mechanics.dof() + (mechanics.floating ? 16 : 0);
    }
};

}  // namespace cspace::dynamics
