#include "trajectory_states.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cspace/math/threads.hpp"
#include "cspace/trajectory/synchronize.hpp"
#include "kernels/trajectory_states.hpp"

namespace cspace::trajectory {

namespace {

// A phase as two, so that one part of the motion can be given from each end.
void split_phase(Phases& phases) {
    Phase& f = phases.phase[0];
    f.h /= 2;
    phases.append({f.h, f.a + f.h * f.j, f.j});
}

// The boundary states (2, 3, dof) and the limits (5, dof) of one problem.
struct Task {
    std::size_t dof;
    const double *states, *limits_of_axes;

    AxisState state(std::size_t end, std::size_t axis) const {
        const double* s = states + end * 3 * dof + axis;
        return {s[0], s[dof], s[2 * dof]};
    }
    AxisLimits limits(std::size_t axis) const {
        const double* l = limits_of_axes + axis;
        return {l[0], l[dof], l[2 * dof], l[3 * dof], l[4 * dof]};
    }
};

// One problem: rows of StateProblems from its own place on.
struct Problem {
    const StateProblems& all;
    std::size_t row;

    Task task() const { return {all.dof, all.states + row * 6 * all.dof, all.limits}; }
    double* shortest() const { return all.shortest + row * all.dof; }
    // Whether a duration is asked for, and the least one that may be answered.
    bool is_timed() const { return !std::isnan(all.durations[row]); }

    void answer(Verdict verdict, double duration) const {
        all.verdict[row] = std::int32_t(verdict);
        all.duration[row] = duration;
    }
    void write_motion(std::size_t i, const Axis& axis, double T) const {
        const Combination made = combine_axis(axis, std::max(T - axis.brake_time, 0.0));
        const std::size_t stride = all.rows * all.dof;
        double* out = all.motions + row * all.dof + i;
        *out = made.theta;
        for (const double* times : {made.up, made.down})
            for (int k = 0; k < 7; ++k) *(out += stride) = times[k];
    }
};

// From where on a duration is looked for. One within rounding of the shortest is the shortest.
double first_duration(const Problem& problem, double least) {
    if (!problem.is_timed()) return round_up(least, problem.all.cycle);
    const double asked = problem.all.durations[problem.row];
    return asked >= least * (1 - duration_rounding) ? std::max(asked, least) : least;
}

// The answer is T, refused if another duration was asked for.
void answer_duration(const Problem& problem, double T) {
    const double asked = problem.all.durations[problem.row];
    const bool is_kept = !problem.is_timed() || std::fabs(T - asked) <= duration_rounding * T;
    problem.answer(is_kept ? Verdict::found : Verdict::refused_duration, T);
}

double greatest_of(const double* values, std::size_t n) {
    double most = 0;
    for (std::size_t i = 0; i < n; ++i) most = std::max(most, values[i]);
    return most;
}

// The duration of axes that move together.
double choose_duration(const Problem& problem, Axis* axes, std::size_t n, double least) {
    const double cycle = problem.is_timed() ? 0 : problem.all.cycle;
    const double T = common_duration(axes, n, first_duration(problem, least), cycle);
    answer_duration(problem, T);
    return T;
}

// Axes whose shortest times are known.
void finish_in_time(const Problem& problem, Axis* axes) {
    const std::size_t n = problem.all.dof;
    const double least = greatest_of(problem.shortest(), n);
    const bool alone = problem.all.mode == Synchronize::none;
    if (alone)
        problem.answer(Verdict::found, least);
    else
        choose_duration(problem, axes, n, least);
    for (std::size_t i = 0; i < n; ++i)
        problem.write_motion(i, axes[i], alone ? problem.shortest()[i] : problem.all.duration[problem.row]);
}

void solve_in_time(const Problem& problem, Axis* axes) {
    const Task task = problem.task();
    for (std::size_t i = 0; i < task.dof; ++i) {
        set_axis(axes[i], task.state(0, i), task.state(1, i), task.limits(i));
        problem.shortest()[i] = axes[i].shortest;
    }
    finish_in_time(problem, axes);
}

constexpr std::size_t rows_at_once = 64;

// Problems with limits of jerk, their axes side by side in lanes.
class LaneSolver {
  public:
    LaneSolver(const StateProblems& all, std::size_t rows)
        : all_(all),
          dof_(all.dof),
          width_(rows * all.dof),
          numbers_(tables * width_),
          possible_(new bool[width_]) {
        for (std::size_t k = 0; k < 5; ++k)
            for (std::size_t i = 0; i < width_; ++i) table(limits + k)[i] = all.limits[k * dof_ + i % dof_];
    }

    // Rows begin … end, no more than there is room for.
    void solve(std::size_t begin, std::size_t end) {
        const std::size_t count = (end - begin) * dof_, first = begin * dof_;
        for (std::size_t row = begin; row < end; ++row) set_tasks(row, (row - begin) * dof_);
        const AxisRows rows{count,
                            table(v0),
                            table(a0),
                            table(vf),
                            table(af),
                            table(P),
                            table(limits),
                            table(limits + 1),
                            table(limits + 2),
                            table(limits + 3),
                            table(limits + 4)};
        kernels::find_shortest_times(rows, table(time));
        for (std::size_t i = 0; i < count; ++i) all_.shortest[first + i] = table(brake)[i] + table(time)[i];
        if (all_.mode == Synchronize::time)
            for (std::size_t row = begin; row < end; ++row) set_durations(row, (row - begin) * dof_);
        kernels::attain_times(rows, table(time), all_.motions + first, all_.rows * dof_, possible_.get());
        for (std::size_t row = begin; row < end; ++row) answer(row, (row - begin) * dof_);
    }

  private:
    // Tables of one number per axis; of limits there are five.
    enum Table : std::size_t { v0, a0, vf, af, P, brake, time, limits, tables = limits + 5 };

    double* table(std::size_t which) { return numbers_.data() + which * width_; }

    void set_tasks(std::size_t row, std::size_t at) {
        const double* s = all_.states + row * 6 * dof_;
        for (std::size_t i = 0; i < dof_; ++i) {
            table(v0)[at + i] = s[dof_ + i];
            table(a0)[at + i] = s[2 * dof_ + i];
            table(P)[at + i] = s[3 * dof_ + i] - s[i];
            table(vf)[at + i] = s[4 * dof_ + i];
            table(af)[at + i] = s[5 * dof_ + i];
            table(brake)[at + i] = 0;
        }
        for (std::size_t i = 0; i < dof_; ++i) {
            if (s[dof_ + i] == 0 && s[2 * dof_ + i] == 0) continue;
            Phases phases;
            const AxisState start{0, s[dof_ + i], s[2 * dof_ + i]};
            const AxisState within = append_brake(start, Task{dof_, s, all_.limits}.limits(i), phases);
            if (phases.count == 0) continue;
            table(v0)[at + i] = within.v;
            table(a0)[at + i] = within.a;
            table(P)[at + i] -= within.p;
            table(brake)[at + i] = phases.duration();
        }
    }
    void set_durations(std::size_t row, std::size_t at) {
        const Problem problem{all_, row};
        const double T = first_duration(problem, greatest_of(problem.shortest(), dof_));
        all_.duration[row] = T;
        for (std::size_t i = 0; i < dof_; ++i) table(time)[at + i] = T - table(brake)[at + i];
    }
    void answer(std::size_t row, std::size_t at) {
        const Problem problem{all_, row};
        const Task task = problem.task();
        bool agreed = true;
        for (std::size_t i = 0; i < dof_; ++i)
            agreed &= possible_[at + i] || (table(P)[at + i] == 0 && is_still(task, i));
        if (agreed && all_.mode == Synchronize::none)
            return problem.answer(Verdict::found, greatest_of(problem.shortest(), dof_));
        if (agreed) return answer_duration(problem, all_.duration[row]);
        axes_.resize(dof_);
        for (std::size_t i = 0; i < dof_; ++i) {
            set_task(axes_[i], task.state(0, i), task.state(1, i), task.limits(i));
            axes_[i].shortest = problem.shortest()[i];
        }
        finish_in_time(problem, axes_.data());
    }
    static bool is_still(const Task& task, std::size_t i) {
        const AxisState s = task.state(0, i), g = task.state(1, i);
        return s.v == 0 && s.a == 0 && g.v == 0 && g.a == 0;
    }

    const StateProblems& all_;
    std::size_t dof_, width_;
    std::vector<double> numbers_;
    std::unique_ptr<bool[]> possible_;
    std::vector<Axis> axes_;
};

bool has_jerk_limits(const StateProblems& problems) {
    const double* jerk = problems.limits + 4 * problems.dof;
    return std::all_of(jerk, jerk + problems.dof, [](double each) { return each < never; });
}

// A line that all axes follow: displacements and boundary states are multiples of one direction.
struct Line {
    std::vector<double> direction;
    AxisState start{}, goal{};
    AxisLimits limits{};
};

// The multiple of the direction that a vector is; NaN if it is none.
double multiple_of(const std::vector<double>& direction, const std::vector<double>& x) {
    double dot = 0, square = 0, most = 0, rest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        dot += direction[i] * x[i];
        square += direction[i] * direction[i];
        most = std::max(most, std::fabs(x[i]));
    }
    const double factor = square > 0 ? dot / square : 0;
    for (std::size_t i = 0; i < x.size(); ++i) rest = std::max(rest, std::fabs(x[i] - factor * direction[i]));
    return rest <= parallel_rounding * most ? factor : std::nan("");
}

AxisLimits limits_along(const Task& task, const std::vector<double>& direction) {
    AxisLimits l{never, -never, never, -never, never};
    for (std::size_t i = 0; i < direction.size(); ++i) {
        const double d = direction[i];
        if (d == 0) continue;
        const AxisLimits k = d > 0 ? task.limits(i) : brake::mirror_limits(task.limits(i));
        const double size = std::fabs(d);
        l = {std::min(l.v_max, k.v_max / size), std::max(l.v_min, k.v_min / size),
             std::min(l.a_max, k.a_max / size), std::max(l.a_min, k.a_min / size),
             std::min(l.jerk, k.jerk / size)};
    }
    return l;
}

// False if the boundary states lie on no common line.
bool find_line(const Task& task, Line& line) {
    const std::size_t n = task.dof;
    // displacement, then velocities and accelerations at the start and at the goal
    std::vector<std::vector<double>> vectors(5, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i) {
        const AxisState s = task.state(0, i), g = task.state(1, i);
        const double row[5] = {g.p - s.p, s.v, s.a, g.v, g.a};
        for (std::size_t k = 0; k < 5; ++k) vectors[k][i] = row[k];
    }
    const auto moves = [](const std::vector<double>& x) {
        return std::any_of(x.begin(), x.end(), [](double each) { return each != 0; });
    };
    const auto found = std::find_if(vectors.begin(), vectors.end(), moves);
    line.direction = found == vectors.end() ? vectors[0] : *found;
    double along[5];
    for (std::size_t k = 0; k < 5; ++k) {
        along[k] = multiple_of(line.direction, vectors[k]);
        if (std::isnan(along[k])) return false;
    }
    line.start = {0, along[1], along[2]};
    line.goal = {along[0], along[3], along[4]};
    line.limits = limits_along(task, line.direction);
    if (!(line.limits.jerk < never) && !(line.limits.a_max < never))
        line.limits = {1, -1, 1, -1, 1};  // nothing moves at all
    return true;
}

void solve_in_phase(const Problem& problem) {
    const std::size_t n = problem.all.dof;
    Line line;
    if (!find_line(problem.task(), line)) return problem.answer(Verdict::not_parallel, std::nan(""));
    Axis axis;
    set_axis(axis, line.start, line.goal, line.limits);
    const double T = choose_duration(problem, &axis, 1, axis.shortest);
    for (std::size_t i = 0; i < n; ++i) {
        problem.shortest()[i] = axis.shortest;
        problem.write_motion(i, axis, T);
    }
}

// The phases of axis i of a motion from start to goal, of what it is a multiple of.
Phases restore_motion(const StateMotion& motion, std::size_t i, const AxisState& start, const AxisState& goal,
                      const AxisLimits& limits) {
    Axis axis;
    set_task(axis, start, goal, limits);
    const double T = motion.mode == Synchronize::none ? motion.shortest[i] : motion.duration;
    const double time = T - axis.brake_time;
    Combination made;
    const double* from = motion.motions + i;
    made.theta = *from;
    for (double* times : {made.up, made.down})
        for (int k = 0; k < 7; ++k) times[k] = *(from += motion.dof);
    if (time > 0) append_motion(axis.task, time, made, axis.phases);
    return axis.phases;
}

std::vector<Phases> restore_motions(const StateMotion& motion) {
    const Task task{motion.dof, motion.states, motion.limits};
    std::vector<Phases> made(task.dof);
    Line line;
    const bool in_phase = motion.mode == Synchronize::phase && find_line(task, line);
    for (std::size_t i = 0; i < task.dof; ++i) {
        if (in_phase) {
            made[i] = i > 0 ? made[0] : restore_motion(motion, i, line.start, line.goal, line.limits);
        } else {
            made[i] = restore_motion(motion, i, task.state(0, i), task.state(1, i), task.limits(i));
        }
    }
    for (std::size_t i = 0; in_phase && i < task.dof; ++i)
        for (Phase& f : made[i].phase) f = {f.h, line.direction[i] * f.a, line.direction[i] * f.j};
    for (Phases& phases : made)
        if (phases.count == 1) split_phase(phases);
    return made;
}

// The coefficients of a phase in the time from its beginning or its end, where its state is s.
void write_piece(const AxisState& s, double jerk, double* c) {
    c[0] = s.p;
    c[1] = s.v;
    c[2] = s.a / 2;
    c[3] = jerk / 6;
}

// The phases of one axis, and where its pieces are written to.
struct AxisPieces {
    const Task task;
    const Phases& phases;
    double duration;
    StatePieces& all;
    std::size_t axis;
    int count, half = 0;  // phases, and those of them that are given from the start
    double* knots;

    AxisPieces(const StateMotion& motion, const Phases& own, StatePieces& made, std::size_t i)
        : task{motion.dof, motion.states, motion.limits},
          phases(own),
          duration(motion.duration),
          all(made),
          axis(i),
          count(own.count),
          knots(made.knots.data() + i * (made.pieces + 1)) {
        std::fill_n(knots, all.pieces + 1, duration);
        knots[0] = 0;
        place_knots();
    }
    // From both ends, so that rounding adds to the phase in the middle alone: none is longer than it is to
    // be, by which an acceleration would exceed its limit.
    void place_knots() {
        const double sum = phases.duration();
        // Of axes that move until the end, the last knot differs from the duration by rounding alone.
        const bool until_end = std::fabs(sum - duration) <= duration_rounding * duration;
        if (count > 0) knots[count] = until_end ? duration : std::min(sum, duration);
        while (half < count) {
            double next = knots[half] + phase(half).h;
            if (next - knots[half] > phase(half).h) next = std::nextafter(next, 0.0);
            const bool is_late = 2 * next > duration;
            if (is_late && (half > 0 || count == 1)) break;
            knots[++half] = std::min(next, knots[count]);
            if (is_late) break;
        }
        for (int k = count - 1; k > half; --k) {
            double begin = knots[k + 1] - phase(k).h;
            if (knots[k + 1] - begin > phase(k).h) begin = std::nextafter(begin, duration);
            knots[k] = std::max(begin, knots[half]);
        }
    }
    const Phase& phase(int k) const { return phases.phase[k]; }
    // An acceleration at an end of the motion: that of the state there if they differ by rounding alone, else
    // the acceleration jumps.
    double attain(double a, double of_state) const {
        double most = std::fabs(of_state);
        for (int k = 0; k < count; ++k) most = std::max(most, std::fabs(phase(k).a));
        return std::fabs(a - of_state) <= parallel_rounding * most ? of_state : a;
    }
    AxisState state(std::size_t end) const { return task.state(end, axis); }
    double* piece(std::size_t k) const { return all.coefficients.data() + (axis * all.pieces + k) * 4; }

    void write_from_start() const {
        AxisState s = state(0);
        for (int k = 0; k < half; ++k) {
            Phase f = phase(k);
            f.a = s.a = k == 0 ? attain(f.a, s.a) : f.a;
            write_piece(s, f.j, piece(std::size_t(k)));
            all.origins[axis * all.pieces + std::size_t(k)] = knots[k];
            s = advance_axis(s, f);
        }
    }
    void write_from_end() const {
        AxisState s = state(1);
        for (int k = count - 1; k >= half; --k) {
            const Phase f = phase(k);
            const double a = f.a + f.h * f.j;
            s.a = k == count - 1 ? attain(a, s.a) : a;
            write_piece(s, f.j, piece(std::size_t(k)));
            all.origins[axis * all.pieces + std::size_t(k)] = knots[k + 1];
            s = retreat_axis(s, f);
        }
    }
    // Pieces after the last phase: those of an axis that rests at its goal, else of no length.
    void write_rest() const {
        const AxisState goal = state(1);
        const bool rests = knots[count] < duration;
        for (std::size_t k = std::size_t(count); k < all.pieces; ++k) {
            if (count > 0 && !rests)
                std::copy_n(piece(std::size_t(count) - 1), 4, piece(k));
            else
                write_piece(goal, 0, piece(k));
            all.origins[axis * all.pieces + k] = knots[k + 1];
        }
    }
};

}  // namespace

std::size_t numbers_of_motion() { return combination_numbers; }

void solve_states(const StateProblems& problems, int threads) {
    constexpr std::size_t rows_worth_a_thread = 256;
    const bool in_lanes = problems.mode != Synchronize::phase && has_jerk_limits(problems);
    over_rows(problems.rows, threads, 1, rows_worth_a_thread, [&](std::size_t begin, std::size_t end) {
        if (in_lanes) {
            LaneSolver solver(problems, std::min(end - begin, rows_at_once));
            for (std::size_t row = begin; row < end; row += rows_at_once)
                solver.solve(row, std::min(row + rows_at_once, end));
            return true;
        }
        std::vector<Axis> axes(problems.dof);
        for (std::size_t row = begin; row < end; ++row) {
            const Problem problem{problems, row};
            if (problems.mode == Synchronize::phase)
                solve_in_phase(problem);
            else
                solve_in_time(problem, axes.data());
        }
        return true;
    });
}

StatePieces make_pieces(const StateMotion& motion) {
    const std::vector<Phases> phases = restore_motions(motion);
    int most = 1;
    for (const Phases& each : phases) most = std::max(most, each.count);
    StatePieces made{std::size_t(most) + 1, {}, {}, {}};  // one more for axes that end earlier
    made.knots.resize(motion.dof * (made.pieces + 1));
    made.coefficients.resize(motion.dof * made.pieces * 4);
    made.origins.resize(motion.dof * made.pieces);
    for (std::size_t axis = 0; axis < motion.dof; ++axis) {
        const AxisPieces pieces(motion, phases[axis], made, axis);
        pieces.write_from_start();
        pieces.write_from_end();
        pieces.write_rest();
    }
    return made;
}

bool can_be_asked(const double* states, const double* limits, std::size_t dof, double farthest) {
    for (std::size_t k = 0; k < 6 * dof; ++k)
        if (!(std::fabs(states[k]) <= farthest)) return false;
    for (std::size_t k = 0; k < 5 * dof; ++k)
        if (std::isfinite(limits[k]) && std::fabs(limits[k]) > farthest) return false;
    const Task task{dof, states, limits};
    for (std::size_t i = 0; i < dof; ++i) {
        const AxisLimits l = task.limits(i);
        if (!(l.v_max > 0 && l.v_min < 0 && l.a_max > 0 && l.a_min < 0 && l.jerk > 0)) return false;
        if (!l.has_jerk() && !(l.a_max < never && -l.a_min < never)) return false;
        const AxisState goal = task.state(1, i);
        const double a = l.has_jerk() ? goal.a : 0, before = goal.v - a * std::fabs(a) / (2 * l.jerk);
        if (std::max(goal.v, before) > l.v_max || std::min(goal.v, before) < l.v_min) return false;
        if (a > l.a_max || a < l.a_min) return false;
    }
    return true;
}

namespace {

// Whether a cubic piece keeps between two values from one local time to another.
bool keeps_within(const double* c, double from, double to, double lower, double upper) {
    const auto fits = [&](double t) {
        const double q = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
        return lower <= q && q <= upper;
    };
    if (!fits(from) || !fits(to)) return false;
    // Where the velocity is zero: a t² + 2 b t + c₁.
    const double a = 3 * c[3], b = c[2], square = b * b - a * c[1];
    if (square < 0) return true;
    const double sum = -(b + std::copysign(std::sqrt(square), b));
    for (const double t : {sum / a, c[1] / sum})
        if (from < t && t < to && !fits(t)) return false;
    return true;
}

}  // namespace

OneMotion move_axes(const double* states, const double* limits, const double* lower, const double* upper,
                    std::size_t dof) {
    std::vector<double> shortest(dof), motions(numbers_of_motion() * dof);
    const double free = std::nan("");
    std::int32_t verdict = 0;
    OneMotion made{};
    solve_states({1, dof, states, limits, &free, 0, Synchronize::time, &verdict, &made.duration,
                  shortest.data(), motions.data()},
                 1);
    made.pieces =
        make_pieces({dof, states, limits, shortest.data(), motions.data(), made.duration, Synchronize::time});
    const std::size_t n = made.pieces.pieces;
    made.keeps_within = true;
    for (std::size_t i = 0; i < dof && lower != nullptr; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            const double* t = made.pieces.knots.data() + i * (n + 1) + k;
            const double origin = made.pieces.origins[i * n + k];
            made.keeps_within &= keeps_within(made.pieces.coefficients.data() + (i * n + k) * 4,
                                              t[0] - origin, t[1] - origin, lower[i], upper[i]);
        }
    }
    return made;
}

}  // namespace cspace::trajectory
