// The boundary loops that a robot has followed all around, assembled from the corners that it passed.
#pragma once

#include <map>
#include <optional>

#include "cspace/navigation/bugs/boundary_tour.hpp"

namespace cspace::navigation {

class RingBook {
  public:
    void add(const Touch& corner) { after_.insert_or_assign(corner.in.name, corner); }
    void clear() { after_.clear(); }

    // Whether a point lies on a wall that the robot came by.
    bool is_on_wall(Point p) const {
        for (const auto& [name, corner] : after_)
            if (is_on(corner.in, p) || is_on(corner.out, p)) return true;
        return false;
    }

    // Where the line to the goal enters a whole ring that has the goal on its other side.
    std::optional<Touch> shuts_off(Point goal) const {
        std::map<int, bool> judged;
        for (const auto& [name, corner] : after_) {
            if (judged[name]) continue;
            Round round(goal, corner);
            const Touch* at = &corner;
            for (std::size_t walked = 0; at && walked <= after_.size(); ++walked) {
                judged[at->in.name] = true;
                const Wall piece = at->out;
                const auto next = after_.find(piece.name);
                at = next == after_.end() ? nullptr : &next->second;
                if (!at) break;
                round.add(piece, piece.begin, piece.end);
                round.add(*at);
                if (at->in.name != name) continue;
                if (round.shuts_off_goal()) return round.blocked.touch;
                break;
            }
        }
        return {};
    }

  private:
    std::map<int, Touch> after_;  // the corner at which each wall ends
};

}  // namespace cspace::navigation
