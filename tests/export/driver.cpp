// Answers goals with an exported arm: reads their number and 16 doubles each, and LOCKED values of locked
// joints, writes per goal count, status,
// complete (int), the rows, their families (int), and the poses and Jacobians of the rows.
#include HEADER

#include <cstdio>
#include <vector>

namespace arm = ARM;

#ifndef LOCKED
#define LOCKED 0
#endif
constexpr std::size_t stride = 16 + LOCKED;

static arm::Solutions solutions(const double* goal) {
#if LOCKED
    static_assert(arm::locked_count == LOCKED, "as many values as the arm holds joints");
    return arm::ik(goal, goal + 16);
#else
    return arm::ik(goal);
#endif
}

template <class T>
static void put(const T* values, std::size_t count) {
    if (std::fwrite(values, sizeof(T), count, stdout) != count) std::perror("write");
}

int main() {
    int n = 0;
    if (std::fread(&n, sizeof n, 1, stdin) != 1) return 2;
    std::vector<double> goals(stride * static_cast<std::size_t>(n));
    if (std::fread(goals.data(), sizeof(double), goals.size(), stdin) != goals.size()) return 2;
    for (int k = 0; k < n; ++k) {
        const arm::Solutions found = solutions(&goals[stride * static_cast<std::size_t>(k)]);
        const int head[3] = {found.count, static_cast<int>(found.status), found.complete};
        put(head, 3);
        for (int j = 0; j < found.count; ++j) {
            double T[4][4], J[6 * arm::dof];
            arm::fk(found.q[j], T);
            arm::jacobian(found.q[j], J);
            const int family = found.self_motion[j];
            put(found.q[j], arm::dof);
            put(&family, 1);
            put(&T[0][0], 16);
            put(J, 6 * arm::dof);
        }
    }
    return 0;
}
