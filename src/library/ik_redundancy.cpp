#include "ik_redundancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>

#include "cspace/ik/goal.hpp"
#include "cspace/ik/redundancy/arcs.hpp"
#include "cspace/ik/redundancy/arm_angle.hpp"
#include "cspace/math/made_once.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "kernels/ik.hpp"

namespace cspace::ik {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

Posed pose_of(const double* m) { return read_goal(m).T; }

// The unit of length in which curves along prismatic joints are followed [m]: a power of two, which rounds
// nothing; 1 for arms about that long and for those without prismatic joints.
double unit_of(const Redundant& arm) {
    bool slides = false;
    for (int i = 0; i < arm.chain.n; ++i) slides |= arm.chain.prismatic[i];
    const bool usual = arm.length > 0.25 && arm.length < 4;
    return slides && !usual ? std::exp2(std::round(std::log2(arm.length))) : 1.0;
}

// Whether the limits leave the configuration as near to the seed as it is without them: turned, its copy
// inside the limits, is the nearest of all copies and inside.
bool is_kept_by_limits(const Redundant& arm, const double* seed, const double* nearest,
                       const double* turned) {
    for (int i = 0; i < arm.chain.n; ++i) {
        if (turned[i] < arm.lower[i] || turned[i] > arm.upper[i]) return false;
        const double gap = joint_difference(arm.chain, i, nearest[i] - seed[i]);
        if (std::fabs(turned[i] - seed[i]) > std::fabs(gap) + limit_slack) return false;
    }
    return true;
}

// Goals of joints that follow one another, by the closed form on lanes.
struct LaneRows {
    static constexpr std::size_t most = 64;
    double T[most][16], q[most][max_branches * 6];
    std::int64_t count[most];
    FastPath quick[most];

    void solve(const LockedArm& locked, const double* goals, const double* at, std::size_t stride,
               std::size_t rows) {
        kernels::locked_goals(locked, goals, at, stride, rows, T[0]);
        kernels::ik_many(locked.arm, T[0], rows, rows, max_branches, q[0], count, quick);
    }
};

}  // namespace

struct RedundantSolver::State {
    Redundant arm;
    double unit;  // [m]
    SwivelArm swivel;
    std::mutex mutex;
    std::map<std::vector<int>, std::unique_ptr<LockedArm>> plans;
    MadeOnce<RedundantSolver> scaled, unlimited;
    MadeOnce<LimitArms> limits;

    // The same arm with lengths in its unit.
    RedundantSolver& in_its_unit() {
        return scaled.get([this] {
            Chain chain = in_units_of(unit, arm.chain);
            double lower[max_joints], upper[max_joints];
            for (int i = 0; i < chain.n; ++i) {
                const double size = chain.prismatic[i] ? unit : 1;
                lower[i] = arm.lower[i] / size;
                upper[i] = arm.upper[i] / size;
            }
            return std::make_unique<RedundantSolver>(chain, lower, upper, arm.weight);
        });
    }
    bool looks() const {
        bool any = false;
        for (int j = 0; j < arm.chain.n; ++j) any |= leads_ahead(arm.chain, arm.weight, arm.lower, j);
        return any;
    }
    RedundantSolver& without_limits() {
        return unlimited.get([this] {
            double lower[max_joints], upper[max_joints];
            std::fill(lower, lower + max_joints, -std::numeric_limits<double>::infinity());
            std::fill(upper, upper + max_joints, std::numeric_limits<double>::infinity());
            return std::make_unique<RedundantSolver>(arm.chain, lower, upper, arm.weight);
        });
    }
    const LimitArms& limit_arms() {
        return limits.get([this] {
            auto made = std::make_unique<LimitArms>();
            kernels::ik_make_limit_arms(arm, *made);
            return made;
        });
    }
};

RedundantSolver::RedundantSolver(const Chain& chain, const double* lower, const double* upper,
                                 const double* weight)
    : state_(std::make_shared<State>()) {
    kernels::ik_make_redundant(chain, lower, upper, weight, state_->arm);
    state_->unit = unit_of(state_->arm);
    state_->swivel = make_swivel_arm(chain);
}

const Chain& RedundantSolver::chain() const { return state_->arm.chain; }
RedundantSolver& RedundantSolver::without_limits() { return state_->without_limits(); }
int RedundantSolver::redundant_joints() const { return state_->arm.redundancy_degree; }
bool RedundantSolver::has_closed_form() const { return rank_of(state_->arm.locked.arm) > 1; }
std::vector<int> RedundantSolver::default_locked() const {
    const LockedArm& locked = state_->arm.locked;
    return {locked.locked_joint, locked.locked_joint + locked.n_locked};
}

int RedundantSolver::redundant_with(const std::vector<int>& locked) const {
    if (locked.empty()) return redundant_joints();
    unsigned bits = 0;
    for (const int joint : locked) {
        if (joint < 0 || joint >= chain().n) throw std::invalid_argument("locked joints belong to the arm");
        bits |= 1u << joint;
    }
    return redundancy_degree_with(state_->arm, bits);
}

const LockedArm& RedundantSolver::lock(const std::vector<int>& joints) const {
    const int n = chain().n, moving = n - int(joints.size());
    const bool ascending =
        std::adjacent_find(joints.begin(), joints.end(), std::greater_equal<>()) == joints.end();
    if (!ascending || (!joints.empty() && (joints.front() < 0 || joints.back() >= n)) || moving < 1 ||
        moving > max_moving)
        throw std::invalid_argument("locked joints must ascend and leave one to six to move");
    const std::lock_guard<std::mutex> guard(state_->mutex);
    const LockedArm& usual = state_->arm.locked;
    if (usual.n_moving > 0 &&
        std::equal(joints.begin(), joints.end(), usual.locked_joint, usual.locked_joint + usual.n_locked))
        return usual;
    auto& slot = state_->plans[joints];
    if (!slot) {
        slot = std::make_unique<LockedArm>();
        kernels::ik_lock_joints(state_->arm, joints.data(), int(joints.size()), *slot);
    }
    return *slot;
}

int RedundantSolver::room_for(const std::vector<int>& joints) const {
    const LockedArm& locked = lock(joints);
    return locked.at_ends ? ik::room_for(locked.arm) : max_solutions;
}

void RedundantSolver::solve(const LockedArm& locked, const Rows& rows) const {
    const std::size_t n = std::size_t(chain().n), stride = rows.at_each ? n : 0;
    const bool on_lanes = rows.n > 1 && !rows.unconstrained && locked.at_ends && rank_of(locked.arm) == 3 &&
                          rows.room >= max_branches;
    over_rows(rows.n, rows.threads, 1, 64, [&](std::size_t from, std::size_t to) {
        Solutions found;
        const auto lanes = on_lanes ? std::make_unique_for_overwrite<LaneRows>() : nullptr;
        for (std::size_t i = from; i < to; ++i) {
            const double* values = rows.at + stride * i;
            double* q = rows.q + rows.room * n * i;
            const std::size_t in = (i - from) % LaneRows::most;
            if (lanes && in == 0)
                lanes->solve(locked, rows.goals + 16 * i, values, stride, std::min(to - i, LaneRows::most));
            if (lanes && lanes->quick[in] == FastPath::settled) {
                kernels::locked_rows(locked, values, lanes->q[in], lanes->count[in], rows.room, q);
                rows.count[i] = lanes->count[in];
                rows.status[i] = std::uint8_t(lanes->count[in] ? Status::exact : Status::unreachable);
                continue;
            }
            poll_interrupts();
            kernels::ik_locked(locked, pose_of(rows.goals + 16 * i), values, rows.unconstrained, found);
            std::fill(q, q + rows.room * n, none);
            const int count = std::min(found.count, int(rows.room));
            for (int k = 0; k < count; ++k) {
                whole_row(locked, values, found.q[k], q + n * std::size_t(k));
                rows.branch[rows.room * i + std::size_t(k)] = found.branch[k];
                rows.self_motion[rows.room * i + std::size_t(k)] = found.self_motion[k];
            }
            rows.count[i] = count;
            rows.status[i] = std::uint8_t(int(found.status) + (found.complete ? 0 : incomplete));
        }
        return true;
    });
}

bool RedundantSolver::find_nearest_turned(const double* goal, const double* seed, double* q) const {
    const Redundant& arm = state_->arm;
    const ReadGoal<double> read = read_goal(goal);
    if (!read.is_pose || !kernels::ik_nearest(arm, read.T, seed, q)) return false;
    turn_to_seed(arm.chain.prismatic, arm.chain.n, arm.lower, arm.upper, seed, q);
    return true;
}

// Any configuration within limits: from the feasible intervals, or else by searches from the middle of the
// limits and around it.
bool RedundantSolver::find_one_within(const double* goal, double* q, bool& complete) {
    if (redundant_joints() == 1) {
        const std::vector<Interval> all = intervals(default_locked().front(), goal, complete);
        if (all.empty()) return false;
        std::copy(all[0].q, all[0].q + chain().n, q);
        return true;
    }
    complete = false;
    constexpr int attempts = 8;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        double start[max_joints];
        start_of_search(goal, attempt, start);
        if (kernels::ik_nearest_within(state_->arm, nullptr, pose_of(goal), start, nullptr, q)) return true;
    }
    return false;
}

RedundantSolver::NearestFound RedundantSolver::find_nearest_within(const double* goal, const double* seed,
                                                                   double* q) {
    const Redundant& arm = state_->arm;
    const int n = arm.chain.n;
    const ReadGoal<double> read = read_goal(goal);
    if (!read.is_pose) return {};
    const auto turn = [&](double* row) {
        turn_to_seed(arm.chain.prismatic, n, arm.lower, arm.upper, seed, row);
    };
    const auto is_kept = [&] {
        double nearest[max_joints];
        std::copy(q, q + n, nearest);
        turn(q);
        return is_kept_by_limits(arm, seed, nearest, q);
    };
    if (kernels::ik_nearest_proven(arm, read.T, seed, q) && is_kept()) return {true, true, true};
    const LimitArms* const arms = redundant_joints() == 1 ? &state_->limit_arms() : nullptr;
    double within[max_joints];
    const bool is_quick = is_sampled_quickly(arm) || has_arcs_to_follow(arm);
    bool found = arms && is_quick && kernels::ik_nearest_within(arm, arms, read.T, seed, nullptr, within);
    if (found) {
        std::copy(within, within + n, q);
        turn(q);
        return {true, true, true};
    }
    if (!kernels::ik_nearest(arm, read.T, seed, q)) return {};
    if (is_kept()) return {true, true, true};
    const auto trail = arms && !is_sampled_quickly(arm) ? std::make_unique_for_overwrite<Trail>() : nullptr;
    if (!arms || trail) found = kernels::ik_nearest_within(arm, arms, read.T, seed, trail.get(), within);
    bool complete = found;
    if (!found) {
        double start[max_joints];
        found = find_one_within(goal, start, complete) &&
                kernels::ik_nearest_from(arm, read.T, seed, start, within);
    }
    if (found) {
        std::copy(within, within + n, q);
        turn(q);
    }
    return {true, found, found || complete};
}

std::vector<Interval> RedundantSolver::intervals(int parameter, const double* goal, bool& complete) {
    if (redundant_joints() != 1 || parameter < 0 || parameter >= chain().n)
        throw std::invalid_argument("intervals are those of a joint of an arm with one redundant joint");
    const double unit = state_->unit;
    RedundantSolver& solver = unit == 1 ? *this : state_->in_its_unit();
    Posed T = pose_of(goal);
    T.t = (1 / unit) * T.t;
    const LockedArm& locked = solver.lock({parameter});
    const auto trail = std::make_unique_for_overwrite<Trail>();
    const auto found = std::make_unique_for_overwrite<Intervals>();
    kernels::ik_intervals(solver.state_->arm, locked, parameter, solver.state_->limit_arms(), T, *trail,
                          *found);
    const Redundant& own = state_->arm;
    for (int k = 0; k < found->count; ++k) {
        Interval& i = found->interval[k];
        for (int j = 0; j < own.chain.n; ++j)
            if (own.chain.prismatic[j]) i.q[j] *= unit;
        if (own.chain.prismatic[parameter]) i.lower *= unit, i.upper *= unit;
        turn_to_seed(own.chain.prismatic, own.chain.n, own.lower, own.upper, i.q, i.q);
    }
    complete = found->complete;
    return {found->interval, found->interval + found->count};
}

std::vector<Span> unite_intervals(std::vector<Span> intervals) {
    std::sort(intervals.begin(), intervals.end());
    std::vector<Span> out;
    for (const Span& next : intervals) {
        if (out.empty() || next.first > out.back().second)
            out.push_back(next);
        else
            out.back().second = std::max(out.back().second, next.second);
    }
    return out;
}

std::vector<double> spread_values(std::vector<Span> intervals, int n) {
    const std::vector<Span> disjoint = unite_intervals(std::move(intervals));
    double whole = 0;
    for (const Span& part : disjoint) whole += part.second - part.first;
    std::vector<double> out;
    double end = 0;  // how much of the whole the parts up to this one cover
    std::size_t k = 0;
    if (!disjoint.empty()) end = disjoint[0].second - disjoint[0].first;
    for (int i = 0; i < n && !disjoint.empty(); ++i) {
        const double along = (i + 0.5) / n * whole;
        while (k + 1 < disjoint.size() && end <= along) {
            ++k;
            end += disjoint[k].second - disjoint[k].first;
        }
        out.push_back(disjoint[k].second - (end - along));
    }
    return out;
}

bool RedundantSolver::sample(const double* goal, int n, GoalAnswer& out) {
    const int parameter = default_locked().front();
    std::vector<Interval> found = intervals(parameter, goal, out.complete);
    out.feasible = !found.empty();
    if (found.empty()) found = state_->without_limits().intervals(parameter, goal, out.complete);
    std::vector<Span> spans;
    for (const Interval& one : found) spans.emplace_back(one.lower, one.upper);
    std::vector<double> values = spread_values(std::move(spans), n);
    if (!chain().prismatic[parameter])
        for (double& value : values) value = wrap_angle(value);
    const double at[max_joints] = {};
    std::vector<SweptRows> rows(values.size());
    if (!rows.empty())
        kernels::ik_sweep(lock({parameter}), parameter, pose_of(goal), at, values.data(), int(values.size()),
                          rows.data());
    for (const SweptRows& swept : rows) {
        out.complete = out.complete && swept.complete;
        for (int k = 0; k < swept.count; ++k) out.append_row(swept.q[k], chain().n, swept.branch[k], false);
    }
    out.status = Status::exact;
    out.values = int(values.size());
    return !found.empty();
}

// The first attempt begins in the middle of the limits, further ones around it. A joint that leads ahead
// begins as far out as the goal is, and the others where they look at a point up to a hundred times closer.
void RedundantSolver::start_of_search(const double* goal, int attempt, double* start) const {
    constexpr double near_by = 300, golden = 0.6180339887498949;  // [m], and a number whose multiples spread
    const Redundant& arm = state_->arm;
    for (int j = 0; j < arm.chain.n; ++j) {
        start[j] = arm.middle[j];
        if (attempt > 0 && !arm.chain.prismatic[j]) {
            const double place = golden * (attempt + j * attempt);
            start[j] += place - std::floor(place) - 0.5;
        }
    }
    if (!state_->looks()) return;
    const double away = std::hypot(goal[3], goal[7], goal[11]);
    if (away > near_by) {
        double closer[16], from[max_joints], q[max_joints];
        std::copy(goal, goal + 16, closer);
        for (const int k : {3, 7, 11}) closer[k] /= std::min(attempt % 2 ? 10.0 : 100.0, away / near_by * 2);
        start_of_search(closer, attempt, from);
        if (find_nearest_turned(closer, from, q)) std::copy(q, q + arm.chain.n, start);
    }
    for (int j = 0; j < arm.chain.n; ++j)
        if (leads_ahead(arm.chain, arm.weight, arm.lower, j)) start[j] = away;
}

bool RedundantSolver::find_near_middle(const double* goal, double* q) const {
    constexpr int attempts_to_look = 8;
    const int attempts = state_->looks() ? attempts_to_look : 1;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        double start[max_joints];
        start_of_search(goal, attempt, start);
        if (find_nearest_turned(goal, start, q)) return true;
    }
    return false;
}

bool RedundantSolver::has_swivel() const { return state_->swivel.applies; }

void RedundantSolver::solve_swivels(const double* goals, bool one_goal, const double* swivels, std::size_t n,
                                    double* q) const {
    const std::size_t each = one_goal ? n : 1;
    for (std::size_t i = 0; i < n; i += each)
        kernels::swivel_solutions(state_->swivel, pose_of(goals + 16 * (one_goal ? 0 : i)), swivels + i,
                                  int(each), q + 56 * i);
}

double RedundantSolver::swivel_at(const double* q) const { return swivel_of(state_->swivel, q); }

bool solve_locked_goal(const LockedArm& locked, const double* goal, const double* at, SolutionStore& store,
                       SolutionRows& rows) {
    const ReadGoal<double> read = read_goal(goal);
    if (!read.is_pose) return false;
    const int n = locked.whole.n;
    kernels::ik_locked(locked, read.T, at, nullptr, store.found);
    for (int k = 0; k < store.found.count; ++k) whole_row(locked, at, store.found.q[k], store.q + n * k);
    rows = rows_of(store.found);
    rows.q = store.q;
    rows.stride = n;
    return true;
}

}  // namespace cspace::ik
