// What a PolygonCore holds: for files of the library, not for bindings.
#pragma once

#include <atomic>
#include <memory>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/math/made_once.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::maps {

// A value of one type, which is named where it is asked for.
class Memory {
  public:
    template <class T, class... Arguments>
    T& get(const Arguments&... arguments) {
        Holder& made = made_.get([&] { return std::make_unique<Held<T>>(arguments...); });
        return static_cast<Held<T>&>(made).value;
    }
    // Returns use(value), which changes it; amid another such call, from which a signal handler can come, it
    // gets a value of its own.
    template <class T, class Use, class... Arguments>
    auto lend(const Use& use, const Arguments&... arguments) {
        if (lent_.test_and_set()) {
            T own(arguments...);
            return use(own);
        }
        const Return at_end{lent_};
        return use(get<T>(arguments...));
    }

  private:
    struct Holder {
        virtual ~Holder() = default;
    };
    template <class T>
    struct Held final : Holder {
        template <class... Arguments>
        explicit Held(const Arguments&... arguments) : value(arguments...) {}
        T value;
    };
    struct Return {
        std::atomic_flag& lent;
        ~Return() { lent.clear(); }
    };
    MadeOnce<Holder> made_;
    std::atomic_flag lent_;
};

struct PolygonCore::State {
    State(Outlines outlines, double tolerance);

    const PolygonWorld world;
    const double tolerance;
    // What planners keep with a world. Each is used by one file of the library, which knows its type.
    Memory walls, sites, polyanya, visibility_graph, visibility, exact_cells, quadtree, voronoi, samples;

    Settled settle(Point p) const { return world.settle(p, tolerance); }
    // Start and goal taken off walls; false where one is not free.
    bool settle(Point start, Point goal, Settled& from, Settled& to) const {
        from = settle(start), to = settle(goal);
        return from.is_free() && to.is_free();
    }
};

}  // namespace cspace::maps
