// Newton's method with barriers on a window of a section: intervals whose squared speeds change together.
//
// The squared speed is a quadratic spline, made of one middle coefficient of every interval. A window changes
// those of its intervals, but for the first and the last one beside a neighbour outside of it: the motion
// beyond a window stays as it is.
#pragma once

#include <cstddef>
#include <vector>

#include "cspace/math/banded.hpp"
#include "kernels/trajectory_jerk.hpp"
#include "trajectory_aligned.hpp"

namespace cspace::trajectory {

// The squared speed at an end of a section in terms of the middle coefficient beside it, and the largest one.
struct SectionEnd {
    double ratio, largest;
};

// A path between two stops, without its launch and its landing.
struct JerkSection {
    JerkPath path;
    SectionEnd start, end;
    std::vector<double> length, middle;  // (intervals,)
    std::vector<double> touched;         // (intervals,): squared speeds of the tangents for the jerks

    std::size_t size() const { return length.size(); }
    // The share of the next middle coefficient in the squared speed between intervals i and i + 1.
    double share(std::size_t i) const { return length[i] / (length[i] + length[i + 1]); }
    // The coefficients of interval i from the middle ones, middle(i); linear.
    template <class Middle>
    Squares spread(std::size_t i, const Middle& middle) const {
        const double own = middle(i);
        const auto mix = [&](std::size_t k, double a, double b) { return a + share(k) * (b - a); };
        return {{i == 0 ? start.ratio * own : mix(i - 1, middle(i - 1), own), own,
                 i + 1 == size() ? end.ratio * own : mix(i, own, middle(i + 1))}};
    }
    Squares squares(std::size_t i) const {
        return spread(i, [this](std::size_t k) { return middle[k]; });
    }
};

// Seconds of an interval.
double gauss_seconds(double length, const Squares& x);

class JerkWindow {
  public:
    // Of intervals begin … end − 1. The section has to last as long as the window.
    JerkWindow(JerkSection& section, std::size_t begin, std::size_t end);

    // Puts the tangents at the middles of the intervals.
    void touch_middles();
    // Whether the middle coefficients of the section keep all limits, from which on `minimize` can begin.
    bool is_within();
    // The shortest motion whose duration is within a tolerance, relative; into the section.
    void minimize(double tolerance);

  private:
    template <class Visit>
    void over_parts(const Visit& visit) const;
    void spread_middle();
    double seconds() const;
    double longest_step(const std::vector<double>& direction) const;
    BarrierTerms add_terms(std::size_t i, double weight) const;
    bool step(double weight, double& decrement);
    void add_interval(std::size_t i, const BarrierTerms& terms, std::vector<double>& gradient,
                      Pentadiagonal& hessian) const;
    void move_tangents();
    double measure_room(std::size_t i, double at) const;
    double middle(std::size_t i) const { return section_.middle[begin_ + i]; }
    double& touched(std::size_t i) const { return section_.touched[begin_ + i]; }
    double length(std::size_t i) const { return section_.length[begin_ + i]; }
    bool is_start() const { return begin_ == 0; }
    bool is_end() const { return begin_ + count_ == section_.size(); }

    JerkSection& section_;
    std::size_t begin_, count_;
    JerkPath path_;
    Aligned rows_;
    std::vector<double> largest_, jerks_;
    std::vector<Squares> x_, change_;
    std::vector<Tangent> tangents_;
    std::vector<BarrierTerms> terms_;
};

}  // namespace cspace::trajectory
