// Set cover: few sets whose union holds every item, by greedy choice and by exchange.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "cspace/shapes/cover_items.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

// Sets of items, each as runs of consecutive numbers, in blocks of memory: a long vector that grows is
// copied, which takes long.
class ItemSets {
  public:
    void add(std::span<const Run> runs) {
        constexpr std::size_t block = 1 << 16;
        if (blocks_.empty() || blocks_.back().size() + runs.size() > blocks_.back().capacity()) {
            blocks_.emplace_back();
            blocks_.back().reserve(std::max(block, runs.size()));
        }
        std::vector<Run>& last = blocks_.back();
        sets_.push_back({last.data() + last.size(), runs.size()});
        last.insert(last.end(), runs.begin(), runs.end());
        count_ += runs.size();
    }
    // Gives the memory back, block by block.
    void release(Watch& watch) {
        for (sets_.clear(), count_ = 0; !blocks_.empty(); blocks_.pop_back()) watch.look();
    }
    std::size_t size() const { return sets_.size(); }
    std::size_t count_runs() const { return count_; }
    std::span<const Run> operator[](std::size_t set) const { return sets_[set]; }

  private:
    std::vector<std::vector<Run>> blocks_;  // never grow beyond what they reserve
    std::vector<std::span<const Run>> sets_;
    std::size_t count_ = 0;
};

class SetCover {
  public:
    using Number = std::uint32_t;
    // weights: of the items.
    SetCover(const ItemSets& sets, std::vector<std::uint32_t> weights, Watch& watch)
        : sets_(sets),
          weights_(std::move(weights)),
          count_(weights_.size(), 0),
          holders_(weights_.size(), 0),
          owned_(sets.size(), 0),
          lost_(sets.size(), 0),
          is_chosen_(sets.size(), 0),
          watch_(watch) {}

    // The numbers of the chosen sets. Items that no set holds stay without one.
    std::vector<Number> choose() {
        choose_greedily();
        drop_redundant();
        while (exchange()) continue;
        std::erase_if(order_, [&](Number set) { return !std::exchange(is_chosen_[set], 0); });
        return order_;
    }
    // How many chosen sets hold each item.
    std::span<const Number> counts() const { return count_; }

  private:
    const ItemSets& sets_;
    std::vector<std::uint32_t> weights_;
    std::vector<Number> count_, holders_;  // of an item: chosen sets that hold it, and ⊕ of their numbers
    std::vector<Number> owned_;            // of a chosen set: items that it holds alone; 0: it is redundant
    std::vector<Number> lost_, touched_;   // of an exchange
    std::vector<std::uint8_t> is_chosen_;
    std::vector<Number> order_;  // of choices
    Watch& watch_;

    template <class Visit>
    void visit_items(std::size_t set, const Visit& visit) const {
        for (const Run& run : sets_[set])
            for (std::size_t k = run.begin; k < run.end; ++k) visit(k);
    }
    void add(Number set) {
        is_chosen_[set] = 1, order_.push_back(set);
        visit_items(set, [&](std::size_t k) {
            const Number before = count_[k]++;
            if (before == 0) ++owned_[set];
            if (before == 1) --owned_[holders_[k]];
            holders_[k] ^= set;
        });
    }
    void remove(Number set) {
        is_chosen_[set] = 0;
        visit_items(set, [&](std::size_t k) {
            const Number after = --count_[k];
            holders_[k] ^= set;
            if (after == 0) --owned_[set];
            if (after == 1) ++owned_[holders_[k]];
        });
    }

    // Takes the set of the largest weight that is left, again and again (Johnson 1974). Gains only shrink, so
    // the largest of the old ones is computed anew first (Minoux 1978).
    void choose_greedily() {
        std::vector<std::uint32_t> open = weights_;
        const auto gain_of = [&](Number set) {
            std::uint64_t gain = 0;
            for (const Run& run : sets_[set])
                for (std::size_t k = run.begin; k < run.end; ++k) gain += open[k];
            watch_.look();
            return gain;
        };
        struct Entry {
            std::uint64_t gain;
            Number set;
            bool operator<(const Entry& other) const {
                return gain < other.gain || (gain == other.gain && set > other.set);
            }
        };
        std::vector<Entry> entries;
        for (Number set = 0; set < Number(sets_.size()); ++set) entries.push_back({gain_of(set), set});
        std::priority_queue<Entry> queue(std::less<Entry>(), std::move(entries));
        while (!queue.empty()) {
            const Entry top = queue.top();
            queue.pop();
            const std::uint64_t gain = gain_of(top.set);
            if (gain == 0) continue;
            if (!queue.empty() && Entry{gain, top.set} < queue.top()) {
                queue.push({gain, top.set});
                continue;
            }
            add(top.set);
            visit_items(top.set, [&](std::size_t k) { open[k] = 0; });
        }
    }

    // Drops sets whose items others hold, the last chosen first.
    void drop_redundant() {
        for (std::size_t i = order_.size(); i-- > 0;) {
            watch_.look();
            if (owned_[order_[i]] == 0) remove(order_[i]);
        }
    }

    // Adds sets that make two or more chosen ones redundant, and drops these; returns whether any did.
    bool exchange() {
        bool found = false;
        for (Number set = 0; set < Number(sets_.size()); ++set) {
            watch_.look();
            if (is_chosen_[set] || count_freed(set) < 2) continue;
            add(set);
            std::size_t dropped = 0;
            for (const Number other : touched_)
                if (owned_[other] == 0) remove(other), ++dropped;
            found |= dropped > 1;
        }
        return found;
    }
    // How many chosen sets would own nothing any more if `set` were added.
    std::size_t count_freed(Number set) {
        touched_.clear();
        visit_items(set, [&](std::size_t k) {
            if (count_[k] == 1 && lost_[holders_[k]]++ == 0) touched_.push_back(holders_[k]);
        });
        std::size_t freed = 0;
        for (const Number other : touched_) freed += lost_[other] == owned_[other], lost_[other] = 0;
        return freed;
    }
};

}  // namespace cspace::shapes
