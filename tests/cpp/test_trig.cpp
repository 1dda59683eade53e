#include "check.hpp"
#include "cspace/math/trig.hpp"

using namespace cspace;

TEST(a_pack_agrees_with_one_lane) {
    for (double x = -7; x < 7; x += 0.37) {
        Pack<4> s, c;
        sincos(fill<Pack<4>>(x), s, c);
        CHECK_NEAR(lane(s, 2), std::sin(x), 1e-15);
        CHECK_NEAR(lane(c, 1), std::cos(x), 1e-15);
    }
}
