// The logarithm of a number of things, summed so that it is the same on every machine.
#pragma once

#include <cstddef>

namespace cspace::search {

inline double portable_log(std::size_t n) {
    double log = 0, m = double(n);
    for (; m > 1.5; m /= 2) log += 0.6931471805599453;
    const double x = (m - 1) / (m + 1), xx = x * x;
    double term = 2 * x;
    for (int k = 1; k < 30; k += 2, term *= xx) log += term / k;
    return log;
}

}  // namespace cspace::search
