// A batch split over threads. Every row is computed alone, so the result does not depend on their number.
//
// Not for kernels: it uses the standard library.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace cspace {

// Calls body(begin, end) on parts of 0 … n, each a multiple of `step` rows long but the last, on at most
// `threads` threads (0: one per processor), fewer where a part would have less than `least` rows. True if
// all calls were.
template <class Body>
bool over_rows(std::size_t n, int threads, std::size_t step, std::size_t least, const Body& body) {
    const std::size_t wanted =
        threads > 0 ? std::size_t(threads) : std::max(1u, std::thread::hardware_concurrency());
    const std::size_t parts = std::clamp<std::size_t>(n / std::max<std::size_t>(least, 1), 1, wanted);
    const std::size_t part = ((n + parts - 1) / parts + step - 1) / step * step;
    std::atomic<bool> good = true;
    const auto run = [&](std::size_t begin) {
        if (begin < n && !body(begin, std::min(begin + part, n))) good = false;
    };
    std::vector<std::thread> helpers;
    helpers.reserve(parts);
    for (std::size_t k = 1; k < parts; ++k) {
        try {
            helpers.emplace_back(run, k * part);
        } catch (const std::system_error&) {
            run(k * part);  // no thread to be had: this one does the work
        }
    }
    run(0);
    for (auto& helper : helpers) helper.join();
    return good;
}

}  // namespace cspace
