// Laws of continuation on a curve that is known: a circle.
#include <cmath>

#include "check.hpp"
#include "cspace/math/continuation.hpp"

using namespace cspace;

namespace {

// A point of the unit circle with its tangent and its second derivative by the arc length.
struct Point {
    double q[2], tangent[2], bend[2];
};
Point point_at(double s) {
    return {{std::cos(s), std::sin(s)}, {-std::sin(s), std::cos(s)}, {-std::cos(s), -std::sin(s)}};
}
double off_circle(const double* q) { return std::fabs(std::hypot(q[0], q[1]) - 1); }

}  // namespace

TEST(the_predictor_leaves_the_curve_by_the_third_order) {
    double last = 0;
    for (const double h : {0.4, 0.2, 0.1, 0.05}) {
        const Point at = point_at(0.7), there = point_at(0.7 + h);
        double q[2];
        predict_along(at.q, at.tangent, at.bend, h, 2, q);
        const double error = std::hypot(q[0] - there.q[0], q[1] - there.q[1]);
        CHECK(error < 0.2 * h * h * h);
        if (last > 0) CHECK(error < last / 7);
        last = error;
    }
}

TEST(a_point_may_be_predicted_in_place) {
    Point at = point_at(1.1);
    double q[2];
    predict_along(at.q, at.tangent, at.bend, -0.3, 2, q);
    predict_along(at.q, at.tangent, at.bend, -0.3, 2, at.q);
    CHECK(q[0] == at.q[0] && q[1] == at.q[1]);
}

TEST(a_tangent_takes_the_sense_of_another) {
    Point at = point_at(0.2);
    const double along[2] = {1, -1};
    orient_tangent(at.tangent, along, 2);
    CHECK(dot_n(at.tangent, along, 2) > 0);
    const Point before = at;
    orient_tangent(at.tangent, along, 2);
    CHECK(before.tangent[0] == at.tangent[0] && before.tangent[1] == at.tangent[1]);
}

TEST(a_step_is_halved_until_it_stays_on_the_curve) {
    const Point at = point_at(0);
    double h = 1, q[2];
    int attempts = 0;
    const auto attempt = [&](double step) {
        ++attempts;
        predict_along(at.q, at.tangent, at.bend, step, 2, q);
        return off_circle(q) < 1e-3;
    };
    CHECK(halve_step(h, 1e-6, attempt));
    CHECK(off_circle(q) < 1e-3 && h == std::ldexp(1.0, 1 - attempts) && attempts > 1);
    h = 1;
    CHECK(!halve_step(h, 0.3, [](double) { return false; }));
    CHECK(h < 0.3);
}
