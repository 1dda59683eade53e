// The symbolic half of a sparse Cholesky factorisation: elimination tree, column counts, and supernodes.
//
// The tree is found by path compression (Liu 1986); its postorder keeps the fill and makes the columns of a
// supernode neighbours. A supernode is a run of columns with one pattern. A child is amalgamated with its
// parent where the zeros this stores are few (Ashcraft & Grimes 1989).
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/math/sparse/block_graph.hpp"

namespace cspace {

// A run of block columns, and the block rows below them.
struct Supernode {
    int first, count;                // block columns
    int pivots = 0;                  // rows of these columns
    int below = 0;                   // rows of the blocks below
    int parent = -1;                 // supernode of the first block row below; −1: none
    std::size_t begin = 0, end = 0;  // of its block rows in SymbolicFactor::rows
};

struct SymbolicFactor {
    std::vector<int> order, place;      // block of the matrix at each column, and column of each block
    std::vector<int> starts;            // first row of each column, and the number of rows
    std::vector<Supernode> supernodes;  // children before parents, in postorder
    std::vector<int> owner;             // supernode of each column
    std::vector<int> rows;              // block rows below the pivots, ascending

    int columns() const { return int(order.size()); }
    int size(int column) const { return starts[std::size_t(column) + 1] - starts[std::size_t(column)]; }
};

// How many zeros amalgamation may store, as a share of a supernode of so many columns (found by trial).
struct Amalgamation {
    int always = 12;  // columns that are merged whatever they store
    int narrow = 24, wide = 48;
    double narrow_share = 0.2, wide_share = 0.1, share = 0.02;
    int most = 96;  // columns of a supernode

    bool accepts(int pivots, double zero_share) const {
        if (pivots <= always) return true;
        return zero_share < (pivots <= narrow ? narrow_share : pivots <= wide ? wide_share : share);
    }
};

namespace symbolic {

inline constexpr int none = -1;

// The neighbours of each column that precede it.
struct EarlierColumns {
    std::vector<std::size_t> starts;
    std::vector<int> columns;
};

inline EarlierColumns find_earlier_columns(const BlockGraph& graph, const std::vector<int>& order,
                                           const std::vector<int>& place) {
    EarlierColumns found;
    found.starts.reserve(order.size() + 1);
    found.columns.reserve(graph.neighbours.size() / 2);
    for (std::size_t column = 0; column < order.size(); ++column) {
        found.starts.push_back(found.columns.size());
        const auto block = std::size_t(order[column]);
        for (std::size_t k = graph.starts[block]; k < graph.starts[block + 1]; ++k) {
            const int other = place[std::size_t(graph.neighbours[k])];
            if (other < int(column)) found.columns.push_back(other);
        }
    }
    found.starts.push_back(found.columns.size());
    return found;
}

inline std::vector<int> find_tree(const EarlierColumns& earlier) {
    const std::size_t n = earlier.starts.size() - 1;
    std::vector<int> parent(n, none), ancestor(n, none);
    for (std::size_t column = 0; column < n; ++column) {
        for (std::size_t k = earlier.starts[column]; k < earlier.starts[column + 1]; ++k) {
            int at = earlier.columns[k];
            while (at != none && at < int(column)) {
                const int up = std::exchange(ancestor[std::size_t(at)], int(column));
                if (up == none) parent[std::size_t(at)] = int(column);
                at = up;
            }
        }
    }
    return parent;
}

// The rows of each column from its diagonal on, by walking the tree from each entry of each row.
inline std::vector<int> count_rows(const EarlierColumns& earlier, const std::vector<int>& parent,
                                   const std::vector<int>& sizes) {
    const std::size_t n = parent.size();
    std::vector<int> count(sizes), seen(n, none);
    InterruptPoll poll(1 << 7);
    for (std::size_t row = 0; row < n; ++row) {
        poll.step();
        seen[row] = int(row);
        for (std::size_t k = earlier.starts[row]; k < earlier.starts[row + 1]; ++k) {
            for (int at = earlier.columns[k]; seen[std::size_t(at)] != int(row);
                 at = parent[std::size_t(at)]) {
                seen[std::size_t(at)] = int(row);
                count[std::size_t(at)] += sizes[row];
            }
        }
    }
    return count;
}

// Children before parents, the child with the most rows last: it is the one to amalgamate, and the memory for
// the complements of its siblings is least.
inline std::vector<int> find_postorder(const std::vector<int>& parent, const std::vector<int>& count) {
    const std::size_t n = parent.size();
    std::vector<int> by_count(n), first(n + 1, none), next(n, none), order;
    std::iota(by_count.begin(), by_count.end(), 0);
    sort_polled(by_count, [&](int a, int b) {
        return count[std::size_t(a)] != count[std::size_t(b)] ? count[std::size_t(a)] > count[std::size_t(b)]
                                                              : a > b;
    });
    // Each child is put before those with more rows.
    for (int child : by_count) {
        int& head = first[parent[std::size_t(child)] == none ? n : std::size_t(parent[std::size_t(child)])];
        next[std::size_t(child)] = head;
        head = child;
    }
    order.reserve(n);
    std::vector<int> path;
    for (int root = first[n]; root != none; root = next[std::size_t(root)]) {
        path.push_back(root);
        while (!path.empty()) {
            int& child = first[std::size_t(path.back())];
            if (child == none) {
                order.push_back(path.back());
                path.pop_back();
            } else {
                path.push_back(std::exchange(child, next[std::size_t(child)]));
            }
        }
    }
    return order;
}

template <class T>
std::vector<T> permute(const std::vector<T>& values, const std::vector<int>& order) {
    std::vector<T> permuted(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) permuted[k] = values[std::size_t(order[k])];
    return permuted;
}
inline std::vector<int> invert_order(const std::vector<int>& order) {
    std::vector<int> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) place[std::size_t(order[k])] = int(k);
    return place;
}

// Merges each run with the one before it where that is its child and the rule accepts the zeros to be stored.
inline std::vector<Supernode> merge_runs(const std::vector<Supernode>& runs, const std::vector<int>& parent,
                                         const Amalgamation& rule) {
    std::vector<Supernode> merged;
    std::vector<double> zeros;  // numbers stored in vain
    const auto try_merge = [&] {
        const Supernode child = merged[merged.size() - 2], last = merged.back();
        const int up = parent[std::size_t(child.first + child.count - 1)];
        if (up < last.first || up >= last.first + last.count) return false;
        const double stored = zeros[zeros.size() - 2] + zeros.back() +
                              double(child.pivots) * (last.pivots + last.below - child.below);
        const double pivots = child.pivots + last.pivots;
        const double all = pivots * (pivots + 1) / 2 + pivots * last.below;
        if (!rule.accepts(int(pivots), stored / all)) return false;
        merged.pop_back(), zeros.pop_back();
        merged.back() = {child.first, child.count + last.count, int(pivots), last.below};
        zeros.back() = stored;
        return true;
    };
    for (const Supernode& run : runs) {
        merged.push_back(run);
        zeros.push_back(0);
        while (merged.size() > 1 && try_merge()) {
        }
    }
    return merged;
}

// Splits supernodes of too many columns into chains. A panel is stored as a rectangle, and the triangle above
// its diagonal is lost.
inline std::vector<Supernode> split_wide(const std::vector<Supernode>& runs, const std::vector<int>& sizes,
                                         int most) {
    std::vector<Supernode> split;
    split.reserve(runs.size());
    for (const Supernode& run : runs) {
        const int parts = (run.pivots + most - 1) / most, wanted = (run.pivots + parts - 1) / parts;
        int left = run.pivots + run.below;
        Supernode next{run.first, 0};
        for (int column = run.first; column < run.first + run.count; ++column) {
            if (next.count > 0 && next.pivots + sizes[std::size_t(column)] > wanted) {
                next.below = left;
                split.push_back(std::exchange(next, Supernode{column, 0}));
            }
            ++next.count, next.pivots += sizes[std::size_t(column)], left -= sizes[std::size_t(column)];
        }
        next.below = left;
        split.push_back(next);
    }
    return split;
}

// First the runs of columns with one pattern, then the amalgamated ones.
inline std::vector<Supernode> find_supernodes(const std::vector<int>& parent, const std::vector<int>& count,
                                              const std::vector<int>& sizes, const Amalgamation& rule) {
    std::vector<Supernode> runs;
    runs.reserve(parent.size());
    for (int column = 0; column < int(parent.size()); ++column) {
        const int size = sizes[std::size_t(column)];
        runs.push_back({column, 1, size, count[std::size_t(column)] - size});
    }
    constexpr double least_share = std::numeric_limits<double>::min();
    return split_wide(
        merge_runs(merge_runs(runs, parent, {0, 0, 0, least_share, least_share, least_share}), parent, rule),
        sizes, rule.most);
}

// The block rows below each supernode: those of its columns in the matrix, and those of its children.
inline void find_rows(SymbolicFactor& factor, const BlockGraph& graph) {
    const std::size_t n = factor.order.size(), nodes = factor.supernodes.size();
    std::vector<int> first_child(nodes, none), next_child(nodes, none), seen(n, none);
    InterruptPoll poll(1 << 5);
    for (std::size_t s = 0; s < nodes; ++s) {
        poll.step();
        Supernode& at = factor.supernodes[s];
        const int end = at.first + at.count;
        at.begin = factor.rows.size();
        const auto add_row = [&](int row) {
            if (row < end || seen[std::size_t(row)] == int(s)) return;
            seen[std::size_t(row)] = int(s);
            factor.rows.push_back(row);
        };
        for (int column = at.first; column < end; ++column) {
            const auto block = std::size_t(factor.order[std::size_t(column)]);
            for (std::size_t k = graph.starts[block]; k < graph.starts[block + 1]; ++k)
                add_row(factor.place[std::size_t(graph.neighbours[k])]);
        }
        for (int c = first_child[s]; c != none; c = next_child[std::size_t(c)]) {
            const Supernode& child = factor.supernodes[std::size_t(c)];
            for (std::size_t k = child.begin; k < child.end; ++k) add_row(factor.rows[k]);
        }
        at.end = factor.rows.size();
        std::sort(factor.rows.begin() + std::ptrdiff_t(at.begin), factor.rows.end());
        at.below = 0;
        for (std::size_t k = at.begin; k < at.end; ++k) at.below += factor.size(factor.rows[k]);
        if (at.begin == at.end) continue;
        at.parent = factor.owner[std::size_t(factor.rows[at.begin])];
        next_child[s] = std::exchange(first_child[std::size_t(at.parent)], int(s));
    }
}

}  // namespace symbolic

// The numbers of the sparse Cholesky factor of a matrix of blocks, eliminated in this order.
inline double count_factor(const BlockGraph& graph, const std::vector<int>& order) {
    using namespace symbolic;
    const EarlierColumns earlier = find_earlier_columns(graph, order, invert_order(order));
    const std::vector<int> sizes = permute(graph.sizes, order);
    const std::vector<int> count = count_rows(earlier, find_tree(earlier), sizes);
    double numbers = 0;
    for (std::size_t k = 0; k < count.size(); ++k)
        numbers += double(sizes[k]) * (count[k] - 0.5 * (sizes[k] - 1));
    return numbers;
}

// The pattern of the sparse Cholesky factor of a matrix of blocks, eliminated in about this order.
CSPACE_ONCE SymbolicFactor analyze_pattern(const BlockGraph& graph, std::vector<int> order,
                                           const Amalgamation& rule = {}) {
    using namespace symbolic;
    SymbolicFactor factor;
    std::vector<int> place = invert_order(order);
    const EarlierColumns earlier = find_earlier_columns(graph, order, place);
    std::vector<int> sizes = permute(graph.sizes, order), parent = find_tree(earlier);
    std::vector<int> count = count_rows(earlier, parent, sizes);
    const std::vector<int> postorder = find_postorder(parent, count), moved = invert_order(postorder);
    factor.order = permute(order, postorder);
    factor.place = invert_order(factor.order);
    sizes = permute(sizes, postorder), count = permute(count, postorder), parent = permute(parent, postorder);
    for (int& up : parent) up = up == none ? none : moved[std::size_t(up)];
    factor.starts.assign(1, 0);
    for (int size : sizes) factor.starts.push_back(factor.starts.back() + size);
    factor.supernodes = find_supernodes(parent, count, sizes, rule);
    factor.owner.resize(order.size());
    for (std::size_t s = 0; s < factor.supernodes.size(); ++s) {
        const Supernode& at = factor.supernodes[s];
        std::fill_n(factor.owner.begin() + at.first, at.count, int(s));
    }
    find_rows(factor, graph);
    return factor;
}

}  // namespace cspace
