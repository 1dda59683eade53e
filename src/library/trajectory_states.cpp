#include "trajectory_states.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cspace/math/threads.hpp"
#include "cspace/trajectory/synchronize.hpp"

namespace cspace::trajectory {

namespace {

// A phase as two, so that one part of the motion can be given from each end.
void split_phase(Phases& phases) {
    Phase& f = phases.phase[0];
    f.h /= 2;
    phases.append({f.h, f.a + f.h * f.j, f.j});
}

// One problem: rows of StateProblems from its own place on.
struct Problem {
    const StateProblems& all;
    std::size_t row;

    double state(int end, int order, std::size_t axis) const {
        return all.states[((row * 2 + std::size_t(end)) * 3 + std::size_t(order)) * all.dof + axis];
    }
    AxisState state(int end, std::size_t axis) const {
        return {state(end, 0, axis), state(end, 1, axis), state(end, 2, axis)};
    }
    AxisLimits limits(std::size_t axis) const {
        const double* l = all.limits + axis;
        const std::size_t n = all.dof;
        return {l[0], l[n], l[2 * n], l[3 * n], l[4 * n]};
    }
    // Whether a duration is asked for, and the least one that may be answered.
    bool is_timed() const { return !std::isnan(all.durations[row]); }

    void answer(Verdict verdict, double duration) const {
        all.verdict[row] = std::int32_t(verdict);
        all.duration[row] = duration;
    }
    void write_phases(std::size_t axis, Phases phases, double scale) const {
        if (phases.count == 1) split_phase(phases);
        const std::size_t place = row * all.dof + axis;
        all.count[place] = phases.count;
        double* out = all.phases + place * most_phases * phase_numbers;
        for (int i = 0; i < phases.count; ++i, out += phase_numbers) {
            out[0] = phases.phase[i].h;
            out[1] = scale * phases.phase[i].a;
            out[2] = scale * phases.phase[i].j;
        }
    }
};

// The duration of axes that move together; refused if another one was asked for.
double choose_duration(const Problem& problem, Axis* axes, std::size_t n) {
    double least = 0;
    for (std::size_t i = 0; i < n; ++i) least = std::max(least, axes[i].shortest);
    if (!problem.is_timed()) {
        const double T = common_duration(axes, n, least, problem.all.cycle);
        problem.answer(Verdict::found, T);
        return T;
    }
    // A duration within rounding of the shortest is the shortest.
    const double asked = problem.all.durations[problem.row];
    const double from = asked >= least * (1 - duration_rounding) ? std::max(asked, least) : least;
    const double T = common_duration(axes, n, from, 0);
    const bool is_kept = std::fabs(T - asked) <= duration_rounding * T;
    problem.answer(is_kept ? Verdict::found : Verdict::refused_duration, T);
    return T;
}

void solve_in_time(const Problem& problem, Axis* axes) {
    const std::size_t n = problem.all.dof;
    double* shortest = problem.all.shortest + problem.row * n;
    for (std::size_t i = 0; i < n; ++i) {
        set_axis(axes[i], problem.state(0, i), problem.state(1, i), problem.limits(i));
        shortest[i] = axes[i].shortest;
    }
    if (problem.all.mode == Synchronize::none)
        problem.answer(Verdict::found, n ? *std::max_element(shortest, shortest + n) : 0);
    else
        choose_duration(problem, axes, n);
    for (std::size_t i = 0; i < n; ++i) {
        const bool alone = problem.all.mode == Synchronize::none;
        finish_axis(axes[i], alone ? shortest[i] : problem.all.duration[problem.row]);
        problem.write_phases(i, axes[i].phases, 1);
    }
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

AxisLimits limits_along(const Problem& problem, const std::vector<double>& direction) {
    AxisLimits l{never, -never, never, -never, never};
    for (std::size_t i = 0; i < direction.size(); ++i) {
        const double d = direction[i];
        if (d == 0) continue;
        const AxisLimits k = d > 0 ? problem.limits(i) : brake::mirror_limits(problem.limits(i));
        const double size = std::fabs(d);
        l = {std::min(l.v_max, k.v_max / size), std::max(l.v_min, k.v_min / size),
             std::min(l.a_max, k.a_max / size), std::max(l.a_min, k.a_min / size),
             std::min(l.jerk, k.jerk / size)};
    }
    return l;
}

// False if the boundary states lie on no common line.
bool find_line(const Problem& problem, Line& line) {
    const std::size_t n = problem.all.dof;
    // displacement, then velocities and accelerations at the start and at the goal
    std::vector<std::vector<double>> vectors(5, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i) {
        const AxisState s = problem.state(0, i), g = problem.state(1, i);
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
    line.limits = limits_along(problem, line.direction);
    return true;
}

void solve_in_phase(const Problem& problem) {
    const std::size_t n = problem.all.dof;
    Line line;
    if (!find_line(problem, line)) return problem.answer(Verdict::not_parallel, std::nan(""));
    Axis axis;
    const bool rests = !(line.limits.jerk < never) && !(line.limits.a_max < never);  // nothing moves at all
    if (rests) line.limits = {1, -1, 1, -1, 1};
    set_axis(axis, line.start, line.goal, line.limits);
    const double T = choose_duration(problem, &axis, 1);
    finish_axis(axis, T);
    for (std::size_t i = 0; i < n; ++i) {
        problem.all.shortest[problem.row * n + i] = axis.shortest;
        problem.write_phases(i, axis.phases, line.direction[i]);
    }
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
    const StatePieces& all;
    std::size_t axis;
    int count;
    std::vector<double> knots;

    AxisPieces(const StatePieces& made, std::size_t i) : all(made), axis(i), count(made.count[i]) {
        knots.resize(all.pieces + 1, all.duration);
        knots[0] = 0;
        for (int k = 0; k < count; ++k) knots[std::size_t(k) + 1] = knots[std::size_t(k)] + phase(k).h;
        // Of axes that move until the end, the last knot differs from the duration by rounding alone.
        const double last = knots[std::size_t(count)];
        if (count > 0 && std::fabs(last - all.duration) <= duration_rounding * all.duration)
            knots[std::size_t(count)] = all.duration;
        for (double& t : knots) t = std::min(t, all.duration);
    }
    Phase phase(int k) const {
        const double* f = all.phases + (axis * most_phases + std::size_t(k)) * phase_numbers;
        return {f[0], f[1], f[2]};
    }
    // An acceleration at an end of the motion: that of the state there if they differ by rounding alone, else
    // the acceleration jumps.
    double attain(double a, double of_state) const {
        double most = std::fabs(of_state);
        for (int k = 0; k < count; ++k) most = std::max(most, std::fabs(phase(k).a));
        return std::fabs(a - of_state) <= parallel_rounding * most ? of_state : a;
    }
    AxisState state(std::size_t end) const {
        const double* s = all.states + end * 3 * all.dof + axis;
        return {s[0], s[all.dof], s[2 * all.dof]};
    }
    double* piece(std::size_t k) const { return all.coefficients + (axis * all.pieces + k) * 4; }

    void write_from_start(int half) const {
        AxisState s = state(0);
        for (int k = 0; k < half; ++k) {
            Phase f = phase(k);
            f.a = s.a = k == 0 ? attain(f.a, s.a) : f.a;
            write_piece(s, f.j, piece(std::size_t(k)));
            all.origins[axis * all.pieces + std::size_t(k)] = knots[std::size_t(k)];
            s = advance_axis(s, f);
        }
    }
    void write_from_end(int half) const {
        AxisState s = state(1);
        for (int k = count - 1; k >= half; --k) {
            const Phase f = phase(k);
            const double a = f.a + f.h * f.j;
            s.a = k == count - 1 ? attain(a, s.a) : a;
            write_piece(s, f.j, piece(std::size_t(k)));
            all.origins[axis * all.pieces + std::size_t(k)] = knots[std::size_t(k) + 1];
            s = retreat_axis(s, f);
        }
    }
    // Pieces after the last phase: those of an axis that rests at its goal, else of no length.
    void write_rest() const {
        const AxisState goal = state(1);
        const bool rests = knots[std::size_t(count)] < all.duration;
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

int phases_of_axis() { return most_phases; }

void solve_states(const StateProblems& problems, int threads) {
    constexpr std::size_t rows_worth_a_thread = 256;
    over_rows(problems.rows, threads, 1, rows_worth_a_thread, [&](std::size_t begin, std::size_t end) {
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

void make_pieces(const StatePieces& made) {
    for (std::size_t axis = 0; axis < made.dof; ++axis) {
        const AxisPieces pieces(made, axis);
        std::copy(pieces.knots.begin(), pieces.knots.end(), made.knots + axis * (made.pieces + 1));
        int half = 0;
        while (half < pieces.count && 2 * pieces.knots[std::size_t(half) + 1] <= made.duration) ++half;
        if (half == 0 && pieces.count > 1) half = 1;
        pieces.write_from_start(half);
        pieces.write_from_end(half);
        pieces.write_rest();
    }
}

}  // namespace cspace::trajectory
