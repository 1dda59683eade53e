// A batch split over threads. Every row is computed alone, so the result does not depend on their number.
//
// Not for kernels: it uses the standard library.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace {

namespace threads {

// The rows that are not yet taken, and what became of the others.
struct Work {
    std::size_t rows, step;
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> good = true, stopped = false;
    std::mutex busy = {};
    std::exception_ptr error = nullptr;
    std::size_t helping = 0;  // helpers at work
    std::condition_variable helped = {};

    void fail(std::exception_ptr thrown) {
        const std::lock_guard<std::mutex> lock(busy);
        if (!error) error = std::move(thrown);
        stopped = true;
    }
    void enter() {
        const std::lock_guard<std::mutex> lock(busy);
        ++helping;
    }
    void leave() {
        const std::lock_guard<std::mutex> lock(busy);
        --helping;
        helped.notify_one();
    }
    // Until the last helper has left; polls meanwhile, for their last rows may take long.
    void wait() {
        std::unique_lock<std::mutex> lock(busy);
        while (!helped.wait_for(lock, interrupts::least_period, [&] { return helping == 0; })) {
            if (stopped) continue;
            lock.unlock();
            try {
                poll_interrupts();
            } catch (...) {
                fail(std::current_exception());
            }
            lock.lock();
        }
    }
};

// Takes rows until none is left, in pieces of about a millisecond.
template <class Body>
void take_rows(Work& work, std::size_t piece, const Body& body) try {
    using std::chrono::microseconds;
    constexpr auto short_piece = microseconds(400), long_piece = microseconds(1200);
    while (work.good && !work.stopped) {
        const std::size_t begin = work.next.fetch_add(piece);
        if (begin >= work.rows) return;
        const auto began = interrupts::Clock::now();
        if (!body(begin, std::min(begin + piece, work.rows))) work.good = false;
        poll_interrupts();
        const auto spent = interrupts::Clock::now() - began;
        if (spent < short_piece)
            piece *= 2;
        else if (spent > long_piece)
            piece = std::max(piece / work.step / 2, std::size_t(1)) * work.step;
    }
} catch (...) {
    work.fail(std::current_exception());
}

}  // namespace threads

// Calls body(begin, end) on parts of 0 … n, each a multiple of `step` rows long but the last, on at most
// `threads` threads (0: one per processor), fewer where one would have less than `least` rows. True if all
// calls were; after one that was not, no later rows are begun. Throws what a call throws, or the check of
// interrupts.
template <class Body>
bool over_rows(std::size_t n, int threads, std::size_t step, std::size_t least, const Body& body) {
    const std::size_t wanted =
        threads > 0 ? std::size_t(threads) : std::max(1u, std::thread::hardware_concurrency());
    const std::size_t parts = std::clamp<std::size_t>(n / std::max<std::size_t>(least, 1), 1, wanted);
    const std::size_t piece = (std::min(least, (n + parts - 1) / parts) + step - 1) / step * step;
    if (n <= piece) return n == 0 || body(0, n);
    threads::Work work{n, step};
    const auto help = [&] {
        interrupts::stop_of_helper = &work.stopped;
        threads::take_rows(work, piece, body);
        work.leave();
    };
    std::vector<std::thread> helpers;
    helpers.reserve(parts);
    for (std::size_t k = 1; k < parts; ++k) {
        work.enter();
        try {
            helpers.emplace_back(help);
        } catch (const std::system_error&) {
            work.leave();
            break;  // no thread to be had: the others do the work
        }
    }
    threads::take_rows(work, piece, body);
    work.wait();
    for (auto& helper : helpers) helper.join();
    if (work.error) std::rethrow_exception(work.error);
    return work.good;
}

}  // namespace cspace
