// The Halton tables that all planners of arms read.
#pragma once

#include "cspace/math/made_once.hpp"
#include "cspace/search/halton.hpp"

namespace cspace::planning {

inline const search::HaltonTable& halton_table(int width) {
    static const MadeOnce<search::HaltonTable> tables[search::most_dimensions + 1];
    return tables[width].get([&] { return std::make_unique<search::HaltonTable>(width); });
}

}  // namespace cspace::planning
