// Approximate minimum degree: an elimination order of the blocks of a symmetric matrix with little fill
// (Amestoy, Davis & Duff 1996, "An approximate minimum degree ordering algorithm").
//
// The quotient graph holds variables that are not eliminated yet, and elements: the cliques that eliminated
// variables leave.
// A pivot absorbs the elements it touches; variables with the same neighbours are merged; the degree of a
// variable is bounded by the sizes of its elements. Degrees count rows, so that blocks of several sizes are
// compared fairly. Blocks may be given stages: those of a stage are eliminated before those of later ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cspace/math/sparse/block_graph.hpp"

namespace cspace {

class MinimumDegree {
  public:
    // stages: of each block, from 0; empty: one for all.
    explicit MinimumDegree(const BlockGraph& graph, std::vector<int> stages = {})
        : n_(graph.nodes()), rows_(graph.sizes), stages_(std::move(stages)) {
        lists_.assign(graph.neighbours.begin(), graph.neighbours.end());
        nodes_.resize(std::size_t(n_));
        weight_.assign(std::size_t(n_), 0), stamp_.assign(std::size_t(n_), 0);
        mark_.assign(std::size_t(n_), 0);
        for (int rows : rows_) total_ += rows;
        left_ = total_;
        heads_.assign(std::size_t(total_) + 1, none);
        for (int i = 0; i < n_; ++i) add_variable(graph, i);
        sort_stages();
    }

    // The blocks in the order of their elimination.
    std::vector<int> find_order() {
        std::vector<int> order;
        order.reserve(std::size_t(n_));
        InterruptPoll poll(1 << 6);
        while (int(order.size()) < n_) {
            poll.step();
            const int pivot = take_pivot();
            form_element(pivot);
            weigh_elements();
            update_variables(pivot);
            merge_variables();
            close_element(pivot);
            append_group(pivot, order);
        }
        return order;
    }
    // About how many multiplications a factorisation in the order found takes.
    double operations() const { return operations_; }

  private:
    static constexpr int none = -1;
    enum class Kind : std::uint8_t { variable, element, gone };
    struct Node {
        std::size_t begin =
            0;  // of its list: the elements, then the variables; an element has variables only
        int elements = 0, variables = 0;
        int degree = 0;                // bound of the rows beside its own
        int next = none, last = none;  // in the list of its degree
        int group = none;              // the next variable eliminated together with it
        int group_end = none;          // the last of its own group
        Kind kind = Kind::variable;
    };

    Node& node(int i) { return nodes_[std::size_t(i)]; }
    int& rows(int i) { return rows_[std::size_t(i)]; }
    int* list(int i) { return lists_.data() + node(i).begin; }

    void add_variable(const BlockGraph& graph, int i) {
        Node& added = node(i);
        added.begin = graph.starts[std::size_t(i)];
        added.variables = int(graph.starts[std::size_t(i) + 1] - graph.starts[std::size_t(i)]);
        added.group_end = i;
        for (int k = 0; k < added.variables; ++k) added.degree += rows(list(i)[k]);
        link_variable(i);
    }
    // The blocks of later stages, which are linked when theirs begins.
    void sort_stages() {
        for (int i = 0; i < int(stages_.size()); ++i) {
            if (!is_due(i)) later_.push_back(i);
        }
        std::stable_sort(later_.begin(), later_.end(),
                         [&](int a, int b) { return stages_[std::size_t(a)] > stages_[std::size_t(b)]; });
    }
    bool is_due(int i) const { return stages_.empty() || stages_[std::size_t(i)] <= stage_; }
    void begin_next_stage() {
        stage_ = stages_[std::size_t(later_.back())];
        least_ = 0;
        for (; !later_.empty() && is_due(later_.back()); later_.pop_back()) {
            if (is_variable(later_.back())) link_variable(later_.back());
        }
    }
    void link_variable(int i) {
        if (!is_due(i)) return;
        ++linked_;
        Node& linked = node(i);
        int& head = heads_[std::size_t(linked.degree)];
        linked.next = head, linked.last = none;
        if (head != none) node(head).last = i;
        head = i;
        least_ = std::min(least_, linked.degree);
    }
    void unlink_variable(int i) {
        if (!is_due(i)) return;
        --linked_;
        const Node& old = node(i);
        if (old.next != none) node(old.next).last = old.last;
        (old.last != none ? node(old.last).next : heads_[std::size_t(old.degree)]) = old.next;
    }
    int take_pivot() {
        while (linked_ == 0) begin_next_stage();
        while (heads_[std::size_t(least_)] == none) ++least_;
        const int pivot = heads_[std::size_t(least_)];
        unlink_variable(pivot);
        left_ -= rows(pivot);
        return pivot;
    }

    bool is_variable(int i) { return node(i).kind == Kind::variable && rows(i) > 0; }
    void visit_variables(const int* begin, int count) {
        for (int k = 0; k < count; ++k) {
            const int i = begin[k];
            if (!is_variable(i) || mark_[std::size_t(i)] == tag_) continue;
            mark_[std::size_t(i)] = tag_;
            members_.push_back(i);
        }
    }
    // The variables that the pivot and the elements it absorbs touch.
    void form_element(int pivot) {
        ++tag_;
        mark_[std::size_t(pivot)] = tag_;
        members_.clear();
        const Node& from = node(pivot);
        visit_variables(list(pivot) + from.elements, from.variables);
        for (int k = 0; k < from.elements; ++k) {
            const int e = list(pivot)[k];
            if (node(e).kind != Kind::element) continue;
            visit_variables(list(e), node(e).variables);
            node(e).kind = Kind::gone;
        }
        node(pivot).kind = Kind::element;
        member_rows_ = 0;
        for (int i : members_) member_rows_ += rows(i);
        const double pivots = rows(pivot), below = member_rows_;
        operations_ += pivots * (pivots * pivots / 3 + pivots * below + below * below);
    }
    // The rows of each touched element outside the new one.
    void weigh_elements() {
        ++weigh_tag_;
        for (int i : members_) {
            const int* const elements = list(i);
            for (int k = 0; k < node(i).elements; ++k) {
                const int e = elements[k];
                if (node(e).kind != Kind::element) continue;
                if (stamp_[std::size_t(e)] != weigh_tag_) {
                    stamp_[std::size_t(e)] = weigh_tag_;
                    weight_[std::size_t(e)] = node(e).degree;
                }
                weight_[std::size_t(e)] -= rows(i);
            }
        }
    }
    // Removes absorbed elements and covered variables from the lists of the members, and bounds their
    // degrees.
    void update_variables(int pivot) {
        keys_.clear();
        for (int i : members_) {
            unlink_variable(i);
            Node& at = node(i);
            int* const items = list(i);
            int kept = 0, outside = 0;
            std::uint64_t hash = 0;
            for (int k = 0; k < at.elements; ++k) {
                const int e = items[k];
                if (node(e).kind != Kind::element) continue;
                if (weight_[std::size_t(e)] <= 0) {  // covered by the new element
                    node(e).kind = Kind::gone;
                    continue;
                }
                outside += weight_[std::size_t(e)], hash += std::uint64_t(e);
                items[kept++] = e;
            }
            const int first = kept;
            for (int k = at.elements; k < at.elements + at.variables; ++k) {
                const int v = items[k];
                if (!is_variable(v) || mark_[std::size_t(v)] == tag_) continue;
                outside += rows(v), hash += std::uint64_t(v);
                items[kept++] = v;
            }
            // The new element comes first; what it moves goes to the ends of both parts. There is room, for
            // the pivot or an element of it stood in the list.
            at.elements = first + 1, at.variables = kept - first;
            if (kept > first) items[kept] = items[first];
            if (first > 0) items[first] = items[0];
            items[0] = pivot;
            hash += std::uint64_t(pivot);
            const int others = member_rows_ - rows(i);
            at.degree = std::min({at.degree + others, outside + others, left_ - rows(i)});
            keys_.push_back({hash, i});
        }
    }
    // Variables with the same elements and variables are eliminated together.
    void merge_variables() {
        std::sort(keys_.begin(), keys_.end(), [](const Key& a, const Key& b) {
            return a.hash != b.hash ? a.hash < b.hash : a.variable < b.variable;
        });
        for (std::size_t a = 0; a < keys_.size(); ++a) {
            const int i = keys_[a].variable;
            if (rows(i) == 0) continue;
            bool is_marked = false;
            for (std::size_t b = a + 1; b < keys_.size() && keys_[b].hash == keys_[a].hash; ++b) {
                const int j = keys_[b].variable;
                if (rows(j) == 0 || !share_stage(i, j) || node(j).elements != node(i).elements ||
                    node(j).variables != node(i).variables)
                    continue;
                if (!is_marked) mark_list(i), is_marked = true;
                if (has_marked_list(j)) absorb_variable(i, j);
            }
        }
    }
    bool share_stage(int i, int j) const {
        return stages_.empty() || stages_[std::size_t(i)] == stages_[std::size_t(j)];
    }
    void mark_list(int i) {
        ++tag_;
        const int count = node(i).elements + node(i).variables;
        for (int k = 0; k < count; ++k) mark_[std::size_t(list(i)[k])] = tag_;
    }
    bool has_marked_list(int i) {
        const int count = node(i).elements + node(i).variables;
        const int* const items = list(i);
        return std::all_of(items, items + count, [&](int k) { return mark_[std::size_t(k)] == tag_; });
    }
    void absorb_variable(int i, int j) {
        node(i).degree -= rows(j);
        rows(i) += rows(j);
        rows(j) = 0;
        join_groups(i, j);
        node(j).kind = Kind::gone;
    }
    void join_groups(int i, int j) {
        node(node(i).group_end).group = j;
        node(i).group_end = node(j).group_end;
    }
    // Stores the members of the new element; those that nothing else touches are eliminated with the pivot.
    void close_element(int pivot) {
        std::size_t kept = 0;
        int element_rows = 0;
        for (int i : members_) {
            if (rows(i) == 0) continue;
            Node& at = node(i);
            if (at.elements == 1 && at.variables == 0) {
                join_groups(pivot, i);
                left_ -= rows(i);
                rows(i) = 0, at.kind = Kind::gone;
                continue;
            }
            members_[kept++] = i;
            element_rows += rows(i);
        }
        members_.resize(kept);
        Node& element = node(pivot);
        if (kept > std::size_t(element.elements + element.variables)) {
            element.begin = lists_.size();
            lists_.insert(lists_.end(), members_.begin(), members_.end());
        } else {
            std::copy(members_.begin(), members_.end(), list(pivot));
        }
        element.elements = 0, element.variables = int(kept), element.degree = element_rows;
        for (int i : members_) link_variable(i);
    }
    void append_group(int pivot, std::vector<int>& order) {
        for (int i = pivot; i != none; i = node(i).group) order.push_back(i);
    }

    struct Key {
        std::uint64_t hash;
        int variable;
    };

    int n_, total_ = 0, least_ = 0, member_rows_ = 0;
    int left_ = 0;                     // rows of the variables that are not eliminated yet
    std::vector<int> rows_;            // of a variable with all that are merged into it; 0 once merged
    std::vector<int> stages_, later_;  // later_: the next stage at its end
    int stage_ = 0, linked_ = 0;       // linked_: variables in the lists of degrees
    double operations_ = 0;
    std::vector<int> lists_;
    std::vector<Node> nodes_;
    std::vector<int> heads_;   // the first variable of each degree
    std::vector<int> weight_;  // rows of an element outside the new one, if stamped
    std::vector<int> stamp_, mark_, members_;
    std::vector<Key> keys_;
    int tag_ = 0, weigh_tag_ = 0;
};

CSPACE_ONCE std::vector<int> order_minimum_degree(const BlockGraph& graph) {
    return MinimumDegree(graph).find_order();
}

}  // namespace cspace
