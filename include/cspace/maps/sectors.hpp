// The sectors of free space around each point: the parts between two walls, or the full circle.
//
// Where obstacles meet in a point, free space has several sectors there that do not touch: a path through one
// does not come to the other.
#pragma once

#include "cspace/maps/free_space.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

struct Sector {
    Point at;
    Index first;  // its first corner counterclockwise, as 3t + i for corner i of triangle t
    Point begin,
        end;     // the ends of the walls that it begins and ends at, the sector on the left of the first
    bool turns;  // whether it is larger than half a turn and ends at walls: paths turn there
};

struct Sectors {
    std::vector<Index> of;  // of corner i of triangle t at 3t + i
    std::vector<Sector> all;
};

inline Sectors find_sectors(const FreeSpace& space) {
    const Triangulation& mesh = space.mesh;
    Sectors found;
    found.of.assign(3 * mesh.triangles.size(), none);
    InterruptPoll poll(1024);
    for (Index seed = 0; seed < Index(found.of.size()); ++seed) {
        poll.step();
        if (!space.is_free(seed / 3) || found.of[std::size_t(seed)] != none) continue;
        Index t = seed / 3;
        int i = int(seed % 3);
        const Index v = mesh[t].corner[std::size_t(i)];
        while (!space.is_wall(t, previous_corner(i))) {  // clockwise to a wall, or once around
            t = mesh[t].across[std::size_t(previous_corner(i))];
            i = mesh[t].place_of(v);
            if (t == seed / 3) break;
        }
        const bool has_walls = space.is_wall(t, previous_corner(i));
        const Point first = mesh.point(mesh[t].corner[std::size_t(next_corner(i))]), center = mesh.point(v);
        const Index sector = Index(found.all.size()), first_corner = 3 * t + i;
        for (;;) {
            found.of[std::size_t(3 * t + i)] = sector;
            if (space.is_wall(t, next_corner(i))) break;
            t = mesh[t].across[std::size_t(next_corner(i))];
            i = mesh[t].place_of(v);
            if (found.of[std::size_t(3 * t + i)] == sector) break;
        }
        const Point last = mesh.point(mesh[t].corner[std::size_t(previous_corner(i))]);
        const int turn = orientation(last, center, first);
        const bool turns =
            has_walls && (turn < 0 || (turn == 0 && (first == last || !is_between(last, center, first))));
        found.all.push_back({center, first_corner, first, last, turns});
    }
    return found;
}

}  // namespace cspace::maps
