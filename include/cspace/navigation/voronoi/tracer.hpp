// The Voronoi diagram of free space, traced: from one point of it along every arc.
//
// At a vertex the disc of its distance touches walls in some points. Between any two of them that follow each
// other around it, one arc leads away (topology before numbers: Sugihara & Iri 1992, "Construction of the
// Voronoi diagram for one million generators in single-precision arithmetic"; Held 2001, "VRONI"). It ends
// where the disc first touches a third site, or in a corner. Each component's part is connected, and has as
// many cycles as the component has holes: that is asked of the result.
#pragma once

#include <numbers>
#include <unordered_map>

#include "cspace/maps/free_space.hpp"
#include "cspace/navigation/voronoi/first_touch.hpp"

namespace cspace::navigation::voronoi {

class Tracer {
  public:
    Tracer(Diagram& diagram, Grain grain)
        : d_(diagram), s_(diagram.sites), grain_(grain), cell_(1e-4 * diagram.sites.extent) {}

    // Adds the part of the component that a point lies in.
    void trace(Point seed) {
        const Retraction up = retract(s_, d_.tree, seed);
        if (up.b == none) return;
        component_ = s_.component[std::size_t(s_.edge_of(up.a))];
        if (!start(up)) return;
        while (!open_.empty()) {
            const auto [vertex, gap] = open_.back();
            open_.pop_back();
            if (taken_[std::size_t(gap)]) continue;
            if (d_.arcs.size() > 40 * std::size_t(s_.size()) + 1000) break;
            taken_[std::size_t(gap)] = 1;
            const Fan& fan = fans_.at(vertex);
            const Index k = gap - fan.first;
            follow(vertex, touches_[std::size_t(gap)].site,
                   touches_[std::size_t(fan.first + (k + 1) % fan.count)].site);
        }
        open_.clear();
    }

  private:
    struct Touch {
        Index site;
        Point towards;  // unit, from the vertex to where its disc touches the site
    };
    struct Fan {
        Index first, count;  // of touches_; gap k lies between touch k and the one after it
    };
    Diagram& d_;
    const Sites& s_;
    Grain grain_;
    double cell_;
    Index component_ = none;
    std::vector<Touch> touches_;
    std::vector<std::uint8_t> taken_;
    std::vector<std::pair<Index, Index>> open_;  // a vertex and a gap
    std::unordered_map<Index, Fan> fans_;
    std::unordered_multimap<std::uint64_t, Index> vertex_in_;

    // The first vertex: where an arc from the retracted point ends that does not end in a corner.
    bool start(const Retraction& up) {
        for (const auto& [a, b] : {std::pair{up.a, up.b}, std::pair{up.b, up.a}}) {
            const std::size_t vertices = d_.vertices.size(), arcs = d_.arcs.size();
            follow(add_plain_vertex(up.at, up.radius), a, b);
            const Index last = Index(d_.vertices.size()) - 1;
            const auto fan = fans_.find(last);
            const bool found = fan != fans_.end();
            Point at;
            std::vector<Touch> touches;
            if (found) at = d_.vertices[std::size_t(last)].at, touches = touches_at(fan->second);
            d_.vertices.resize(vertices);
            d_.arcs.resize(arcs);
            open_.clear();
            if (!found) continue;
            fans_.erase(last);
            vertex_in_.erase(key(at, 0, 0));
            add_vertex(at, touches);
            return true;
        }
        return false;
    }
    std::vector<Touch> touches_at(const Fan& fan) const {
        return {touches_.begin() + fan.first, touches_.begin() + fan.first + fan.count};
    }

    static double turn_from(Point a, Point b) {
        const double angle = std::atan2(cross(a, b), dot(a, b));
        return angle < 0 ? angle + 2 * std::numbers::pi : angle;
    }

    // The sites that the disc touches that has come along the arc of a and b to p, counterclockwise from a to
    // b; c is one between them. Between b and a there is only what the disc has left behind.
    std::vector<Touch> contacts(Point& p, Index a, Index b, Index c) const {
        polish(p, a, b, c);
        std::vector<Touch> all{{a, s_.towards(a, p)}, {b, s_.towards(b, p)}, {c, s_.towards(c, p)}};
        const double radius = s_.distance_to(a, p), slack = grain_.at(radius);
        const Point start = all[0].towards;
        const double sector = turn_from(start, all[1].towards);
        const auto add = [&](Index site) {
            if (site == a || site == b || site == c) return;
            const Touch touch{site, s_.towards(site, p)};
            if (turn_from(start, touch.towards) < sector) all.push_back(touch);
        };
        d_.tree.visit_disc(p, radius + slack, EitherSide{}, [&](Index e) {
            const double s = s_.advance(e, p), h = s_.height(e, p);
            if (h > 0.5 * radius && h <= radius + slack && s >= 0 && s <= s_.length[std::size_t(e)]) add(e);
            if (s_.turn_at(e) == Turn::around && distance(p, s_.begin(e)) <= radius + slack &&
                s_.is_in_cone(e, p, slack))
                add(s_.size() + e);
            return true;
        });
        std::sort(all.begin(), all.end(), [&](const Touch& x, const Touch& y) {
            const bool x_is_a = x.site == a, y_is_a = y.site == a, x_is_b = x.site == b, y_is_b = y.site == b;
            if (x_is_a || y_is_a) return x_is_a && !y_is_a;
            if (x_is_b || y_is_b) return y_is_b && !x_is_b;
            return turn_from(start, x.towards) < turn_from(start, y.towards);
        });
        std::vector<Touch> kept{all.front()};
        for (std::size_t i = 1; i + 1 < all.size(); ++i)
            if (!is_same(kept.back(), all[i], radius)) kept.push_back(all[i]);
        while (kept.size() > 1 && is_same(kept.back(), all.back(), radius)) kept.pop_back();
        kept.push_back(all.back());
        if (kept.size() > 3) polish_by_spread(p, kept);
        return kept;
    }
    // By three touches that are far from each other around the disc.
    void polish_by_spread(Point& p, const std::vector<Touch>& all) const {
        const auto farthest = [&](auto spread) {
            return *std::max_element(all.begin(), all.end(),
                                     [&](const Touch& x, const Touch& y) { return spread(x) < spread(y); });
        };
        const Touch a = all.front();
        const Touch b = farthest([&](const Touch& x) { return squared_norm(x.towards - a.towards); });
        const Touch c = farthest(
            [&](const Touch& x) { return std::abs(cross(b.towards - a.towards, x.towards - a.towards)); });
        polish(p, a.site, b.site, c.site);
    }
    // Whether two touches are one: of the same site, or near each other on sites without a corner between.
    bool is_same(const Touch& x, const Touch& y, double radius) const {
        if (x.site == y.site) return true;
        if (!(squared_norm(x.towards - y.towards) < 1e-12) && radius > 0) return false;
        return follows(x.site, y.site) || follows(y.site, x.site);
    }
    bool follows(Index x, Index y) const {
        const Index e = s_.edge_of(x), f = s_.edge_of(y);
        if (!s_.is_edge(x)) return f == e || (s_.is_edge(y) && f == s_.previous(e));
        return s_.after(e) == f && (!s_.is_edge(y) || s_.turn_at(f) != Turn::corner);
    }

    // Newton's method for the point as far from three sites.
    void polish(Point& p, Index a, Index b, Index c) const {
        for (int i = 0; i < 2; ++i) {
            const Point da = s_.towards(a, p), ab = s_.towards(b, p) - da, ac = s_.towards(c, p) - da;
            const double det = cross(ab, ac), ra = s_.distance_to(a, p);
            if (!(std::abs(det) > 1e-6)) return;
            const double fb = s_.distance_to(b, p) - ra, fc = s_.distance_to(c, p) - ra;
            const Point step{(fb * ac.y - fc * ab.y) / det, (fc * ab.x - fb * ac.x) / det};
            if (!(norm(step) <= 1e-6 * s_.extent)) return;
            p = p + step;
        }
    }

    // Of the cell that a point lies in, after steps of half a cell.
    std::uint64_t key(Point p, int half_steps_x, int half_steps_y) const {
        const auto cell = [&](double x, int steps) {
            return std::uint64_t(std::int64_t(std::floor(x / cell_ + 0.5 * steps)));
        };
        return cell(p.x, half_steps_x) * 0x9e3779b97f4a7c15u + cell(p.y, half_steps_y);
    }
    Index add_plain_vertex(Point p, double radius) {
        d_.vertices.push_back({p, radius, component_, 0});
        return Index(d_.vertices.size() - 1);
    }
    Index add_vertex(Point p, const std::vector<Touch>& touches) {
        const Index v = add_plain_vertex(p, s_.distance_to(touches[0].site, p));
        const Fan fan{Index(touches_.size()), Index(touches.size())};
        fans_[v] = fan;
        touches_.insert(touches_.end(), touches.begin(), touches.end());
        taken_.resize(touches_.size(), 0);
        vertex_in_.emplace(key(p, 0, 0), v);
        for (Index k = 0; k < fan.count; ++k) open_.push_back({v, fan.first + k});
        return v;
    }
    void add_arc(Index from, Index to, Index a, Index b, const Bisector& curve, double begin, double end) {
        d_.arcs.push_back(
            {from, to, a, b, curve, begin, end, curve.least_radius(begin, end), curve.length(begin, end)});
        d_.arcs.back().least = std::min({d_.arcs.back().least, d_.vertices[std::size_t(to)].radius});
        ++d_.vertices[std::size_t(from)].degree;
        ++d_.vertices[std::size_t(to)].degree;
    }

    // The vertex that an arc of a and b reaches at p, where it touches c.
    Index arrive(Point p, Index a, Index b, Index c) {
        const std::vector<Touch> touches = contacts(p, a, b, c);
        const Touch &first = touches.front(), &last = touches.back();
        const double radius = s_.distance_to(a, p);
        Index vertex = none, gap = none;
        double best = 1e-5;
        const double near = 1e2 * grain_.at(radius);
        for (int i = 0; i < 4; ++i) {
            const auto [begin, end] = vertex_in_.equal_range(key(p, i % 2 ? 1 : -1, i / 2 ? 1 : -1));
            for (auto it = begin; it != end; ++it) {
                if (distance(d_.vertices[std::size_t(it->second)].at, p) > near) continue;
                const Fan& fan = fans_.at(it->second);
                for (Index k = 0; k < fan.count; ++k) {
                    const Touch &x = touches_[std::size_t(fan.first + k)],
                                &y = touches_[std::size_t(fan.first + (k + 1) % fan.count)];
                    const double off = norm(x.towards - last.towards) + norm(y.towards - first.towards);
                    if (taken_[std::size_t(fan.first + k)] || !(off < best)) continue;
                    best = off;
                    vertex = it->second;
                    gap = fan.first + k;
                }
            }
        }
        if (vertex == none) {
            vertex = add_vertex(p, touches);
            gap = Index(touches_.size()) - 1;  // back to where the arc comes from
        }
        taken_[std::size_t(gap)] = 1;
        return vertex;
    }

    // Along the arcs of a, whose foot moves forward, and b, whose foot moves backward, to the next vertex.
    void follow(Index vertex, Index a, Index b) {
        for (Index joints = 0; joints <= 2 * s_.size(); ++joints) {
            const Point from = d_.vertices[std::size_t(vertex)].at;
            const Bisector curve = bisector_of(s_, a, b, from);
            const double begin = curve.parameter(from);
            double end = begin + 4 * s_.extent;
            if (!std::isfinite(begin) || !std::isfinite(squared_norm(curve.p2))) return;
            const double end_a = leaves(curve, begin, forward_gate(a)),
                         end_b = leaves(curve, begin, backward_gate(b));
            end = std::min({end, end_a, end_b});
            FirstTouch touch(s_, d_.tree, grain_, curve, a, b, begin, end);
            touch.find();
            end = touch.at();
            if (touch.site() != none) {
                const Index to = arrive(curve.at(end), a, b, touch.site());
                return add_arc(vertex, to, a, b, curve, begin, end);
            }
            if (s_.is_edge(a) && s_.is_edge(b) && s_.after(a) == b && s_.turn_at(b) == Turn::corner) {
                const Index to = add_plain_vertex(s_.begin(b), 0);
                return add_arc(vertex, to, a, b, curve, begin, curve.parameter(s_.begin(b)));
            }
            const bool turn_a = end_a <= end, turn_b = end_b <= end;
            if (!turn_a && !turn_b) return;  // nothing in the way: lost
            const Index corner = turn_a ? corner_after(a) : none, other = turn_b ? corner_before(b) : none;
            if (corner != none || other != none) {
                const Index to = arrive(curve.at(end), a, b, corner != none ? corner : other);
                return add_arc(vertex, to, a, b, curve, begin, end);
            }
            if (end > begin) {
                const Index to = add_plain_vertex(curve.at(end), curve.radius(end));
                add_arc(vertex, to, a, b, curve, begin, end);
                vertex = to;
            }
            if (turn_a) a = site_after(a);
            if (turn_b) b = site_before(b);
            if (a == b) return;
        }
    }

    // A foot leaves its site where p crosses the line through q across s, in the direction of s.
    struct Gate {
        Point q, s;
    };
    Gate forward_gate(Index a) const {
        const Index e = s_.edge_of(a);
        return s_.is_edge(a) ? Gate{s_.end(e), s_.direction(e)} : Gate{s_.begin(e), s_.direction(e)};
    }
    Gate backward_gate(Index b) const {
        const Index e = s_.edge_of(b);
        return {s_.begin(e), -1.0 * s_.direction(s_.is_edge(b) ? e : s_.previous(e))};
    }
    double leaves(const Bisector& curve, double begin, Gate gate) const {
        const Quadratic g = curve.along(gate.s, gate.q);
        const double slack = grain_.at(curve.radius(begin)) * 1e-3;
        if (std::abs(g.at(begin)) <= slack && g.slope(begin) > 0) return begin;
        double first = std::numeric_limits<double>::infinity();
        for (const double t : g.zeros())
            if (t >= begin && t < first && g.slope(t) > 0) first = t;
        return first;
    }
    Index site_after(Index a) const {
        if (!s_.is_edge(a)) return s_.edge_of(a);
        const Index e = s_.after(a);
        return s_.turn_at(e) == Turn::around ? s_.size() + e : e;
    }
    Index site_before(Index b) const {
        const Index e = s_.edge_of(b);
        return s_.is_edge(b) && s_.turn_at(e) == Turn::around ? s_.size() + e : s_.previous(e);
    }
    // The edge behind the corner in which an edge ends, or begins.
    Index corner_after(Index a) const {
        return s_.is_edge(a) && s_.turn_at(s_.after(a)) == Turn::corner ? s_.after(a) : none;
    }
    Index corner_before(Index b) const {
        return s_.is_edge(b) && s_.turn_at(b) == Turn::corner ? s_.previous(b) : none;
    }
};

// Traces the part of one component; whether it is whole: connected, as traced from one point, with one cycle
// less than the component has rings of walls.
inline bool trace_component(Diagram& d, Point seed, std::int64_t rings) {
    constexpr Grain grains[] = {{1e-13, 1e-9}, {1e-15, 1e-12}, {1e-11, 1e-7}};
    const std::size_t vertices = d.vertices.size(), arcs = d.arcs.size();
    for (const Grain& grain : grains) {
        d.vertices.resize(vertices);
        d.arcs.resize(arcs);
        Tracer(d, {grain.fine * d.sites.extent, grain.share}).trace(seed);
        const auto added = std::int64_t(d.vertices.size() - vertices) - std::int64_t(d.arcs.size() - arcs);
        if (added == 2 - rings) return true;
    }
    return false;
}

// seeds: a point inside each component of free space.
inline Diagram make_diagram(const maps::Boundary& walls, const std::vector<Point>& seeds, Point origin) {
    Diagram diagram;
    diagram.sites = sites_of(walls, origin);
    diagram.tree = EdgeTree(diagram.sites);
    std::vector<std::int64_t> rings(seeds.size(), 0);
    for (const Index c : walls.component) ++rings[std::size_t(c)];
    for (std::size_t c = 0; c < seeds.size(); ++c)
        diagram.is_whole.push_back(trace_component(diagram, seeds[c] - origin, rings[c]));
    return diagram;
}

// The middle of the largest triangle of each component.
inline std::vector<Point> seeds_of(const maps::FreeSpace& space) {
    std::vector<double> largest(std::size_t(space.components), 0);
    std::vector<Point> seeds(largest.size());
    for (Index t = 0; t < Index(space.mesh.triangles.size()); ++t) {
        if (!space.is_free(t)) continue;
        const auto& corner = space.mesh[t].corner;
        const Point a = space.mesh.point(corner[0]), b = space.mesh.point(corner[1]) - a,
                    c = space.mesh.point(corner[2]) - a;
        const std::size_t part = std::size_t(space.component[std::size_t(t)]);
        if (!(cross(b, c) > largest[part])) continue;
        largest[part] = cross(b, c);
        seeds[part] = a + (1.0 / 3) * (b + c);
    }
    return seeds;
}

}  // namespace cspace::navigation::voronoi
