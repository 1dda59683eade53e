#include "planning_arm_field.hpp"

#include <limits>

#include "planning_arm_potential.hpp"
#include "planning_arm_query.hpp"

namespace cspace::planning {

namespace {

search::Gains read_gains(const FieldRule& rule) { return {rule.k, rule.k_r, rule.rho_0, rule.cone}; }

// The potential, and the motions that a descent may make.
class ArmField : public ArmPotential {
  public:
    ArmField(const ArmSpace& space, const GoalRows& goals, const FieldRule& rule, ArmEdges& edges,
             ArmStats& stats)
        : ArmPotential(space.checker, goals, read_gains(rule), rule.rho_links),
          space_(space),
          goals_(goals),
          edges_(edges),
          stats_(stats) {}

    std::size_t width() const { return goals_.width(); }
    double lower(std::size_t k) const { return goals_.is_wrapping(k) ? -unbounded : space_.lower[k]; }
    double upper(std::size_t k) const { return goals_.is_wrapping(k) ? unbounded : space_.upper[k]; }
    int find_goal(const double* q, double* to) const {
        const std::size_t goal = goals_.find_nearest(q).first;
        for (std::size_t k = 0; k < width(); ++k) to[k] = q[k] + goals_.difference(goal, k, q[k]);
        return int(goal);
    }
    bool is_free(const double* a, const double* b) {
        ++stats_.edges;
        const bool is_free = edges_.is_free(a, b);
        stats_.blocked += !is_free;
        return is_free;
    }
    bool has_time() { return edges_.has_time_now(); }

  private:
    static constexpr double unbounded = std::numeric_limits<double>::infinity();

    const ArmSpace& space_;
    const GoalRows& goals_;
    ArmEdges& edges_;
    ArmStats& stats_;
};

class FieldSearch {
  public:
    FieldSearch(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                const FieldRule& rule)
        : space_(space), query_(space, problem, options), rule_(rule) {}

    FieldPlan run() {
        if (query_.check_ends()) query_.plan().status = search();
        return {query_.take_plan(), std::move(rest_)};
    }

  private:
    using Row = std::vector<double>;

    const ArmSpace& space_;
    ArmQuery query_;
    const FieldRule& rule_;
    FieldRest rest_;

    ArmStats& stats() { return query_.plan().stats; }

    PlanStatus search() {
        Row goal_rows;
        query_.each_given_goal(
            [&](const double* q) { goal_rows.insert(goal_rows.end(), q, q + query_.width()); });
        const GoalRows goals(space_, goal_rows);
        ArmField field(space_, goals, rule_, query_.edges(), stats());
        PlanStatus status = PlanStatus::resting;
        Row best;
        for (const auto& [start, row] : sort_starts(goals)) {
            const Descent descent = descend(field, row.data());
            if (descent.rest == Rest::goal && accept_path(start, descent)) {
                keep_rest(descent, goals, field);
                return PlanStatus::found;
            }
            if (query_.edges().is_late()) status = PlanStatus::time_limit;
            const double left = goals.find_nearest(last_row(descent)).second;
            if (rest_.kind < 0 || left < rest_.distance) {
                keep_rest(descent, goals, field);
                best = row;
            }
            if (status == PlanStatus::time_limit) break;
        }
        const std::size_t n = query_.width(), last = rest_.rows.size() - n;
        ArmQuery::Row from = {}, to = {};
        Row goal(n);
        field.find_goal(&rest_.rows[last], goal.data());
        for (std::size_t k = 0; k < n; ++k) from[k] = float(rest_.rows[last + k]), to[k] = float(goal[k]);
        return query_.give_up(status, float(rest_.distance), from.data(), to.data());
    }
    // The nearest to a goal first.
    std::vector<std::pair<int, Row>> sort_starts(const GoalRows& goals) const {
        std::vector<std::pair<double, std::pair<int, Row>>> starts;
        query_.each_given_start([&](const double* q) {
            starts.push_back({goals.find_nearest(q).second, {int(starts.size()), {q, q + goals.width()}}});
        });
        std::stable_sort(starts.begin(), starts.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<std::pair<int, Row>> sorted;
        for (auto& each : starts) sorted.push_back(std::move(each.second));
        return sorted;
    }
    Descent descend(ArmField& field, const double* start) {
        const StageTimer timer(stats().search_seconds);
        Descent descent = JointDescent<ArmField>(field, rule_.step, rule_.looks).run(start);
        stats().samples += descent.looks;
        stats().nodes += std::int64_t(descent.values.size());
        return descent;
    }
    const double* last_row(const Descent& descent) const {
        return descent.rows.data() + descent.rows.size() - query_.width();
    }
    // Its steps are proved; false if the ends as given, or a turn further, are not joined to them.
    bool accept_path(int start, const Descent& descent) {
        const std::size_t n = query_.width(), rows = descent.rows.size() / n;
        query_.write_path(start, descent.goal, rows < 2 ? 0 : rows - 2, [&](std::size_t i, float* q) {
            for (std::size_t k = 0; k < n; ++k) q[k] = float(descent.rows[(i + 1) * n + k]);
        });
        return query_.finish_path([](std::size_t) {}) == ArmQuery::Finish::accepted;
    }
    void keep_rest(const Descent& descent, const GoalRows& goals, ArmField& field) {
        rest_ = {int(descent.rest),
                 descent.rows,
                 descent.values,
                 descent.force,
                 goals.find_nearest(last_row(descent)).second,
                 descent.saddles,
                 {}};
        field.visit_near(last_row(descent), [&](const collision::Contact& contact, double rho,
                                                std::span<const double> slope) {
            double square = 0;
            for (const double x : slope) square += x * x;
            add_push(contact, -field.gains_for(contact).repulsion_rate(rho) * std::sqrt(square), rho);
        });
        std::stable_sort(rest_.pushes.begin(), rest_.pushes.end(),
                         [](const Push& a, const Push& b) { return a.force > b.force; });
    }
    int owner_of(const collision::Contact& contact) const {
        return contact.is_pair ? contact.other : space_.checker.scene_data().owner(contact.other);
    }
    void add_push(const collision::Contact& contact, double force, double rho) {
        for (Push& each : rest_.pushes)
            if (each.contact.link == contact.link && each.contact.is_pair == contact.is_pair &&
                owner_of(each.contact) == owner_of(contact)) {
                each.force += force;
                if (rho < each.rho) each.rho = rho, each.contact = contact;
                return;
            }
        rest_.pushes.push_back({contact, force, rho});
    }
};

void check_rule(const FieldRule& rule) {
    require(rule.k > 0 && rule.k_r > 0 && rule.rho_0 > 0 && rule.cone > 0 && rule.rho_links >= 0,
            "gains and distances must be positive");
    require(rule.step > 0 && std::isfinite(rule.step) && rule.looks >= 1,
            "the longest step must be positive, with one evaluation at least");
}

}  // namespace

FieldPlan plan_by_field(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                        const FieldRule& rule) {
    check_rule(rule);
    return run_search<FieldSearch>(space, problem, options, rule);
}

std::vector<FieldPlan> plan_each_by_field(const ArmSpace& space, std::span<const ArmProblem> problems,
                                          const ArmOptions& options, const FieldRule& rule, int threads) {
    check_rule(rule);
    return run_searches<FieldSearch>(space, problems, options, threads, rule);
}

void evaluate_potential(const ArmSpace& space, std::span<const double> goals, const FieldRule& rule,
                        std::span<const double> rows, double* values, double* gradients) {
    check_space(space), check_rule(rule), check_problem(space, {goals, goals});
    const std::size_t n = std::size_t(space.checker.dof());
    const GoalRows targets(space, {goals.begin(), goals.end()});
    ArmPotential potential(space.checker, targets, read_gains(rule), rule.rho_links);
    for (std::size_t i = 0; i < rows.size() / n; ++i) {
        const ArmPotential::Look seen = potential.look(&rows[i * n]);
        values[i] = seen.value;
        std::copy_n(seen.slope.begin(), n, gradients + i * n);
    }
}

double find_reach(const collision::Checker& checker) {
    const collision::Robot& robot = checker.robot();
    float reach = 0;
    for (int j = 0; j < robot.n_joints; ++j)
        for (int b = 1; b < robot.n_bodies; ++b)
            reach = std::max(reach, robot.levers[j * robot.body_stride + b]);
    return double(reach);
}

}  // namespace cspace::planning
