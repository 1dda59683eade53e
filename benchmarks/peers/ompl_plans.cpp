// Plans of OMPL's RRT-Connect with checks of our own or of coal, on problems that planning_peers.py writes.
//
// Usage: ompl_plans FILE CHECKER ROUNDS RESOLUTION SECONDS [FIRST STEP]. CHECKER: spheres (scalar double
// precision, links enclosed in balls), coal_spheres (the same spheres as coal objects) or coal_meshes
// (triangle meshes of the links, OBBRSS trees, as MoveIt uses them); both of coal with a broad phase of
// dynamic trees of boxes. RESOLUTION: of the samples of a motion [rad]; 0 leaves OMPL's default, a hundredth
// of the extent of the space. A line per problem: valid, solved, microseconds of the search and with OMPL's
// simplification, both lengths, checks of the search. Times are of the thread's processor clock, the median
// of the rounds. Only every STEP-th problem is planned.

#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/broadphase/default_broadphase_callbacks.h>
#include <coal/collision.h>
#include <coal/shape/geometric_shapes.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/RandomNumbers.h>
#include <time.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Vec = Eigen::Vector3d;
using Mat = Eigen::Matrix3d;

struct Frame {
    Mat R = Mat::Identity();
    Vec p = Vec::Zero();
};

struct Joint {
    int parent, motion, variable;
    Vec xyz, axis;
    Mat R;
};

struct Sphere {
    int link;
    Vec center;
    double radius;
};

struct Link {
    int frame;
    std::vector<Sphere> spheres;
    Vec middle;  // of the ball around all spheres
    double reach;
    std::vector<Vec> vertices;
    std::vector<coal::Triangle> faces;
};

struct Obstacle {
    int kind;  // box, sphere, capsule
    Vec p, size;
    Mat R;
};

struct Problem {
    std::vector<double> start, goal;
    std::vector<Obstacle> obstacles;
};

struct Setup {
    int dof = 0;
    std::vector<double> low, high;
    std::vector<Joint> joints;
    std::vector<Link> links;
    std::vector<std::pair<int, int>> pairs;
    std::vector<Problem> problems;
};

template <class T>
T read(std::istream& in) {
    T value{};
    if (!(in >> value)) std::exit((std::fprintf(stderr, "the file of problems ends early\n"), 1));
    return value;
}

Vec read_vector(std::istream& in) {
    Vec v;
    for (int i = 0; i < 3; ++i) v[i] = read<double>(in);
    return v;
}

Mat read_matrix(std::istream& in) {
    Mat m;
    for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = read<double>(in);
    return m;
}

std::vector<double> read_row(std::istream& in, int n) {
    std::vector<double> row;
    for (int i = 0; i < n; ++i) row.push_back(read<double>(in));
    return row;
}

Link read_link(std::istream& in) {
    Link link;
    link.frame = read<int>(in);
    for (int n = read<int>(in); n > 0; --n) {
        const Vec c = read_vector(in);
        link.spheres.push_back({0, c, read<double>(in)});
    }
    link.middle = Vec::Zero();
    for (const Sphere& s : link.spheres) link.middle += s.center / static_cast<double>(link.spheres.size());
    link.reach = 0.0;
    for (const Sphere& s : link.spheres)
        link.reach = std::max(link.reach, (s.center - link.middle).norm() + s.radius);
    for (int n = read<int>(in); n > 0; --n) link.vertices.push_back(read_vector(in));
    for (int n = read<int>(in); n > 0; --n) {
        const int a = read<int>(in), b = read<int>(in), c = read<int>(in);
        link.faces.emplace_back(a, b, c);
    }
    return link;
}

Setup read_setup(const char* path) {
    std::ifstream in(path);
    Setup s;
    s.dof = read<int>(in);
    s.low = read_row(in, s.dof), s.high = read_row(in, s.dof);
    for (int n = read<int>(in); n > 0; --n) {
        Joint j;
        j.parent = read<int>(in), j.motion = read<int>(in), j.variable = read<int>(in);
        j.xyz = read_vector(in), j.R = read_matrix(in), j.axis = read_vector(in);
        s.joints.push_back(j);
    }
    for (int n = read<int>(in); n > 0; --n) s.links.push_back(read_link(in));
    for (int n = read<int>(in); n > 0; --n) {
        const int a = read<int>(in), b = read<int>(in);
        s.pairs.emplace_back(a, b);
    }
    for (int n = read<int>(in); n > 0; --n) {
        Problem p;
        p.start = read_row(in, s.dof), p.goal = read_row(in, s.dof);
        for (int m = read<int>(in); m > 0; --m) {
            Obstacle o;
            o.kind = read<int>(in), o.p = read_vector(in), o.R = read_matrix(in), o.size = read_vector(in);
            p.obstacles.push_back(o);
        }
        s.problems.push_back(std::move(p));
    }
    return s;
}

class Checker {
  public:
    explicit Checker(const Setup& setup) : setup_(setup), frames_(setup.joints.size() + 1) {}
    virtual ~Checker() = default;
    virtual void set_scene(const std::vector<Obstacle>& obstacles) = 0;
    virtual bool is_free(const double* q) = 0;
    long checks = 0;

  protected:
    void place(const double* q) {
        ++checks;
        for (std::size_t k = 0; k < setup_.joints.size(); ++k) {
            const Joint& j = setup_.joints[k];
            const Frame& base = frames_[static_cast<std::size_t>(j.parent)];
            Frame& f = frames_[k + 1];
            f.p = base.p + base.R * j.xyz;
            f.R.noalias() = base.R * j.R;
            if (j.variable >= 0 && j.motion == 1)
                f.R = f.R * Eigen::AngleAxisd(q[j.variable], j.axis).toRotationMatrix();
            if (j.variable >= 0 && j.motion == 2) f.p += q[j.variable] * (f.R * j.axis);
        }
    }

    const Setup& setup_;
    std::vector<Frame> frames_;
};

class SphereChecker : public Checker {
  public:
    explicit SphereChecker(const Setup& setup)
        : Checker(setup), centers_(setup.links.size()), balls_(setup.links.size()) {
        for (std::size_t k = 0; k < setup.links.size(); ++k)
            centers_[k].resize(setup.links[k].spheres.size());
    }

    void set_scene(const std::vector<Obstacle>& obstacles) override { obstacles_ = obstacles; }

    bool is_free(const double* q) override {
        place(q);
        for (std::size_t k = 0; k < setup_.links.size(); ++k) {
            const Link& link = setup_.links[k];
            const Frame& f = frames_[static_cast<std::size_t>(link.frame)];
            balls_[k] = f.p + f.R * link.middle;
            for (std::size_t i = 0; i < link.spheres.size(); ++i)
                centers_[k][i] = f.p + f.R * link.spheres[i].center;
            for (const Obstacle& o : obstacles_)
                if (touches(o, balls_[k], link.reach))
                    for (std::size_t i = 0; i < link.spheres.size(); ++i)
                        if (touches(o, centers_[k][i], link.spheres[i].radius)) return false;
        }
        for (const auto& [a, b] : setup_.pairs)
            if (touch(static_cast<std::size_t>(a), static_cast<std::size_t>(b))) return false;
        return true;
    }

  private:
    static bool touches(const Obstacle& o, const Vec& c, double r) {
        if (o.kind == 1) return (c - o.p).squaredNorm() < (r + o.size[0]) * (r + o.size[0]);
        Vec y = o.R.transpose() * (c - o.p);
        if (o.kind == 0) return (y.cwiseAbs() - o.size).cwiseMax(0.0).squaredNorm() < r * r;
        y[2] -= std::clamp(y[2], -o.size[1], o.size[1]);
        return y.squaredNorm() < (r + o.size[0]) * (r + o.size[0]);
    }

    bool touch(std::size_t a, std::size_t b) const {
        const Link &x = setup_.links[a], &y = setup_.links[b];
        const double reach = x.reach + y.reach;
        if ((balls_[a] - balls_[b]).squaredNorm() >= reach * reach) return false;
        for (std::size_t i = 0; i < x.spheres.size(); ++i)
            for (std::size_t k = 0; k < y.spheres.size(); ++k) {
                const double r = x.spheres[i].radius + y.spheres[k].radius;
                if ((centers_[a][i] - centers_[b][k]).squaredNorm() < r * r) return true;
            }
        return false;
    }

    std::vector<Obstacle> obstacles_;
    std::vector<std::vector<Vec>> centers_;
    std::vector<Vec> balls_;
};

class CoalChecker : public Checker {
  public:
    CoalChecker(const Setup& setup, bool meshes) : Checker(setup) {
        objects_.resize(setup.links.size());
        for (std::size_t k = 0; k < setup.links.size(); ++k) {
            const Link& link = setup.links[k];
            if (meshes && !link.faces.empty()) {
                auto model = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
                model->beginModel();
                std::vector<coal::Vec3s> vertices(link.vertices.begin(), link.vertices.end());
                model->addSubModel(vertices, link.faces);
                model->endModel();
                objects_[k].push_back({Vec::Zero(), std::make_unique<coal::CollisionObject>(model)});
            }
            if (!meshes)
                for (const Sphere& s : link.spheres)
                    objects_[k].push_back({s.center, std::make_unique<coal::CollisionObject>(
                                                         std::make_shared<coal::Sphere>(s.radius))});
        }
    }

    void set_scene(const std::vector<Obstacle>& obstacles) override {
        world_ = std::make_unique<coal::DynamicAABBTreeCollisionManager>();
        obstacles_.clear();
        for (const Obstacle& o : obstacles) {
            std::shared_ptr<coal::CollisionGeometry> shape;
            if (o.kind == 0) shape = std::make_shared<coal::Box>(2.0 * o.size);
            if (o.kind == 1) shape = std::make_shared<coal::Sphere>(o.size[0]);
            if (o.kind == 2) shape = std::make_shared<coal::Capsule>(o.size[0], 2.0 * o.size[1]);
            obstacles_.push_back(std::make_unique<coal::CollisionObject>(shape, o.R, o.p));
            world_->registerObject(obstacles_.back().get());
        }
        world_->setup();
    }

    bool is_free(const double* q) override {
        place(q);
        for (std::size_t k = 0; k < setup_.links.size(); ++k) {
            const Frame& f = frames_[static_cast<std::size_t>(setup_.links[k].frame)];
            for (Part& part : objects_[k]) {
                part.object->setTransform(f.R, f.p + f.R * part.center);
                part.object->computeAABB();
                coal::CollisionCallBackDefault found;
                world_->collide(part.object.get(), &found);
                if (found.data.result.isCollision()) return false;
            }
        }
        for (const auto& [a, b] : setup_.pairs)
            for (const Part& x : objects_[static_cast<std::size_t>(a)])
                for (const Part& y : objects_[static_cast<std::size_t>(b)]) {
                    if (!x.object->getAABB().overlap(y.object->getAABB())) continue;
                    coal::CollisionRequest request;
                    coal::CollisionResult result;
                    if (coal::collide(x.object.get(), y.object.get(), request, result)) return false;
                }
        return true;
    }

  private:
    struct Part {
        Vec center;
        std::unique_ptr<coal::CollisionObject> object;
    };

    std::vector<std::vector<Part>> objects_;
    std::vector<std::unique_ptr<coal::CollisionObject>> obstacles_;
    std::unique_ptr<coal::DynamicAABBTreeCollisionManager> world_;
};

double read_clock() {  // of the thread [µs]
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

void plan(const Setup& setup, const Problem& problem, Checker& checker, int rounds, double resolution,
          double seconds) {
    checker.set_scene(problem.obstacles);
    const bool valid = checker.is_free(problem.start.data()) && checker.is_free(problem.goal.data());
    std::vector<double> search, total, raw, short_, checks;
    for (int round = 0; valid && round < rounds; ++round) {
        auto space = std::make_shared<ob::RealVectorStateSpace>(setup.dof);
        ob::RealVectorBounds bounds(static_cast<unsigned>(setup.dof));
        bounds.low = setup.low, bounds.high = setup.high;
        space->setBounds(bounds);
        og::SimpleSetup simple(space);
        simple.setStateValidityChecker([&](const ob::State* state) {
            return space->satisfiesBounds(state) &&
                   checker.is_free(state->as<ob::RealVectorStateSpace::StateType>()->values);
        });
        if (resolution > 0.0)
            simple.getSpaceInformation()->setStateValidityCheckingResolution(resolution /
                                                                             space->getMaximumExtent());
        ob::ScopedState<> start(space), goal(space);
        for (int i = 0; i < setup.dof; ++i) {
            const auto k = static_cast<std::size_t>(i);
            start[static_cast<unsigned>(i)] = std::clamp(problem.start[k], setup.low[k], setup.high[k]);
            goal[static_cast<unsigned>(i)] = std::clamp(problem.goal[k], setup.low[k], setup.high[k]);
        }
        simple.setStartAndGoalStates(start, goal);
        simple.setPlanner(std::make_shared<og::RRTConnect>(simple.getSpaceInformation()));
        simple.setup();
        checker.checks = 0;
        const double begin = read_clock();
        const bool solved = simple.solve(seconds) == ob::PlannerStatus::EXACT_SOLUTION;
        const double middle = read_clock();
        if (!solved) continue;
        checks.push_back(static_cast<double>(checker.checks));
        raw.push_back(simple.getSolutionPath().length());
        const double again = read_clock();
        simple.simplifySolution();
        total.push_back(middle - begin + read_clock() - again);
        search.push_back(middle - begin);
        short_.push_back(simple.getSolutionPath().length());
    }
    std::printf("%d %d %.2f %.2f %.4f %.4f %.0f\n", valid, 2 * static_cast<int>(search.size()) > rounds,
                median(search), median(total), median(raw), median(short_), median(checks));
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** given) {
    if (count < 6)
        return std::fprintf(stderr,
                            "usage: ompl_plans FILE CHECKER ROUNDS RESOLUTION SECONDS [FIRST STEP]\n"),
               2;
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);
    const Setup setup = read_setup(given[1]);
    const std::string kind = given[2];
    std::unique_ptr<Checker> checker;
    if (kind == "spheres") checker = std::make_unique<SphereChecker>(setup);
    if (kind == "coal_spheres" || kind == "coal_meshes")
        checker = std::make_unique<CoalChecker>(setup, kind == "coal_meshes");
    if (!checker) return std::fprintf(stderr, "no checker %s\n", given[2]), 2;
    const auto first = static_cast<std::size_t>(count > 6 ? std::atoi(given[6]) : 0);
    const auto step = static_cast<std::size_t>(count > 7 ? std::atoi(given[7]) : 1);
    for (std::size_t k = first; k < setup.problems.size(); k += step)
        plan(setup, setup.problems[k], *checker, std::atoi(given[3]), std::atof(given[4]),
             std::atof(given[5]));
}
