// Rows on threads: whoever waits for helpers heeds interrupts.
#include <atomic>
#include <chrono>
#include <thread>

#include "check.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/threads.hpp"

using namespace cspace;

namespace {

struct Interrupted {};
std::atomic<bool> is_raised = false;

bool wait_for(const std::atomic<bool>& flag) {
    const auto end = interrupts::Clock::now() + std::chrono::seconds(20);
    while (!flag && interrupts::Clock::now() < end) std::this_thread::yield();
    return flag;
}

}  // namespace

TEST(a_caller_whose_rows_are_done_heeds_interrupts) {
    const auto caller = std::this_thread::get_id();
    std::atomic<bool> helping = false, stopped = false;
    set_interrupt_check([] {
        if (is_raised) throw Interrupted();
    });
    bool was_interrupted = false;
    const auto begin = interrupts::Clock::now();
    try {
        over_rows(2, 2, 1, 1, [&](std::size_t, std::size_t) {
            if (std::this_thread::get_id() == caller) return wait_for(helping);
            helping = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the caller is done
            is_raised = true;
            try {
                while (interrupts::Clock::now() - begin < std::chrono::seconds(20)) poll_interrupts();
            } catch (const Stopped&) {
                stopped = true;
                throw;
            }
            return true;
        });
    } catch (const Interrupted&) {
        was_interrupted = true;
    }
    is_raised = false;
    set_interrupt_check(nullptr);
    CHECK(was_interrupted && stopped);
    CHECK(interrupts::Clock::now() - begin < std::chrono::seconds(5));
}

TEST(what_a_helper_throws_ends_the_call) {
    for (int turn = 0; turn < 100; ++turn) {
        const auto caller = std::this_thread::get_id();
        std::atomic<bool> helping = false;
        bool was_thrown = false;
        try {
            over_rows(2, 2, 1, 1, [&](std::size_t, std::size_t) {
                if (std::this_thread::get_id() == caller) return wait_for(helping);
                helping = true;
                throw Interrupted();
            });
        } catch (const Interrupted&) {
            was_thrown = true;
        }
        CHECK(was_thrown);
    }
}
