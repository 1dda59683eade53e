// A judge of motions of arms, compiled for speed: double precision, its own kinematics, nothing of the
// package.
//
// planning_judge.py compiles this file into a shared library and calls it with plain arrays. Bodies are
// capsules (spheres have length 0), obstacles are boxes, spheres, capsules and cylinders. A motion is looked
// at in intervals: the clearance of the middle is compared with a bound on how far the bodies move within the
// interval (levers of joints times their travel; Schwarzer, Saha & Latombe 2005). Of the tests that the bound
// does not settle, both halves of the interval are looked at, down to intervals of a given length.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace {

using Vec = std::array<double, 3>;
using Mat = std::array<double, 9>;  // by rows

constexpr int search_steps = 64;  // of a golden section: 0.618^64 of a segment is less than 1e-13 of it
constexpr double golden = 0.6180339887498949;
constexpr double far_enough = 0.05;  // clearances above this need not be known exactly [m]

Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec operator*(double s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const Vec& a) { return std::sqrt(dot(a, a)); }

Vec turn(const Mat& R, const Vec& v) {
    return {R[0] * v[0] + R[1] * v[1] + R[2] * v[2], R[3] * v[0] + R[4] * v[1] + R[5] * v[2],
            R[6] * v[0] + R[7] * v[1] + R[8] * v[2]};
}

Vec turn_back(const Mat& R, const Vec& v) {
    return {R[0] * v[0] + R[3] * v[1] + R[6] * v[2], R[1] * v[0] + R[4] * v[1] + R[7] * v[2],
            R[2] * v[0] + R[5] * v[1] + R[8] * v[2]};
}

Mat multiply(const Mat& A, const Mat& B) {
    Mat C{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) C[3 * i + j] += A[3 * i + k] * B[3 * k + j];
    return C;
}

Mat turn_about(const Vec& n, double angle) {  // Rodrigues
    const double s = std::sin(angle), c = std::cos(angle), d = 1.0 - c;
    return {c + d * n[0] * n[0],        d * n[0] * n[1] - s * n[2], d * n[0] * n[2] + s * n[1],
            d * n[0] * n[1] + s * n[2], c + d * n[1] * n[1],        d * n[1] * n[2] - s * n[0],
            d * n[0] * n[2] - s * n[1], d * n[1] * n[2] + s * n[0], c + d * n[2] * n[2]};
}

struct Frame {
    Mat R{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Vec p{};
};

enum class Motion { fixed, revolute, prismatic };

struct Joint {
    int parent, variable;  // frame before it; number in q, or -1
    Motion motion;
    Vec xyz, axis;
    Mat R;
};

struct Body {
    int frame;
    Vec a, b;
    double radius;
};

enum class Kind { box, sphere, capsule, cylinder };

struct Obstacle {
    Kind kind;
    Vec p;
    Mat R;
    Vec size;  // half sizes; radius; radius and half length
};

struct Placed {
    Vec a, b;
};

struct Test {
    int body, other;  // another body, or an obstacle
    bool is_pair;
    double motion;  // bound for a whole motion [m]
};

// Distance of a point from a solid, 0 inside: a convex function of the point.
double distance(const Obstacle& o, const Vec& point) {
    const Vec y = turn_back(o.R, point - o.p);
    if (o.kind == Kind::box) {
        const Vec s{std::max(std::abs(y[0]) - o.size[0], 0.0), std::max(std::abs(y[1]) - o.size[1], 0.0),
                    std::max(std::abs(y[2]) - o.size[2], 0.0)};
        return norm(s);
    }
    const double z = std::max(std::abs(y[2]) - o.size[1], 0.0);
    return std::hypot(std::max(std::hypot(y[0], y[1]) - o.size[0], 0.0), z);
}

// Distance between segments p–q and r–s (Ericson 2005, section 5.1.9).
double distance(const Vec& p, const Vec& q, const Vec& r, const Vec& s) {
    const Vec u = q - p, v = s - r, w = p - r;
    const double a = dot(u, u), e = dot(v, v), f = dot(v, w), c = dot(u, w);
    double i = 0.0, j = 0.0;
    if (a > 0.0 && e > 0.0) {
        const double b = dot(u, v), det = a * e - b * b;
        i = det > 0.0 ? std::clamp((b * f - c * e) / det, 0.0, 1.0) : 0.0;
        j = (b * i + f) / e;
        if (j < 0.0 || j > 1.0) {
            j = std::clamp(j, 0.0, 1.0);
            i = std::clamp((b * j - c) / a, 0.0, 1.0);
        }
    } else if (a > 0.0) {
        i = std::clamp(-c / a, 0.0, 1.0);
    } else if (e > 0.0) {
        j = std::clamp(f / e, 0.0, 1.0);
    }
    return norm(w + i * u - j * v);
}

// Distance of a segment from an obstacle; a lower bound where that is more than `enough`.
double distance(const Obstacle& o, const Vec& a, const Vec& b, double enough) {
    if (o.kind == Kind::sphere) return distance(a, b, o.p, o.p) - o.size[0];
    if (o.kind == Kind::capsule) {
        const Vec half = turn(o.R, {0.0, 0.0, o.size[1]});
        return distance(a, b, o.p - half, o.p + half) - o.size[0];
    }
    const Vec way = b - a;
    const double length = norm(way), middle = distance(o, a + 0.5 * way);
    if (length == 0.0 || middle - 0.5 * length > enough) return middle - 0.5 * length;
    double low = 0.0, high = 1.0, s = high - golden, t = golden;
    double at_s = distance(o, a + s * way), at_t = distance(o, a + t * way);
    for (int k = 0; k < search_steps; ++k) {
        if (at_s <= at_t) {
            high = t, t = s, at_t = at_s;
            s = high - golden * (high - low), at_s = distance(o, a + s * way);
        } else {
            low = s, s = t, at_s = at_t;
            t = low + golden * (high - low), at_t = distance(o, a + t * way);
        }
    }
    return std::min({at_s, at_t, distance(o, a), distance(o, b)});
}

struct Seen {
    double least = std::numeric_limits<double>::infinity(), at = 0.0;
    long places = 0;
};

class Judge {
  public:
    std::vector<Joint> joints;
    std::vector<Body> bodies;
    std::vector<std::pair<int, int>> pairs;
    std::vector<Obstacle> obstacles;
    std::vector<std::vector<double>>
        levers;  // of a body and a joint variable; 0 where it does not move the body
    int dof = 0;

    void find_levers(const double* travel) {
        levers.assign(bodies.size(), std::vector<double>(static_cast<std::size_t>(dof), 0.0));
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            double reach = std::max(norm(bodies[k].a), norm(bodies[k].b));
            for (int frame = bodies[k].frame; frame > 0;) {
                const Joint& j = joints[static_cast<std::size_t>(frame - 1)];
                if (j.variable >= 0) {
                    levers[k][static_cast<std::size_t>(j.variable)] =
                        j.motion == Motion::prismatic ? 1.0 : reach;
                    if (j.motion == Motion::prismatic) reach += travel[j.variable];
                }
                reach += norm(j.xyz);
                frame = j.parent;
            }
        }
    }

    void place(const double* q) {
        frames_.resize(joints.size() + 1);
        frames_[0] = {};
        for (std::size_t k = 0; k < joints.size(); ++k) {
            const Joint& j = joints[k];
            const Frame& base = frames_[static_cast<std::size_t>(j.parent)];
            Frame f{multiply(base.R, j.R), base.p + turn(base.R, j.xyz)};
            if (j.variable >= 0 && j.motion == Motion::revolute)
                f.R = multiply(f.R, turn_about(j.axis, q[j.variable]));
            if (j.variable >= 0 && j.motion == Motion::prismatic)
                f.p = f.p + q[j.variable] * turn(f.R, j.axis);
            frames_[k + 1] = f;
        }
        placed_.resize(bodies.size());
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            const Frame& f = frames_[static_cast<std::size_t>(bodies[k].frame)];
            placed_[k] = {f.p + turn(f.R, bodies[k].a), f.p + turn(f.R, bodies[k].b)};
        }
    }

    double measure(const Test& test, double enough) const {
        const auto k = static_cast<std::size_t>(test.body), other = static_cast<std::size_t>(test.other);
        const Placed& x = placed_[k];
        const double r = bodies[k].radius;
        if (!test.is_pair) return distance(obstacles[other], x.a, x.b, enough + r) - r;
        return distance(x.a, x.b, placed_[other].a, placed_[other].b) - r - bodies[other].radius;
    }

    std::vector<Test> list_tests(const double* step) const {
        std::vector<Test> tests;
        const auto n = static_cast<std::size_t>(dof);
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            double motion = 0.0;
            for (std::size_t i = 0; i < n; ++i) motion += levers[k][i] * std::abs(step[i]);
            for (std::size_t o = 0; o < obstacles.size(); ++o)
                tests.push_back({static_cast<int>(k), static_cast<int>(o), false, motion});
        }
        for (const auto& [a, b] : pairs) {
            double motion = 0.0;
            for (std::size_t i = 0; i < n;
                 ++i) {  // a joint that moves both does not move one against the other
                const double x = levers[static_cast<std::size_t>(a)][i],
                             y = levers[static_cast<std::size_t>(b)][i];
                motion += (x > 0.0 && y > 0.0 ? 0.0 : x + y) * std::abs(step[i]);
            }
            tests.push_back({a, b, true, motion});
        }
        return tests;
    }

    Seen look(const double* a, const double* b, double fine) {
        std::vector<double> step(static_cast<std::size_t>(dof));
        double length = 0.0;
        for (std::size_t i = 0; i < step.size(); ++i) step[i] = b[i] - a[i], length += step[i] * step[i];
        Seen seen;
        halve(a, step, std::sqrt(length), fine, 0.5, 0.5, list_tests(step.data()), seen);
        return seen;
    }

    double clearance(const double* q) {
        const std::vector<double> still(static_cast<std::size_t>(dof), 0.0);
        place(q);
        double least = std::numeric_limits<double>::infinity();
        for (const Test& test : list_tests(still.data()))
            least = std::min(least, measure(test, std::numeric_limits<double>::infinity()));
        return least;
    }

  private:
    void halve(const double* a, const std::vector<double>& step, double length, double fine, double middle,
               double half, const std::vector<Test>& tests, Seen& seen) {
        std::vector<double> q(a, a + dof);
        for (std::size_t i = 0; i < q.size(); ++i) q[i] += middle * step[i];
        place(q.data());
        ++seen.places;
        std::vector<Test> open;
        for (const Test& test : tests) {
            const double gap = measure(test, test.motion * half + far_enough);
            if (gap < seen.least) seen.least = gap, seen.at = middle;
            if (gap <= test.motion * half) open.push_back(test);
        }
        if (open.empty() || 2.0 * half * length <= fine) return;
        halve(a, step, length, fine, middle - 0.5 * half, 0.5 * half, open, seen);
        halve(a, step, length, fine, middle + 0.5 * half, 0.5 * half, open, seen);
    }

    std::vector<Frame> frames_;
    std::vector<Placed> placed_;
};

Vec read_vector(const double*& from) {
    const Vec v{from[0], from[1], from[2]};
    from += 3;
    return v;
}

Mat read_matrix(const double*& from) {
    Mat m{};
    std::copy(from, from + 9, m.begin());
    from += 9;
    return m;
}

}  // namespace

extern "C" {

// joints: rows parent, motion, variable; frames: rows xyz, R, axis. bodies: rows a, b, radius.
void* judge_make(int dof, const double* travel, int joints, const int* joint_rows, const double* frames,
                 int bodies, const int* body_frames, const double* body_rows, int pairs,
                 const int* pair_rows) {
    auto* judge = new Judge;
    judge->dof = dof;
    for (int k = 0; k < joints; ++k) {
        const int* row = joint_rows + 3 * k;
        const Vec xyz = read_vector(frames);
        const Mat R = read_matrix(frames);
        const Vec axis = read_vector(frames);
        judge->joints.push_back({row[0], row[2], static_cast<Motion>(row[1]), xyz, axis, R});
    }
    for (int k = 0; k < bodies; ++k) {
        const Vec a = read_vector(body_rows), b = read_vector(body_rows);
        judge->bodies.push_back({body_frames[k], a, b, *body_rows++});
    }
    for (int k = 0; k < pairs; ++k) judge->pairs.emplace_back(pair_rows[2 * k], pair_rows[2 * k + 1]);
    judge->find_levers(travel);
    return judge;
}

void judge_free(void* judge) { delete static_cast<Judge*>(judge); }

// rows: position, rotation, size.
void judge_scene(void* judge, int count, const int* kinds, const double* rows) {
    auto& obstacles = static_cast<Judge*>(judge)->obstacles;
    obstacles.clear();
    for (int k = 0; k < count; ++k) {
        const Vec p = read_vector(rows);
        const Mat R = read_matrix(rows);
        obstacles.push_back({static_cast<Kind>(kinds[k]), p, R, read_vector(rows)});
    }
}

// The least distance [m] of each configuration (n, dof) from a contact; inside of solids it is that of the
// surface of the body only.
void judge_clearance(void* judge, long n, const double* q, double* out) {
    auto& j = *static_cast<Judge*>(judge);
    for (long k = 0; k < n; ++k) out[k] = j.clearance(q + k * j.dof);
}

// Of motions from a to b (n, dof) the least clearance that was seen and where; returns the places looked at.
long judge_motions(void* judge, long n, const double* a, const double* b, double fine, double* least,
                   double* at) {
    auto& j = *static_cast<Judge*>(judge);
    long places = 0;
    for (long k = 0; k < n; ++k) {
        const Seen seen = j.look(a + k * j.dof, b + k * j.dof, fine);
        least[k] = seen.least, at[k] = seen.at, places += seen.places;
    }
    return places;
}
}
