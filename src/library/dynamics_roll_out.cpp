#include "dynamics_roll_out.hpp"

#include <algorithm>

#include "cspace/math/threads.hpp"
#include "scratch.hpp"

namespace cspace::dynamics {
namespace {

using Clock = std::chrono::steady_clock;

// How long a kernel works between two looks at the clock, at most twice as long as this.
constexpr auto short_while = std::chrono::microseconds(500);
// Steps of the adaptive method between two looks.
constexpr int adaptive_steps = 16;
// States of a row that are worth a thread.
constexpr long long steps_worth_a_thread = 2048;

bool is_any_running(const RollOut& task, std::size_t begin, std::size_t end) {
    return std::any_of(task.status + begin, task.status + end, [](int status) { return status == running; });
}

// Ends the rows that still run, row by row at its time, if the deadline has passed.
template <class TimeOf>
bool end_late_rows(const RollOut& task, std::size_t begin, std::size_t end, Deadline deadline,
                   const TimeOf& time_of) {
    if (deadline == Deadline::max() || Clock::now() <= deadline) return false;
    for (std::size_t i = begin; i < end; ++i) {
        if (task.status[i] != running) continue;
        task.status[i] = out_of_time;
        task.stopped[i] = time_of(i);
    }
    return true;
}

// The rows of one part, by steps of one length.
void roll_part(const RollOut& task, std::size_t begin, std::size_t end, long long k, long long k_end,
               Deadline deadline, void* scratch) {
    long long stride = 1;
    while (k < k_end && is_any_running(task, begin, end)) {
        if (end_late_rows(task, begin, end, deadline, [&](std::size_t) { return task.find_time(k); })) return;
        const long long next = std::min(k_end, k + stride);
        const auto began = Clock::now();
        kernels::roll_out_fixed(task, begin, end, k, next, scratch);
        poll_interrupts();
        const auto spent = Clock::now() - began;
        if (spent < short_while / 2)
            stride *= 2;
        else if (spent > 2 * short_while)
            stride = std::max(stride / 2, 1LL);
        k = next;
    }
}

// The rows of one part, by the adaptive method over steps between which what acts is smooth. values: room
// for the steps of one call.
void roll_smooth_part(const RollOut& task, std::size_t begin, std::size_t end, long long k, long long k_end,
                      Deadline deadline, void* scratch, std::vector<double>& values,
                      std::vector<std::vector<double>>& kept) {
    const std::size_t width = std::size_t(task.piece_width());
    bool is_fresh = true, is_done = false;
    while (!is_done && is_any_running(task, begin, end)) {
        int count[part_rows] = {};
        PieceBuffer pieces = {values.data(), count, adaptive_steps};
        is_done = kernels::roll_out_adaptive(task, begin, end, k, k_end, is_fresh, pieces, scratch);
        is_fresh = false;
        for (std::size_t i = begin; i < end; ++i) {
            const double* from = &values[(i - begin) * std::size_t(adaptive_steps) * width];
            kept[i].insert(kept[i].end(), from, from + std::size_t(count[i - begin]) * width);
        }
        poll_interrupts();
        if (end_late_rows(task, begin, end, deadline, [&](std::size_t i) { return task.time[i]; })) return;
    }
}

void roll_part_adaptively(const RollOut& task, std::size_t begin, std::size_t end, long long k,
                          long long k_end, Deadline deadline, void* scratch,
                          std::vector<std::vector<double>>& kept) {
    const long long last = std::min(k_end, task.steps), stride = task.is_held ? 1 : std::max(1LL, last - k);
    std::vector<double> values(part_rows * std::size_t(adaptive_steps) * std::size_t(task.piece_width()));
    for (; k < last && is_any_running(task, begin, end); k += stride)
        roll_smooth_part(task, begin, end, k, k + stride, deadline, scratch, values, kept);
    if (k_end > task.steps && is_any_running(task, begin, end))
        kernels::roll_out_fixed(task, begin, end, task.steps, k_end, scratch);
}

// f(begin, end, scratch) for the parts of all rows. steps: of each row.
template <class F>
void over_parts(const RollOut& task, std::size_t rows, long long steps, int threads, const F& f) {
    const std::size_t per_thread = std::size_t(std::max(1LL, steps_worth_a_thread / std::max(1LL, steps)));
    const std::size_t least = std::max(part_rows, per_thread);
    over_rows(rows, threads, part_rows, least, [&](std::size_t begin, std::size_t end) {
        const Scratch scratch = make_scratch(scratch_bytes(task));
        for (; begin < end; begin += part_rows) f(begin, std::min(end, begin + part_rows), scratch.get());
        return true;
    });
}

}  // namespace

void roll_out(const RollOut& task, std::size_t rows, long long k, long long k_end, int threads,
              Deadline deadline) {
    over_parts(task, rows, k_end - k, threads, [&](std::size_t begin, std::size_t end, void* scratch) {
        roll_part(task, begin, end, k, k_end, deadline, scratch);
    });
}

void roll_out_adaptively(const RollOut& task, std::size_t rows, long long k, long long k_end, int threads,
                         Deadline deadline, std::vector<std::vector<double>>& pieces) {
    over_parts(task, rows, k_end - k, threads, [&](std::size_t begin, std::size_t end, void* scratch) {
        roll_part_adaptively(task, begin, end, k, k_end, deadline, scratch, pieces);
    });
}

}  // namespace cspace::dynamics
