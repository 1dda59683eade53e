// The Voronoi diagram of free space, traced: from one point of it along every arc.
//
// At a vertex the disc of its distance touches walls in some points. Between any two of them that follow each
// other around it, one arc leads away (topology before numbers: Sugihara & Iri 1992, "Construction of the
// Voronoi diagram for one million generators in single-precision arithmetic"; Held 2001, "VRONI"). It ends
// where the disc first touches a third site, or in a corner. Each component's part is connected, and has as
// many cycles as the component has holes: the result is tested for that.
#pragma once

#include <unordered_map>

#include "cspace/maps/free_space.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/voronoi/contacts.hpp"
#include "cspace/navigation/voronoi/feet.hpp"

namespace cspace::navigation::voronoi {

class Tracer {
  public:
    Tracer(Diagram& diagram, Grain grain)
        : d_(diagram),
          s_(diagram.sites),
          grain_(grain),
          contacts_(diagram.sites, grain),
          cell_(cell_share * diagram.sites.extent) {}

    // Adds the part of the component that a point lies in; false where it would have no end.
    bool trace(Point seed) {
        const Retraction up = retract_point(s_, seed);
        if (up.b == none) return true;
        component_ = s_.component[std::size_t(s_.edge_of(up.a))];
        const std::size_t arcs = d_.arcs.size();
        if (!start(up)) return true;
        while (!open_.empty()) {
            const auto [vertex, gap] = open_.back();
            open_.pop_back();
            if (taken_[std::size_t(gap)]) continue;
            if (d_.arcs.size() - arcs > most_arcs * std::size_t(s_.size()) + 64) return false;
            taken_[std::size_t(gap)] = 1;
            const Fan& fan = fans_.at(vertex);
            const Index k = gap - fan.first;
            follow(vertex, touches_[std::size_t(gap)].site,
                   touches_[std::size_t(fan.first + (k + 1) % fan.count)].site);
        }
        return true;
    }

  private:
    static constexpr double cell_share = 1e-4;  // of the extent: few vertices share a cell
    // Per edge of the walls, of which each may bring a point as a second site: a plane graph with faces for
    // its n sites has less than 3 n edges (Euler), and rounding may divide some of them.
    static constexpr std::size_t most_arcs = 8;
    static constexpr double same_direction = 1e-5;  // [rad] sum of two, between arcs of one gap
    struct Fan {
        Index first, count;  // of touches_; gap k lies between touch k and the one after it
    };
    Diagram& d_;
    const Sites& s_;
    Grain grain_;
    Contacts contacts_;
    double cell_;
    Index component_ = none;
    std::vector<Contact> touches_;
    std::vector<std::uint8_t> taken_;
    std::vector<std::pair<Index, Index>> open_;  // a vertex and a gap
    std::unordered_map<Index, Fan> fans_;
    std::unordered_multimap<std::uint64_t, Index> vertex_in_;
    InterruptPoll poll_{16};

    // The first vertex: where an arc from the retracted point ends that does not end in a corner.
    bool start(const Retraction& up) {
        for (const auto& [a, b] : {std::pair{up.a, up.b}, std::pair{up.b, up.a}}) {
            const std::size_t vertices = d_.vertices.size(), arcs = d_.arcs.size();
            follow(add_plain_vertex(up.at, up.radius), a, b);
            const Index last = Index(d_.vertices.size()) - 1;
            const auto fan = fans_.find(last);
            const bool found = fan != fans_.end();
            Point at;
            std::vector<Contact> touches;
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
    std::vector<Contact> touches_at(const Fan& fan) const {
        return {touches_.begin() + fan.first, touches_.begin() + fan.first + fan.count};
    }

    // Of the cell that a point lies in, after steps of half a cell.
    std::uint64_t key(Point p, int half_steps_x, int half_steps_y) const {
        const auto cell = [&](double x, int steps) {
            return std::uint64_t(std::int64_t(std::floor(x / cell_ + 0.5 * steps)));
        };
        return cell(p.x, half_steps_x) * 0x9e3779b97f4a7c15u + cell(p.y, half_steps_y);
    }
    Index add_plain_vertex(Point p, double radius) {
        d_.vertices.push_back({p, radius, component_});
        return Index(d_.vertices.size() - 1);
    }
    Index add_vertex(Point p, const std::vector<Contact>& touches) {
        const Index v = add_plain_vertex(p, s_.distance_to(touches[0].site, p));
        const Fan fan{Index(touches_.size()), Index(touches.size())};
        fans_[v] = fan;
        touches_.insert(touches_.end(), touches.begin(), touches.end());
        taken_.resize(touches_.size(), 0);
        vertex_in_.emplace(key(p, 0, 0), v);
        for (Index k = 0; k < fan.count; ++k) open_.push_back({v, fan.first + k});
        return v;
    }
    // The vertex that an arc of a and b reaches at p, where it touches c.
    Index arrive(Point p, Index a, Index b, Index c) {
        const std::vector<Contact> touches = contacts_.around(p, a, b, c);
        const Contact &first = touches.front(), &last = touches.back();
        const double radius = s_.distance_to(a, p);
        Index vertex = none, gap = none;
        double best = same_direction;
        const double near = 1e2 * grain_.at(radius);
        for (int i = 0; i < 4; ++i) {
            const auto [begin, end] = vertex_in_.equal_range(key(p, i % 2 ? 1 : -1, i / 2 ? 1 : -1));
            for (auto it = begin; it != end; ++it) {
                if (distance(d_.vertices[std::size_t(it->second)].at, p) > near) continue;
                const Fan& fan = fans_.at(it->second);
                for (Index k = 0; k < fan.count; ++k) {
                    const Contact &x = touches_[std::size_t(fan.first + k)],
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
            poll_.step();
            const Point from = d_.vertices[std::size_t(vertex)].at;
            const ArcPiece arc = next_piece(s_, grain_, a, b, from, [](const ArcPiece&) {
                return std::numeric_limits<double>::infinity();
            });
            const auto add = [&](Index to) {
                d_.arcs.push_back({vertex, to, a, b, arc.curve, arc.begin, arc.end});
            };
            if (arc.cause == ArcEnd::lost) return;
            if (arc.cause == ArcEnd::vertex) return add(arrive(arc.curve.at(arc.end), a, b, arc.third));
            if (arc.cause == ArcEnd::corner) return add(add_plain_vertex(s_.begin(b), 0));
            if (arc.end > arc.begin) {
                const Index to = add_plain_vertex(arc.curve.at(arc.end), arc.curve.radius(arc.end));
                add(to);
                vertex = to;
            }
            if (arc.turns_a) a = site_after(s_, a);
            if (arc.turns_b) b = site_before(s_, b);
            if (a == b) return;
        }
    }
};

// Traces the part of one component; whether it is whole: connected, as traced from one point, with one cycle
// less than the number of boundary loops of the component.
inline bool trace_component(Diagram& d, Point seed, std::int64_t rings) {
    const std::size_t vertices = d.vertices.size(), arcs = d.arcs.size();
    for (const Grain& grain : grains) {
        d.vertices.resize(vertices);
        d.arcs.resize(arcs);
        if (!Tracer(d, grain_in(d.sites, grain)).trace(seed)) continue;
        const auto added = std::int64_t(d.vertices.size() - vertices) - std::int64_t(d.arcs.size() - arcs);
        if (added == 2 - rings) return true;
    }
    return false;
}

// seeds: a point inside each component of free space.
inline Diagram make_diagram(const maps::Boundary& walls, const std::vector<Point>& seeds, Point origin) {
    Diagram diagram;
    diagram.sites = Sites(walls, origin);
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
        const auto [corner, b, c] = space.mesh.spanned(t);
        const std::size_t part = std::size_t(space.component[std::size_t(t)]);
        if (!(cross(b, c) > largest[part])) continue;
        largest[part] = cross(b, c);
        seeds[part] = space.mesh.middle_of(t);
    }
    return seeds;
}

}  // namespace cspace::navigation::voronoi
