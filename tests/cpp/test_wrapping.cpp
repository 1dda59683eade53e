// Angles are wrapped into their range at its ends too, to the last digit.
#include <cmath>
#include <limits>

#include "check.hpp"
#include "cspace/math/wrapping.hpp"
#include "random.hpp"

using namespace cspace;
using check::Random;

namespace {

constexpr double largest = std::numeric_limits<double>::infinity();

// The angle and its `steps` neighbours on either side.
template <class Check>
void check_neighbours(double angle, int steps, const Check& check_one) {
    double below = angle, above = angle;
    check_one(angle);
    for (int k = 0; k < steps; ++k) {
        check_one(below = std::nextafter(below, -largest));
        check_one(above = std::nextafter(above, largest));
    }
}

}  // namespace

TEST(angles_above_a_start) {
    Random random{3};
    for (int k = 0; k < 2000; ++k) {
        const double start = k % 4 == 0 ? -pi : k % 4 == 1 ? 0 : random.uniform(-7, 7);
        check_neighbours(start + 2 * pi * (k % 7 - 3), 4, [&](double angle) {
            const double wrapped = wrap_above(angle, start);
            CHECK(wrapped >= start && wrapped <= start + 2 * pi);
            CHECK(std::fabs(std::remainder(wrapped - angle, 2 * pi)) < 1e-14);
        });
    }
}

TEST(angles_in_half_turns) {
    for (int turns = -3; turns <= 3; ++turns)
        check_neighbours(pi * (2 * turns + 1), 4, [](double angle) {
            const double wrapped = wrap_angle(angle);
            CHECK(wrapped > -pi && wrapped <= pi);
            CHECK(std::fabs(std::remainder(wrapped - angle, 2 * pi)) < 1e-14);
        });
}
