// The connected components of the free configurations of two joints, with proofs.
//
// Boxes of neighbouring slabs are connected if they share a gap of the row between them: free boxes one that
// is surely a gap, boxes that may be free one that rounding may have closed. Where both agree the components
// are proved; where one possible region contains several free ones, a passage narrower than the slabs resolve
// may connect them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "cspace/planning/two_joints/sweep.hpp"

namespace cspace::planning::two_joints {

// Free pieces smaller than this [rad²] are no components: they are the tips of larger ones, cut off by slabs
// that are not halved any more.
inline constexpr double least_component = 1e-12;

struct Component {
    std::int32_t region = 0;   // components in different regions are proved to be separate
    bool is_proved = false;    // no other component lies in the region
    double least_area = 0;     // of what is proved free [rad²]
    double greatest_area = 0;  // of what may be free
    double q_1 = 0, q_2 = 0;   // the middle of its largest box
};

namespace detail {

// Sets of numbers that merge (Tarjan 1975).
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    std::size_t find(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::size_t i, std::size_t j) { parent_[find(i)] = find(j); }

  private:
    std::vector<std::size_t> parent_;
};

}  // namespace detail

class Components {
  public:
    static constexpr std::int32_t blocked = -1, unresolved = -2;

    explicit Components(const Sweep& sweep) : sweep_(sweep) {
        first_free_ = number_boxes([](const Slab& slab) { return slab.free.size(); });
        first_possible_ = number_boxes([](const Slab& slab) { return slab.possible.size(); });
        detail::DisjointSets free(first_free_.back()), possible(first_possible_.back());
        visit_neighbours([&](std::size_t s, std::size_t t, const SweepRow& row) {
            for (const Gap& gap : row.gaps) {
                const auto boxes = [&](std::size_t slab) -> auto& { return sweep_.slabs()[slab].free; };
                unite_across(gap, boxes, first_free_, {s, t}, free);
            }
            for (const Gap& gap : sweep_.find_possible_gaps(row)) {
                const auto boxes = [&](std::size_t slab) -> auto& { return sweep_.slabs()[slab].possible; };
                unite_across(gap, boxes, first_possible_, {s, t}, possible);
            }
        });
        name_components(free, possible);
        add_areas(possible);
        keep_large();
        add_greatest_areas();
    }

    const std::vector<Component>& all() const { return all_; }
    // Free boxes are numbered through, slab by slab.
    std::size_t boxes() const { return component_.size(); }
    std::uint32_t box_number(std::size_t slab, std::size_t box) const {
        return std::uint32_t(first_free_[slab] + box);
    }
    std::int32_t component_at(std::uint32_t number) const { return component_[number]; }
    // The slabs that contain an angle: two at a row.
    std::vector<std::size_t> slabs_at(double q_1) const {
        const auto& rows = sweep_.rows();
        std::vector<std::size_t> found;
        const auto above = std::upper_bound(rows.begin(), rows.end(), q_1,
                                            [](double q, const SweepRow& row) { return q < row.q_1; });
        const auto after = std::size_t(above - rows.begin());
        if (after > 0 && after < rows.size()) found.push_back(after - 1);
        if (after > 1 && rows[after - 1].q_1 == q_1) found.push_back(after - 2);
        return found;
    }

    // The number of the component that contains a configuration.
    std::int32_t find_component(double q_1, double q_2) const {
        const Joint& joint_1 = sweep_.space().arm().joint_1;
        if (joint_1.wraps) q_1 = wrap_above(q_1, joint_1.lower);
        q_2 = sweep_.finder().within_range(q_2);
        const SweepRow row = sweep_.make_row(q_1);
        const auto gap = std::find_if(row.gaps.begin(), row.gaps.end(),
                                      [&](const Gap& g) { return sweep_.finder().contains(g, q_2); });
        if (gap == row.gaps.end() || q_1 < joint_1.lower || q_1 > joint_1.upper) return blocked;
        for (const std::size_t slab : slabs_at(q_1))
            for (std::size_t i = 0; i < sweep_.slabs()[slab].free.size(); ++i)
                if (sweep_.finder().overlap(*gap, sweep_.slabs()[slab].free[i]).is_open())
                    return component_at(box_number(slab, i));
        return unresolved;
    }

  private:
    const Sweep& sweep_;
    std::vector<std::size_t> first_free_, first_possible_;  // the number of the first box of each slab
    std::vector<std::int32_t> component_;                   // of each free box
    std::vector<Component> all_;
    std::vector<double> possible_area_;  // of each region

    template <class Count>
    std::vector<std::size_t> number_boxes(const Count& count) const {
        std::vector<std::size_t> first{0};
        for (const Slab& slab : sweep_.slabs()) first.push_back(first.back() + count(slab));
        return first;
    }
    double width_of(std::size_t slab) const { return sweep_.rows()[slab + 1].q_1 - sweep_.rows()[slab].q_1; }
    // Calls visit with each slab, the next one, and the row between them.
    template <class Visit>
    void visit_neighbours(const Visit& visit) const {
        const std::size_t count = sweep_.slabs().size();
        InterruptPoll poll(64);
        for (std::size_t s = 0; s + 1 < count; ++s) poll.step(), visit(s, s + 1, sweep_.rows()[s + 1]);
        if (sweep_.space().arm().joint_1.wraps && count > 0) visit(count - 1, 0, sweep_.rows().front());
    }
    // Unites the boxes of two slabs that a gap of the row between them connects.
    template <class BoxesOf>
    void unite_across(const Gap& gap, const BoxesOf& boxes_of, const std::vector<std::size_t>& first,
                      const std::array<std::size_t, 2>& slabs, detail::DisjointSets& sets) const {
        std::size_t last = first.back();
        for (const std::size_t slab : slabs)
            for (std::size_t i = 0; i < boxes_of(slab).size(); ++i) {
                if (!sweep_.finder().overlap(gap, boxes_of(slab)[i]).is_open()) continue;
                if (last < first.back()) sets.unite(last, first[slab] + i);
                last = first[slab] + i;
            }
    }

    void name_components(detail::DisjointSets& free, detail::DisjointSets& possible) {
        std::vector<std::int32_t> named(first_free_.back(), -1);
        component_.resize(first_free_.back());
        for (std::size_t s = 0; s < sweep_.slabs().size(); ++s) {
            const Slab& slab = sweep_.slabs()[s];
            for (std::size_t i = 0; i < slab.free.size(); ++i) {
                const std::size_t box = first_free_[s] + i;
                std::int32_t& name = named[free.find(box)];
                if (name < 0) {
                    name = std::int32_t(all_.size());
                    all_.push_back({std::int32_t(possible.find(region_of(s, slab.free[i])))});
                }
                component_[box] = name;
            }
        }
    }
    // The box that may be free around one that is.
    std::size_t region_of(std::size_t s, const Gap& free) const {
        const auto& possible = sweep_.slabs()[s].possible;
        std::size_t i = 0;
        while (i + 1 < possible.size() && !sweep_.finder().overlap(possible[i], free).is_open()) ++i;
        return first_possible_[s] + i;
    }

    void add_areas(detail::DisjointSets& possible) {
        std::vector<double> largest(all_.size());
        possible_area_.resize(first_possible_.back());
        for (std::size_t s = 0; s < sweep_.slabs().size(); ++s) {
            const Slab& slab = sweep_.slabs()[s];
            for (std::size_t i = 0; i < slab.possible.size(); ++i)
                possible_area_[possible.find(first_possible_[s] + i)] +=
                    width_of(s) * (slab.possible[i].high - slab.possible[i].low);
            for (std::size_t i = 0; i < slab.free.size(); ++i) {
                const auto name = std::size_t(component_at(box_number(s, i)));
                const Gap& box = slab.free[i];
                const double area = width_of(s) * (box.high - box.low);
                all_[name].least_area += area;
                if (area <= largest[name]) continue;
                largest[name] = area;
                all_[name].q_1 = sweep_.rows()[s].q_1 + 0.5 * width_of(s);
                all_[name].q_2 = sweep_.finder().within_range(0.5 * (box.low + box.high));
            }
        }
    }
    // Sorts by size, largest first, and drops what is too small. Regions get numbers in the same order.
    void keep_large() {
        std::vector<std::size_t> order(all_.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return all_[a].least_area > all_[b].least_area;
        });
        std::vector<Component> kept;
        std::vector<std::int32_t> place(all_.size(), unresolved), number(first_possible_.back(), -1);
        std::vector<double> area;  // of each region
        for (const std::size_t old : order) {
            if (all_[old].least_area < least_component) break;
            place[old] = std::int32_t(kept.size());
            kept.push_back(all_[old]);
            const auto region = std::size_t(all_[old].region);
            if (number[region] < 0) {
                number[region] = std::int32_t(area.size());
                area.push_back(possible_area_[region]);
            }
            kept.back().region = number[region];
        }
        all_ = std::move(kept), possible_area_ = std::move(area);
        for (std::int32_t& name : component_) name = place[std::size_t(name)];
    }
    void add_greatest_areas() {
        std::vector<int> count(possible_area_.size());
        std::vector<double> least(possible_area_.size());
        for (const Component& one : all_) {
            ++count[std::size_t(one.region)];
            least[std::size_t(one.region)] += one.least_area;
        }
        for (Component& one : all_) {
            const auto region = std::size_t(one.region);
            one.is_proved = count[region] == 1;
            one.greatest_area = possible_area_[region] - (least[region] - one.least_area);
        }
    }
};

}  // namespace cspace::planning::two_joints
