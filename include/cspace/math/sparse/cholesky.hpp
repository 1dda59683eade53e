// Multifrontal sparse Cholesky factorisation of symmetric positive definite matrices of small blocks, with
// solves and the selected inverse (Duff & Reid 1983, "The multifrontal solution of indefinite sparse
// symmetric linear systems"; Takahashi, Fagan & Chin 1973; Erisman & Tinney 1975).
//
// The pattern is analysed once; matrices of it are then factored as often as needed. A front adds the blocks
// of its columns and the Schur complements of its children, which wait on a stack, and is factored as a dense
// matrix. Half of the numbers of a large factor stand in small subtrees that take little time. They share one
// place: a solve factors each of them again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cspace/math/sparse/front.hpp"
#include "cspace/math/sparse/nested_dissection.hpp"
#include "cspace/math/sparse/symbolic.hpp"

namespace cspace {

// The dense loops of a front, as the headers have them; src/library has those compiled per instruction set.
struct HeaderFronts {
    static bool factor(double* panel, int stride, int pivots, int first) {
        return factor_columns(panel, stride, pivots, first);
    }
    static void update(double* schur, int size, const double* panel, int stride, int pivots, int row) {
        update_strip(schur, size, panel, stride, pivots, row);
    }
    static void lower(const double* panel, int stride, int pivots, double* x) {
        solve_lower(panel, stride, pivots, x);
    }
    static void upper(const double* panel, int stride, int pivots, double* x) {
        solve_upper(panel, stride, pivots, x);
    }
};

// Where a block of the matrix stands among the values: column by column, with so many rows. The block of (i,
// j) off the diagonal is stored once, with the block eliminated later as its rows; transposed: those are of
// j.
struct BlockSlot {
    std::size_t at;
    int rows;
    bool is_transposed;
};

// Numbers that are undefined at first: zeros for all of a large factor would take long, with no look at the
// clock.
class RawNumbers {
  public:
    void allocate(std::size_t count) {
        if (count == count_) return;
        numbers_ = std::make_unique_for_overwrite<double[]>(count);
        count_ = count;
    }
    double* data() { return numbers_.get(); }
    const double* data() const { return numbers_.get(); }

  private:
    std::unique_ptr<double[]> numbers_;
    std::size_t count_ = 0;
};

// Which panels share one place: those of subtrees with so many numbers at most, where all are more.
struct PanelSharing {
    std::size_t large = 48'000'000;  // numbers, 384 MB; factors of common graphs are smaller
    std::size_t subtree = 1 << 19;   // numbers, 4 MB
};

template <class Fronts = HeaderFronts>
class SparseCholesky {
  public:
    SparseCholesky(const BlockGraph& graph, std::vector<int> order, const Amalgamation& rule = {},
                   const PanelSharing& sharing = {})
        : factor_(analyze_pattern(graph, std::move(order), rule)) {
        place_values(graph);
        place_panels(sharing);
        place_rows();
        place_targets();
        for (std::size_t s = 0; s < nodes(); ++s) place_runs(s);
    }
    explicit SparseCholesky(const BlockGraph& graph) : SparseCholesky(graph, order_blocks(graph)) {}

    const SymbolicFactor& pattern() const { return factor_; }
    int rows() const { return factor_.starts.back(); }
    // The first row of a block in vectors, which have the order of the elimination.
    int row_of(int block) const { return factor_.starts[std::size_t(factor_.place[std::size_t(block)])]; }
    std::size_t value_count() const { return value_count_; }
    std::size_t factor_count() const { return panels_.back(); }  // numbers that are kept
    std::size_t stack_count() const {
        return stack_peak_;
    }  // numbers beside the factor, while it is computed

    // The slot of the block (i, j), which must be in the pattern.
    BlockSlot slot_of(int i, int j) const {
        const int a = factor_.place[std::size_t(i)], b = factor_.place[std::size_t(j)];
        const auto column = std::size_t(std::min(a, b));
        const auto begin = blocks_.begin() + std::ptrdiff_t(first_block_[column]);
        const auto end = blocks_.begin() + std::ptrdiff_t(first_block_[column + 1]);
        const auto found = std::lower_bound(begin, end, std::max(a, b),
                                            [](const Block& block, int row) { return block.row < row; });
        return {found->at, factor_.size(found->row), a < b};
    }

    // Factors the matrix of these values, with `added` on its diagonal unless null; both must stay until the
    // last solve. False where it is not positive definite; failed_block() then is near the reason.
    bool factor_matrix(const double* values, const double* added = nullptr) {
        return eliminate(values, added, {});
    }
    // Factors, and each x becomes A⁻¹ x, in the order of the elimination.
    bool solve_matrix(const double* values, const double* added, std::span<double* const> sides) {
        if (!eliminate(values, added, sides)) return false;
        substitute_back(sides);
        return true;
    }
    int failed_block() const { return failed_; }

    // x becomes A⁻¹ x, in the order of the elimination.
    void solve(double* x) {
        InterruptPoll poll(1 << 6);
        for (std::size_t s = 0; s < nodes(); ++s) {
            poll.step();
            restore_panel(s);
            solve_lower_front(s, x);
        }
        substitute_back({&x, 1});
    }

    // y = A x for the values of a matrix, in the order of the elimination.
    void multiply(const double* values, const double* x, double* y) const {
        std::fill_n(y, rows(), 0.0);
        for (int column = 0; column < factor_.columns(); ++column) {
            const int from = factor_.starts[std::size_t(column)], size = factor_.size(column);
            for (std::size_t b = first_block_[std::size_t(column)]; b < first_block_[std::size_t(column) + 1];
                 ++b) {
                const int to = factor_.starts[std::size_t(blocks_[b].row)],
                          height = factor_.size(blocks_[b].row);
                multiply_block(values + blocks_[b].at, x, y, to, height, from, size);
            }
        }
    }

    // Computes the entries of the inverse on the pattern of the factor.
    void invert_pattern() {
        inverse_.allocate(inverses_.back());
        std::vector<int> local(std::size_t(factor_.columns()));
        for (std::size_t s = nodes(); s-- > 0;) {
            poll_interrupts();
            restore_panel(s);
            gather_inverse(s, local);
            invert_front(s);
        }
    }
    // The block (i, j) of the inverse row by row, after invert_pattern(); false outside of the pattern.
    bool inverse_block(int i, int j, double* out) const {
        const int a = factor_.place[std::size_t(i)], b = factor_.place[std::size_t(j)];
        const int column = std::min(a, b), row = std::max(a, b);
        const auto s = std::size_t(factor_.owner[std::size_t(column)]);
        const int offset = local_row(s, row);
        if (offset < 0) return false;
        const int first =
            factor_.starts[std::size_t(column)] - factor_.starts[std::size_t(supernode(s).first)];
        const double* const from = inverse_.data() + inverses_[s];
        for (int r = 0; r < factor_.size(row); ++r) {
            for (int c = 0; c < factor_.size(column); ++c) {
                const double value =
                    from[std::size_t(first + c) * std::size_t(stride(s)) + std::size_t(offset + r)];
                out[a >= b ? r * factor_.size(column) + c : c * factor_.size(row) + r] = value;
            }
        }
        return true;
    }

  private:
    struct Block {
        int row;             // block column of the factor that is its row
        std::size_t at;      // of its values
        std::size_t target;  // of its first number in the panels
    };
    // Rows of a child that are neighbours in its parent too.
    struct Run {
        int from, to, length;
    };
    // Rows from which a strip or a column takes long enough for a look at the clock.
    static constexpr std::size_t many_rows = 256;
    static int round_up(int count) { return (count + front_lanes - 1) / front_lanes * front_lanes; }

    std::size_t nodes() const { return factor_.supernodes.size(); }
    const Supernode& supernode(std::size_t s) const { return factor_.supernodes[s]; }
    int stride(std::size_t s) const { return supernode(s).pivots + round_up(supernode(s).below); }
    double* panel(std::size_t s) { return numbers_.data() + panels_[s]; }

    void place_values(const BlockGraph& graph) {
        first_block_.reserve(std::size_t(factor_.columns()) + 1);
        blocks_.reserve(graph.neighbours.size() / 2 + std::size_t(factor_.columns()));
        for (int column = 0; column < factor_.columns(); ++column) {
            const auto block = std::size_t(factor_.order[std::size_t(column)]);
            const std::size_t begin = blocks_.size();
            first_block_.push_back(begin);
            blocks_.push_back({column, 0, 0});
            for (std::size_t k = graph.starts[block]; k < graph.starts[block + 1]; ++k) {
                const int row = factor_.place[std::size_t(graph.neighbours[k])];
                if (row > column) blocks_.push_back({row, 0, 0});
            }
            std::sort(blocks_.begin() + std::ptrdiff_t(begin), blocks_.end(),
                      [](const Block& a, const Block& b) { return a.row < b.row; });
            for (std::size_t b = begin; b < blocks_.size(); ++b) {
                blocks_[b].at = value_count_;
                value_count_ += std::size_t(factor_.size(column)) * std::size_t(factor_.size(blocks_[b].row));
            }
        }
        first_block_.push_back(blocks_.size());
    }
    // Panels one after the other; complements on a stack, from which the parent removes those of its
    // children.
    void place_panels(const PanelSharing& sharing) {
        share_panels(sharing);
        complements_.resize(nodes());
        scratch_.resize(nodes());
        std::vector<std::size_t> base(nodes(), 0);
        std::vector<char> has_child(nodes(), 0);
        std::size_t top = 0;
        int tallest = 0;
        for (std::size_t s = 0; s < nodes(); ++s) {
            const auto size = std::size_t(round_up(supernode(s).below));
            scratch_[s] = top;
            complements_[s] = has_child[s] ? base[s] : top;
            stack_peak_ = std::max(stack_peak_, top + size * size);
            top = complements_[s] + size * size;
            tallest = std::max(tallest, stride(s));
            if (supernode(s).parent < 0) continue;
            const auto parent = std::size_t(supernode(s).parent);
            if (!has_child[parent]) has_child[parent] = 1, base[parent] = complements_[s];
        }
        local_.assign(std::size_t(tallest), 0.0);
    }
    std::size_t panel_size(std::size_t s) const {
        return std::size_t(stride(s)) * std::size_t(supernode(s).pivots);
    }
    // Panels that share the place before all others, and where each stands.
    void share_panels(const PanelSharing& sharing) {
        std::vector<std::size_t> below(nodes(), 0), first(nodes());  // numbers and first node of each subtree
        for (std::size_t s = 0; s < nodes(); ++s) first[s] = s;
        inverses_.assign(1, 0);
        for (std::size_t s = 0; s < nodes(); ++s) {
            inverses_.push_back(inverses_.back() + panel_size(s));
            below[s] += panel_size(s);
            if (supernode(s).parent < 0) continue;
            const auto parent = std::size_t(supernode(s).parent);
            below[parent] += below[s], first[parent] = std::min(first[parent], first[s]);
        }
        panels_ = inverses_;
        subtree_of_.assign(nodes(), -1);
        if (inverses_.back() <= sharing.large) return;
        std::size_t shared = 0;
        for (std::size_t s = 0; s < nodes(); ++s) {
            const int parent = supernode(s).parent;
            const bool is_root = parent < 0 || below[std::size_t(parent)] > sharing.subtree;
            if (below[s] > sharing.subtree || !is_root) continue;
            for (std::size_t k = first[s]; k <= s; ++k) {
                subtree_of_[k] = int(subtrees_.size());
                panels_[k] = inverses_[k] - inverses_[first[s]];
            }
            subtrees_.push_back({first[s], s + 1});
            shared = std::max(shared, below[s]);
        }
        std::size_t at = shared;
        for (std::size_t s = 0; s < nodes(); ++s) {
            if (subtree_of_[s] < 0) panels_[s] = std::exchange(at, at + panel_size(s));
        }
        panels_.back() = at;
    }
    void place_rows() {
        row_offsets_.reserve(factor_.rows.size());
        for (const Supernode& at : factor_.supernodes) {
            int next = at.pivots;
            for (std::size_t k = at.begin; k < at.end; ++k) {
                row_offsets_.push_back(next);
                next += factor_.size(factor_.rows[k]);
            }
        }
    }
    // Sets the first row of each block row of a front.
    void set_local_rows(std::size_t s, std::vector<int>& local) const {
        const Supernode& at = supernode(s);
        for (int k = 0; k < at.count; ++k) {
            const int column = at.first + k;
            local[std::size_t(column)] =
                factor_.starts[std::size_t(column)] - factor_.starts[std::size_t(at.first)];
        }
        for (std::size_t k = at.begin; k < at.end; ++k) local[std::size_t(factor_.rows[k])] = row_offsets_[k];
    }
    void place_targets() {
        std::vector<int> local(std::size_t(factor_.columns()));
        children_.assign(nodes(), -1), siblings_.assign(nodes(), -1);
        run_starts_.assign(nodes() + 1, 0);
        for (std::size_t s = nodes(); s-- > 0;) {
            if (supernode(s).parent >= 0)
                siblings_[s] = std::exchange(children_[std::size_t(supernode(s).parent)], int(s));
        }
        for (std::size_t s = 0; s < nodes(); ++s) {
            const Supernode& at = supernode(s);
            set_local_rows(s, local);
            for (int column = at.first; column < at.first + at.count; ++column) {
                const std::size_t begin =
                    panels_[s] + std::size_t(local[std::size_t(column)]) * std::size_t(stride(s));
                for (std::size_t b = first_block_[std::size_t(column)];
                     b < first_block_[std::size_t(column) + 1]; ++b)
                    blocks_[b].target = begin + std::size_t(local[std::size_t(blocks_[b].row)]);
            }
        }
    }
    // The rows of a front, in the front of its parent.
    void place_runs(std::size_t s) {
        const Supernode& at = supernode(s);
        run_starts_[s] = runs_.size();
        int from = 0;
        for (std::size_t k = at.begin; k < at.end; ++k) {
            const int row = factor_.rows[k], size = factor_.size(row);
            const int to = local_row(std::size_t(at.parent), row);
            if (k > at.begin && runs_.back().to + runs_.back().length == to)
                runs_.back().length += size;
            else
                runs_.push_back({from, to, size});
            from += size;
        }
        run_starts_[s + 1] = runs_.size();
    }
    // The first row of a block row in a front; −1 outside of it.
    int local_row(std::size_t s, int row) const {
        const Supernode& at = supernode(s);
        if (row < at.first + at.count)
            return row < at.first ? -1
                                  : factor_.starts[std::size_t(row)] - factor_.starts[std::size_t(at.first)];
        const auto begin = factor_.rows.begin() + std::ptrdiff_t(at.begin);
        const auto end = factor_.rows.begin() + std::ptrdiff_t(at.end);
        const auto found = std::lower_bound(begin, end, row);
        if (found == end || *found != row) return -1;
        return row_offsets_[std::size_t(found - factor_.rows.begin())];
    }

    // Factors all fronts, and substitutes forwards in each side.
    bool eliminate(const double* values, const double* added, std::span<double* const> sides) {
        numbers_.allocate(panels_.back());
        stack_.allocate(stack_peak_);
        values_ = values, added_ = added;
        InterruptPoll poll(1 << 4);
        for (std::size_t s = 0; s < nodes(); ++s) {
            poll.step();
            assemble_front(s, values, added);
            if (!factor_front(s)) {
                failed_ = factor_.order[std::size_t(factor_.supernodes[s].first)];
                return false;
            }
            for (double* x : sides) solve_lower_front(s, x);
        }
        resident_ = int(subtrees_.size()) - 1;
        return true;
    }
    void substitute_back(std::span<double* const> sides) {
        InterruptPoll poll(1 << 6);
        for (std::size_t s = nodes(); s-- > 0;) {
            poll.step();
            restore_panel(s);
            for (double* x : sides) {
                gather_rows(s, x);
                Fronts::upper(panel(s), stride(s), supernode(s).pivots, local_.data());
                scatter_rows(s, x, false);
            }
        }
    }
    void solve_lower_front(std::size_t s, double* x) {
        gather_rows(s, x);
        Fronts::lower(panel(s), stride(s), supernode(s).pivots, local_.data());
        scatter_rows(s, x, true);
    }
    // Factors the subtree of a front again where another one has taken its place. The stack is free by then.
    void restore_panel(std::size_t s) {
        const int subtree = subtree_of_[s];
        if (subtree < 0 || subtree == resident_) return;
        resident_ = -1;
        InterruptPoll poll(1 << 4);
        for (std::size_t k = subtrees_[std::size_t(subtree)].first;
             k < subtrees_[std::size_t(subtree)].second; ++k) {
            poll.step();
            assemble_front(k, values_, added_);
            factor_front(k);
        }
        resident_ = subtree;
    }

    void assemble_front(std::size_t s, const double* values, const double* added) {
        const Supernode& at = supernode(s);
        const auto step = std::size_t(stride(s)), size = std::size_t(round_up(at.below));
        std::fill_n(panel(s), step * std::size_t(at.pivots), 0.0);
        for (std::size_t column = 0; column < size; ++column) {
            std::fill_n(stack_.data() + scratch_[s] + column * size, size, 0.0);
            if (size > many_rows) poll_interrupts();
        }
        for (int column = at.first; column < at.first + at.count; ++column) {
            const int width = factor_.size(column);
            for (std::size_t b = first_block_[std::size_t(column)]; b < first_block_[std::size_t(column) + 1];
                 ++b) {
                const int height = factor_.size(blocks_[b].row);
                const double* from = values + blocks_[b].at;
                double* to = numbers_.data() + blocks_[b].target;
                for (int c = 0; c < width; ++c, from += height, to += step) std::copy_n(from, height, to);
            }
        }
        if (added) {
            const double* const here = added + factor_.starts[std::size_t(at.first)];
            for (int k = 0; k < at.pivots; ++k) panel(s)[std::size_t(k) * (step + 1)] += here[k];
        }
        for (int child = children_[s]; child >= 0; child = siblings_[std::size_t(child)])
            add_complement(std::size_t(child), s);
    }
    void add_complement(std::size_t child, std::size_t s) {
        const int pivots = supernode(s).pivots;
        const auto step = std::size_t(stride(s)), size = std::size_t(round_up(supernode(s).below));
        const auto child_size = std::size_t(round_up(supernode(child).below));
        const double* const from = stack_.data() + complements_[child];
        double* const schur = stack_.data() + scratch_[s];
        const Run* const begin = runs_.data() + run_starts_[child];
        const Run* const end = runs_.data() + run_starts_[child + 1];
        for (const Run* across = begin; across != end; ++across) {
            for (int c = 0; c < across->length; ++c) {
                const double* const source = from + std::size_t(across->from + c) * child_size;
                const int column = across->to + c;
                double* const target = column < pivots ? panel(s) + std::size_t(column) * step
                                                       : schur + std::size_t(column - pivots) * size - pivots;
                add_numbers(source + across->from + c, target + column, across->length - c);
                for (const Run* down = across + 1; down != end; ++down)
                    add_numbers(source + down->from, target + down->to, down->length);
                if (child_size > many_rows) poll_interrupts();
            }
        }
    }
    static void add_numbers(const double* from, double* to, int count) {
        for (int k = 0; k < count; ++k) to[k] += from[k];
    }
    bool factor_front(std::size_t s) {
        const Supernode& at = supernode(s);
        const int size = round_up(at.below), height = stride(s);
        for (int first = 0; first < at.pivots; first += front_lanes) {
            if (!Fronts::factor(panel(s), height, at.pivots, first)) return false;
            if (height > int(many_rows)) poll_interrupts();
        }
        double* const schur = stack_.data() + scratch_[s];
        for (int row = 0; row < size; row += front_lanes * front_strip_packs) {
            Fronts::update(schur, size, panel(s), height, at.pivots, row);
            if (height > int(many_rows)) poll_interrupts();
        }
        if (scratch_[s] == complements_[s]) return true;
        double* const to = stack_.data() + complements_[s];
        for (std::ptrdiff_t column = 0; column < size; ++column) {  // the first first: it moves down
            std::memmove(to + column * size, schur + column * size, sizeof(double) * std::size_t(size));
            if (size > int(many_rows)) poll_interrupts();
        }
        return true;
    }

    void gather_rows(std::size_t s, const double* x) {
        const Supernode& at = supernode(s);
        double* to = std::copy_n(x + factor_.starts[std::size_t(at.first)], at.pivots, local_.data());
        for (std::size_t k = at.begin; k < at.end; ++k)
            to = std::copy_n(x + factor_.starts[std::size_t(factor_.rows[k])], factor_.size(factor_.rows[k]),
                             to);
        std::fill(to, local_.data() + stride(s), 0.0);
    }
    void scatter_rows(std::size_t s, double* x, bool below) const {
        const Supernode& at = supernode(s);
        const double* from = local_.data();
        std::copy_n(from, at.pivots, x + factor_.starts[std::size_t(at.first)]);
        if (!below) return;
        from += at.pivots;
        for (std::size_t k = at.begin; k < at.end; ++k) {
            const int size = factor_.size(factor_.rows[k]);
            std::copy_n(from, size, x + factor_.starts[std::size_t(factor_.rows[k])]);
            from += size;
        }
    }
    static void multiply_block(const double* block, const double* x, double* y, int to, int height, int from,
                               int width) {
        for (int c = 0; c < width; ++c, block += height) {
            for (int r = 0; r < height; ++r) {
                if (to == from && r < c) continue;
                y[to + r] += block[r] * x[from + c];
                if (to + r != from + c) y[from + c] += block[r] * x[to + r];
            }
        }
    }

    // The inverse on the rows below a front, from the fronts that own them, as a full symmetric matrix.
    void gather_inverse(std::size_t s, std::vector<int>& local) {
        const Supernode& at = supernode(s);
        const auto below = std::size_t(at.below);
        dense_.resize(below * below);
        int owner = -1;
        std::size_t column = 0;
        for (std::size_t j = at.begin; j < at.end; ++j) {
            const int block = factor_.rows[j];
            if (factor_.owner[std::size_t(block)] != owner) {
                owner = factor_.owner[std::size_t(block)];
                set_local_rows(std::size_t(owner), local);
            }
            const double* const from = inverse_.data() + inverses_[std::size_t(owner)];
            const auto step = std::size_t(stride(std::size_t(owner)));
            for (int c = 0; c < factor_.size(block); ++c, ++column) {
                const double* const source = from + std::size_t(local[std::size_t(block)] + c) * step;
                std::size_t row = column - std::size_t(c);
                for (std::size_t i = j; i < at.end; ++i) {
                    const int first = local[std::size_t(factor_.rows[i])];
                    for (int r = 0; r < factor_.size(factor_.rows[i]); ++r, ++row) {
                        dense_[column * below + row] = source[first + r];
                        dense_[row * below + column] = source[first + r];
                    }
                }
            }
        }
    }
    // Z₂₁ = −Z₂₂ G and Z₁₁ = L⁻ᵀL⁻¹ − Gᵀ Z₂₁ with G = L₂₁ L₁₁⁻¹.
    void invert_front(std::size_t s) {
        const Supernode& at = supernode(s);
        const auto p = std::size_t(at.pivots), below = std::size_t(at.below), step = std::size_t(stride(s));
        const double* const L = panel(s);
        double* const Z = inverse_.data() + inverses_[s];
        std::fill_n(Z, step * p, 0.0);
        gain_.assign(below * p, 0.0);
        for (std::size_t k = p; k-- > 0;) {  // columns of G, the last first
            double* const g = gain_.data() + k * below;
            std::copy_n(L + k * step + p, below, g);
            for (std::size_t m = k + 1; m < p; ++m)
                add_multiple(-L[k * step + m], gain_.data() + m * below, g, below);
            for (std::size_t r = 0; r < below; ++r) g[r] /= L[k * step + k];
        }
        for (std::size_t k = 0; k < p; ++k) {
            for (std::size_t m = 0; m < below; ++m)
                add_multiple(-gain_[k * below + m], dense_.data() + m * below, Z + k * step + p, below);
            poll_interrupts();
        }
        invert_pivots(L, Z, step, p);
        for (std::size_t k = 0; k < p; ++k) {
            for (std::size_t m = k; m < p; ++m) {
                double sum = Z[k * step + m];
                for (std::size_t r = 0; r < below; ++r) sum -= gain_[m * below + r] * Z[k * step + p + r];
                Z[k * step + m] = Z[m * step + k] = sum;
            }
        }
    }
    static void add_multiple(double factor, const double* from, double* to, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) to[k] += factor * from[k];
    }
    // The lower half of (L Lᵀ)⁻¹ of the pivots, by columns of the identity.
    void invert_pivots(const double* L, double* Z, std::size_t step, std::size_t p) {
        std::vector<double> x(p);
        for (std::size_t k = 0; k < p; ++k) {
            std::fill(x.begin(), x.end(), 0.0);
            x[k] = 1;
            for (std::size_t c = k; c < p; ++c) {
                x[c] /= L[c * step + c];
                for (std::size_t r = c + 1; r < p; ++r) x[r] -= L[c * step + r] * x[c];
            }
            for (std::size_t c = p; c-- > k;) {
                double sum = x[c];
                for (std::size_t r = c + 1; r < p; ++r) sum -= L[c * step + r] * x[r];
                x[c] = sum / L[c * step + c];
            }
            std::copy(x.begin() + std::ptrdiff_t(k), x.end(), Z + k * step + k);
        }
    }

    SymbolicFactor factor_;
    std::vector<std::size_t> first_block_;  // of each column, and the number of blocks
    std::vector<Block> blocks_;
    std::size_t value_count_ = 0;
    std::vector<std::size_t> panels_;    // begin of each panel, and the numbers of all
    std::vector<std::size_t> inverses_;  // the same of the inverse, where none share a place
    std::vector<int> subtree_of_;        // of each front whose panel shares its place, else −1
    std::vector<std::pair<std::size_t, std::size_t>> subtrees_;  // first front, and that after the last
    int resident_ = -1;                                          // subtree whose panels are there
    std::vector<std::size_t> scratch_, complements_;  // where a complement is made, and where it waits
    std::size_t stack_peak_ = 0;
    std::vector<int> children_, siblings_;
    std::vector<int> row_offsets_;  // of each block row below its supernode, in the front
    std::vector<std::size_t> run_starts_;
    std::vector<Run> runs_;
    RawNumbers numbers_, stack_, inverse_;
    const double *values_ = nullptr, *added_ = nullptr;  // of the matrix that was factored
    std::vector<double> local_, dense_, gain_;
    int failed_ = -1;
};

}  // namespace cspace
