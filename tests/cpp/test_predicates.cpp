// The sign of a determinant, where rounding would turn it.
#include <cstdint>
#include <random>

#include "check.hpp"
#include "cspace/math/predicates.hpp"

using namespace cspace;

namespace {

// Points whose coordinates are 2⁻³⁰ times integers below 2³¹: their determinants fit into 64 bits.
struct Grid {
    std::int64_t x, y;
    Point point(double shift) const {
        return {std::ldexp(double(x), -30) + shift, std::ldexp(double(y), -30) + shift};
    }
};
int true_orientation(Grid a, Grid b, Grid c) {
    const std::int64_t det = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
    return (det > 0) - (det < 0);
}

}  // namespace

TEST(orientation_is_that_of_integers_wherever_they_are_moved) {
    std::mt19937_64 random(1);
    int on_a_line = 0;
    for (int trial = 0; trial < 200000; ++trial) {
        const auto draw = [&](std::int64_t most) { return std::int64_t(random() % (2 * most + 1)) - most; };
        const Grid a{draw(1 << 20), draw(1 << 20)}, step{draw(1 << 10), draw(1 << 10)};
        const std::int64_t m = draw(1 << 10), n = draw(1 << 10), off = trial % 3 == 0 ? 0 : 1;
        const Grid b{a.x + m * step.x, a.y + m * step.y},
            c{a.x + n * step.x + off * draw(1), a.y + n * step.y + off * draw(1)};
        const int truth = true_orientation(a, b, c);
        on_a_line += truth == 0;
        for (const double shift : {0.0, 1.0, 4194303.0}) {
            const Point p = a.point(shift), q = b.point(shift), r = c.point(shift);
            CHECK(orientation(p, q, r) == truth);
            CHECK(exact::orientation(p, q, r) == truth);
            CHECK(orientation(q, r, p) == truth && orientation(q, p, r) == -truth);
        }
    }
    CHECK(on_a_line > 50000);
}

TEST(sums_without_rounding_tell_the_least_difference) {
    // c is moved off the line from a to b by the last bit of a coordinate that has no common exponent with
    // theirs.
    const Point a{0.1, 0.1}, b{0.3, 0.3};
    for (const double t : {1e-300, 0.2, 7.0, 1e15}) {
        CHECK(orientation(a, b, {t, t}) == 0);
        CHECK(orientation(a, b, {t, std::nextafter(t, 1e300)}) == 1);
        CHECK(orientation(a, b, {t, std::nextafter(t, -1e300)}) == -1);
    }
    CHECK(orientation({1e6 + 0.1, 1e6 + 0.1}, {1e-9, 1e-9}, {3, 3}) == 0);
}

TEST(a_point_is_inside_a_circle_for_sure_or_not) {
    const Point a{0, 0}, b{1, 0}, c{0, 1};
    CHECK(surely_in_circle(a, b, c, {0.5, 0.5}));
    CHECK(!surely_in_circle(a, b, c, {1, 1}));
    CHECK(!surely_in_circle(a, b, c, {2, 1}));
}

TEST(between_holds_its_ends) {
    const Point a{5, 1}, b{0, 0}, c{-5, -1};
    CHECK(is_between(a, b, c) && is_between(c, b, a) && is_between(a, a, c) && is_between(a, c, c));
    CHECK(!is_between(b, a, c) && !is_between(a, c, b));
    CHECK(is_between({1, 2}, {1, 3}, {1, 4}) && !is_between({1, 3}, {1, 2}, {1, 4}));
}
