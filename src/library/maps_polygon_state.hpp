// What a PolygonCore holds: for files of the library, not for bindings.
#pragma once

#include <atomic>
#include <memory>

#include "cspace/maps/polygon_world.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::maps {

// A value of one type, made when first asked for. Of two threads that make it at once, the first keeps its
// own.
class MadeOnce {
  public:
    MadeOnce() = default;
    MadeOnce(const MadeOnce&) = delete;
    MadeOnce& operator=(const MadeOnce&) = delete;
    ~MadeOnce() {
        if (Holder* made = made_.load()) delete made;
    }
    template <class T, class... Arguments>
    T& get(const Arguments&... arguments) {
        Holder* made = made_.load(std::memory_order_acquire);
        if (!made) {
            auto fresh = std::make_unique<Held<T>>(arguments...);
            if (made_.compare_exchange_strong(made, fresh.get())) made = fresh.release();
        }
        return static_cast<Held<T>*>(made)->value;
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
    std::atomic<Holder*> made_ = nullptr;
};

struct PolygonCore::State {
    State(Outlines outlines, double tolerance);

    const PolygonWorld world;
    const double tolerance;
    // What planners keep with a world. Each is used by one file of the library, which knows its type.
    MadeOnce walls, surroundings, polyanya, visibility, exact_cells, quadtree, voronoi, samples;

    Settled settle(Point p) const;
};

}  // namespace cspace::maps
