// Plans and checks of arms without Python, on the problems of files that benchmarks/planning_core.py writes.
//
// Usage: bench_plans plan ROBOT PROBLEMS ROUNDS      a line per problem; the first one names the columns
//        bench_plans edges ROBOT PROBLEMS EDGES ROUNDS   ns per edge, proved and sampled, free and blocked
//        bench_plans rows ROBOT PROBLEMS ROUNDS      configurations per second, in blocks of eight
//
// ROBOT: dof, numbers of joints, links, spheres, pairs; 21 numbers per joint, as the bindings take them;
// lower and upper bounds; the body of each link; x y z r and the link of each sphere; pairs of links.
// PROBLEMS: a line "robot NAME dof count", then per problem "problem SET INDEX goals objects", a line "start
// …", lines "goal …", and lines of objects, "sphere x y z r", "box" (centre, three axes, half sizes),
// "capsule" (start, the vector to its end, radius); z before a name says that it stands upright. EDGES:
// floats, both ends of each edge, equally many per problem.
//
// Times are those of the thread's processor clock: rounds over all problems, the median per problem.
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bench.hpp"
#include "library/planning_arm.hpp"

using namespace cspace;
using planning::ArmOptions;
using planning::ArmPlan;
using planning::EdgeTest;

namespace {

double clock_us() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}
double median_of(std::vector<double> values) {
    if (values.empty()) return 0;
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

struct Arm {
    std::shared_ptr<const collision::RobotData> data;
    std::vector<double> lower, upper;
};

std::vector<double> read_numbers(std::istream& in, std::size_t count) {
    std::vector<double> numbers(count);
    for (double& x : numbers) in >> x;
    return numbers;
}

Arm read_arm(const char* path) {
    std::ifstream in(path);
    std::size_t dof, n_joints, n_links, n_spheres, n_pairs;
    if (!(in >> dof >> n_joints >> n_links >> n_spheres >> n_pairs)) throw std::runtime_error("no robot");
    std::vector<model::Joint> joints;
    for (std::size_t j = 0; j < n_joints; ++j) {
        const std::vector<double> row = read_numbers(in, 21);
        Posed T = identity_pose();
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) T.R.m[r][c] = row[std::size_t(4 * r + c)];
        T.t = {row[3], row[7], row[11]};
        joints.push_back({T, int(row[16]), int(row[17]), row[18], row[19], row[20] != 0, 0.0});
    }
    Arm arm;
    arm.lower = read_numbers(in, dof), arm.upper = read_numbers(in, dof);
    std::vector<int> bodies(n_links);
    for (int& body : bodies) in >> body;
    std::vector<collision::Sphere> spheres(n_spheres);
    for (collision::Sphere& s : spheres) in >> s.center.x >> s.center.y >> s.center.z >> s.radius >> s.link;
    std::vector<std::pair<int, int>> pairs(n_pairs);
    for (auto& [a, b] : pairs) in >> a >> b;
    if (!in) throw std::runtime_error("the robot ends early");
    arm.data = std::make_shared<collision::RobotData>(joints, int(dof), arm.lower, arm.upper, bodies, spheres,
                                                      pairs);
    return arm;
}

struct Problem {
    std::string name;
    std::vector<double> start, goals;
    std::unique_ptr<collision::Checker> checker;
    bool valid = false;
};

// The obstacles of a problem, line by line.
class Obstacles {
  public:
    void add(std::string kind, const std::vector<double>& v) {
        if (kind[0] == 'z') kind.erase(0, 1);
        if (kind == "sphere") {
            append(capsules_, {v[0], v[1], v[2], v[0], v[1], v[2], v[3]});
        } else if (kind == "capsule") {
            append(capsules_, {v[0], v[1], v[2], v[0] + v[3], v[1] + v[4], v[2] + v[5], v[6]});
        } else if (kind == "box") {
            append(boxes_, {v[0], v[1], v[2]});
            for (std::size_t r = 0; r < 3; ++r)  // the axes are columns
                append(boxes_, {v[3 + r], v[6 + r], v[9 + r]});
            append(boxes_, {v[12], v[13], v[14]});
        } else {
            throw std::runtime_error("unknown object " + kind);
        }
        owners_.push_back(int(owners_.size()));
    }
    std::shared_ptr<const collision::SceneData> make() const {
        collision::Primitives given = {};
        given.boxes = boxes_, given.capsules = capsules_, given.owners = owners_;
        return std::make_shared<collision::SceneData>(given);
    }

  private:
    std::vector<double> boxes_, capsules_;
    std::vector<int> owners_;
    static void append(std::vector<double>& to, std::initializer_list<double> row) {
        to.insert(to.end(), row);
    }
};

std::vector<Problem> read_problems(const char* path, const Arm& arm) {
    std::ifstream in(path);
    std::string line, word, name;
    std::size_t dof = 0, count = 0;
    const auto next = [&] { return std::getline(in, line), std::istringstream(line); };
    next() >> word >> name >> dof >> count;
    std::vector<Problem> problems(count);
    for (Problem& problem : problems) {
        std::string group, index;
        std::size_t goals = 0, objects = 0;
        next() >> word >> group >> index >> goals >> objects;
        problem.name = group + " " + index;
        Obstacles obstacles;
        for (std::size_t k = 0; k < 1 + goals + objects; ++k) {
            std::istringstream row = next();
            row >> word;
            const std::vector<double> v{std::istream_iterator<double>(row), {}};
            if (word == "start")
                problem.start = v;
            else if (word == "goal")
                problem.goals.insert(problem.goals.end(), v.begin(), v.end());
            else
                obstacles.add(word, v);
        }
        problem.checker = std::make_unique<collision::Checker>(arm.data, obstacles.make(), 0.0,
                                                               std::span<const std::pair<int, int>>());
        const auto memory = problem.checker->borrow_workspace();
        problem.valid = problem.checker->is_free(problem.start.data(), *memory);
        for (std::size_t g = 0; g < problem.goals.size(); g += dof)
            problem.valid = problem.valid && problem.checker->is_free(&problem.goals[g], *memory);
    }
    return problems;
}

ArmPlan plan_problem(const Arm& arm, const Problem& problem, const ArmOptions& options) {
    return plan_arm({*problem.checker, arm.lower, arm.upper, {}}, {problem.start, problem.goals}, options);
}

// RRT-Connect alone, at samples and proved; the default plan, and what of it is simplification and proofs.
int measure_plans(const Arm& arm, const std::vector<Problem>& problems, int rounds) {
    ArmOptions sampled, proved, whole;
    sampled.search = sampled.answer = proved.answer = EdgeTest::sampled;
    sampled.simplify = proved.simplify = false;
    const ArmOptions* kinds[] = {&sampled, &proved, &whole};
    struct Spent {
        std::vector<double> all[3], simplify;
        ArmPlan plans[3];
    };
    std::vector<Spent> spent(problems.size());
    for (int round = 0; round < rounds; ++round)
        for (int kind = 0; kind < 3; ++kind)
            for (std::size_t i = 0; i < problems.size(); ++i) {
                if (!problems[i].valid) continue;
                const double begin = clock_us();
                ArmPlan plan = plan_problem(arm, problems[i], *kinds[kind]);
                spent[i].all[kind].push_back(clock_us() - begin);
                if (kind == 2)
                    spent[i].simplify.push_back(1e6 *
                                                (plan.stats.simplify_seconds + plan.stats.proof_seconds));
                spent[i].plans[kind] = std::move(plan);
            }
    std::printf(
        "# set index valid solved sampled_us proved_us plan_us simplify_us cost_raw cost edges nodes\n");
    for (std::size_t i = 0; i < problems.size(); ++i) {
        const Spent& row = spent[i];
        const ArmPlan &raw = row.plans[1], &plan = row.plans[2];
        const bool solved = problems[i].valid && plan.status == planning::PlanStatus::found;
        std::printf("%s %d %d %.3f %.3f %.3f %.3f %.6f %.6f %.0f %.0f\n", problems[i].name.c_str(),
                    problems[i].valid, solved, median_of(row.all[0]), median_of(row.all[1]),
                    median_of(row.all[2]), median_of(row.simplify), raw.cost, plan.cost,
                    double(raw.stats.edges), double(raw.stats.nodes));
    }
    return 0;
}

// Of each problem the least time of the rounds, as the peer takes it.
int measure_edges(const std::vector<Problem>& problems, const char* path, int rounds) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<float> ends(bytes.size() / sizeof(float));
    std::memcpy(ends.data(), bytes.data(), ends.size() * sizeof(float));
    const std::size_t dof = problems[0].start.size(), width = 2 * dof;
    const std::size_t each = ends.size() / width / problems.size();
    for (const bool is_proved : {true, false}) {
        double ns[3] = {};
        std::size_t counts[3] = {};
        for (std::size_t i = 0; i < problems.size(); ++i) {
            const collision::Checker& checker = *problems[i].checker;
            const auto memory = checker.borrow_workspace();
            const auto check = [&](const float* edge) {
                constexpr float resolution = 1.0f / 32;
                return is_proved ? checker.prove_edge(edge, edge + dof, *memory)
                                 : checker.sample_edge(edge, edge + dof, resolution, *memory);
            };
            std::vector<const float*> chosen[3];  // all, free, blocked
            for (std::size_t k = 0; k < each; ++k) {
                const float* edge = &ends[(i * each + k) * width];
                chosen[0].push_back(edge);
                chosen[check(edge) == collision::Verdict::free ? 1 : 2].push_back(edge);
            }
            for (int c = 0; c < 3; ++c) {
                double least = 1e300;
                for (int round = 0; round < rounds && !chosen[c].empty(); ++round) {
                    const double begin = clock_us();
                    for (const float* edge : chosen[c]) bench::keep(check(edge));
                    least = std::min(least, clock_us() - begin);
                }
                if (!chosen[c].empty()) ns[c] += 1e3 * least, counts[c] += chosen[c].size();
            }
        }
        std::printf("%s edges %zu ns %.1f free %zu ns %.1f blocked %zu ns %.1f\n",
                    is_proved ? "proved" : "sampled", counts[0], ns[0] / double(counts[0]), counts[1],
                    ns[1] / double(counts[1]), counts[2], ns[2] / double(counts[2]));
    }
    return 0;
}

// Random configurations, in the scene of every eighth problem.
int measure_rows(const Arm& arm, const std::vector<Problem>& problems, int rounds) {
    constexpr std::size_t n = 1 << 13, step = 8;
    const std::size_t dof = arm.lower.size();
    std::vector<double> q(n * dof);
    std::uint64_t state = 1;
    for (std::size_t i = 0; i < q.size(); ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        q[i] = arm.lower[i % dof] + double(state >> 11) * 0x1p-53 * (arm.upper[i % dof] - arm.lower[i % dof]);
    }
    std::vector<std::uint8_t> collides(n);
    std::vector<double> rates;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < problems.size(); i += step) {
        std::vector<double> times;
        for (int round = 0; round < rounds; ++round) {
            const double begin = clock_us();
            problems[i].checker->check_rows(q.data(), n, collides.data(), 1);
            times.push_back(clock_us() - begin);
        }
        rates.push_back(double(n) / median_of(times));
        for (const std::uint8_t hit : collides) hits += hit;
    }
    std::printf("rows_per_second %.3g hits %zu\n", 1e6 * median_of(rates), hits);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "";
    const bool has_edges = mode == "edges" && argc == 6;
    if (!has_edges && !((mode == "plan" || mode == "rows") && argc == 5)) {
        std::fprintf(stderr, "usage: bench_plans plan|rows ROBOT PROBLEMS ROUNDS, or edges … EDGES ROUNDS\n");
        return 2;
    }
    const Arm arm = read_arm(argv[2]);
    const std::vector<Problem> problems = read_problems(argv[3], arm);
    const int rounds = std::stoi(argv[argc - 1]);
    if (mode == "plan") return measure_plans(arm, problems, rounds);
    if (mode == "rows") return measure_rows(arm, problems, rounds);
    return measure_edges(problems, argv[4], rounds);
}
