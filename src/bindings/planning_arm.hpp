// What the bindings of the planners of arms share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collision.hpp"
#include "library/planning_arm.hpp"

using Bytes = Plain<const std::uint8_t>;
using Integers = Plain<const std::int64_t>;

// A plan and the checker whose numbers its contacts have.
struct NamedPlan {
    cspace::planning::ArmPlan plan;
    const cspace::collision::Checker* checker;
    int dof;

    Doubles path() const { return rows_of(plan.path); }
    Doubles rows_of(const std::vector<double>& values) const {
        const std::size_t width = std::size_t(std::max(dof, 1));
        return Doubles({npy_intp(values.size() / width), dof}, values.data());
    }
    // State and contact of each start or goal.
    using Reports = std::vector<std::pair<int, std::optional<NamedContact>>>;
    Reports name_rows(const std::vector<cspace::planning::RowReport>& rows) const {
        Reports named;
        for (const cspace::planning::RowReport& row : rows)
            named.emplace_back(int(row.state), name_contact(*checker, row.contact));
        return named;
    }
};

inline cspace::planning::ArmSpace read_space(const cspace::collision::Checker& checker,
                                             const ConstDoubles& bounds, const Bytes& wraps) {
    require(bounds.ndim() == 2 && bounds.shape(0) == 2 && bounds.shape(1) == checker.dof(),
            "bounds must be an array (2, dof)");
    require(wraps.size == checker.dof(), "wraps must be an array (dof,)");
    const std::size_t n = std::size_t(checker.dof());
    return {checker, {bounds.data, n}, {bounds.data + n, n}, {wraps.data, n}};
}
inline std::span<const double> read_rows(const cspace::collision::Checker& checker,
                                         const ConstDoubles& rows) {
    require(rows.ndim() == 2 && rows.shape(1) == checker.dof(), "configurations must be an array (n, dof)");
    return {rows.data, std::size_t(rows.size)};
}

// The plans of many problems, and the checker whose numbers their contacts have.
struct NamedPlans {
    std::vector<cspace::planning::ArmPlan> plans;
    const cspace::collision::Checker* checker;
    int dof;

    NamedPlan plan(std::size_t k) const {
        require(k < plans.size(), "there is no plan of that number");
        return {plans[k], checker, dof};
    }
    std::size_t corners(std::size_t k) const { return plans[k].path.size() / std::size_t(std::max(dof, 1)); }
    // An array (n,) of value(k) for each.
    template <class T, class Value>
    Plain<T> list(const Value& value) const {
        Plain<T> values({npy_intp(plans.size())});
        for (std::size_t k = 0; k < plans.size(); ++k) values.data[k] = T(value(k));
        return values;
    }
};

// Pairs of starts and goals, with numbers of their own: what is done to the arrays later changes nothing.
class GivenProblems {
  public:
    // Rows (s, dof) and (g, dof) of all problems, one below the other, and how many each has (n,); none: one.
    GivenProblems(const ConstDoubles& starts, const std::optional<Integers>& start_counts,
                  const ConstDoubles& goals, const std::optional<Integers>& goal_counts,
                  const std::optional<ConstDoubles>& time_limits);
    GivenProblems(const GivenProblems&) = delete;
    GivenProblems& operator=(const GivenProblems&) = delete;

    std::size_t size() const { return problems_.size(); }
    std::pair<Doubles, Doubles> rows(std::size_t k) const;
    // Checked to be those of a robot.
    std::span<const cspace::planning::ArmProblem> read(const cspace::collision::Checker& checker) const;

  private:
    npy_intp width_;
    std::vector<double> starts_, goals_;
    std::vector<cspace::planning::ArmProblem> problems_;
};
