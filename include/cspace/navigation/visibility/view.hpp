// What a point sees: the triangles of free space are crossed one by one, each through the edge that the point
// sees, narrowed by the corners passed (Bungiu, Hemmer, Hershberger, Huang & Kröller 2014, "Efficient
// computation of visibility polygons"). Whether a corner narrows the view is an exact orientation of three
// given points.
#pragma once

#include "cspace/maps/sectors.hpp"

namespace cspace::navigation {

using maps::FreeSpace;
using maps::Index;
using maps::none;
using maps::Sectors;

// The line from one point to another; what lies beyond the second is seen along it.
struct Ray {
    Point from, to;
    int side(Point p) const { return orientation(from, to, p); }
};

// A part of the view: between two rays from the viewer.
struct Cone {
    Ray right, left;
};

class View {
  public:
    explicit View(const FreeSpace& space) : space_(space) {}

    // Looks from v, a point of the closed triangle t, through its edge e inside a cone. Calls enter(triangle,
    // cone) for every triangle that is looked into, and see(corner) for every corner that is seen, as 3t + i.
    // Corners behind one another on a line are all seen.
    template <class Enter, class See>
    void look(Point v, Index t, int e, Cone cone, Enter enter, See see) {
        stack_.push_back({t, e, cone});
        while (!stack_.empty()) {
            const Step step = stack_.back();
            stack_.pop_back();
            if (space_.is_wall(step.triangle, step.edge)) continue;
            ++triangles;
            enter(space_.mesh[step.triangle].across[std::size_t(step.edge)], step.cone);
            cross(v, step, see);
        }
    }
    std::int64_t triangles = 0;  // looked into so far

  private:
    struct Step {
        Index triangle;
        int edge;
        Cone cone;
    };
    const FreeSpace& space_;
    std::vector<Step> stack_;

    template <class See>
    void cross(Point v, const Step& step, See& see) {
        const maps::Triangulation& mesh = space_.mesh;
        const Index u = mesh[step.triangle].across[std::size_t(step.edge)];
        const int apex = mesh[u].edge_to(step.triangle);
        const Point w = mesh.point(mesh[u].corner[std::size_t(apex)]);
        const int of_right = step.cone.right.side(w), of_left = step.cone.left.side(w);
        if (of_right >= 0 && of_left <= 0) see(3 * u + apex);
        // In u the edge runs from the left of the view to its right; the apex divides what lies behind.
        const Ray through{v, w};
        if (of_right > 0) {
            const Cone part{step.cone.right, of_left < 0 ? through : step.cone.left};
            stack_.push_back({u, maps::after(apex), part});
        }
        if (of_left < 0) {
            const Cone part{of_right > 0 ? through : step.cone.right, step.cone.left};
            stack_.push_back({u, maps::before(apex), part});
        }
    }
};

}  // namespace cspace::navigation
