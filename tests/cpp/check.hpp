// The test harness of the C++ side: TEST(name) { CHECK(...); CHECK_NEAR(a, b, tolerance); } and a main.
#pragma once

#include <cmath>
#include <cstdio>
#include <vector>

namespace check {
struct Test {
    const char* name;
    void (*body)();
};
inline std::vector<Test>& tests() {
    static std::vector<Test> all;
    return all;
}
inline int failures = 0;
inline bool add(const char* name, void (*body)()) {
    tests().push_back({name, body});
    return true;
}
inline void fail(const char* file, int line, const char* what) {
    ++failures;
    std::printf("%s:%d: %s\n", file, line, what);
}
}  // namespace check

#define TEST(name)                                             \
    static void name();                                        \
    static const bool name##_added = check::add(#name, &name); \
    static void name()
#define CHECK(condition)                                               \
    do {                                                               \
        if (!(condition)) check::fail(__FILE__, __LINE__, #condition); \
    } while (0)
#define CHECK_NEAR(a, b, tolerance)                                 \
    do {                                                            \
        const double check_a = (a), check_b = (b);                  \
        if (!(std::fabs(check_a - check_b) <= (tolerance))) {       \
            std::printf("%.17g against %.17g\n", check_a, check_b); \
            check::fail(__FILE__, __LINE__, #a " is not near " #b); \
        }                                                           \
    } while (0)

int main() {
    for (const auto& test : check::tests()) {
        const int before = check::failures;
        test.body();
        std::printf("%s %s\n", check::failures == before ? "ok  " : "FAIL", test.name);
    }
    return check::failures ? 1 : 0;
}
