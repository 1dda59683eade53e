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
