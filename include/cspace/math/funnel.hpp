// The shortest path through a row of gaps (Lee & Preparata 1984, "Euclidean shortest paths in the presence of
// rectilinear barriers"): the funnel between the strings that are pulled taut along the left and the right
// ends of the gaps.
#pragma once

#include <cstddef>
#include <vector>

#include "cspace/math/predicates.hpp"

namespace cspace {

struct Portal {
    Point left, right;                                 // as seen by who passes
    bool left_is_open = false, right_is_open = false;  // an end so far away that no string comes to it
};

class Funnel {
  public:
    explicit Funnel(Point start) : path_{start} {}

    void pass(const Portal& gap) {
        extend(left_, right_, {gap.left, gap.right, gap.left_is_open}, -1);
        extend(right_, left_, {gap.right, gap.left, gap.right_is_open}, 1);
    }
    // The path to the goal behind the last gap.
    std::vector<Point> finish(Point goal) {
        pass({goal, goal});
        for (std::size_t i = right_.first; i < right_.points.size(); ++i) add(right_.points[i].at);
        return path_;
    }

  private:
    // The string from the last point of the path along one side; points before `first` are part of the path
    // by now.
    struct End {
        Point at, other;  // the other end of the gap
        bool is_open;
    };
    struct String {
        std::vector<End> points;
        std::size_t first = 0;
        bool empty() const { return first == points.size(); }
        End front() const { return points[first]; }
    };
    std::vector<Point> path_;
    String left_, right_;

    void add(Point p) {
        if (!(path_.back() == p)) path_.push_back(p);
    }
    // Of three points on one line: whether the string must go to the middle one and back, as around the end
    // of a wall. It need not where the gap lies along the line and reaches back over the first.
    static bool turns_back(Point before, const End& last, Point end) {
        const Point back = before - last.at, gap = last.other - last.at;
        if (last.is_open || dot(back, end - last.at) <= 0) return false;
        return gap.x * back.y != gap.y * back.x || dot(gap, back) <= 0;
    }
    // Pulls the string of one side (hand 1: right) taut to a new end. Where that leads across the other
    // side's string, the path is certain up to there.
    void extend(String& own, String& other, End end, int hand) {
        while (!own.empty()) {
            const std::size_t n = own.points.size();
            const End last = own.points[n - 1];
            const Point before = n - 1 == own.first ? path_.back() : own.points[n - 2].at;
            const int turn = hand * orientation(before, last.at, end.at);
            if (turn < 0 || (turn == 0 && turns_back(before, last, end.at))) break;
            own.points.pop_back();
        }
        while (own.empty() && !other.empty() &&
               hand * orientation(path_.back(), other.front().at, end.at) > 0) {
            if (!other.front().is_open) add(other.front().at);
            ++other.first;
        }
        own.points.push_back(end);
    }
};

}  // namespace cspace
