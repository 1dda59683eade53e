// The signed distance of two convex solids.
//
// The differences a − b of places of two convex cores fill a convex body. Outside each other, its place
// nearest to the origin gives the distance (Gilbert, Johnson & Keerthi 1988, "A fast procedure for computing
// the distance between complex objects in three-dimensional space"). Inside, the face nearest to the origin
// of a polyhedron that grows within it gives the depth (van den Bergen 2001, "Proximity queries and
// penetration depth computation on 3D game objects").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/math/isa.hpp"
#include "cspace/shapes/convex.hpp"

namespace cspace::shapes {

inline ConvexDistance nothing_near(const Vec3d& center) {
    return {std::numeric_limits<double>::infinity(), {0, 0, 1}, center, center};
}

namespace detail {

// A place of the body of differences, and that of the first core which it comes from.
struct Difference {
    Vec3d at, first;
};

class ConvexPair {
  public:
    ConvexPair(const Convex& a, const Convex& b) : a_(a), b_(b), scale_(bound_size(a) + bound_size(b)) {}

    Difference find_farthest(const Vec3d& direction) const {
        const Vec3d first = shapes::find_farthest(a_, direction);
        return {first - shapes::find_farthest(b_, -direction), first};
    }
    Vec3d first_direction() const {
        const Vec3d apart = find_center(a_) - find_center(b_);
        return dot(apart, apart) > 0 ? -apart : Vec3d{1, 0, 0};
    }
    // What rounding may make of a distance.
    double rounding() const { return rounding_share * scale_; }
    double scale() const { return scale_; }

  private:
    // Of the size of both solids: some thousand times what doubles round.
    static constexpr double rounding_share = 1e-12;

    const Convex &a_, &b_;
    double scale_;
};

// One to four differences, and the place of their hull that is nearest to the origin.
class Simplex {
  public:
    int size() const { return size_; }
    const Difference& operator[](int i) const { return vertices_[std::size_t(i)]; }
    const Vec3d& nearest() const { return nearest_; }
    bool holds_origin() const { return size_ == 4; }
    Vec3d first() const {
        Vec3d sum = {0, 0, 0};
        for (int i = 0; i < size_; ++i)
            sum = sum + weights_[std::size_t(i)] * vertices_[std::size_t(i)].first;
        return sum;
    }
    bool has(const Difference& d) const {
        for (int i = 0; i < size_; ++i) {
            const Vec3d apart = vertices_[std::size_t(i)].at - d.at;
            if (dot(apart, apart) == 0) return true;
        }
        return false;
    }
    // Adds a vertex and keeps those of the face that is nearest to the origin; all four if it is inside.
    void add(const Difference& d) {
        vertices_[std::size_t(size_++)] = d;
        if (size_ == 4 && is_around_origin()) {
            nearest_ = {0, 0, 0};
            return;
        }
        Candidate best;  // the nearest place is on a face with the new vertex
        for (unsigned face = 1u << (size_ - 1); face < 1u << size_; ++face) try_face(face, best);
        keep(best);
    }

  private:
    std::array<Difference, 4> vertices_;
    std::array<double, 4> weights_ = {1, 0, 0, 0};
    Vec3d nearest_ = {0, 0, 0};
    int size_ = 0;

    struct Candidate {
        double square = std::numeric_limits<double>::infinity();
        int count = 0;
        std::array<int, 3> corner = {};
        std::array<double, 3> weight = {};
        Vec3d at = {};
    };

    const Vec3d& at(int i) const { return vertices_[std::size_t(i)].at; }
    static double triple(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return dot(a, cross(b, c)); }

    // The origin lies on the inner side of all four faces.
    bool is_around_origin() const {
        const double whole = triple(at(1) - at(0), at(2) - at(0), at(3) - at(0));
        if (whole == 0) return false;
        const auto is_inside = [&](int i, int j, int k) {
            // The sign of the volume that the origin makes with a face, seen from the fourth vertex.
            return triple(at(i), at(j), at(k)) * whole >= 0;
        };
        return is_inside(1, 2, 3) && is_inside(0, 3, 2) && is_inside(0, 1, 3) && is_inside(0, 2, 1);
    }
    void try_face(unsigned face, Candidate& best) const {
        Candidate tried;
        for (int i = 0; i < size_; ++i) {
            if (!(face >> i & 1)) continue;
            if (tried.count == 3) return;
            tried.corner[std::size_t(tried.count++)] = i;
        }
        if (!find_weights(tried)) return;
        tried.at = {0, 0, 0};
        for (int i = 0; i < tried.count; ++i)
            tried.at = tried.at + tried.weight[std::size_t(i)] * at(tried.corner[std::size_t(i)]);
        tried.square = dot(tried.at, tried.at);
        if (tried.square < best.square) best = tried;
    }
    // Of the foot of the origin on a vertex, an edge or a triangle; false where it lies outside.
    bool find_weights(Candidate& face) const {
        const Vec3d& a = at(face.corner[0]);
        if (face.count == 1) return face.weight[0] = 1, true;
        const Vec3d& b = at(face.corner[1]);
        const Vec3d ab = b - a;
        if (face.count == 2) {
            const double square = dot(ab, ab);
            if (!(square > 0)) return false;
            const double t = -dot(a, ab) / square;
            face.weight = {1 - t, t, 0};
            return t >= 0 && t <= 1;
        }
        const Vec3d& c = at(face.corner[2]);
        const Vec3d normal = cross(ab, c - a);
        const double square = dot(normal, normal);
        if (!(square > 0)) return false;
        face.weight[0] = dot(cross(b, c), normal) / square;
        face.weight[1] = dot(cross(c, a), normal) / square;
        face.weight[2] = 1 - face.weight[0] - face.weight[1];
        return face.weight[0] >= 0 && face.weight[1] >= 0 && face.weight[2] >= 0;
    }
    void keep(const Candidate& best) {
        std::array<Difference, 3> kept;
        for (int i = 0; i < best.count; ++i)
            kept[std::size_t(i)] = vertices_[std::size_t(best.corner[std::size_t(i)])];
        for (int i = 0; i < best.count; ++i) {
            vertices_[std::size_t(i)] = kept[std::size_t(i)];
            weights_[std::size_t(i)] = best.weight[std::size_t(i)];
        }
        size_ = best.count;
        nearest_ = best.at;
    }
};

// The simplex whose nearest place is that of all differences, or which holds the origin. The search ends as
// soon as the distance is known to be within `least`, or beyond `most`.
CSPACE_ONCE Simplex find_nearest_simplex(const ConvexPair& pair, double least = 0,
                                         double most = std::numeric_limits<double>::infinity()) {
    constexpr int most_steps = 128;
    Simplex simplex;
    simplex.add(pair.find_farthest(pair.first_direction()));
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_steps && !simplex.holds_origin(); ++i) {
        const Vec3d& nearest = simplex.nearest();
        const double length = norm(nearest);
        // No longer nearer: what is left is rounding.
        if (length <= std::fmax(pair.rounding(), least) || length >= last) break;
        last = length;
        const Difference next = pair.find_farthest(-nearest);
        const double bound = dot(next.at, nearest) / length;  // the distance is no less
        if (length - bound <= pair.rounding() || bound > most || simplex.has(next)) break;
        simplex.add(next);
    }
    return simplex;
}

// A polyhedron around the origin, within the body of differences.
class Polyhedron {
  public:
    explicit Polyhedron(const ConvexPair& pair) : pair_(pair) {}

    // Grows to four vertices with a volume; false where the differences are flat.
    bool begin(const Simplex& simplex) {
        for (int i = 0; i < simplex.size(); ++i) vertices_.push_back(simplex[i]);
        const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        if (vertices_.size() == 1 && !extend(axes, 3)) return false;
        if (vertices_.size() == 2) {
            const Vec3d along = vertices_[1].at - vertices_[0].at;
            const Vec3d side = any_perpendicular((1 / norm(along)) * along);
            const Vec3d sides[] = {side, cross(along, side)};
            if (!extend(sides, 2)) return false;
        }
        if (vertices_.size() == 3) {
            const Vec3d normal = cross(vertices_[1].at - vertices_[0].at, vertices_[2].at - vertices_[0].at);
            if (!extend(&normal, 1)) return false;
        }
        constexpr int corners[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
        const bool is_turned =
            dot(cross(vertices_[1].at - vertices_[0].at, vertices_[2].at - vertices_[0].at),
                vertices_[3].at - vertices_[0].at) > 0;
        for (const auto& c : corners)
            if (!(is_turned ? add_face(c[0], c[2], c[1]) : add_face(c[0], c[1], c[2]))) return false;
        return true;
    }
    // The face that is nearest to the origin, once the body reaches no farther along its normal.
    ConvexDistance find_depth() {
        constexpr int most_steps = 256;
        constexpr double settled_depth = 1e-10;  // of the size of both solids
        Face best = nearest_face();
        for (int i = 0; i < most_steps; ++i) {
            const Difference next = pair_.find_farthest(best.normal);
            if (dot(next.at, best.normal) - best.distance <= settled_depth * pair_.scale()) break;
            if (!insert(next)) break;
            best = nearest_face();
        }
        return describe(best);
    }

  private:
    struct Face {
        std::array<int, 3> corner;
        Vec3d normal;  // unit, outwards
        double distance;
    };
    const ConvexPair& pair_;
    std::vector<Difference> vertices_;
    std::vector<Face> faces_;

    const Vec3d& at(int i) const { return vertices_[std::size_t(i)].at; }

    // Adds the farthest vertex in one of some directions or against it, if it leaves what there is.
    bool extend(const Vec3d* directions, int count) {
        for (int i = 0; i < count; ++i) {
            const double length = norm(directions[i]);
            if (!(length > 0)) continue;
            const Vec3d unit = (1 / length) * directions[i];
            for (const double sign : {1.0, -1.0}) {
                const Difference found = pair_.find_farthest(sign * unit);
                if (sign * dot(found.at - vertices_[0].at, unit) <= pair_.rounding()) continue;
                vertices_.push_back(found);
                return true;
            }
        }
        return false;
    }
    bool add_face(int a, int b, int c) {
        const Vec3d normal = cross(at(b) - at(a), at(c) - at(a));
        const double length = norm(normal);
        if (!(length > 0)) return false;
        const Vec3d unit = (1 / length) * normal;
        faces_.push_back({{a, b, c}, unit, std::fmax(dot(unit, at(a)), 0.0)});
        return true;
    }
    Face nearest_face() const {
        return *std::min_element(faces_.begin(), faces_.end(),
                                 [](const Face& x, const Face& y) { return x.distance < y.distance; });
    }
    // Faces that see the vertex give way to faces between it and the edges around them. False where rounding
    // lets these edges make no loop.
    bool insert(const Difference& next) {
        std::vector<std::array<int, 2>> rim;
        std::vector<Face> kept;
        for (const Face& face : faces_) {
            if (dot(face.normal, next.at - at(face.corner[0])) <= pair_.rounding()) {
                kept.push_back(face);
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) toggle_edge(rim, face.corner[k], face.corner[(k + 1) % 3]);
        }
        if (rim.empty() || !is_loop(rim)) return false;
        const std::vector<Face> before = std::exchange(faces_, std::move(kept));
        const int number = int(vertices_.size());
        vertices_.push_back(next);
        for (const auto& [a, b] : rim)
            if (!add_face(a, b, number)) return faces_ = before, false;
        return true;
    }
    static void toggle_edge(std::vector<std::array<int, 2>>& rim, int a, int b) {
        const auto other = std::find(rim.begin(), rim.end(), std::array<int, 2>{b, a});
        if (other != rim.end())
            rim.erase(other);
        else
            rim.push_back({a, b});
    }
    static bool is_loop(const std::vector<std::array<int, 2>>& rim) {
        int at = rim[0][1];
        for (std::size_t seen = 1; seen < rim.size(); ++seen) {
            if (at == rim[0][0]) return false;
            const auto next =
                std::find_if(rim.begin(), rim.end(), [&](const auto& edge) { return edge[0] == at; });
            if (next == rim.end()) return false;
            at = (*next)[1];
        }
        return at == rim[0][0];
    }
    ConvexDistance describe(const Face& face) const {
        const Vec3d &a = at(face.corner[0]), &b = at(face.corner[1]), &c = at(face.corner[2]);
        const Vec3d foot = face.distance * face.normal, normal = cross(b - a, c - a);
        const double square = dot(normal, normal);
        const double u = dot(cross(b - foot, c - foot), normal) / square,
                     v = dot(cross(c - foot, a - foot), normal) / square;
        const auto first = [&](int k) { return vertices_[std::size_t(face.corner[std::size_t(k)])].first; };
        const Vec3d place = u * first(0) + v * first(1) + (1 - u - v) * first(2);
        // Moved by so much along the normal the cores are apart, also where the body is round.
        const double depth = dot(pair_.find_farthest(face.normal).at, face.normal);
        return {-depth, -face.normal, place, place - depth * face.normal};
    }
};

// Of the cores.
CSPACE_ONCE ConvexDistance measure_cores(const Convex& a, const Convex& b) {
    const ConvexPair pair(a, b);
    const Simplex simplex = find_nearest_simplex(pair);
    const double length = norm(simplex.nearest());
    if (!simplex.holds_origin() && length > pair.rounding()) {
        const Vec3d first = simplex.first();
        return {length, (1 / length) * simplex.nearest(), first, first - simplex.nearest()};
    }
    Polyhedron polyhedron(pair);
    if (polyhedron.begin(simplex)) return polyhedron.find_depth();
    const Vec3d first = simplex.first(), apart = -pair.first_direction();
    return {0, (1 / norm(apart)) * apart, first, first};
}

}  // namespace detail

// Below zero inside.
inline ConvexDistance measure_distance(const Convex& a, const Convex& b) {
    ConvexDistance d = detail::measure_cores(a, b);
    d.value -= a.radius + b.radius;
    d.first = d.first - a.radius * d.normal, d.second = d.second + b.radius * d.normal;
    return d;
}
// Of a solid from the half space normal · x ≤ offset, given by a unit normal.
inline ConvexDistance measure_above(const Convex& solid, const Vec3d& normal, double offset) {
    const Vec3d lowest = find_farthest(solid, -normal) - solid.radius * normal;
    const double value = dot(normal, lowest) - offset;
    return {value, normal, lowest, lowest - value * normal};
}
// Whether they are no farther apart than a gap.
inline bool is_within(const Convex& a, const Convex& b, double gap) {
    const double reach = gap + a.radius + b.radius;
    const detail::Simplex simplex = detail::find_nearest_simplex({a, b}, reach, reach);
    return norm(simplex.nearest()) <= reach;
}

}  // namespace cspace::shapes
