// Free space cut into regions that a robot can sweep to and fro (Choset & Pignon 1997): a new region begins
// wherever the free part of a line splits, joins, appears or ends.
#pragma once

#include <vector>

#include "cspace/navigation/coverage/sweep_frame.hpp"

namespace cspace::navigation {

// A part of a line without obstacles, both ends included.
struct FreeRun {
    int line, first, last;
    int region;
};

struct SweepRegion {
    std::vector<FreeRun> runs;  // one on each of its lines, in order
};

struct Decomposition {
    std::vector<SweepRegion> regions;
    std::vector<std::int32_t> region_of;  // of each place, −1 where it is not to be swept
};

// reach: which places are to be swept.
inline std::vector<FreeRun> free_runs(const SweepFrame& frame, const std::vector<char>& reach, int line) {
    std::vector<FreeRun> runs;
    for (int at = 0; at < frame.length(); ++at) {
        if (!reach[std::size_t(frame.number(line, at))]) continue;
        const int first = at;
        while (at + 1 < frame.length() && reach[std::size_t(frame.number(line, at + 1))]) ++at;
        runs.push_back({line, first, at, -1});
    }
    return runs;
}

inline Decomposition decompose(const SweepFrame& frame, const std::vector<char>& reach) {
    Decomposition made;
    made.region_of.assign(std::size_t(frame.size()), -1);
    std::vector<FreeRun> before;
    for (int line = 0; line < frame.lines(); ++line) {
        std::vector<FreeRun> runs = free_runs(frame, reach, line);
        std::vector<int> onward(before.size()), back(runs.size()), behind(runs.size(), -1);
        std::size_t from = 0;
        for (std::size_t k = 0; k < runs.size(); ++k) {
            while (from < before.size() && before[from].last < runs[k].first) ++from;
            for (std::size_t b = from; b < before.size() && before[b].first <= runs[k].last; ++b)
                ++onward[b], ++back[k], behind[k] = int(b);
        }
        for (std::size_t k = 0; k < runs.size(); ++k) {
            const bool goes_on = back[k] == 1 && onward[std::size_t(behind[k])] == 1;
            runs[k].region = goes_on ? before[std::size_t(behind[k])].region : int(made.regions.size());
            if (!goes_on) made.regions.emplace_back();
            made.regions[std::size_t(runs[k].region)].runs.push_back(runs[k]);
            for (int at = runs[k].first; at <= runs[k].last; ++at)
                made.region_of[std::size_t(frame.number(line, at))] = runs[k].region;
        }
        before = std::move(runs);
    }
    return made;
}

}  // namespace cspace::navigation
