// A sparse Cholesky factor of growing least-squares problems: the Bayes tree of Kaess, Johannsson, Roberts, Ila,
// Leonard & Dellaert 2012, "iSAM2: Incremental smoothing and mapping using the Bayes tree".
//
// The tree's cliques are the supernodes of the factor. Each keeps its panel, and the Schur complement on its
// separator. New or changed factors touch the cliques of their variables and those above up to the root; these
// are eliminated again, with the complements of the subtrees below, which stay. The newest variable is ordered
// last, where the next factors will touch it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "cspace/math/sparse/cholesky.hpp"
#include "cspace/math/sparse/number_pool.hpp"

namespace cspace {

// Of the incremental tree: small cliques are eliminated again more cheaply.
inline constexpr Amalgamation clique_amalgamation{12, 24, 48, 0.3, 0.1, 0.05};

template <class Fronts = HeaderFronts>
class CliqueTree {
  public:
    // A variable of so many numbers; its number.
    int add_variable(int size) {
        const int variable = variables();
        starts_.push_back(rows());
        sizes_.push_back(size);
        solution_.resize(solution_.size() + std::size_t(size), 0.0);
        clique_of_.push_back(none), first_factor_.push_back(none);
        local_.push_back(none), row_at_.push_back(0), stamp_.push_back(0);
        return variable;
    }
    // A factor of one or two variables, −1 for one that is known; its number.
    int add_factor(int a, int b) {
        const int factor = int(factors_.size());
        const auto na = std::size_t(size_or_none(a)), nb = std::size_t(size_or_none(b));
        factors_.push_back({a, b, none, none, factor_numbers_.size()});
        factor_numbers_.resize(factor_numbers_.size() + na * na + na * nb + nb * nb + na + nb);
        if (a >= 0) factors_.back().next_a = std::exchange(first_factor_[std::size_t(a)], factor);
        if (b >= 0) factors_.back().next_b = std::exchange(first_factor_[std::size_t(b)], factor);
        return factor;
    }
    // Its quadratic model: blocks of the matrix row by row, and parts of the gradient.
    void write_factor(int factor, const double* aa, const double* ab, const double* bb, const double* ga,
                      const double* gb) {
        const Factor& at = factors_[std::size_t(factor)];
        const int na = size_or_none(at.a), nb = size_or_none(at.b);
        double* to = factor_numbers_.data() + at.begin;
        to = std::copy_n(aa, na * na, to);
        to = std::copy_n(ab, na * nb, to);
        to = std::copy_n(bb, nb * nb, to);
        to = std::copy_n(ga, na, to);
        std::copy_n(gb, nb, to);
    }
    // visit(factor) for each factor of a variable.
    template <class Visit>
    void visit_factors(int variable, const Visit& visit) const {
        for (int f = first_factor_[std::size_t(variable)]; f != none; f = next_factor(f, variable)) visit(f);
    }
    std::pair<int, int> factor_variables(int factor) const {
        return {factors_[std::size_t(factor)].a, factors_[std::size_t(factor)].b};
    }

    int variables() const { return int(sizes_.size()); }
    int rows() const { return int(solution_.size()); }
    double* solution(int variable) { return solution_.data() + starts_[std::size_t(variable)]; }
    const double* solution(int variable) const { return solution_.data() + starts_[std::size_t(variable)]; }
    // Variables whose solution the last call of substitute changed.
    const std::vector<int>& changed() const { return changed_; }
    // How many variables the last update eliminated.
    int eliminated() const { return int(affected_.size()); }

    // Eliminates again what new or changed factors of these variables touch; newest: the variable to order
    // last. False where the matrix is not positive definite. After a failure or an interrupt the next call
    // eliminates everything.
    bool update(const std::vector<int>& touched, int newest) {
        if (is_whole_) {
            collect_affected(touched);
        } else {
            forget_cliques();
        }
        is_whole_ = false;
        order_affected(newest);
        if (!eliminate()) return false;
        is_whole_ = true;
        return true;
    }
    bool is_whole() const { return is_whole_; }
    // From now on nothing is eliminated.
    void spoil() { is_whole_ = false; }

    // Substitutes back: in the new cliques, and below where the solution of a separator changed by more than
    // the threshold.
    void substitute(double threshold) {
        changed_.clear();
        ++step_;
        is_whole_ = false;
        for (std::size_t k = made_.size(); k-- > 0;) solve_clique(made_[k], -1.0);
        path_.assign(orphans_.begin(), orphans_.end());
        InterruptPoll poll(1 << 6);
        while (!path_.empty()) {
            poll.step();
            const int c = path_.back();
            path_.pop_back();
            if (!has_changed_separator(c)) continue;
            solve_clique(c, threshold);
            for (int child = clique(c).child; child != none; child = clique(child).sibling)
                path_.push_back(child);
        }
        is_whole_ = true;
    }

    // The block (a, b) of the inverse row by row: Aᵀ B of the columns A, B of L⁻¹, which are zero beside the
    // paths to the root.
    void inverse_block(int a, int b, double* out) const {
        const int na = size_or_none(a), nb = size_or_none(b);
        std::vector<double> A, B;
        std::vector<int> variables_a, variables_b;
        solve_path(a, A, variables_a);
        if (a != b) solve_path(b, B, variables_b);
        const std::vector<double>& other = a == b ? A : B;
        const auto n = std::size_t(rows());
        for (int i = 0; i < na; ++i) {
            for (int j = 0; j < nb; ++j) {
                const double *x = A.data() + std::size_t(i) * n, *y = other.data() + std::size_t(j) * n;
                double sum = 0;
                for (int v : variables_a) {
                    const int from = starts_[std::size_t(v)];
                    for (int k = from; k < from + sizes_[std::size_t(v)]; ++k) sum += x[k] * y[k];
                }
                out[i * nb + j] = sum;
            }
        }
    }

  private:
    static constexpr int none = -1;
    struct Factor {
        int a, b, next_a, next_b;
        std::size_t begin;
    };
    // A clique: its variables, first those it eliminates; the panel, the complement and the right side.
    struct Clique {
        int fronts = 0, count = 0;     // variables it eliminates, and all
        int pivots = 0, below = 0;     // their rows
        int parent = none, child = none, sibling = none;
        bool is_alive = false;
        int* variables = nullptr;
        double* numbers = nullptr;

        int size() const { return (below + front_lanes - 1) / front_lanes * front_lanes; }
        int stride() const { return pivots + size(); }
        std::size_t number_count() const {
            return std::size_t(stride()) * std::size_t(pivots + 1) + std::size_t(size()) * std::size_t(size());
        }
        double* panel() const { return numbers; }
        double* schur() const { return numbers + std::size_t(stride()) * std::size_t(pivots); }
        double* side() const { return schur() + std::size_t(size()) * std::size_t(size()); }
        // An entry of the front; row ≥ column.
        double* entry(int row, int column) const {
            if (column < pivots)
                return panel() + std::size_t(column) * std::size_t(stride()) + std::size_t(row);
            return schur() + std::size_t(column - pivots) * std::size_t(size()) + std::size_t(row - pivots);
        }
    };

    int size_or_none(int variable) const { return variable < 0 ? 0 : sizes_[std::size_t(variable)]; }
    int next_factor(int f, int variable) const {
        const Factor& at = factors_[std::size_t(f)];
        return at.a == variable ? at.next_a : at.next_b;
    }
    Clique& clique(int c) { return cliques_[std::size_t(c)]; }
    const Clique& clique(int c) const { return cliques_[std::size_t(c)]; }

    void take_variable(int variable) {
        if (local_[std::size_t(variable)] != none) return;
        local_[std::size_t(variable)] = 0;
        affected_.push_back(variable);
    }
    // The variables of the cliques above those touched, which die, and the cliques below that stay.
    void collect_affected(const std::vector<int>& touched) {
        affected_.clear(), orphans_.clear(), dead_.clear();
        for (int variable : touched) {
            take_variable(variable);
            for (int c = clique_of_[std::size_t(variable)]; c != none && clique(c).is_alive;
                 c = clique(c).parent) {
                clique(c).is_alive = false;
                dead_.push_back(c);
                for (int k = 0; k < clique(c).fronts; ++k) take_variable(clique(c).variables[k]);
            }
        }
        for (int c : dead_) {
            for (int child = clique(c).child; child != none; child = clique(child).sibling) {
                if (clique(child).is_alive) orphans_.push_back(child);
            }
        }
        for (int c : dead_) {
            numbers_.give(clique(c).numbers, clique(c).number_count());
            lists_.give(clique(c).variables, std::size_t(clique(c).count));
            free_.push_back(c);
        }
    }
    void forget_cliques() {
        affected_.clear(), orphans_.clear(), cliques_.clear(), free_.clear();
        numbers_.clear(), lists_.clear();
        std::fill(clique_of_.begin(), clique_of_.end(), none);
        for (int v = 0; v < variables(); ++v) affected_.push_back(v);
    }

    // Factors whose variables are all affected; the others are in the complements of the orphans.
    void find_factors() {
        found_.clear();
        for (int v : affected_) {
            for (int f = first_factor_[std::size_t(v)]; f != none; f = next_factor(f, v)) {
                const Factor& at = factors_[std::size_t(f)];
                if (v != (at.a >= 0 ? at.a : at.b)) continue;
                if (at.b < 0 || local_[std::size_t(at.b)] != none) found_.push_back(f);
            }
        }
    }
    void order_affected(int newest) {
        std::sort(affected_.begin(), affected_.end());
        for (std::size_t k = 0; k < affected_.size(); ++k)
            local_[std::size_t(affected_[k])] = int(k);
        find_factors();
        pairs_.clear();
        for (int f : found_) {
            const Factor& at = factors_[std::size_t(f)];
            if (at.a >= 0 && at.b >= 0)
                pairs_.push_back({local_[std::size_t(at.a)], local_[std::size_t(at.b)]});
        }
        for (int orphan : orphans_) {
            const Clique& at = clique(orphan);
            for (int i = at.fronts; i < at.count; ++i) {
                for (int j = i + 1; j < at.count; ++j)
                    pairs_.push_back({local_[std::size_t(at.variables[i])],
                                      local_[std::size_t(at.variables[j])]});
            }
        }
        std::vector<int> sizes;
        sizes.reserve(affected_.size());
        for (int v : affected_) sizes.push_back(sizes_[std::size_t(v)]);
        const BlockGraph graph = make_block_graph(std::move(sizes), pairs_);
        const int last = newest < 0 ? none : local_[std::size_t(newest)];
        pattern_ = analyze_pattern(graph, order_with_last(graph, last), clique_amalgamation);
        for (int v : affected_) local_[std::size_t(v)] = none;
    }
    // Minimum degree of all blocks but one, which comes last.
    static std::vector<int> order_with_last(const BlockGraph& graph, int last) {
        if (last == none) return order_minimum_degree(graph);
        BlockGraph rest;
        rest.sizes = graph.sizes;
        rest.starts.assign(1, 0);
        rest.neighbours.reserve(graph.neighbours.size());
        for (int node = 0; node < graph.nodes(); ++node) {
            for (std::size_t k = graph.starts[std::size_t(node)]; k < graph.starts[std::size_t(node) + 1]; ++k) {
                if (node != last && graph.neighbours[k] != last)
                    rest.neighbours.push_back(graph.neighbours[k]);
            }
            rest.starts.push_back(rest.neighbours.size());
        }
        std::vector<int> order = order_minimum_degree(rest);
        order.erase(std::find(order.begin(), order.end(), last));
        order.push_back(last);
        return order;
    }

    // Factors and orphans are added to the front that eliminates the first of their variables.
    void assign_inputs() {
        const std::size_t nodes = pattern_.supernodes.size();
        first_input_.assign(nodes, none), first_orphan_.assign(nodes, none);
        first_child_.assign(nodes, none);
        next_input_.assign(found_.size(), none), next_orphan_.assign(orphans_.size(), none);
        for (int column = 0; column < pattern_.columns(); ++column)
            row_at_[std::size_t(affected_[std::size_t(pattern_.order[std::size_t(column)])])] = column;
        const auto node_of = [&](int column) { return std::size_t(pattern_.owner[std::size_t(column)]); };
        for (std::size_t k = 0; k < found_.size(); ++k) {
            const Factor& at = factors_[std::size_t(found_[k])];
            int column = row_at_[std::size_t(at.a >= 0 ? at.a : at.b)];
            if (at.a >= 0 && at.b >= 0) column = std::min(column, row_at_[std::size_t(at.b)]);
            next_input_[k] = std::exchange(first_input_[node_of(column)], int(k));
        }
        for (std::size_t k = 0; k < orphans_.size(); ++k) {
            const Clique& at = clique(orphans_[k]);
            int column = pattern_.columns();
            for (int i = at.fronts; i < at.count; ++i)
                column = std::min(column, row_at_[std::size_t(at.variables[i])]);
            next_orphan_[k] = std::exchange(first_orphan_[node_of(column)], int(k));
        }
    }
    bool eliminate() {
        assign_inputs();
        made_.clear();
        InterruptPoll poll(1 << 4);
        for (std::size_t s = 0; s < pattern_.supernodes.size(); ++s) {
            poll.step();
            const int c = make_clique(s);
            Clique& made = clique(c);
            std::fill_n(made.numbers, made.number_count(), 0.0);
            for (int k = first_input_[s]; k != none; k = next_input_[std::size_t(k)])
                add_factor_to(made, factors_[std::size_t(found_[std::size_t(k)])]);
            for (int k = first_orphan_[s]; k != none; k = next_orphan_[std::size_t(k)])
                adopt(c, orphans_[std::size_t(k)]);
            for (int child = first_child_[s]; child != none;)
                child = adopt(c, child);
            if (!factor_clique(made)) return false;
            const int parent = pattern_.supernodes[s].parent;
            if (parent >= 0) made.sibling = std::exchange(first_child_[std::size_t(parent)], c);
        }
        return true;
    }
    // A clique of the variables of a supernode, with the rows of its front in row_at_.
    int make_clique(std::size_t s) {
        const Supernode& node = pattern_.supernodes[s];
        int c = int(cliques_.size());
        if (free_.empty()) {
            cliques_.emplace_back();
        } else {
            c = free_.back();
            free_.pop_back();
        }
        Clique& made = clique(c) = {};
        made.fronts = node.count, made.count = node.count + int(node.end - node.begin);
        made.pivots = node.pivots, made.below = node.below;
        made.is_alive = true;
        made.variables = lists_.take(std::size_t(made.count));
        made.numbers = numbers_.take(made.number_count());
        int row = 0;
        for (int k = 0; k < made.count; ++k) {
            const int column = k < node.count
                                   ? node.first + k
                                   : pattern_.rows[node.begin + std::size_t(k - node.count)];
            const int v = affected_[std::size_t(pattern_.order[std::size_t(column)])];
            made.variables[k] = v;
            row_at_[std::size_t(v)] = row;
            row += sizes_[std::size_t(v)];
            if (k < node.count) clique_of_[std::size_t(v)] = c;
        }
        made_.push_back(c);
        return c;
    }
    void add_factor_to(const Clique& front, const Factor& factor) {
        const int na = size_or_none(factor.a), nb = size_or_none(factor.b);
        const double* const aa = factor_numbers_.data() + factor.begin;
        const double *const ab = aa + na * na, *const bb = ab + na * nb, *const ga = bb + nb * nb;
        if (na) add_diagonal(front, row_at_[std::size_t(factor.a)], aa, ga, na);
        if (nb) add_diagonal(front, row_at_[std::size_t(factor.b)], bb, ga + na, nb);
        if (!na || !nb) return;
        const int ra = row_at_[std::size_t(factor.a)], rb = row_at_[std::size_t(factor.b)];
        for (int i = 0; i < na; ++i) {
            for (int j = 0; j < nb; ++j)
                *(ra > rb ? front.entry(ra + i, rb + j) : front.entry(rb + j, ra + i)) += ab[i * nb + j];
        }
    }
    static void add_diagonal(const Clique& front, int row, const double* block, const double* gradient,
                             int size) {
        for (int c = 0; c < size; ++c) {
            double* const to = front.entry(row, row + c) ;
            for (int r = c; r < size; ++r) to[r] += block[r * size + c];
            front.side()[row + c] -= gradient[c];
        }
    }
    // Adds the complement of a child; returns the sibling it had.
    int adopt(int c, int child) {
        Clique& below = clique(child);
        const Clique& front = clique(c);
        const double* const side = below.side() + below.pivots;
        int column = 0;
        for (int j = below.fronts; j < below.count; ++j) {
            const int width = sizes_[std::size_t(below.variables[j])];
            const int to = row_at_[std::size_t(below.variables[j])];
            for (int k = 0; k < width; ++k) front.side()[to + k] += side[column + k];
            add_columns(front, below, j, column, to, width);
            column += width;
        }
        below.parent = c;
        return std::exchange(below.sibling, std::exchange(clique(c).child, child));
    }
    // One block column of a complement. The orders of a child and of its new parent may differ.
    void add_columns(const Clique& front, const Clique& below, int j, int column, int to, int width) const {
        for (int k = 0; k < width; ++k) {
            const double* from = below.schur() + std::size_t(column + k) * std::size_t(below.size()) +
                                 std::size_t(column);
            double* const here = front.entry(to, to + k);
            for (int r = k; r < width; ++r) here[r] += from[r];
            from += width;
            double* const target = here - to;
            for (int i = j + 1; i < below.count; ++i) {
                const int height = sizes_[std::size_t(below.variables[i])];
                const int row = row_at_[std::size_t(below.variables[i])];
                if (row > to) {
                    for (int r = 0; r < height; ++r) target[row + r] += from[r];
                } else {
                    for (int r = 0; r < height; ++r) *front.entry(to + k, row + r) += from[r];
                }
                from += height;
            }
        }
    }
    static bool factor_clique(const Clique& at) {
        constexpr int many = 256;  // rows from which a strip takes long enough for a look at the clock
        for (int first = 0; first < at.pivots; first += front_lanes) {
            if (!Fronts::factor(at.panel(), at.stride(), at.pivots, first)) return false;
            if (at.stride() > many) poll_interrupts();
        }
        for (int row = 0; row < at.size(); row += front_lanes * front_strip_packs) {
            Fronts::update(at.schur(), at.size(), at.panel(), at.stride(), at.pivots, row);
            if (at.stride() > many) poll_interrupts();
        }
        Fronts::lower(at.panel(), at.stride(), at.pivots, at.side());
        return true;
    }

    bool has_changed_separator(int c) const {
        const Clique& at = clique(c);
        return std::any_of(at.variables + at.fronts, at.variables + at.count,
                           [&](int v) { return stamp_[std::size_t(v)] == step_; });
    }
    // The solution of a clique, kept as it was where it changes by less than the threshold.
    void solve_clique(int c, double threshold) {
        const Clique& at = clique(c);
        x_.resize(std::max(x_.size(), std::size_t(at.stride())));
        double* to = std::copy_n(at.side(), at.pivots, x_.data());
        for (int k = at.fronts; k < at.count; ++k) {
            const double* const known = solution(at.variables[k]);
            for (int i = 0; i < sizes_[std::size_t(at.variables[k])]; ++i) *to++ = known[i];
        }
        for (double* const end = x_.data() + at.stride(); to != end;) *to++ = 0;
        Fronts::upper(at.panel(), at.stride(), at.pivots, x_.data());
        double farthest = 0;
        const double* from = x_.data();
        for (int k = 0; k < at.fronts; ++k) {
            const double* const old = solution(at.variables[k]);
            for (int i = 0; i < sizes_[std::size_t(at.variables[k])]; ++i)
                farthest = std::max(farthest, std::fabs(*from++ - old[i]));
        }
        if (farthest <= threshold) return;
        from = x_.data();
        for (int k = 0; k < at.fronts; ++k) {
            const int v = at.variables[k];
            double* const to_solution = solution(v);
            for (int i = 0; i < sizes_[std::size_t(v)]; ++i) to_solution[i] = *from++;
            stamp_[std::size_t(v)] = step_;
            changed_.push_back(v);
        }
    }

    // The columns of L⁻¹ of a variable, one after the other, and the variables of its path to the root.
    void solve_path(int variable, std::vector<double>& columns, std::vector<int>& path) const {
        const auto n = std::size_t(rows());
        const int size = sizes_[std::size_t(variable)];
        columns.assign(std::size_t(size) * n, 0.0);
        std::vector<double> x;
        for (int k = 0; k < size; ++k)
            columns[std::size_t(k) * n + std::size_t(starts_[std::size_t(variable)] + k)] = 1;
        for (int c = clique_of_[std::size_t(variable)]; c != none; c = clique(c).parent) {
            const Clique& at = clique(c);
            x.resize(std::size_t(at.stride()));
            for (int k = 0; k < size; ++k) {
                double* const column = columns.data() + std::size_t(k) * n;
                visit_rows(at, [&](int row, int from, int count) {
                    std::copy_n(column + from, count, x.data() + row);
                });
                std::fill(x.begin() + at.pivots + at.below, x.end(), 0.0);
                Fronts::lower(at.panel(), at.stride(), at.pivots, x.data());
                visit_rows(at, [&](int row, int from, int count) {
                    std::copy_n(x.data() + row, count, column + from);
                });
            }
            path.insert(path.end(), at.variables, at.variables + at.fronts);
        }
    }
    // visit(row of the front, row of the vectors, count) for the variables of a clique.
    template <class Visit>
    void visit_rows(const Clique& at, const Visit& visit) const {
        int row = 0;
        for (int k = 0; k < at.count; ++k) {
            const auto v = std::size_t(at.variables[k]);
            visit(row, starts_[v], sizes_[v]);
            row += sizes_[v];
        }
    }

    std::vector<int> sizes_, starts_;  // of the variables
    std::vector<int> clique_of_, first_factor_;
    std::vector<double> solution_;
    std::vector<Factor> factors_;
    std::vector<double> factor_numbers_;
    std::vector<Clique> cliques_;
    std::vector<int> free_;  // cliques that died
    NumberPool<double> numbers_;
    NumberPool<int> lists_;
    bool is_whole_ = true;
    // Of the last update.
    std::vector<int> affected_, orphans_, dead_, made_;
    std::vector<int> found_;  // factors
    std::vector<BlockPair> pairs_;
    SymbolicFactor pattern_;
    std::vector<int> first_input_, next_input_, first_orphan_, next_orphan_, first_child_;
    std::vector<int> local_, row_at_;  // of the variables
    // Of the last substitution.
    std::vector<int> changed_, path_, stamp_;
    std::vector<double> x_;
    int step_ = 0;
};

}  // namespace cspace
