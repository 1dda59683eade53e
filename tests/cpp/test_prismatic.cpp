// The subproblems of a sliding joint, against a sweep along the line and on packs.
#include "check.hpp"
#include "cspace/ik/subproblems/prismatic.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::ik;
using check::Random;

namespace {

template <class F>
void check_best(const Slides<double>& s, F f) {
    for (double x : s.x) CHECK_NEAR(f(x), s.error, 1e-14 * (1 + std::fabs(x)));
    for (int i = -300; i <= 300; ++i) CHECK(f(0.01 * i) >= s.error - 1e-14);
    if (s.free) CHECK_NEAR(f(1.0), s.error, 1e-13);
}

}  // namespace

TEST(slides_leave_the_smallest_error) {
    Random random{1};
    for (int repeat = 0; repeat < 500; ++repeat) {
        const Vec3d h = random.axis(), p = random.vector(), n = random.below(4) ? random.axis() : cross(h, p);
        const Vec3d q = random.below(3) ? random.vector() : p + random.uniform(-1, 1) * h;
        const double d = random.uniform(0, 1.5);
        check_best(slide_1(h, p, q), [&](double x) { return norm(p + x * h - q); });
        check_best(slide_3(h, p, q, d), [&](double x) { return std::fabs(norm(p + x * h - q) - d); });
        check_best(slide_4(n, h, p, d), [&](double x) { return std::fabs(dot(n, p + x * h) - d); });
    }
}

TEST(a_distance_is_met_twice_once_or_never) {
    const Vec3d h = {1, 0, 0}, p = {0, 0, 0}, q = {0.5, 1, 0};
    CHECK(slide_3(h, p, q, 1.25).two && slide_3(h, p, q, 1.25).exact);
    CHECK_NEAR(slide_3(h, p, q, 1.25).x[0], 1.25, 1e-15);
    CHECK_NEAR(slide_3(h, p, q, 1.25).x[1], -0.25, 1e-15);
    CHECK(!slide_3(h, p, q, 1.0).two && slide_3(h, p, q, 1.0).exact);
    CHECK(!slide_3(h, p, q, 0.75).exact);
    CHECK_NEAR(slide_3(h, p, q, 0.75).error, 0.25, 1e-15);
}

TEST(a_pack_slides_like_one_lane) {
    Random random{2};
    using V = Pack<4>;
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Vec3d h = random.axis(), p = random.vector(), q = random.vector();
        V d;
        for (int i = 0; i < 4; ++i) set_lane(d, i, random.uniform(0, 1.5));
        const auto three = slide_3(fill3<V>(h), fill3<V>(p), fill3<V>(q), d);
        const auto four = slide_4(fill3<V>(q), fill3<V>(h), fill3<V>(p), d);
        for (int i = 0; i < 4; ++i) {
            const auto one = slide_3(h, p, q, lane(d, i)), other = slide_4(q, h, p, lane(d, i));
            CHECK(lane(three.two, i) == one.two && lane(three.exact, i) == one.exact);
            CHECK_NEAR(lane(three.x[0], i), one.x[0], 1e-14);
            CHECK_NEAR(lane(three.x[1], i), one.x[1], 1e-14);
            CHECK_NEAR(lane(four.x[0], i), other.x[0], 1e-12 * (1 + std::fabs(other.x[0])));
        }
    }
}
