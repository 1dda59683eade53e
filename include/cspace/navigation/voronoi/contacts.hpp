// What a disc touches that has come as far as it can: its contacts in order around it.
#pragma once

#include <numbers>

#include "cspace/math/wrapping.hpp"
#include "cspace/navigation/voronoi/first_touch.hpp"

namespace cspace::navigation::voronoi {

struct Contact {
    Index site;
    Point towards;  // unit, from the middle of the disc to where it touches the site
};

// The angle from one direction counterclockwise to another, in [0, 2π).
inline double turn_from(Point a, Point b) { return wrap_above(std::atan2(cross(a, b), dot(a, b)), 0); }

class Contacts {
  public:
    Contacts(const Sites& sites, Grain grain) : s_(sites), grain_(grain) {}

    // The sites that the disc touches that has come along the arc of a and b to p, counterclockwise from a to
    // b; c is one between them. Between b and a there is only what the disc has left behind.
    std::vector<Contact> around(Point& p, Index a, Index b, Index c) const {
        polish(p, a, b, c);
        const Contact right = contact(a, p), left = contact(b, p);
        const double sector = turn_from(right.towards, left.towards);
        const std::vector<Contact> kept = gather(p, {right, left, contact(c, p)}, sector, b);
        if (kept.size() > 3) polish_by_spread(p, kept);
        return kept;
    }
    // The same for a disc that has rolled along a alone, its foot moving forward, until it touched c in
    // front.
    std::vector<Contact> ahead(Point p, Index a, Index c) const {
        return gather(p, {contact(a, p), contact(c, p)}, std::numbers::pi, none);
    }
    // All that a disc touches which touches a and b.
    std::vector<Contact> everywhere(Point p, Index a, Index b) const {
        std::vector<Contact> kept = gather(p, {contact(a, p), contact(b, p)}, 2 * std::numbers::pi, none);
        if (kept.size() > 2 && is_same(kept.back(), kept.front(), s_.distance_to(a, p))) kept.pop_back();
        return kept;
    }
    Contact contact(Index site, Point p) const { return {site, s_.towards(site, p)}; }

  private:
    const Sites& s_;
    Grain grain_;

    // The given contacts and what else the disc touches in the sector of an angle from the first of them on,
    // counterclockwise from there; the site that is last, if one is, goes to the end.
    std::vector<Contact> gather(Point p, std::vector<Contact> all, double sector, Index last) const {
        const double radius = s_.distance_to(all[0].site, p), slack = grain_.at(radius);
        const Point start = all[0].towards;
        const std::size_t given = all.size();
        const auto add = [&](Index site) {
            for (std::size_t i = 0; i < given; ++i)
                if (all[i].site == site) return;
            const Contact touch = contact(site, p);
            if (turn_from(start, touch.towards) < sector) all.push_back(touch);
        };
        s_.tree.visit_disc(p, radius + slack, EitherSide{}, [&](Index e) {
            const double h = s_.height(e, p);
            if (h > 0.5 * radius && h <= radius + slack && s_.is_beside(e, p, 0)) add(e);
            if (s_.turn_at(e) == Turn::around && distance(p, s_.begin(e)) <= radius + slack &&
                s_.is_in_cone(e, p, slack))
                add(s_.size() + e);
            return true;
        });
        std::sort(all.begin() + 1, all.end(), [&](const Contact& x, const Contact& y) {
            if (x.site == last || y.site == last) return y.site == last && x.site != last;
            return turn_from(start, x.towards) < turn_from(start, y.towards);
        });
        std::vector<Contact> kept{all.front()};  // each once
        for (std::size_t i = 1; i + 1 < all.size(); ++i)
            if (!is_same(kept.back(), all[i], radius)) kept.push_back(all[i]);
        while (kept.size() > 1 && is_same(kept.back(), all.back(), radius)) kept.pop_back();
        kept.push_back(all.back());
        return kept;
    }
    // By three touches that are far from each other around the disc.
    void polish_by_spread(Point& p, const std::vector<Contact>& all) const {
        const auto farthest = [&](auto spread) {
            return *std::max_element(all.begin(), all.end(), [&](const Contact& x, const Contact& y) {
                return spread(x) < spread(y);
            });
        };
        const Contact a = all.front();
        const Contact b = farthest([&](const Contact& x) { return squared_norm(x.towards - a.towards); });
        const Contact c = farthest(
            [&](const Contact& x) { return std::abs(cross(b.towards - a.towards, x.towards - a.towards)); });
        polish(p, a.site, b.site, c.site);
    }
    // Whether two touches are one: of the same site, or near each other on sites without a corner between.
    bool is_same(const Contact& x, const Contact& y, double radius) const {
        constexpr double same_direction2 = 1e-12;  // square of an angle known to the square root of rounding
        if (x.site == y.site) return true;
        if (!(squared_norm(x.towards - y.towards) < same_direction2) && radius > 0) return false;
        return follows(x.site, y.site) || follows(y.site, x.site);
    }
    bool follows(Index x, Index y) const {
        const Index e = s_.edge_of(x), f = s_.edge_of(y);
        if (!s_.is_edge(x)) return f == e || (s_.is_edge(y) && f == s_.previous(e));
        return s_.after(e) == f && (!s_.is_edge(y) || s_.turn_at(f) != Turn::corner);
    }

    // Newton's method for the point as far from three sites.
    void polish(Point& p, Index a, Index b, Index c) const {
        constexpr double firm = 1e-6;        // sine of directions that fix a point at all
        constexpr double correction = 1e-6;  // of the extent: more leads to another point
        for (int i = 0; i < 2; ++i) {
            const Point da = s_.towards(a, p), ab = s_.towards(b, p) - da, ac = s_.towards(c, p) - da;
            if (!(std::abs(cross(ab, ac)) > firm)) return;
            const double ra = s_.distance_to(a, p);
            const Point step = solve_two(ab, ac, s_.distance_to(b, p) - ra, s_.distance_to(c, p) - ra);
            if (!(norm(step) <= correction * s_.extent)) return;
            p = p + step;
        }
    }
};

}  // namespace cspace::navigation::voronoi
