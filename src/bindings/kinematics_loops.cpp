#include "kinematics_loops.hpp"

#include "bindings.hpp"
#include "kinematics_rows.hpp"
#include "library/kinematics_loops.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using kinematics::ClosedLoops;

namespace {

constexpr int joint_width = 6 + 16, loop_width = 2 * 17 + 10, row_width = 15;

Mat3d read_rotation(const double* values, int stride) {
    Mat3d R;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) R.m[i][j] = values[i * stride + j];
    return R;
}
Posed read_pose(const double* T) { return {read_rotation(T, 4), {T[3], T[7], T[11]}}; }
kinematics::LoopEnd read_end(const double* values) { return {int(values[0]), read_pose(values + 1)}; }
void require(bool fits) {
    if (!fits) throw nb::value_error("an array of the loops has the wrong size or a number out of range");
}
bool within(int number, int least, int count) { return number >= least && number < count; }

}  // namespace

LoopTable::LoopTable(const ConstDoubles& joints, const ConstDoubles& loops, const ConstDoubles& rows,
                     const ConstDoubles& sides, const ConstDoubles& unit, int n_coordinates, double length)
    : unit_(unit.data, unit.data + unit.size), n_coordinates_(n_coordinates), length_(length) {
    require(joints.size % joint_width == 0 && loops.size % loop_width == 0 && rows.size % row_width == 0);
    const int n = int(joints.size / joint_width), count = int(loops.size / loop_width);
    require(sides.size == npy_intp(n) * count && n_coordinates >= 0 && n_coordinates <= unit.size);
    for (const double* from = joints.data; from < joints.data + joints.size; from += joint_width) {
        joints_.push_back({int(from[0]), int(from[1]), int(from[2]), from[3] != 0.0, from[4], from[5],
                           read_pose(from + 6)});
        const kinematics::LoopJoint& joint = joints_.back();
        require(within(joint.parent, -1, int(joints_.size()) - 1) &&
                within(joint.coordinate, 0, n_coordinates) && within(joint.column, 0, int(unit.size)));
    }
    for (const double* from = loops.data; from < loops.data + loops.size; from += loop_width) {
        loops_.push_back({read_end(from), read_end(from + 17), from[34] != 0.0, read_rotation(from + 35, 3)});
        require(within(loops_.back().a.joint, -1, n) && within(loops_.back().b.joint, -1, n));
    }
    for (const double* from = rows.data; from < rows.data + rows.size; from += row_width) {
        rows_.push_back(
            {int(from[0]), {from[1], from[2], from[3]}, read_rotation(from + 4, 3), from[13], from[14]});
        require(within(rows_.back().loop, 0, count));
    }
    for (npy_intp i = 0; i < sides.size; ++i) sides_.push_back(static_cast<signed char>(sides.data[i]));
}

ClosedLoops LoopTable::view() const {
    return {joints_.data(),
            loops_.data(),
            rows_.data(),
            sides_.data(),
            unit_.data(),
            int(joints_.size()),
            int(loops_.size()),
            int(rows_.size()),
            n_coordinates_,
            int(unit_.size()),
            length_};
}

namespace {

void evaluate(const LoopTable& table, const ConstDoubles& q, const In& qd, const Out& phi,
              const std::optional<Plain<bool>>& over, const Out& K, const Out& wrenches, const Out& k,
              int threads) {
    const ClosedLoops loops = table.view();
    const npy_intp rows = row_count(q, loops.n_coordinates), r = loops.n_rows;
    if (k && !qd) throw nb::value_error("k needs velocities");
    const kinematics::LoopArrays arrays = {q.data,
                                           values_of(qd, rows, loops.dof),
                                           values_of(phi, rows, r),
                                           values_of(over, rows, loops.n_loops),
                                           values_of(K, rows, r * loops.dof),
                                           values_of(wrenches, rows, r * 6),
                                           values_of(k, rows, r)};
    const nb::gil_scoped_release release;
    kinematics::evaluate_loops(loops, arrays, std::size_t(rows), threads);
}

}  // namespace

void bind_kinematics_loops(nb::module_& m) {
    nb::class_<LoopTable>(m, "LoopTable", "The numbers of closed loops; see kinematics.LoopConstraints.")
        .def(nb::init<const ConstDoubles&, const ConstDoubles&, const ConstDoubles&, const ConstDoubles&,
                      const ConstDoubles&, int, double>(),
             "joints"_a, "loops"_a, "rows"_a, "sides"_a, "unit"_a, "n_coordinates"_a, "length"_a,
             "joints (…, 22): parent, coordinate, column, whether it turns, ratio, offset, place; loops (…, "
             "44); rows (…, 15); sides (loops, joints); unit (dof,).")
        .def("evaluate", evaluate, "q"_a, "qd"_a.none(), "phi"_a.none(), "over"_a.none(), "K"_a.none(),
             "wrenches"_a.none(), "k"_a.none(), "threads"_a,
             "Fills in the arrays of as many rows as q (rows, n) has.");
}
