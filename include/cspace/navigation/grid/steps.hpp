// The length of a path over a grid, exact: how many steps along rows and columns, and how many diagonal ones.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace cspace::navigation {

inline constexpr double sqrt_two = 1.4142135623730951;

struct Steps {
    std::int32_t straight = 0, diagonal = 0;
    // In cells. Ways of less than 2²⁴ steps of each kind get different numbers unless they are equally long.
    double value() const { return straight + sqrt_two * diagonal; }
    friend Steps operator+(Steps x, Steps y) { return {x.straight + y.straight, x.diagonal + y.diagonal}; }
    friend bool operator==(Steps, Steps) = default;
    // Whether a + b √2 < 0 for the differences a, b, that is a |a| + 2 b |b| < 0. For less than 2³⁰ steps.
    friend bool operator<(Steps x, Steps y) {
        const std::int64_t a = std::int64_t(x.straight) - y.straight,
                           b = std::int64_t(x.diagonal) - y.diagonal;
        return a * std::abs(a) + 2 * b * std::abs(b) < 0;
    }
};

inline double value_of(Steps g) { return g.value(); }
inline double value_of(double g) { return g; }

}  // namespace cspace::navigation
