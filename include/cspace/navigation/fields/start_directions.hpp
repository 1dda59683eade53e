// Directions in which free space begins at a point of its boundary.
//
// Where obstacles touch, free space has several sectors at one point, and the sum of their walls' normals may
// lead into an obstacle; so each triangle of free space at the point gives one direction that lies inside it.
#pragma once

#include <vector>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/fields/near_walls.hpp"

namespace cspace::navigation {

// Between the directions to b and c.
inline Point bisector(Point a, Point b, Point c) {
    return distance(a, c) * (b - a) + distance(a, b) * (c - a);
}

// None where walls are farther away than the tolerance.
inline std::vector<Point> find_start_directions(const maps::FreeSpace& space, const maps::Settled& from,
                                                const NearWalls& walls, double tolerance) {
    std::vector<Point> found;
    const auto add = [&](Point direction) {
        if (squared_norm(direction) > 0) found.push_back(direction);
    };
    for (const maps::Index t : from.triangles) {
        const auto corner = [&](int i) { return space.mesh.point(space.mesh[t].corner[std::size_t(i)]); };
        const maps::Place place = space.mesh.place_in(t, from.at);
        const Point b = corner(maps::after(place.index)), c = corner(maps::before(place.index));
        if (place.kind == maps::Place::at_corner)
            add(bisector(from.at, b, c));
        else if (place.kind == maps::Place::on_edge && space.is_wall(t, place.index))
            add({b.y - c.y, c.x - b.x});
        else
            add(walls.inward(from.at, tolerance));
    }
    return found;
}

}  // namespace cspace::navigation
