// Ways that keep away from walls: up to the Voronoi diagram, along it, and down to the goal.
//
// Away from the nearest wall the clearance grows until a second wall is as near: so any path between two
// points can be moved onto the diagram without coming nearer to a wall (Ó'Dúnlaing & Yap 1985, "A
// 'retraction' method for planning the motion of a disc"). The widest way on the diagram is therefore the
// widest at all. Of all ways whose least clearance is as large, which may be that of an end, the shortest on
// the diagram is given.
#pragma once

#include <algorithm>
#include <memory>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/navigation/sampling/sight.hpp"
#include "cspace/navigation/voronoi/tracer.hpp"
#include "cspace/search/adjacency.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation::voronoi {

// A place on the diagram, and how to get there from a point of free space.
struct Landing {
    std::vector<Point> lead;  // from the point to the diagram
    double clearance = 0;     // the least on that way, which is that of the point [m]
    Index arc = none;
    double t = 0;
};

// Part of an arc, from parameter t0 to t1 in either direction.
struct Stretch {
    Index arc;
    double t0, t1;
};

// What a search is for: the widest way, or the shortest among the arcs that are wide enough.
struct Wish {
    bool widest;
    double floor;
};

class Roadmap {
  public:
    explicit Roadmap(const maps::PolygonWorld& world)
        : world_(world),
          diagram_(make_diagram(world.walls, seeds_of(world.space),
                                0.5 * (world.outlines.low + world.outlines.high))) {
        around_ = {diagram_.vertices.size(), [&](const auto& add) {
                       for (Index k = 0; k < Index(diagram_.arcs.size()); ++k)
                           add(std::size_t(arc(k).from), k), add(std::size_t(arc(k).to), k);
                   }};
        for (Index k = 0; k < Index(diagram_.arcs.size()); ++k)
            between_.emplace(pair_key(arc(k).a, arc(k).b), k);
    }

    const Diagram& diagram() const { return diagram_; }

    // The way between two settled points of one component; tolerance: how far a chord may lie from its arc
    // [m]. Undetermined where the component's part of the diagram is not whole, and where rounding has put
    // the way into a wall.
    DiagramRoute solve(const maps::Settled& start, const maps::Settled& goal, Index component, bool widest,
                       double tolerance, Trace* trace) const {
        DiagramRoute way;
        if (!diagram_.is_whole[std::size_t(component)]) return way;
        const Landing from = land(start, component), to = land(goal, component);
        if (from.arc == none || to.arc == none) return way;
        if (start.at == goal.at) return stay(start.at, from.clearance);
        if (trace)
            for (const Landing* end : {&from, &to})
                trace->push_back(
                    {0, diagram_.place(end->lead.front()), diagram_.place(end->lead.back()), end->clearance});
        const double floor =
            widest ? floor_of(from, to, search(from, to, {true, 0}, nullptr, way, trace)) : 0;
        std::vector<Stretch> stretches;
        search(from, to, {false, floor}, &stretches, way, trace);
        draw(from, to, stretches, tolerance, way);
        way.route.path.front() = start.at, way.route.path.back() = goal.at;
        if (is_free(way.route.path, start, component))
            way.route.status = Status::found;
        else
            way.route.path.clear(), way.route.length = std::numeric_limits<double>::infinity();
        return way;
    }

  private:
    const maps::PolygonWorld& world_;
    Diagram diagram_;
    search::Adjacency<Index> around_;  // the arcs around each vertex
    std::unordered_multimap<std::uint64_t, Index> between_;

    static std::uint64_t pair_key(Index a, Index b) {
        return (std::uint64_t(std::uint32_t(std::min(a, b))) << 32) | std::uint32_t(std::max(a, b));
    }
    const Arc& arc(Index k) const { return diagram_.arcs[std::size_t(k)]; }
    Point vertex(Index v) const { return diagram_.vertices[std::size_t(v)].at; }

    // Whether a path keeps to the open free space of a component, decided exactly.
    bool is_free(const std::vector<Point>& path, const maps::Settled& start, Index component) const {
        const maps::FreeSpace& space = world_.space;
        return std::any_of(start.triangles.begin(), start.triangles.end(), [&](Index t) {
            return space.component[std::size_t(t)] == component && sampling::keeps_in_sight(space, path, t);
        });
    }

    static DiagramRoute stay(Point at, double clearance) {
        DiagramRoute way;
        way.route.status = Status::found;
        way.route.path = {at};
        way.route.length = 0;
        way.clearance = way.on_diagram = way.at_start = way.at_goal = clearance;
        return way;
    }

    // What no way from start to goal exceeds, which no arc may fall short of, less what rounding may have
    // added to it: `width` is that of the widest way on the diagram, but an end may lie nearer to a wall.
    double floor_of(const Landing& from, const Landing& to, double width) const {
        return std::min({width, from.clearance, to.clearance}) - diagram_.sites.rounding();
    }

    Landing land(const maps::Settled& end, Index component) const {
        Landing landing;
        Point p = end.at - diagram_.sites.origin;
        landing.lead = {p};
        Retraction up = retract_point(diagram_.sites, p);
        const double on_wall = tolerance::widening * diagram_.sites.extent;
        landing.clearance = up.clearance;
        for (const double share : {1.0 / 64, 1.0 / 4, 1.0}) {
            if (up.clearance > on_wall && up.b != none) break;
            p = landing.lead[0] + share * (middle_of(end, component) - landing.lead[0]);
            up = retract_point(diagram_.sites, p);
        }
        if (p != landing.lead[0]) landing.lead.push_back(p), landing.clearance = 0;
        if (up.b == none) return landing;
        locate(up, component, landing);
        if (landing.arc != none) landing.lead.push_back(arc(landing.arc).curve.at(landing.t));
        return landing;
    }
    // The middle of the triangle of the component in whose closure a point lies.
    Point middle_of(const maps::Settled& end, Index component) const {
        for (const Index t : end.triangles)
            if (world_.space.component[std::size_t(t)] == component)
                return world_.space.mesh.middle_of(t) - diagram_.sites.origin;
        return end.at - diagram_.sites.origin;
    }

    void locate(const Retraction& up, Index component, Landing& landing) const {
        constexpr double on_arc = 1e-7;  // of the extent: an arc that is known to the square root of rounding
        double best = on_arc * diagram_.sites.extent;
        const auto consider = [&](Index k) {
            const Arc& a = arc(k);
            const double t = std::clamp(a.curve.parameter(up.at), a.begin, a.end);
            const double off = distance(a.curve.at(t), up.at);
            if (off < best) best = off, landing.arc = k, landing.t = t;
        };
        const auto [begin, end] = between_.equal_range(pair_key(up.a, up.b));
        for (auto it = begin; it != end; ++it) consider(it->second);
        if (landing.arc != none) return;
        best = std::numeric_limits<double>::infinity();
        for (Index k = 0; k < Index(diagram_.arcs.size()); ++k)
            if (diagram_.vertices[std::size_t(arc(k).from)].component == component) consider(k);
    }

    struct Search;
    double search(const Landing& from, const Landing& to, Wish wish, std::vector<Stretch>* stretches,
                  DiagramRoute& way, Trace* trace) const;

    void draw(const Landing& from, const Landing& to, const std::vector<Stretch>& stretches, double tolerance,
              DiagramRoute& way) const {
        std::vector<Point>& path = way.route.path;
        path = from.lead;
        way.on_diagram = arc(from.arc).curve.radius(from.t);
        for (const Stretch& s : stretches) {
            sample(arc(s.arc).curve, s.t0, s.t1, tolerance, path);
            way.on_diagram = std::min(
                way.on_diagram, arc(s.arc).curve.least_radius(std::min(s.t0, s.t1), std::max(s.t0, s.t1)));
        }
        path.insert(path.end(), to.lead.rbegin(), to.lead.rend());
        path.erase(std::unique(path.begin(), path.end()), path.end());
        if (path.size() == 1) path.push_back(path[0]);
        for (Point& p : path) p = diagram_.place(p);
        way.clearance = std::min({from.clearance, to.clearance, way.on_diagram});
        way.at_start = from.clearance;
        way.at_goal = to.clearance;
        way.route.length = length_of(path);
    }

  public:
    // Appends the points after the first of a polyline no farther from the curve than the tolerance [m], and
    // than a hundredth of its clearance.
    static void sample(const Bisector& curve, double t0, double t1, double tolerance,
                       std::vector<Point>& out) {
        const double bend = 2 * norm(curve.p2);
        double steps = 1;
        if (bend > 0) {
            const double off = std::min(tolerance, 0.01 * curve.radius(0));
            steps = std::clamp(std::ceil(std::abs(t1 - t0) * std::sqrt(bend / (8 * off))), 1.0, 1e5);
        }
        for (int i = 1; i <= int(steps); ++i) out.push_back(curve.at(t0 + (t1 - t0) * (i / steps)));
    }
};

// A space for best_first: the vertices, and after them the goal.
struct Roadmap::Search {
    const Roadmap& map;
    const Landing& to;
    Wish wish;
    Stats& stats;
    Trace* trace;
    search::Ways ways;          // to each vertex: the length, or minus the least width
    std::vector<Stretch> came;  // by which stretch

    std::uint32_t goal() const { return std::uint32_t(came.size()) - 1; }
    Point at(std::uint32_t node) const { return node == goal() ? to.lead.back() : map.vertex(Index(node)); }

    bool settle(std::uint32_t node) {
        if (!ways.settle(node)) return false;
        ++stats.nodes;
        if (trace) record(node);
        return true;
    }
    bool is_goal(std::uint32_t node) const { return node == goal(); }
    void record(std::uint32_t node) const {
        const Stretch& s = came[node];
        const Bisector& curve = map.arc(s.arc).curve;
        trace->push_back({std::int8_t(wish.widest ? 1 : 2), map.diagram_.place(curve.at(s.t0)),
                          map.diagram_.place(curve.at(s.t1)), std::abs(ways.cost(node))});
    }

    void push(std::uint32_t node, std::uint32_t from, double before, const Stretch& s,
              search::PriorityQueue& queue) {
        ++stats.edges;
        const Bisector& curve = map.arc(s.arc).curve;
        const double low = std::min(s.t0, s.t1), high = std::max(s.t0, s.t1);
        const double width = curve.least_radius(low, high);
        if (width < wish.floor) return;
        const double after = wish.widest ? std::max(before, -width) : before + curve.length(low, high);
        if (!ways.improve(node, after, from)) return;
        came[node] = s;
        const double left = wish.widest ? 0 : distance(at(node), to.lead.back());
        queue.push({after + left, 0, node});
    }
    void leave(std::uint32_t from, double before, Index k, double t, search::PriorityQueue& queue) {
        const Arc& arc = map.arc(k);
        const bool is_first = from == search::no_node;
        if (t != arc.begin || is_first) push(std::uint32_t(arc.from), from, before, {k, t, arc.begin}, queue);
        if (t != arc.end || is_first) push(std::uint32_t(arc.to), from, before, {k, t, arc.end}, queue);
        if (k == to.arc) push(goal(), from, before, {k, t, to.t}, queue);
    }
    void expand(std::uint32_t node, search::PriorityQueue& queue) {
        for (const Index k : map.around_.of(node)) {
            const Arc& arc = map.arc(k);
            if (arc.from == Index(node)) leave(node, ways.cost(node), k, arc.begin, queue);
            if (arc.to == Index(node)) leave(node, ways.cost(node), k, arc.end, queue);
        }
    }
};

// The value of the goal as a width; the stretches of the way to it.
inline double Roadmap::search(const Landing& from, const Landing& to, Wish wish,
                              std::vector<Stretch>* stretches, DiagramRoute& way, Trace* trace) const {
    const std::size_t nodes = diagram_.vertices.size() + 1;
    Search space{*this, to, wish, way.route.stats, trace, search::Ways(nodes), std::vector<Stretch>(nodes)};
    search::PriorityQueue queue;
    search::Effort effort;
    space.leave(search::no_node, wish.widest ? -std::numeric_limits<double>::infinity() : 0, from.arc, from.t,
                queue);
    search::best_first(space, queue, effort);
    if (stretches) {
        for (std::uint32_t v = space.goal(); v != search::no_node; v = space.ways.before(v))
            stretches->push_back(space.came[v]);
        std::reverse(stretches->begin(), stretches->end());
    }
    return -space.ways.cost(space.goal());
}

}  // namespace cspace::navigation::voronoi
