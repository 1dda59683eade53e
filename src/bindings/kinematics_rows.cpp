#include "kinematics_rows.hpp"

#include <memory>
#include <new>

#include "cspace/math/threads.hpp"
#include "kernels/kinematics.hpp"
#include "kinematics.hpp"

using namespace cspace;

const char kinematics_chain_rows_doc[] =
    "_chain_rows(frame, q, qd, T_world_base, point, T, J, J_rate, sigma, chosen, in_tip, threads)\n\n"
    "Fills the arrays that are not None; False if a value of q is not finite.";
const char kinematics_tree_rows_doc[] =
    "_tree_rows(q, T_world_base, T, center, center_columns, threads)\n\n"
    "Fills the arrays that are not None; False if a value of q is not finite.";

namespace {

// Reads arrays by what they must hold per row; one that does not fit leaves an error behind.
struct Reader {
    npy_intp rows;
    bool good = true;

    double* array(PyObject* value, npy_intp per_row, const char* name, bool written = false,
                  bool shared = false) {
        if (value == Py_None || !good) return nullptr;
        auto* a = reinterpret_cast<PyArrayObject*>(value);
        if (!PyArray_Check(value) || PyArray_TYPE(a) != NPY_DOUBLE || !PyArray_ISCARRAY_RO(a) ||
            (written && !PyArray_ISWRITEABLE(a))) {
            return fail("%s must be a contiguous float64 array", name);
        }
        const npy_intp size = PyArray_SIZE(a);
        if (size != rows * per_row && !(shared && size == per_row))
            return fail("%s has the wrong size", name);
        return static_cast<double*>(PyArray_DATA(a));
    }
    // Shared by all rows (0) or one each (per_row).
    std::size_t stride(PyObject* value, npy_intp per_row) const {
        if (value == Py_None) return 0;
        return PyArray_SIZE(reinterpret_cast<PyArrayObject*>(value)) == per_row ? 0 : std::size_t(per_row);
    }
    double* fail(const char* format, const char* name) {
        good = false;
        PyErr_Format(PyExc_ValueError, format, name);
        return nullptr;
    }
};

struct Free {
    void operator()(void* memory) const { ::operator delete(memory, std::align_val_t(64)); }
};

constexpr std::size_t lanes = 4, rows_worth_a_thread = 2048;

// Runs a kernel over all rows without the interpreter lock.
template <class Rows, class Kernel>
PyObject* run(const Rows& rows, npy_intp n, long threads, Kernel kernel) {
    bool finite = true;
    std::atomic<bool> memory = true;
    Py_BEGIN_ALLOW_THREADS;
    const std::size_t bytes = scratch_bytes(rows);
    finite = over_rows(std::size_t(n), int(threads), lanes, rows_worth_a_thread,
                       [&](std::size_t begin, std::size_t end) {
                           const std::unique_ptr<void, Free> scratch(
                               ::operator new(bytes, std::align_val_t(64), std::nothrow));
                           if (!scratch) {
                               memory = false;
                               return false;
                           }
                           return kernel(rows, begin, end, scratch.get());
                       });
    Py_END_ALLOW_THREADS;
    if (!memory) return PyErr_NoMemory();
    return PyBool_FromLong(finite);
}

const model::RobotModel* loaded(PyObject* self) {
    const auto& model = reinterpret_cast<KinematicsObject*>(self)->model;
    if (!model) PyErr_SetString(PyExc_TypeError, "the robot was not initialised");
    return model.get();
}
npy_intp row_count(PyObject* q, int n) {
    if (!PyArray_Check(q) || PyArray_NDIM(reinterpret_cast<PyArrayObject*>(q)) != 2 ||
        PyArray_DIM(reinterpret_cast<PyArrayObject*>(q), 1) != n) {
        PyErr_SetString(PyExc_ValueError, "q must have two axes, (rows, coordinates)");
        return -1;
    }
    return PyArray_DIM(reinterpret_cast<PyArrayObject*>(q), 0);
}
int count_bits(unsigned bits) {
    int count = 0;
    for (; bits; bits &= bits - 1) ++count;
    return count;
}

}  // namespace

PyObject* kinematics_chain_rows(PyObject* self, PyObject* const* args, Py_ssize_t nargs) {
    const model::RobotModel* model = loaded(self);
    if (!model) return nullptr;
    if (nargs != 12) return PyErr_Format(PyExc_TypeError, "_chain_rows takes 12 arguments, got %zd", nargs);
    const bool floating = reinterpret_cast<KinematicsObject*>(self)->floating;
    const long frame = PyLong_AsLong(args[0]), chosen = PyLong_AsLong(args[9]),
               threads = PyLong_AsLong(args[11]);
    const int in_tip = PyObject_IsTrue(args[10]);
    if (PyErr_Occurred()) return nullptr;
    if (frame < 0 || frame >= model->n_frames()) return PyErr_Format(PyExc_ValueError, "no frame %ld", frame);
    const int n = model->n_coordinates(), dof = n + (floating ? 6 : 0);
    Reader read{row_count(args[1], n)};
    if (read.rows < 0) return nullptr;
    const int counted = count_bits(unsigned(chosen) & 63u), k = counted < n ? counted : n;
    kinematics::ChainRows rows{};
    rows.chain = model->chain(int(frame));
    rows.q = read.array(args[1], n, "q");
    rows.qd = read.array(args[2], dof, "qd");
    rows.T_world_base = read.array(args[3], 16, "T_world_base", false, true);
    rows.point = read.array(args[4], 3, "point", false, true);
    rows.T = read.array(args[5], 16, "T", true);
    rows.J = read.array(args[6], 6 * dof, "J", true);
    rows.J_rate = read.array(args[7], 6 * dof, "J_rate", true);
    rows.sigma = read.array(args[8], k, "sigma", true);
    rows.floating = floating;
    rows.in_tip = in_tip != 0;
    rows.chosen = unsigned(chosen) & 63u;
    if (!read.good) return nullptr;
    if (rows.J_rate && !rows.qd) return PyErr_Format(PyExc_ValueError, "J_rate needs qd");
    rows.base_stride = read.stride(args[3], 16);
    rows.point_stride = read.stride(args[4], 3);
    return run(rows, read.rows, threads, kernels::chain_rows);
}

PyObject* kinematics_tree_rows(PyObject* self, PyObject* const* args, Py_ssize_t nargs) {
    const model::RobotModel* model = loaded(self);
    if (!model) return nullptr;
    if (nargs != 6) return PyErr_Format(PyExc_TypeError, "_tree_rows takes 6 arguments, got %zd", nargs);
    const bool floating = reinterpret_cast<KinematicsObject*>(self)->floating;
    const long threads = PyLong_AsLong(args[5]);
    if (PyErr_Occurred()) return nullptr;
    const int n = model->n_coordinates(), dof = n + (floating ? 6 : 0);
    Reader read{row_count(args[0], n)};
    if (read.rows < 0) return nullptr;
    kinematics::TreeRows rows{};
    rows.tree = model->tree();
    rows.q = read.array(args[0], n, "q");
    rows.T_world_base = read.array(args[1], 16, "T_world_base", false, true);
    rows.T = read.array(args[2], 16 * npy_intp(model->n_frames()), "T", true);
    rows.center = read.array(args[3], 3, "center", true);
    rows.center_columns = read.array(args[4], 3 * dof, "center_columns", true);
    rows.floating = floating;
    if (!read.good) return nullptr;
    rows.base_stride = read.stride(args[1], 16);
    return run(rows, read.rows, threads, kernels::tree_rows);
}
