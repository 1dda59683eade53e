// Shorter paths by shortcuts: between rows of the path, then between any two places on it (Geraerts &
// Overmars 2007, "Creating high-quality paths for motion planning", give the variants). A part of a checked
// edge needs no check, so every shortcut leaves a path as good as the one before.
#pragma once

#include <array>
#include <cstdint>

#include "cspace/planning/path.hpp"

namespace cspace::planning {

// A space offers is_free(a, b) for rows of doubles, and has_time().
template <class Space>
class Simplifier {
  public:
    static constexpr std::size_t most_coordinates = 64;
    // Shortcuts between any places: so many are tried, and so many in a row may fail.
    static constexpr int most_tries = 80, most_failures = 12;
    // The least gain of a shortcut, as a share of the length of the path.
    static constexpr double least_gain = 0.005;

    Simplifier(Space& space, Path& path) : space_(space), path_(path), shorter_(path.width()), arcs_(path) {}

    // The ends stay. The straight edge between them is known to be blocked.
    void run() {
        if (path_.size() < 3) return;
        skip_rows();
        shorten_anywhere();
    }

  private:
    Space& space_;
    Path& path_;
    Path shorter_;
    ArcLengths arcs_;

    // From each row to the farthest that can be joined.
    void skip_rows() {
        shorter_.clear();
        std::size_t at = 0;
        shorter_.append(path_.row(0), Path::checked);
        while (at + 1 < path_.size()) {
            std::size_t to = path_.size() - 1 - (at == 0);
            while (to > at + 1 && !(space_.has_time() && space_.is_free(path_.row(at), path_.row(to)))) --to;
            shorter_.append(path_.row(to), to == at + 1 ? path_.source(at) : Path::checked);
            at = to;
        }
        replace_path();
    }

    // The pairs of places follow the R₂ sequence (Roberts 2018, "The unreasonable effectiveness of
    // quasirandom sequences").
    void shorten_anywhere() {
        constexpr double step_1 = 0.7548776662466927, step_2 = 0.5698402909980532;
        double u = 0.5, v = 0.5;
        int failures = 0;
        for (int i = 0; i < most_tries && failures < most_failures && path_.size() > 2; ++i) {
            if (!space_.has_time()) return;
            u += step_1, v += step_2;
            u -= std::floor(u), v -= std::floor(v);
            const double total = arcs_.total();
            failures = try_shortcut(std::min(u, v) * total, std::max(u, v) * total) ? 0 : failures + 1;
        }
    }
    bool try_shortcut(double from, double to) {
        const Place a = arcs_.find_place(from), b = arcs_.find_place(to);
        if (a.edge == b.edge) return false;
        std::array<double, most_coordinates> p, q;
        interpolate(path_, a, p.data());
        interpolate(path_, b, q.data());
        const double gain = to - from - row_distance(p.data(), q.data(), path_.width());
        if (gain < least_gain * arcs_.total() || !space_.is_free(p.data(), q.data())) return false;
        shorter_.clear();
        for (std::size_t i = 0; i <= a.edge; ++i)
            shorter_.append(path_.row(i), i == 0 ? 0 : path_.source(i - 1));
        if (a.share > 0) shorter_.append(p.data(), path_.source(a.edge));
        shorter_.append(q.data(), Path::checked);
        for (std::size_t i = b.edge + (b.share < 1 ? 1 : 2); i < path_.size(); ++i)
            shorter_.append(path_.row(i), path_.source(i - 1));
        replace_path();
        return true;
    }
    void replace_path() {
        std::swap(path_, shorter_);
        arcs_.measure(path_);
    }
};

}  // namespace cspace::planning
