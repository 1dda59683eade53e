// Inverse kinematics without Python: all branches of one pose after another, and of many in one call.
//
// Usage: bench_ik ARMS. The file holds per arm its name, its number of joints n, n axes, n points and the tip
// at zero (16 numbers, row by row).
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "bench.hpp"
#include "cspace/ik/arm.hpp"
#include "kernels/ik.hpp"

using namespace cspace;

struct NamedArm {
    std::string name;
    ik::Chain chain;
};

static std::vector<NamedArm> read_arms(const char* path) {
    std::ifstream file(path);
    std::vector<NamedArm> arms;
    NamedArm arm;
    while (file >> arm.name >> arm.chain.n) {
        for (int i = 0; i < arm.chain.n; ++i) {
            Vec3d& axis = arm.chain.axis[i];
            file >> axis.x >> axis.y >> axis.z;
        }
        for (int i = 0; i < arm.chain.n; ++i) {
            Vec3d& point = arm.chain.point[i];
            file >> point.x >> point.y >> point.z;
        }
        double T[16];
        for (double& entry : T) file >> entry;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) arm.chain.tip.R.m[i][j] = T[4 * i + j];
        arm.chain.tip.t = {T[3], T[7], T[11]};
        arms.push_back(arm);
    }
    return arms;
}

static std::vector<double> random_goals(const ik::Chain& chain, int count) {
    std::mt19937_64 rng(2026);
    std::uniform_real_distribution<double> angle(-3.141592653589793, 3.141592653589793);
    std::vector<double> goals;
    for (int k = 0; k < count; ++k) {
        double q[ik::max_joints];
        for (int i = 0; i < chain.n; ++i) q[i] = angle(rng);
        const Posed T = forward_kinematics(chain, q);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) goals.push_back(T.R.m[i][j]);
            goals.push_back(i == 0 ? T.t.x : i == 1 ? T.t.y : T.t.z);
        }
        for (const double entry : {0.0, 0.0, 0.0, 1.0}) goals.push_back(entry);
    }
    return goals;
}

static void measure_arm(const NamedArm& arm) {
    const ik::Arm solver = make_arm(arm.chain);
    if (!solver.has_plan) {
        std::fprintf(stderr, "%s has no closed form\n", arm.name.c_str());
        return;
    }
    constexpr int n = 1000;
    const std::vector<double> goals = random_goals(arm.chain, n);
    std::vector<double> q(n * ik::max_branches * 6);
    std::vector<std::int64_t> counts(n);
    std::vector<ik::FastPath> verdicts(n);
    std::int8_t branch[ik::max_branches];
    bench::measure(("ik " + arm.name).c_str(), n, 200, [&] {
        for (int k = 0; k < n; ++k) {
            int count = 0;
            kernels::ik_one(solver, &goals[16 * k], q.data(), branch, &count);
            bench::keep(q[0]);
        }
    });
    bench::measure(("ik batch " + arm.name).c_str(), n, 200, [&] {
        kernels::ik_many(solver, goals.data(), n, n, ik::max_branches, q.data(), counts.data(),
                         verdicts.data());
    });
}

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: bench_ik ARMS\n");
        return 2;
    }
    for (const NamedArm& arm : read_arms(argv[1])) measure_arm(arm);
    return 0;
}
