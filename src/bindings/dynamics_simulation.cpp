// Roll-outs over arrays that Python owns, run here step by step or all at once.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>

#include "cspace/dynamics/make_links.hpp"
#include "kinematics_loops.hpp"
#include "kinematics_rows.hpp"
#include "library/dynamics_roll_out.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using dynamics::ControlLaw;
using dynamics::Method;

namespace {

using Flags = Plain<std::int32_t>;

// A simulation: what it reads and writes belongs to the arrays that it keeps.
class Simulator {
  public:
    Simulator(nb::object robot, const std::string& method, const ConstDoubles& gravity, const In& damping,
              const In& dry, double friction_speed, const std::pair<double, double>& times,
              const std::pair<long long, long long>& steps, bool is_held, bool keeps_pieces, double tolerance,
              const In& lower, const In& upper, int threads)
        : robot_(std::move(robot)), threads_(threads) {
        KinematicsObject& object = robot_from(robot_);
        auto& mechanics = task_.mechanics;
        mechanics.bodies = links_of(object).view();
        mechanics.floating = object.floating;
        mechanics.friction_speed = friction_speed;
        if (gravity.size != 3) throw nb::value_error("gravity has three numbers");
        mechanics.gravity = {gravity.data[0], gravity.data[1], gravity.data[2]};
        n_ = mechanics.bodies.n_coordinates;
        dof_ = mechanics.dof();
        mechanics.damping = keep(damping, dof_);
        mechanics.dry = keep(dry, dof_);
        if (!mechanics.damping != !mechanics.dry)
            throw nb::value_error("damping and dry friction go together");
        task_.method = method == "rk4"           ? Method::runge_kutta
                       : method == "variational" ? Method::variational
                                                 : Method::adaptive;
        task_.duration = times.first;
        task_.dt = times.second;
        task_.steps = steps.first;
        task_.every = steps.second;
        task_.is_held = is_held;
        task_.keeps_pieces = keeps_pieces;
        task_.tolerance = tolerance;
        task_.lower = keep(lower, n_);
        task_.upper = keep(upper, n_);
    }

    // Loops that stay closed, and the rank of each row so far.
    void close_loops(nb::object table, const Flags& rank) {
        kept_.push_back(table);
        loops_ = nb::cast<const LoopTable&>(table).view();
        require(loops_.dof == dof_ && loops_.n_coordinates == n_ && task_.method == Method::runge_kutta);
        task_.mechanics.loops = &loops_;
        task_.rank = keep(rank, rows_);
    }

    // The state of each row (rows, …), and whether one pose (16,) serves all.
    void hold_state(const Doubles& q, const Doubles& qd, const Doubles& T, const Doubles& tau,
                    const Flags& status, const Flags& joint, const Doubles& stopped) {
        rows_ = status.size;
        task_.q = keep(q, rows_ * n_);
        task_.qd = keep(qd, rows_ * dof_);
        const bool is_shared = T.size == 16 && !task_.mechanics.floating;
        task_.T = keep(T, is_shared ? 16 : rows_ * 16);
        task_.T_stride = is_shared ? 0 : 16;
        task_.tau = keep(tau, rows_ * dof_);
        task_.status = keep(status, rows_);
        task_.joint = keep(joint, rows_);
        task_.stopped = keep(stopped, rows_);
        time_.assign(std::size_t(rows_), 0.0);
        length_.assign(std::size_t(rows_), task_.dt);
        next_.assign(std::size_t(rows_), 0);
        pieces_.resize(task_.method == Method::adaptive ? std::size_t(rows_) : 0);
        task_.time = time_.data();
        task_.length = length_.data();
        task_.next = next_.data();
    }
    // Where states are recorded: (rows, count, …).
    void hold_records(const Doubles& q, const Doubles& qd, const Doubles& tau, const Doubles& energy,
                      const Doubles& momentum, const Out& T) {
        const npy_intp count = rows_ > 0 ? energy.size / rows_ : 0;
        task_.records = {keep(q, rows_ * count * n_),
                         keep(qd, rows_ * count * dof_),
                         keep(tau, rows_ * count * dof_),
                         keep(energy, rows_ * count),
                         keep(momentum, rows_ * count * 6),
                         T ? keep(*T, rows_ * count * 16) : nullptr,
                         std::size_t(count)};
        const long long needed = (task_.steps + task_.every - 1) / task_.every + 1;
        if (rows_ > 0 && count < needed) throw nb::value_error("the records are too short");
        if (task_.mechanics.floating != bool(T)) throw nb::value_error("a floating base has poses to record");
    }

    void set_torques(const In& tau) {
        task_.control = {};
        torques_ = tau;
        task_.control.torques = rows_of(torques_, dof_);
    }
    void set_pd(const ConstDoubles& kp, const ConstDoubles& kd, const ConstDoubles& goal,
                bool carries_weight) {
        task_.control = {};
        task_.control.law = ControlLaw::pd;
        task_.control.kp = keep_rows(kp, n_);
        task_.control.kd = keep_rows(kd, n_);
        task_.control.goal = keep_rows(goal, n_);
        task_.control.carries_weight = carries_weight;
    }
    void set_computed_torque(const ConstDoubles& kp, const ConstDoubles& kd, const ConstDoubles& damping,
                             const ConstDoubles& dry) {
        if (task_.mechanics.floating) throw nb::value_error("the base floats");
        task_.control = {};
        task_.control.law = ControlLaw::computed_torque;
        task_.control.kp = keep_rows(kp, n_);
        task_.control.kd = keep_rows(kd, n_);
        task_.control.damping = keep(damping, n_);
        task_.control.dry = keep(dry, n_);
        task_.control.begin = 0;
        motion_steps_ = 0;
    }
    // q, qd and qdd (steps, 3, n), or of each row, from step `begin` on.
    void set_motion(const ConstDoubles& samples, long long begin, long long count) {
        motion_ = samples;
        task_.control.motion = rows_of(motion_, npy_intp(count) * 3 * n_);
        task_.control.begin = begin;
        motion_steps_ = count;
    }
    void set_wrenches(const std::vector<std::pair<int, ConstDoubles>>& wrenches, bool in_tip) {
        wrench_values_.clear();
        wrenches_.clear();
        for (const auto& [frame, values] : wrenches) {
            wrench_values_.push_back(values);
            const auto rows = rows_of(values, 6);
            wrenches_.push_back({chain_on(robot_, frame), rows.values, rows.stride});
        }
        task_.mechanics.wrenches = wrenches_.data();
        task_.mechanics.n_wrenches = int(wrenches_.size());
        task_.mechanics.in_tip = in_tip;
    }

    // From step k to k_end; seconds: what is left of the time limit, infinite without one.
    void run(long long k, long long k_end, double seconds) {
        if (k < 0 || k_end > task_.steps + 1) throw nb::value_error("there are no such steps");
        if (!task_.q || !task_.records.q) throw nb::value_error("arrays are missing");
        if (task_.control.law == ControlLaw::computed_torque &&
            (k < task_.control.begin ||
             std::min(k_end, task_.steps + 1) > task_.control.begin + motion_steps_))
            throw nb::value_error("the motion is not known at these steps");
        const auto deadline = deadline_in(seconds);
        const nb::gil_scoped_release release;
        if (task_.method == Method::adaptive)
            dynamics::roll_out_adaptively(task_, std::size_t(rows_), k, k_end, threads_, deadline, pieces_);
        else
            dynamics::roll_out(task_, std::size_t(rows_), k, k_end, threads_, deadline);
    }
    // The steps of the adaptive method of all rows (k, width), and where those of each row begin (rows + 1,).
    std::pair<Doubles, Plain<std::int64_t>> take_pieces() {
        const npy_intp width = task_.piece_width();
        std::size_t total = 0;
        for (const auto& row : pieces_) total += row.size();
        std::pair<Doubles, Plain<std::int64_t>> taken{Doubles({npy_intp(total) / width, width}),
                                                      Plain<std::int64_t>({npy_intp(pieces_.size()) + 1})};
        double* to = taken.first.data;
        std::int64_t *first = taken.second.data, count = 0;
        for (auto& row : pieces_) {
            *first++ = count;
            to = std::copy(row.begin(), row.end(), to);
            count += std::int64_t(row.size()) / width;
            std::vector<double>().swap(row);
        }
        *first = count;
        return taken;
    }

  private:
    template <class T>
    T* keep(const Plain<T>& array, npy_intp size) {
        require(array.size == size);
        kept_.push_back(array.array);
        return array.data;
    }
    const double* keep(const In& array, npy_intp size) { return array ? keep(*array, size) : nullptr; }
    dynamics::RowValues keep_rows(const ConstDoubles& array, npy_intp width) {
        kept_.push_back(array.array);
        return rows_of(array, width);
    }
    dynamics::RowValues rows_of(const In& array, npy_intp width) const {
        return array ? rows_of(*array, width) : dynamics::RowValues{nullptr, 0};
    }
    dynamics::RowValues rows_of(const ConstDoubles& array, npy_intp width) const {
        const bool is_shared = array.size == width;
        require(is_shared || array.size == rows_ * width);
        return {array.data, is_shared ? 0 : std::size_t(width)};
    }
    static void require(bool fits) {
        if (!fits) throw nb::value_error("an array has the wrong size");
    }
    static dynamics::Deadline deadline_in(double seconds) {
        constexpr double forever = 1e9;
        if (!(seconds < forever)) return dynamics::Deadline::max();
        return std::chrono::steady_clock::now() + std::chrono::duration_cast<dynamics::Deadline::duration>(
                                                      std::chrono::duration<double>(seconds));
    }

    nb::object robot_;
    dynamics::RollOut task_{};
    kinematics::ClosedLoops loops_{};
    npy_intp rows_ = 0, n_ = 0, dof_ = 0;
    long long motion_steps_ = 0;
    int threads_;
    std::vector<nb::object> kept_;
    In torques_, motion_;
    std::vector<ConstDoubles> wrench_values_;
    std::vector<dynamics::FrameWrench> wrenches_;
    std::vector<double> time_, length_;
    std::vector<long long> next_;
    std::vector<std::vector<double>> pieces_;
};

}  // namespace

void bind_dynamics_simulation(nb::module_& m) {
    nb::class_<Simulator>(m, "Simulator", "The compiled half of cspace.dynamics.simulate.")
        .def(nb::init<nb::object, const std::string&, const ConstDoubles&, const In&, const In&, double,
                      const std::pair<double, double>&, const std::pair<long long, long long>&, bool, bool,
                      double, const In&, const In&, int>(),
             "robot"_a, "method"_a, "gravity"_a, "damping"_a.none(), "dry"_a.none(), "friction_speed"_a,
             "times"_a, "steps"_a, "is_held"_a, "keeps_pieces"_a, "tolerance"_a, "lower"_a.none(),
             "upper"_a.none(), "threads"_a,
             "times: duration and dt; steps: how many, and of how many one state is recorded.")
        .def("hold_state", &Simulator::hold_state, "q"_a, "qd"_a, "T_world_base"_a, "tau"_a, "status"_a,
             "joint"_a, "stopped"_a, "The arrays of the states of all rows, which are written to.")
        .def("hold_records", &Simulator::hold_records, "q"_a, "qd"_a, "tau"_a, "energy"_a, "momentum"_a,
             "T_world_base"_a.none(), "The arrays (rows, count, …) into which states are recorded.")
        .def("close_loops", &Simulator::close_loops, "loops"_a, "rank"_a,
             "A LoopTable whose loops stay closed, and the rank of each row, after the state.")
        .def("set_torques", &Simulator::set_torques, "tau"_a.none(), "Torques that are given.")
        .def("set_pd", &Simulator::set_pd, "kp"_a, "kd"_a, "goal"_a, "carries_weight"_a,
             "Proportional and derivative control.")
        .def("set_computed_torque", &Simulator::set_computed_torque, "kp"_a, "kd"_a, "damping"_a, "dry"_a,
             "Computed torque along the motion of set_motion.")
        .def("set_motion", &Simulator::set_motion, "samples"_a, "begin"_a, "count"_a,
             "q, qd and qdd (…, count, 3, n) at the steps from `begin` on.")
        .def("set_wrenches", &Simulator::set_wrenches, "wrenches"_a, "in_tip"_a,
             "The number of a frame, and what the world does there (…, 6).")
        .def("run", &Simulator::run, "k"_a, "k_end"_a, "seconds"_a, "From step k to step k_end.")
        .def("take_pieces", &Simulator::take_pieces,
             "The steps of the adaptive method (k, width), and where those of each row begin.");
}
