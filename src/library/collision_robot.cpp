#include "collision_robot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "cspace/shapes/convex.hpp"
#include "cspace/shapes/smallest_ball.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::collision {

namespace {

constexpr int lanes = 8;
constexpr std::size_t most_spheres_in_group = 16, spheres_of_group = 8;

int padded(int n) { return (n + lanes - 1) / lanes * lanes; }
float rounded(double x) { return float(x); }

Ball ball_around(std::span<const Ball> spheres) {
    std::vector<shapes::Ball> given;
    for (const Ball& s : spheres) given.push_back({{s.x, s.y, s.z}, s.r});
    const shapes::Ball ball = shapes::smallest_ball(given);
    Ball result = {rounded(ball.center.x), rounded(ball.center.y), rounded(ball.center.z), 0};
    double r = 0;
    for (const Ball& s : spheres)
        r = std::max(
            r, std::hypot(double(s.x) - result.x, double(s.y) - result.y, double(s.z) - result.z) + s.r);
    result.r = rounded(r * (1 + tolerance::float_rounding));
    return result;
}

Joint rounded_joint(const model::Joint& given) {
    Joint joint = {};
    joint.parent = given.parent + 1;
    joint.coordinate = given.coordinate;
    joint.ratio = rounded(given.ratio), joint.offset = rounded(given.offset);
    joint.is_prismatic = given.prismatic;
    joint.is_plain = given.ratio == 1 && given.offset == 0;
    const auto snapped = [](double x) {
        const double whole = std::round(x);
        return std::fabs(x - whole) < tolerance::float_rounding / 10 ? whole : x;
    };
    joint.is_permuted = true;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
            const double entry = snapped(given.T_parent_joint.R.m[r][c]);
            joint.R[3 * r + c] = rounded(entry);
            if (std::fabs(entry) == 1) joint.row[c] = r, joint.sign[c] = rounded(entry);
            if (entry != 0 && std::fabs(entry) != 1) joint.is_permuted = false;
        }
    const Vec3d& p = given.T_parent_joint.t;
    const double parts[] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; ++k)
        joint.p[k] = std::fabs(parts[k]) < tolerance::float_rounding / 10 ? 0.0f : rounded(parts[k]);
    return joint;
}

// A sphere of the view, and the solid that it covers.
struct OwnedBall {
    Ball ball;
    int solid;
};

// Orders spheres so that those near each other come together: halves along the longest side, again and again.
void cluster(std::span<OwnedBall> spheres, std::vector<std::size_t>& sizes) {
    if (spheres.size() <= spheres_of_group) return sizes.push_back(spheres.size());
    float low[3] = {1e30f, 1e30f, 1e30f}, high[3] = {-1e30f, -1e30f, -1e30f};
    const auto part = [](const Ball& b, int k) { return k == 0 ? b.x : k == 1 ? b.y : b.z; };
    for (const OwnedBall& s : spheres)
        for (int k = 0; k < 3; ++k)
            low[k] = std::min(low[k], part(s.ball, k)), high[k] = std::max(high[k], part(s.ball, k));
    int longest = 0;
    for (int k = 1; k < 3; ++k)
        if (high[k] - low[k] > high[longest] - low[longest]) longest = k;
    const auto middle = spheres.size() / 2;
    std::nth_element(spheres.begin(), spheres.begin() + std::ptrdiff_t(middle), spheres.end(),
                     [&](const OwnedBall& a, const OwnedBall& b) {
                         return part(a.ball, longest) < part(b.ball, longest);
                     });
    cluster(spheres.first(middle), sizes);
    cluster(spheres.subspan(middle), sizes);
}

// Of a ball that a solid holds, around the centre of one that covers it.
float inner_radius(const shapes::Convex& solid, const Ball& ball) {
    const Vec3d center = {ball.x, ball.y, ball.z};
    const double depth = shapes::find_depth(solid, center);
    const double rounding = (double(ball.r) + norm(center)) * tolerance::float_rounding;
    return depth > rounding ? std::min(ball.r, rounded(depth - rounding)) : -1.0f;
}

// How far the slide of a prismatic joint can take what it carries.
double travel_of(const model::Joint& joint, std::span<const double> lower, std::span<const double> upper) {
    if (!joint.prismatic) return 0.0;
    const auto at = [&](std::span<const double> q) {
        return std::fabs(joint.ratio * q[std::size_t(joint.coordinate)] + joint.offset);
    };
    return std::max(at(lower), at(upper));
}

}  // namespace

shapes::Convex read_solid(const double* row) {
    const double* r = row + 4;
    const Posed pose = {{{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, {r[6], r[7], r[8]}}}, {r[9], r[10], r[11]}};
    if (row[0] == 0) return shapes::make_box(pose, {row[1], row[2], row[3]});
    if (row[0] == 1) return shapes::make_cylinder(pose, row[1], row[3]);
    const Vec3d ends[] = {pose * Vec3d{0, 0, -row[3]}, pose * Vec3d{0, 0, row[3]}};
    return shapes::make_points(ends, 2, row[1]);
}

RobotData::RobotData(std::span<const model::Joint> joints, int n_coordinates, std::span<const double> lower,
                     std::span<const double> upper, std::span<const int> link_bodies,
                     std::span<const Sphere> spheres, std::span<const std::pair<int, int>> pairs,
                     std::span<const shapes::Convex> solids)
    : given_joints_(joints.begin(), joints.end()),
      given_spheres_(spheres.begin(), spheres.end()),
      given_pairs_(pairs.begin(), pairs.end()),
      given_solids_(solids.begin(), solids.end()) {
    view_.n_coordinates = n_coordinates;
    check_order(joints, link_bodies, spheres, pairs);
    constexpr double largest = 1e12;  // of an angle
    range_.assign(std::size_t(n_coordinates), {-largest, largest});
    double reach = 0;
    for (const model::Joint& joint : joints) {
        joints_.push_back(rounded_joint(joint));
        const std::size_t k = std::size_t(joint.coordinate);
        if (joint.prismatic) range_[k] = {lower[k], upper[k]};
        const Vec3d& p = joint.T_parent_joint.t;
        reach += std::hypot(p.x, p.y, p.z) + travel_of(joint, lower, upper);
    }
    slack_ = rounded(tolerance::collision_slack * std::max(1.0, reach));
    bodies_.assign(joints.size() + 1, {0, 0, {0, 0, 0, 0}});
    add_links(link_bodies, spheres);
    view_.n_joints = int(joints_.size()), view_.n_bodies = int(bodies_.size()),
    view_.n_coordinates = n_coordinates;
    view_.body_stride = padded(view_.n_bodies);
    add_solids();
    add_pairs(pairs);
    view_.pair_stride = padded(int(pairs_.size()));
    bound_levers(joints, lower, upper);
    add_columns();
    view_.joints = joints_.data(), view_.bodies = bodies_.data(), view_.links = links_.data();
    view_.groups = groups_.data(), view_.spheres = spheres_.data();
    view_.pairs = pairs_.data(), view_.link_pairs = link_pairs_.data();
    view_.levers = levers_.data(), view_.pair_levers = pair_levers_.data();
    view_.n_links = int(links_.size()), view_.n_groups = int(groups_.size());
    view_.n_spheres = int(spheres_.size()), view_.n_pairs = int(pairs_.size());
    view_.n_link_pairs = int(link_pairs_.size());
}

void RobotData::check_order(std::span<const model::Joint> joints, std::span<const int> link_bodies,
                            std::span<const Sphere> spheres,
                            std::span<const std::pair<int, int>> pairs) const {
    const auto require = [](bool holds, const char* rule) {
        if (!holds) throw std::invalid_argument(rule);
    };
    const auto is_below = [](int number, std::size_t count) {
        return number >= 0 && std::size_t(number) < count;
    };
    require(view_.n_coordinates <= most_coordinates, "a robot must have at most 64 coordinates");
    for (std::size_t k = 0; k < joints.size(); ++k)
        require(joints[k].parent >= -1 && joints[k].parent < int(k) &&
                    is_below(joints[k].coordinate, std::size_t(view_.n_coordinates)),
                "joints must follow their parents, and have coordinates of the robot");
    for (std::size_t l = 0; l < link_bodies.size(); ++l)
        require(
            is_below(link_bodies[l], joints.size() + 1) && (l == 0 || link_bodies[l - 1] <= link_bodies[l]),
            "the bodies of links must ascend");
    for (std::size_t s = 0; s < spheres.size(); ++s)
        require(is_below(spheres[s].link, link_bodies.size()) &&
                    (s == 0 || spheres[s - 1].link <= spheres[s].link),
                "spheres must come in the order of their links");
    for (const Sphere& sphere : spheres)
        require(sphere.solid == -1 || is_below(sphere.solid, given_solids_.size()),
                "the solids of spheres must be numbers of solids, or -1");
    for (const auto& [a, b] : pairs)
        require(is_below(a, link_bodies.size()) && is_below(b, link_bodies.size()) &&
                    link_bodies[std::size_t(a)] != link_bodies[std::size_t(b)],
                "pairs must be links of two bodies");
}

shapes::Convex RobotData::solid_of(int sphere) const {
    const int solid = sphere_solids_.empty() ? -1 : sphere_solids_[std::size_t(sphere)];
    if (solid >= 0) return given_solids_[std::size_t(solid)];
    const Ball& ball = spheres_[std::size_t(sphere)];
    return shapes::make_ball({ball.x, ball.y, ball.z}, ball.r);
}

void RobotData::add_solids() {
    if (std::all_of(sphere_solids_.begin(), sphere_solids_.end(), [](int solid) { return solid < 0; }))
        sphere_solids_.clear();
    for (const shapes::Convex& solid : given_solids_) {
        const Vec3d center = shapes::find_center(solid);
        const double reach = norm(center) + shapes::bound_size(solid);
        solid_balls_.push_back({rounded(center.x), rounded(center.y), rounded(center.z),
                                rounded(shapes::bound_size(solid) + reach * tolerance::float_rounding)});
    }
    for (std::size_t s = 0; s < spheres_.size(); ++s) {
        const Ball& ball = spheres_[s];
        const int solid = sphere_solids_.empty() ? -1 : sphere_solids_[s];
        inner_radii_.push_back(solid < 0 ? ball.r : inner_radius(given_solids_[std::size_t(solid)], ball));
    }
    inner_radii_.resize(spheres_.size() + lanes, -1.0f);
    view_.inner_radii = inner_radii_.data();
    view_.sphere_solids = sphere_solids_.empty() ? nullptr : sphere_solids_.data();
    view_.solid_balls = solid_balls_.data();
}

void RobotData::add_links(std::span<const int> link_bodies, std::span<const Sphere> spheres) {
    std::size_t next = 0;
    for (std::size_t l = 0; l < link_bodies.size(); ++l) {
        Link link = {link_bodies[l], int(groups_.size()), 0, {0, 0, 0, 0}};
        const std::size_t first = spheres_.size();
        std::vector<OwnedBall> own;
        for (; next < spheres.size() && spheres[next].link == int(l); ++next) {
            const Sphere& s = spheres[next];
            own.push_back({{rounded(s.center.x), rounded(s.center.y), rounded(s.center.z), rounded(s.radius)},
                           s.solid});
        }
        std::vector<std::size_t> sizes;
        if (own.size() > most_spheres_in_group)
            cluster(own, sizes);
        else if (!own.empty())
            sizes.push_back(own.size());
        for (const OwnedBall& each : own) spheres_.push_back(each.ball), sphere_solids_.push_back(each.solid);
        std::size_t at = first;
        for (const std::size_t size : sizes) {
            groups_.push_back({int(at), int(size), ball_around(std::span(spheres_).subspan(at, size))});
            at += size;
        }
        link.count = int(sizes.size());
        if (!own.empty())
            link.ball =
                link.count == 1 ? groups_.back().ball : ball_around(std::span(spheres_).subspan(first));
        Body& body = bodies_[std::size_t(link.body)];
        if (body.count == 0) body.first = int(l);
        ++body.count;
        links_.push_back(link);
    }
    for (Body& body : bodies_) {
        std::vector<Ball> all;
        for (int l = body.first; l < body.first + body.count; ++l) {
            const Link& link = links_[std::size_t(l)];
            for (int g = link.first; g < link.first + link.count; ++g) {
                const Group& group = groups_[std::size_t(g)];
                all.insert(all.end(), spheres_.begin() + group.first,
                           spheres_.begin() + group.first + group.count);
            }
        }
        if (body.count == 1)
            body.ball = links_[std::size_t(body.first)].ball;
        else if (body.count)
            body.ball = ball_around(all);
    }
}

void RobotData::add_pairs(std::span<const std::pair<int, int>> pairs) {
    std::map<std::pair<int, int>, std::vector<LinkPair>> by_bodies;
    for (auto [a, b] : pairs) {
        if (links_[std::size_t(a)].body > links_[std::size_t(b)].body) std::swap(a, b);
        by_bodies[{links_[std::size_t(a)].body, links_[std::size_t(b)].body}].push_back({a, b});
    }
    for (const auto& [bodies, links] : by_bodies) {
        pairs_.push_back({bodies.first, bodies.second, int(link_pairs_.size()), int(links.size())});
        link_pairs_.insert(link_pairs_.end(), links.begin(), links.end());
    }
}

void RobotData::Columns::assign(std::span<const Ball> balls, int padded_size) {
    for (std::vector<float>* column : {&x, &y, &z, &r}) column->assign(std::size_t(padded_size), 0.0f);
    for (std::size_t i = 0; i < balls.size(); ++i)
        x[i] = balls[i].x, y[i] = balls[i].y, z[i] = balls[i].z, r[i] = balls[i].r;
}

void RobotData::add_columns() {
    constexpr float no_radius = -3e38f;
    const std::size_t stride = std::size_t(view_.body_stride);
    std::vector<Ball> balls(stride, {0, 0, 0, no_radius});
    for (const Link& link : links_)
        for (int g = link.first; g < link.first + link.count; ++g)
            sphere_links_.insert(sphere_links_.end(), std::size_t(groups_[std::size_t(g)].count),
                                 int(&link - links_.data()));
    std::size_t next = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const std::size_t first = next;
        while (next < spheres_.size() && links_[std::size_t(sphere_links_[next])].body == int(b)) ++next;
        if (next > first) balls[b] = bodies_[b].ball;
        body_chunks_.push_back({int(chunks_.size()), padded(int(next - first)) / lanes});
        for (std::size_t s = first; s < next; s += lanes)
            chunks_.push_back({int(s), int(std::min<std::size_t>(lanes, next - s))});
    }
    body_columns_.assign(balls, int(stride));
    sphere_columns_.assign(spheres_, int(spheres_.size()) + lanes);
    pair_numbers_.assign(bodies_.size() * stride, -1);
    pair_lanes_.assign(bodies_.size() * stride / lanes, 0);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        const std::size_t at = std::size_t(pairs_[p].a) * stride + std::size_t(pairs_[p].b);
        pair_numbers_[at] = int(p);
        pair_lanes_[at / lanes] |= static_cast<unsigned char>(1u << at % lanes);
    }
    view_.body_balls = body_columns_.view(), view_.sphere_columns = sphere_columns_.view();
    view_.chunks = chunks_.data(), view_.body_chunks = body_chunks_.data();
    view_.sphere_links = sphere_links_.data(), view_.n_chunks = int(chunks_.size());
    view_.pair_numbers = pair_numbers_.data(), view_.pair_lanes = pair_lanes_.data();
}

void RobotData::bound_levers(std::span<const model::Joint> joints, std::span<const double> lower,
                             std::span<const double> upper) {
    constexpr double least = 1e-6;  // a joint on whose axis a body lies moves it nevertheless
    constexpr double round_up = 1 + 1e-6;
    const auto radial = [](const Vec3d& p) { return std::hypot(p.x, p.y); };
    const auto travel = [&](const model::Joint& joint) { return travel_of(joint, lower, upper); };
    // Distances of the sphere centres of body b from its own axis and its origin; of covers, of all places.
    const auto extent = [&](int b, bool from_axis) {
        double farthest = 0;
        const Body& body = bodies_[std::size_t(b)];
        for (int l = body.first; l < body.first + body.count; ++l) {
            const Link& link = links_[std::size_t(l)];
            for (int g = link.first; g < link.first + link.count; ++g) {
                const Group& group = groups_[std::size_t(g)];
                for (int s = group.first; s < group.first + group.count; ++s) {
                    const Ball& ball = spheres_[std::size_t(s)];
                    const Vec3d c = {ball.x, ball.y, ball.z};
                    const bool is_cover = !sphere_solids_.empty() && sphere_solids_[std::size_t(s)] >= 0;
                    farthest = std::max(farthest, (from_axis ? radial(c) : std::hypot(c.x, c.y, c.z)) +
                                                      (is_cover ? double(ball.r) : 0.0));
                }
            }
        }
        return farthest;
    };
    const auto body_path = [&](int b) {  // from body b to the base
        std::vector<int> path;
        for (; b > 0; b = joints[std::size_t(b - 1)].parent + 1) path.push_back(b);
        return path;
    };
    const std::size_t bodies = std::size_t(view_.body_stride);
    levers_.assign(joints.size() * bodies, 0.0f);
    for (int b = 1; b < view_.n_bodies; ++b) {
        if (bodies_[std::size_t(b)].count == 0) continue;
        double beyond = extent(b, false), own = extent(b, true);
        for (const int k : body_path(b)) {
            const model::Joint& joint = joints[std::size_t(k - 1)];
            const double lever = joint.prismatic ? 1.0 : std::max(own, least);
            levers_[std::size_t(k - 1) * bodies + std::size_t(b)] = rounded(lever * round_up);
            const Vec3d& p = joint.T_parent_joint.t;
            beyond += travel(joint);
            own = radial(p) + beyond;
            beyond += std::hypot(p.x, p.y, p.z);
        }
    }
    const std::size_t stride = std::size_t(view_.pair_stride);
    pair_levers_.assign(joints.size() * stride, 0.0f);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        const std::vector<int> from = body_path(pairs_[p].a), to = body_path(pairs_[p].b);
        const auto is_on = [](const std::vector<int>& path, int b) {
            return std::find(path.begin(), path.end(), b) != path.end();
        };
        double longest = extent(pairs_[p].b, false);
        for (const int k : to)
            if (!is_on(from, k)) {
                const float lever = levers_[std::size_t(k - 1) * bodies + std::size_t(pairs_[p].b)];
                pair_levers_[std::size_t(k - 1) * stride + p] = lever;
                const Vec3d& at = joints[std::size_t(k - 1)].T_parent_joint.t;
                longest += std::hypot(at.x, at.y, at.z) + travel(joints[std::size_t(k - 1)]);
            }
        // Joints that carry body a alone: the whole way from b bounds the distance from each of their axes.
        for (const int k : from)
            if (!is_on(to, k)) {
                const Vec3d& at = joints[std::size_t(k - 1)].T_parent_joint.t;
                longest += std::hypot(at.x, at.y, at.z) + travel(joints[std::size_t(k - 1)]);
            }
        for (const int k : from)
            if (!is_on(to, k))
                pair_levers_[std::size_t(k - 1) * stride + p] =
                    rounded((joints[std::size_t(k - 1)].prismatic ? 1.0 : longest) * round_up);
    }
}

}  // namespace cspace::collision
