// Where a disc that follows two sites first touches a third.
#pragma once

#include "cspace/navigation/voronoi/diagram.hpp"

namespace cspace::navigation::voronoi {

// Lengths below which two places are one.
struct Grain {
    double fine, share;  // absolute [m], and per radius
    double at(double radius) const { return fine + share * radius; }
};

// Tried in this order, the lengths as shares of the extent: worlds of tiny and of nearly equal lengths need
// the finer or the coarser one.
inline constexpr Grain grains[] = {{1e-13, 1e-9}, {1e-15, 1e-12}, {1e-11, 1e-7}};

// The grain of shares of the extent in the lengths of a world; none is finer than its coordinates.
inline Grain grain_in(const Sites& sites, Grain shares) {
    return {std::max(shares.fine * sites.extent, 2 * sites.spacing), shares.share};
}

class FirstTouch {
  public:
    FirstTouch(const Sites& sites, Grain grain, const Bisector& curve, Index a, Index b, double begin,
               double end)
        : sites_(sites), grain_(grain), curve_(curve), a_(a), b_(b), begin_(begin), end_(end) {
        slack_ = grain.at(curve.radius(begin)) / norm(curve.velocity(begin));
        into_corner_ = sites.is_edge(a) && sites.is_edge(b) && sites.after(a) == b;
    }

    double at() const { return end_; }
    Index site() const { return site_; }  // none: nothing is touched up to the end

    void find() {
        shorten();
        for (double t = begin_, step = end_ - begin_; t < end_;) {
            const double stop = std::min(t + step, end_);
            if (!sweep(t, stop, step > (end_ - begin_) / 4096)) {
                step /= 2;
                continue;
            }
            if (stop >= end_ || !(stop > t)) break;
            t = stop;
            step *= 2;
        }
    }

  private:
    const Sites& sites_;
    Grain grain_;
    const Bisector& curve_;
    Index a_, b_;
    double begin_, end_, slack_;
    Index site_ = none;
    bool into_corner_;  // the arc ends where a meets b

    // Takes the end back, touch by touch, as long as something reaches into the disc there.
    void shorten() {
        for (int tries = 0; tries < 64; ++tries) {
            const Point p = curve_.at(end_);
            double radius = curve_.radius(end_) * (1 - tolerance::widening);
            Index nearest = none;
            const EitherSide ahead{gained(begin_, end_), gained(begin_, end_)};
            sites_.tree.visit_shrinking(
                p, ahead, [&] { return std::pair{p, radius}; },
                [&](Index e) {
                    if (sites_.belongs(e, a_) || sites_.belongs(e, b_)) return;
                    const double s = std::clamp(sites_.advance(e, p), 0.0, sites_.length[std::size_t(e)]);
                    const double d = distance(p, sites_.begin(e) + s * sites_.direction(e));
                    if (d < radius) radius = d, nearest = e;
                });
            if (nearest == none) return;
            const double before = end_;
            consider(nearest);
            consider(sites_.after(nearest));
            if (!(end_ < before)) return;
        }
    }

    // The side on which lies all that the disc at t1 reaches and the disc at t0 does not: that of the line
    // through where their circles cross.
    Side gained(double t0, double t1) const {
        const Point p = curve_.at(t0), q = curve_.at(t1);
        const double r = curve_.radius(t0), s = curve_.radius(t1), apart = distance(p, q);
        constexpr double parted = 1e-7;  // of the radius: closer, rounding turns the line of both
        if (!(apart > parted * r)) return {};
        const Point way = (1 / apart) * (q - p);
        return {way, dot(way, 0.5 * (p + q)) + (r - s) * (r + s) / (2 * apart) - 1e2 * grain_.at(r)};
    }
    // All that discs between t0 and t1 reach and the disc at t0 does not: those lines cross in a point, where
    // one site is one, or never; so they turn from that through the feet at t0 to that of the last disc.
    EitherSide gained_between(double t0, double t1) const {
        const Point p = curve_.at(t0), velocity = curve_.velocity(t0);
        const Point way = (1 / norm(velocity)) * velocity;
        const double r = curve_.radius(t0);
        const double foot = std::min(dot(way, sites_.towards(a_, p)), dot(way, sites_.towards(b_, p)));
        return {Side{way, dot(way, p) + r * foot - 1e2 * grain_.at(r)}, gained(t0, t1)};
    }

    // Looks at all walls that discs between two parameters may meet; false where they are many and a shorter
    // stretch would do better.
    bool sweep(double t0, double t1, bool may_refuse) {
        const Point center = curve_.at(0.5 * (t0 + t1));
        const double speed = std::max(norm(curve_.velocity(t0)), norm(curve_.velocity(t1)));
        const double half = 0.5 * (t1 - t0) * speed, largest = std::max(curve_.radius(t0), curve_.radius(t1));
        const double reach = (largest + half) * (1 + tolerance::widening) + grain_.fine;
        const EitherSide ahead = gained_between(t0, t1);
        Index found[24];
        int count = 0;
        const bool all = sites_.tree.visit_disc(center, reach, ahead, [&](Index e) {
            if (count == 24) return false;
            found[count++] = e;
            return true;
        });
        if (all) {
            for (int i = 0; i < count; ++i) consider(found[i]);
            return true;
        }
        if (may_refuse && half > 0.25 * largest) return false;
        sites_.tree.visit_disc(center, reach, ahead, [&](Index e) { return consider(e), true; });
        return true;
    }

    void consider(Index e) {
        const Point q = sites_.begin(e);
        if (into_corner_ && (q == sites_.begin(b_) || sites_.end(e) == sites_.begin(b_))) return;
        if (!sites_.belongs(e, a_) && !sites_.belongs(e, b_))
            for (const double t : curve_.against_line(sites_.normal(e), q).zeros()) {
                if (!is_ahead(t)) continue;
                const double margin = 1e3 * grain_.at(curve_.radius(t));
                if (sites_.height(e, curve_.at(t)) >= 0 && sites_.is_beside(e, curve_.at(t), margin))
                    touch(t, e);
            }
        if (sites_.turn_at(e) != Turn::around || sites_.ends(q, a_) || sites_.ends(q, b_)) return;
        for (const double t : curve_.against_point(q).zeros())
            if (is_ahead(t) && sites_.is_in_cone(e, curve_.at(t), 1e3 * grain_.at(curve_.radius(t))))
                touch(t, sites_.size() + e);
    }
    bool is_ahead(double t) const { return t >= begin_ - slack_ && t <= end_ + (site_ == none ? slack_ : 0); }

    // A touch counts if it comes from the front, from between the feet on the two sites.
    void touch(double t, Index site) {
        if (!(curve_.radius(t) > 10 * grain_.fine)) return;
        const Point p = curve_.at(t), way = curve_.velocity(t);
        if (!(dot(sites_.towards(site, p) - sites_.towards(a_, p), way) > 0)) return;
        end_ = std::clamp(t, begin_, end_);
        site_ = site;
    }
};

}  // namespace cspace::navigation::voronoi
