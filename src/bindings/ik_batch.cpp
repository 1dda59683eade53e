// Many goals in one call: the kernel or the careful path over rows, on threads.
#include <algorithm>
#include <atomic>
#include <limits>

#include "cspace/ik/goal.hpp"
#include "cspace/math/threads.hpp"
#include "ik.hpp"
#include "ik_shared.hpp"

using namespace cspace;

namespace {

constexpr Py_ssize_t most_threads = 1024;
constexpr std::size_t rows_worth_a_thread = 256;

// Solutions into one goal's rows, NaN behind them.
void put(const ik::Solutions& found, int room, int dof, double* q, std::int64_t* count,
         unsigned char* status) {
    std::fill(q, q + room * dof, std::numeric_limits<double>::quiet_NaN());
    *count = std::min(found.count, room);
    for (int k = 0; k < *count; ++k) std::copy(found.q[k], found.q[k] + dof, q + k * dof);
    *status = static_cast<unsigned char>(int(found.status) + (found.complete ? 0 : incomplete));
}

// The kernel over a slice, then the careful path where it hesitated. Returns the first goal refused, or n.
std::size_t solve_poses(const ik::Arm& arm, const double* T, std::size_t n, double* q, std::int64_t* count,
                        unsigned char* status) {
    auto* quick = reinterpret_cast<ik::Quick*>(status);
    const bool has_kernel = arm.has_plan && arm.plan.on_lanes && arm.plan.virtual_joints == 0;
    const int dof = arm.plan.chain.n, room = room_for(arm), row = room * dof;
    if (has_kernel) kernels::ik_many(arm.plan, T, n, room, q, count, quick);
    for (std::size_t i = 0; i < n; ++i) {
        if (!has_kernel) quick[i] = read_goal(T + 16 * i).is_pose ? ik::Quick::doubtful : ik::Quick::refused;
        if (quick[i] == ik::Quick::refused) return i;
        if (quick[i] == ik::Quick::settled) {
            status[i] = static_cast<unsigned char>(count[i] ? ik::Status::exact : ik::Status::unreachable);
            continue;
        }
        const ik::Solutions found = solve_pose(arm, read_goal(T + 16 * i).T, nullptr);
        put(found, room, dof, q + i * std::size_t(row), count + i, status + i);
    }
    return n;
}

// The same for points.
std::size_t solve_positions(const ik::Arm& arm, const double* p, std::size_t n, double* q,
                            std::int64_t* count, unsigned char* status) {
    const ik::Chain& chain = arm.plan.chain;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3d goal = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
        if (!(std::fabs(goal.x) + std::fabs(goal.y) + std::fabs(goal.z) <= tolerance::farthest)) return i;
        const ik::Solutions found = from_short(chain, solve_position(chain, goal, false));
        put(found, max_branches, chain.n, q + i * std::size_t(max_branches * chain.n), count + i, status + i);
    }
    return n;
}

using Slice = std::size_t (*)(const ik::Arm&, const double*, std::size_t, double*, std::int64_t*,
                              unsigned char*);

// What a call for many goals works on.
struct Batch {
    PyObject *robot, *goals, *q, *count, *status;
    Py_ssize_t threads;
};
bool read_batch(PyObject* args, const char* function, npy_intp numbers, Batch& b) {
    if (!PyArg_ParseTuple(args, "OOOOOn", &b.robot, &b.goals, &b.q, &b.count, &b.status, &b.threads))
        return false;
    const ik::Arm* arm = arm_of(b.robot);
    const npy_intp n = PyArray_Check(b.count) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(b.count)) : -1;
    if (arm && can_solve(*arm) && (numbers != 3 || arm->is_short) && n >= 0 &&
        is_doubles(b.goals, numbers * n) && is_doubles(b.q, n * room_for(*arm) * arm->plan.chain.n) &&
        is_plain(b.count, NPY_INT64, n) && is_plain(b.status, NPY_UINT8, n) && is_writable(b.q) &&
        is_writable(b.count) && is_writable(b.status))
        return true;
    PyErr_Format(PyExc_TypeError,
                 "%s takes a robot with a solver and contiguous arrays: float64, count int64, status uint8",
                 function);
    return false;
}

// All goals, on threads. Returns the first goal refused, or their number, as a Python integer.
PyObject* solve_all(const Batch& b, std::size_t numbers, Slice solve) {
    const ik::Arm* arm = arm_of(b.robot);
    const double* goals = data_of(b.goals);
    double* q = data_of(b.q);
    auto* counts = static_cast<std::int64_t*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(b.count)));
    auto* verdicts = static_cast<unsigned char*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(b.status)));
    const auto total = std::size_t(PyArray_SIZE(reinterpret_cast<PyArrayObject*>(b.count)));
    const std::size_t row = std::size_t(room_for(*arm) * arm->plan.chain.n);
    std::atomic<std::size_t> bad = total;
    Py_BEGIN_ALLOW_THREADS;
    const auto work = [&](std::size_t from, std::size_t to) {
        const std::size_t size = to - from;
        const std::size_t stopped =
            solve(*arm, goals + numbers * from, size, q + row * from, counts + from, verdicts + from);
        if (stopped == size) return true;
        std::size_t first = bad;
        while (from + stopped < first && !bad.compare_exchange_weak(first, from + stopped)) {
        }
        return false;
    };
    over_rows(total, int(std::clamp<Py_ssize_t>(b.threads, 1, most_threads)), 1, rows_worth_a_thread, work);
    Py_END_ALLOW_THREADS;
    return PyLong_FromSize_t(bad);
}

}  // namespace

// _ik_many(robot, goals (n, 4, 4), q (n, k_max, dof), count (n,), status (n,), threads) → index of the first
// goal that is no pose, or n
PyObject* ik_many(PyObject*, PyObject* args) {
    Batch b;
    return read_batch(args, "_ik_many", 16, b) ? solve_all(b, 16, solve_poses) : nullptr;
}

// _ik_positions(robot, points (n, 3), q (n, k_max, dof), count (n,), status (n,), threads) → index of the
// first point that is not finite or too far away, or n
PyObject* ik_positions(PyObject*, PyObject* args) {
    Batch b;
    return read_batch(args, "_ik_positions", 3, b) ? solve_all(b, 3, solve_positions) : nullptr;
}
