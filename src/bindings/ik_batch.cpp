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

// The kernel over a slice, then the careful path where it hesitated. Returns the first goal refused, or n.
std::size_t solve_slice(const ik::Arm& arm, const double* T, std::size_t n, double* q, std::int64_t* count,
                        unsigned char* status) {
    auto* quick = reinterpret_cast<ik::Quick*>(status);
    const bool has_kernel = arm.has_plan && arm.plan.on_lanes && arm.plan.virtual_joints == 0;
    if (has_kernel) kernels::ik_many(arm.plan, T, n, q, count, quick);
    const int dof = arm.plan.chain.n, row = max_branches * dof;
    for (std::size_t i = 0; i < n; ++i) {
        if (!has_kernel) quick[i] = read_goal(T + 16 * i).is_pose ? ik::Quick::doubtful : ik::Quick::refused;
        if (quick[i] == ik::Quick::refused) return i;
        if (quick[i] == ik::Quick::settled) {
            status[i] = static_cast<unsigned char>(count[i] ? ik::Status::exact : ik::Status::unreachable);
            continue;
        }
        const ik::Solutions found = solve_pose(arm, read_goal(T + 16 * i).T, nullptr);
        double* out = q + i * std::size_t(row);
        std::fill(out, out + row, std::numeric_limits<double>::quiet_NaN());
        count[i] = std::min(found.count, max_branches);
        for (int k = 0; k < count[i]; ++k) std::copy(found.q[k], found.q[k] + dof, out + k * dof);
        status[i] = static_cast<unsigned char>(found.status);
    }
    return n;
}

}  // namespace

// _ik_many(robot, goals (n, 4, 4), q (n, 8, dof), count (n,), status (n,), threads) → index of the first goal
// that is no pose, or n
PyObject* ik_many(PyObject*, PyObject* args) {
    PyObject *robot, *goals, *q, *count, *status;
    Py_ssize_t threads;
    if (!PyArg_ParseTuple(args, "OOOOOn", &robot, &goals, &q, &count, &status, &threads)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    const npy_intp n = PyArray_Check(count) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(count)) : -1;
    if (!arm || !can_solve(*arm) || n < 0 || !is_doubles(goals, 16 * n) ||
        !is_doubles(q, n * max_branches * arm->plan.chain.n) || !is_plain(count, NPY_INT64, n) ||
        !is_plain(status, NPY_UINT8, n) || !is_writable(q) || !is_writable(count) || !is_writable(status)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_many takes a robot with a solver and contiguous arrays: float64, count int64, "
                        "status uint8");
        return nullptr;
    }
    const double* T = data_of(goals);
    double* out = data_of(q);
    auto* counts = static_cast<std::int64_t*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(count)));
    auto* verdicts = static_cast<unsigned char*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(status)));
    const std::size_t total = std::size_t(n), row = std::size_t(max_branches * arm->plan.chain.n);
    std::atomic<std::size_t> bad = total;
    Py_BEGIN_ALLOW_THREADS;
    const auto work = [&](std::size_t from, std::size_t to) {
        const std::size_t size = to - from;
        const std::size_t stopped =
            solve_slice(*arm, T + 16 * from, size, out + row * from, counts + from, verdicts + from);
        if (stopped == size) return true;
        std::size_t first = bad;
        while (from + stopped < first && !bad.compare_exchange_weak(first, from + stopped)) {
        }
        return false;
    };
    over_rows(total, int(std::clamp<Py_ssize_t>(threads, 1, most_threads)), 1, rows_worth_a_thread, work);
    Py_END_ALLOW_THREADS;
    return PyLong_FromSize_t(bad);
}
