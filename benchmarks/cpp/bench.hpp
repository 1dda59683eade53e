// The clock of the C++ benchmarks: median over repetitions of the time per item, printed as a JSON line.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

namespace bench {

// The compiler must believe that the value is used.
template <class T>
inline void keep(const T& value) {
#if defined(__GNUC__) || defined(__clang__)
    asm volatile("" : : "r"(&value) : "memory");
#else
    static volatile const void* sink;
    sink = &value;
#endif
}

// Runs body() once to warm up, then `repetitions` times; each run handles `items` items.
template <class Body>
void measure(const char* name, long items, int repetitions, Body body) {
    body();
    std::vector<double> times;
    for (int i = 0; i < repetitions; ++i) {
        const auto start = std::chrono::steady_clock::now();
        body();
        const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
        times.push_back(spent.count() / double(items));
    }
    std::sort(times.begin(), times.end());
    const double median = times[times.size() / 2], p95 = times[times.size() * 95 / 100];
    std::printf("{\"name\": \"%s\", \"unit\": \"ns\", \"median\": %.3f, \"p95\": %.3f}\n", name, median, p95);
}

}  // namespace bench
