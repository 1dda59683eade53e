// The edges of one problem of an arm, as the planners check them.
#pragma once

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "cspace/math/interrupts.hpp"
#include "cspace/planning/box.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/row_leaves.hpp"
#include "kernels/search.hpp"
#include "planning_arm.hpp"

namespace cspace::planning {

using collision::Contact;
using collision::Verdict;
using interrupts::Clock;

// The bounds in floats, none outside of those given; joints that wrap have their whole period.
class FloatBounds {
  public:
    explicit FloatBounds(const ArmSpace& space) {
        const int width = space.checker.dof();
        const bool any_wraps = std::any_of(space.wraps.begin(), space.wraps.end(), [](auto w) { return w; });
        box_ = {width, lower_, upper_, any_wraps ? space.wraps.data() : nullptr};
        for (int k = 0; k < width; ++k) {
            const double low = box_.is_wrapping(k) ? -pi : space.lower[std::size_t(k)];
            const double high = box_.is_wrapping(k) ? pi : space.upper[std::size_t(k)];
            lower_[k] = float(low), upper_[k] = float(high);
            if (lower_[k] < low) lower_[k] = std::nextafter(lower_[k], upper_[k]);
            if (upper_[k] > high) upper_[k] = std::nextafter(upper_[k], lower_[k]);
        }
    }
    FloatBounds(const FloatBounds&) = delete;
    FloatBounds& operator=(const FloatBounds&) = delete;
    const Box& box() const { return box_; }

  private:
    float lower_[collision::most_coordinates], upper_[collision::most_coordinates];
    Box box_;
};

// How often each pair of a link and what it touched blocked an edge.
class BlockerTally {
  public:
    void add(const Contact& contact) {
        if (!last_ || !is_same(last_->first, contact)) {
            last_ = &counts_[key_of(contact)];
            last_->first = contact;
        }
        ++last_->second;
    }
    // The pair with the greatest count, of equal ones that of the least numbers.
    void write_most(ArmPlan& plan) const {
        std::uint64_t best = 0;
        for (const auto& [key, entry] : counts_)
            if (entry.second > plan.blocker_edges || (entry.second == plan.blocker_edges && key < best))
                plan.blocker = entry.first, plan.blocker_edges = entry.second, best = key;
    }

  private:
    using Entry = std::pair<Contact, std::int64_t>;
    std::unordered_map<std::uint64_t, Entry> counts_;
    Entry* last_ = nullptr;

    static bool is_same(const Contact& a, const Contact& b) {
        return a.link == b.link && a.other == b.other && a.is_pair == b.is_pair;
    }
    static std::uint64_t key_of(const Contact& c) {
        return std::uint64_t(c.is_pair) << 63 | std::uint64_t(c.link) << 32 | std::uint64_t(c.other);
    }
};

// The edges of one problem, and its clock.
class ArmEdges {
  public:
    ArmEdges(const ArmSpace& space, const ArmOptions& options, const FloatBounds& bounds)
        : checker_(space.checker),
          options_(options),
          box_(bounds.box()),
          memory_(checker_.borrow_workspace()),
          is_search_proved_(options.search == EdgeTest::proved) {
        checker_.reset_workspace(*memory_);
        if (options.time_limit < longest_limit)
            deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(options.time_limit));
    }

    const Box& box() const { return box_; }
    search::NearRow find_nearest(const search::ConfigurationTree& tree, const float* q) const {
        return kernels::find_nearest(tree.blocks(), tree.size(), tree.width(), q, box_.wraps);
    }

    // leaves: hold the first rows of the tree.
    search::NearRow find_nearest(const search::ConfigurationTree& tree, search::RowLeaves& leaves,
                                 const float* q) const {
        if (leaves.size() == 0) return find_nearest(tree, q);
        search::NearRow found;
        find_nearest(tree, leaves, q, 1, &found);
        return found;
    }
    // Up to so many, the nearest first; returns how many.
    int find_nearest(const search::ConfigurationTree& tree, search::RowLeaves& leaves, const float* q,
                     int most, search::NearRow* found) const {
        const int sorted = leaves.size(), width = tree.width();
        int count = kernels::find_nearest_rows(tree.blocks() + std::ptrdiff_t(sorted) * width,
                                               tree.size() - sorted, width, q, box_.wraps, most, found);
        for (int i = 0; i < count; ++i) found[i].row += sorted;
        if (sorted == 0) return count;
        return kernels::find_nearest_in_leaves(leaves.view(), width, q, box_.wraps, most, leaves.scratch(),
                                               found, count);
    }
    search::NearRow find_nearest_within(const search::ConfigurationTree& tree, const float* q,
                                        float bound) const {
        return kernels::find_nearest_within(tree.blocks(), tree.costs(), tree.size(), tree.width(), q,
                                            box_.wraps, bound);
    }

    // An edge of a tree.
    bool is_free(const float* a, const float* b) {
        float end[collision::most_coordinates];
        if (box_.wraps) {
            for (int k = 0; k < box_.width; ++k) end[k] = a[k] + box_.difference(k, a[k], b[k]);
            b = end;
        }
        const Verdict verdict = is_search_proved_ ? checker_.prove_edge(a, b, *memory_)
                                                  : checker_.sample_edge(a, b, options_.resolution, *memory_);
        if (verdict == Verdict::blocked) tally_.add(memory_->w.contact);
        return verdict == Verdict::free;
    }
    // An edge of the answer.
    bool is_free(const double* a, const double* b) {
        ++answer_edges_;
        const Verdict verdict = options_.answer == EdgeTest::proved
                                    ? checker_.prove_edge(a, b, *memory_)
                                    : checker_.sample_edge(a, b, double(options_.resolution), *memory_);
        return verdict == Verdict::free;
    }
    // A configuration; false and what touches.
    bool is_free(const double* q, Contact& contact) {
        if (checker_.is_free(q, *memory_)) return true;
        contact = memory_->w.contact;
        return false;
    }
    // From now on the trees grow by proved edges only.
    void prove_search() { is_search_proved_ = true; }

    // False when the time is over. Looks at the clock about every ten microseconds, and polls.
    bool has_time() {
        constexpr int most_calls = 64;
        constexpr long long most_blocks = 64;
        if (--calls_left_ > 0 && memory_->w.blocks - blocks_seen_ < most_blocks) [[likely]]
            return !is_late_;
        calls_left_ = most_calls;
        blocks_seen_ = memory_->w.blocks;
        poll_interrupts();
        is_late_ = is_late_ || Clock::now() >= deadline_;
        return !is_late_;
    }
    // The same with a look at the clock in any case.
    bool has_time_now() {
        calls_left_ = 0;
        return has_time();
    }
    bool is_late() const { return is_late_; }

    std::int64_t blocks() const { return memory_->w.blocks; }
    std::int64_t answer_edges() const { return answer_edges_; }
    const BlockerTally& tally() const { return tally_; }

  private:
    static constexpr double longest_limit = 1e9;  // [s], more is no limit

    const collision::Checker& checker_;
    const ArmOptions& options_;
    const Box& box_;
    collision::Checker::Borrowed memory_;
    bool is_search_proved_, is_late_ = false;
    Clock::time_point deadline_ = Clock::time_point::max();
    int calls_left_ = 0;
    long long blocks_seen_ = 0;
    std::int64_t answer_edges_ = 0;
    BlockerTally tally_;
};

}  // namespace cspace::planning
