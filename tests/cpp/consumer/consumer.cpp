#include <cmath>

#include "cspace/math/trig.hpp"
#include "cspace/version.hpp"

int main() {
    double s = 0, c = 0;
    cspace::sincos(0.5, s, c);
    return std::fabs(s - std::sin(0.5)) + std::fabs(c - std::cos(0.5)) < 1e-15 ? 0 : 1;
}
