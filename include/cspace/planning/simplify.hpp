// Shorter paths: shortcuts around the corners of a path (Geraerts & Overmars 2007, "Creating high-quality
// paths for motion planning", compare the variants), and corners pulled inwards. A part of a checked edge
// needs no check, so every step leaves a path as good as the one before.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "cspace/planning/path.hpp"

namespace cspace::planning {

// A space offers is_free(a, b) for rows of doubles, and has_time().
template <class Space>
class Simplifier {
  public:
    static constexpr std::size_t most_coordinates = 64;
    static constexpr int most_rounds = 4;
    // As a share of the length of the path: of a pulled corner, and of a shortcut where corners are few; of a
    // shortcut per number of corners, and where they are many; of a round.
    static constexpr double least_gain = 0.01, gain_per_corner = 0.02, finest_gain = 0.001;
    static constexpr double least_round_gain = 0.02;
    // So many shortcuts in a row may fail, and so many per corner where there are more.
    static constexpr double least_failures = 7, failures_per_corner = 1.5;
    // How far a corner is pulled towards the straight line past it.
    static constexpr double pulls[] = {0.5, 0.25};

    Simplifier(Space& space, Path& path) : space_(space), path_(path), shorter_(path.width()), arcs_(path) {}

    // The ends stay. The straight edge between them is known to be blocked.
    void run() {
        if (!has_corners()) return;
        skip_rows();
        for (int round = 0; round < most_rounds && has_corners(); ++round) {
            const double before = arcs_.total();
            cut_corners();
            pull_corners();
            if (!space_.has_time() || arcs_.total() > (1 - least_round_gain) * before) return;
        }
    }

  private:
    using Row = std::array<double, most_coordinates>;

    Space& space_;
    Path& path_;
    Path shorter_;
    ArcLengths arcs_;
    double u_ = 0.5, v_ = 0.5;

    bool has_corners() const { return path_.size() > 2; }

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

    // Shortcuts around corners, near ones more often than far ones.
    void cut_corners() {
        int failures = 0;
        const auto most_failures = [&] {
            return std::max(least_failures, failures_per_corner * double(path_.size() - 2));
        };
        while (has_corners() && failures < most_failures() && space_.has_time()) {
            draw_pair();
            const std::size_t corners = path_.size() - 2;
            const std::size_t corner = 1 + std::min(std::size_t(u_ * double(corners)), corners - 1);
            const double at = arcs_.upto(corner), share = v_ * v_ * v_;
            failures = try_shortcut(at - share * at, at + share * (arcs_.total() - at)) ? 0 : failures + 1;
        }
    }
    // The R₂ sequence (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
    void draw_pair() {
        constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;
        u_ += step_u, v_ += step_v;
        u_ -= std::floor(u_), v_ -= std::floor(v_);
    }
    bool try_shortcut(double from, double to) {
        const Place a = arcs_.find_place(from), b = arcs_.find_place(to);
        if (a.edge == b.edge) return false;
        Row p, q;
        interpolate_path(path_, a, p.data());
        interpolate_path(path_, b, q.data());
        const double gain = to - from - row_distance(p.data(), q.data(), path_.width());
        const double share = std::clamp(gain_per_corner / double(path_.size() - 2), finest_gain, least_gain);
        if (gain < share * arcs_.total() || !space_.is_free(p.data(), q.data())) return false;
        shorter_.clear();
        shorter_.append(path_.row(0), Path::checked);
        for (std::size_t i = 1; i <= a.edge; ++i) shorter_.append(path_.row(i), path_.source(i - 1));
        if (a.share > 0) shorter_.append(p.data(), path_.source(a.edge));
        shorter_.append(q.data(), Path::checked);
        for (std::size_t i = b.edge + (b.share < 1 ? 1 : 2); i < path_.size(); ++i)
            shorter_.append(path_.row(i), path_.source(i - 1));
        replace_path();
        return true;
    }

    // Moves each corner towards the straight line between the rows beside it.
    void pull_corners() {
        for (std::size_t i = 1; i + 1 < path_.size() && space_.has_time(); ++i) pull_corner(i);
        arcs_.measure(path_);
    }
    void pull_corner(std::size_t i) {
        const std::size_t width = path_.width();
        const double *before = path_.row(i - 1), *at = path_.row(i), *after = path_.row(i + 1);
        const double to = row_distance(before, at, width), from = row_distance(at, after, width);
        if (to + from - row_distance(before, after, width) < least_gain * arcs_.total()) return;
        Row pulled;
        for (const double share : pulls) {
            for (std::size_t k = 0; k < width; ++k) {
                const double straight = before[k] + to / (to + from) * (after[k] - before[k]);
                const double x = at[k] + share * (straight - at[k]);
                const auto [low, high] = std::minmax({before[k], at[k], after[k]});
                pulled[k] = std::clamp(x, low, high);
            }
            if (!space_.is_free(before, pulled.data()) || !space_.is_free(pulled.data(), after)) continue;
            return path_.move_row(i, pulled.data());
        }
    }
    void replace_path() {
        std::swap(path_, shorter_);
        arcs_.measure(path_);
    }
};

}  // namespace cspace::planning
