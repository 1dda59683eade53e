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
#include "cspace/shapes/cover_watch.hpp"

namespace cspace::shapes {

// Sets of items, each as runs of consecutive numbers.
class ItemSets {
  public:
    std::vector<Run> runs;
    void close_set() { ends_.push_back(runs.size()); }  // the runs since the last call are one set
    std::size_t size() const { return ends_.size(); }
    std::span<const Run> operator[](std::size_t set) const {
        const std::size_t begin = set ? ends_[set - 1] : 0;
        return std::span(runs).subspan(begin, ends_[set] - begin);
    }

  private:
    std::vector<std::size_t> ends_;
};

class SetCover {
  public:
    using Number = std::uint32_t;
    SetCover(const ItemSets& sets, std::vector<std::uint32_t> weights, Watch& watch)
        : sets_(sets), weights_(std::move(weights)), count_(weights_.size(), 0), watch_(watch) {}

    // The numbers of the chosen sets. Items that no set holds stay without one.
    std::vector<Number> choose() {
        choose_greedily();
        drop_redundant();
        while (exchange()) drop_redundant();
        return chosen_;
    }
    // How many chosen sets hold each item.
    std::span<const Number> counts() const { return count_; }

  private:
    const ItemSets& sets_;
    std::vector<std::uint32_t> weights_;
    std::vector<Number> count_, chosen_;
    std::vector<Number> owner_, owned_, lost_, touched_;  // of an exchange
    Watch& watch_;

    template <class Visit>
    void visit_items(std::size_t set, const Visit& visit) const {
        for (const Run& run : sets_[set])
            for (std::size_t k = run.begin; k < run.end; ++k) visit(k);
    }

    // Takes the set of the largest weight that is left, again and again (Johnson 1974). Gains only shrink, so
    // the largest of the old ones is computed anew first (Minoux 1978).
    void choose_greedily() {
        std::vector<std::uint32_t> open = weights_;
        const auto gain_of = [&](Number set) {
            std::uint64_t gain = 0;
            for (const Run& run : sets_[set])
                for (std::size_t k = run.begin; k < run.end; ++k) gain += open[k];
            watch_.step();
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

    void add(Number set) {
        chosen_.push_back(set);
        visit_items(set, [&](std::size_t k) { ++count_[k]; });
    }
    bool is_redundant(Number set) const {
        for (const Run& run : sets_[set])
            for (std::size_t k = run.begin; k < run.end; ++k)
                if (count_[k] < 2) return false;
        return true;
    }
    // Drops sets whose items others hold, the last chosen first.
    void drop_redundant() {
        std::vector<Number> kept;
        for (std::size_t i = chosen_.size(); i-- > 0;) {
            watch_.step();
            const Number set = chosen_[i];
            if (is_redundant(set))
                visit_items(set, [&](std::size_t k) { --count_[k]; });
            else
                kept.push_back(set);
        }
        std::reverse(kept.begin(), kept.end());
        chosen_ = std::move(kept);
    }

    // Adds sets that make two or more chosen ones redundant, and drops these; returns whether any did.
    bool exchange() {
        list_owners();
        bool found = false;
        for (Number set = 0; set < Number(sets_.size()); ++set) {
            watch_.step();
            if (count_owners(set) < 2) continue;
            const std::size_t before = chosen_.size();
            visit_items(set, [&](std::size_t k) { ++count_[k]; });
            chosen_.insert(chosen_.begin(), set);  // the last to be dropped
            drop_redundant();
            found |= chosen_.size() < before;
            list_owners();
        }
        return found;
    }
    // Which chosen set alone holds an item, and how many items each holds alone.
    void list_owners() {
        owner_.resize(count_.size());
        owned_.assign(chosen_.size(), 0), lost_.assign(chosen_.size(), 0);
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            watch_.step();
            visit_items(chosen_[i], [&](std::size_t k) {
                if (count_[k] == 1) owner_[k] = Number(i), ++owned_[i];
            });
        }
    }
    // How many chosen sets hold nothing alone any more once `set` is added.
    std::size_t count_owners(Number set) {
        touched_.clear();
        visit_items(set, [&](std::size_t k) {
            if (count_[k] == 1 && lost_[owner_[k]]++ == 0) touched_.push_back(owner_[k]);
        });
        std::size_t freed = 0;
        for (const Number i : touched_) freed += lost_[i] == owned_[i], lost_[i] = 0;
        return freed;
    }
};

}  // namespace cspace::shapes
