// Two files of one program include all headers under strict warnings, and agree.
#include "umbrella.hpp"

#include "check.hpp"

TEST(two_files_that_include_everything_agree) {
    const umbrella::Answers here = umbrella::answers(), there = umbrella::answers_elsewhere();
    CHECK_NEAR(here.tip, 1, 1e-15);
    CHECK_NEAR(here.angle, cspace::pi / 2, 1e-15);
    CHECK_NEAR(here.singular, 4, 1e-15);
    CHECK_NEAR(here.path, 1 + 2 * std::sqrt(2.0), 1e-15);
    CHECK(here.tip == there.tip && here.angle == there.angle);
    CHECK(here.singular == there.singular && here.path == there.path);
}
