// Laws of the sparse Cholesky factorisation: it agrees with a dense one on random patterns of blocks.
#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "cspace/math/sparse/cholesky.hpp"
#include "dense_matrices.hpp"
#include "random.hpp"

namespace {

using check::Dense;
using cspace::BlockGraph;
using cspace::BlockPair;

struct Problem {
    std::vector<int> sizes;
    std::vector<BlockPair> pairs;
    std::vector<int> starts{0};
    Dense A;
};

// A diagonally dominant matrix of blocks of one to six rows; pairs repeat, in both directions.
Problem random_problem(check::Random& random, int blocks, int pairs, bool is_chain) {
    Problem made;
    for (int i = 0; i < blocks; ++i) {
        made.sizes.push_back(1 + random.below(6));
        made.starts.push_back(made.starts.back() + made.sizes.back());
    }
    if (is_chain) {
        for (int i = 1; i < blocks; ++i) made.pairs.push_back({i, i - 1});
    }
    for (int k = 0; k < pairs; ++k) made.pairs.push_back({random.below(blocks), random.below(blocks)});
    const auto n = std::size_t(made.starts.back());
    made.A.assign(n, std::vector<double>(n, 0.0));
    for (auto [i, j] : made.pairs) {
        for (int r = made.starts[std::size_t(i)]; r < made.starts[std::size_t(i) + 1]; ++r) {
            for (int c = made.starts[std::size_t(j)]; c < made.starts[std::size_t(j) + 1]; ++c)
                made.A[std::size_t(r)][std::size_t(c)] = made.A[std::size_t(c)][std::size_t(r)] =
                    random.uniform(-1, 1);
        }
    }
    for (std::size_t r = 0; r < n; ++r) {
        double sum = 0.1;
        for (double x : made.A[r]) sum += std::fabs(x);
        made.A[r][r] = sum;
    }
    // Blocks on the diagonal are full.
    for (std::size_t b = 0; b < made.sizes.size(); ++b) {
        for (int r = made.starts[b]; r < made.starts[b + 1]; ++r) {
            for (int c = made.starts[b]; c < r; ++c) {
                const double x = random.uniform(-0.01, 0.01);
                made.A[std::size_t(r)][std::size_t(c)] += x;
                made.A[std::size_t(c)][std::size_t(r)] = made.A[std::size_t(r)][std::size_t(c)];
            }
        }
    }
    return made;
}

template <class Solver>
std::vector<double> values_of(const Problem& problem, const Solver& solver) {
    std::vector<double> values(solver.value_count());
    const auto write = [&](int i, int j) {
        const cspace::BlockSlot slot = solver.slot_of(i, j);
        const int row = slot.is_transposed ? j : i, column = slot.is_transposed ? i : j;
        for (int r = 0; r < problem.sizes[std::size_t(row)]; ++r) {
            for (int c = 0; c < problem.sizes[std::size_t(column)]; ++c)
                values[slot.at + std::size_t(c * slot.rows + r)] =
                    problem.A[std::size_t(problem.starts[std::size_t(row)] + r)]
                             [std::size_t(problem.starts[std::size_t(column)] + c)];
        }
    };
    for (int i = 0; i < int(problem.sizes.size()); ++i) write(i, i);
    for (auto [i, j] : problem.pairs) write(i, j);
    return values;
}

void check_problem(const Problem& problem, check::Random& random, const cspace::PanelSharing& sharing) {
    const BlockGraph graph = cspace::make_block_graph(problem.sizes, problem.pairs);
    cspace::SparseCholesky<> solver(graph, cspace::order_blocks(graph), {}, sharing);
    std::vector<int> order = solver.pattern().order;
    std::sort(order.begin(), order.end());
    for (int k = 0; k < int(order.size()); ++k) CHECK(order[std::size_t(k)] == k);

    const std::vector<double> values = values_of(problem, solver);
    CHECK(solver.factor_matrix(values.data()));
    const Dense inverse = check::invert_dense(problem.A);
    const auto n = std::size_t(problem.starts.back());
    std::vector<double> b(n), x(n), y(n);
    std::vector<std::size_t> row(n);
    for (int block = 0; block < int(problem.sizes.size()); ++block) {
        for (int r = 0; r < problem.sizes[std::size_t(block)]; ++r)
            row[std::size_t(problem.starts[std::size_t(block)] + r)] = std::size_t(solver.row_of(block) + r);
    }
    for (std::size_t k = 0; k < n; ++k) x[row[k]] = b[k] = random.uniform(-1, 1);
    solver.solve(x.data());
    for (std::size_t k = 0; k < n; ++k) {
        double expected = 0;
        for (std::size_t j = 0; j < n; ++j) expected += inverse[k][j] * b[j];
        CHECK_NEAR(x[row[k]], expected, 1e-9);
    }
    solver.multiply(values.data(), x.data(), y.data());
    for (std::size_t k = 0; k < n; ++k) CHECK_NEAR(y[row[k]], b[k], 1e-9);
    std::vector<double> z(n);
    for (std::size_t k = 0; k < n; ++k) y[row[k]] = b[k], z[row[k]] = -2 * b[k];
    double* const sides[] = {y.data(), z.data()};
    CHECK(solver.solve_matrix(values.data(), nullptr, sides));
    for (std::size_t k = 0; k < n; ++k) {
        CHECK_NEAR(y[k], x[k], 1e-12);
        CHECK_NEAR(z[k], -2 * x[k], 1e-12);
    }

    solver.invert_pattern();
    for (int i = 0; i < int(problem.sizes.size()); ++i) {
        for (int j = 0; j < int(problem.sizes.size()); ++j) {
            double block[36];
            const bool is_found = solver.inverse_block(i, j, block);
            CHECK(is_found || i != j);
            if (!is_found) continue;
            const int width = problem.sizes[std::size_t(j)];
            for (int r = 0; r < problem.sizes[std::size_t(i)]; ++r) {
                for (int c = 0; c < width; ++c)
                    CHECK_NEAR(block[r * width + c],
                               inverse[std::size_t(problem.starts[std::size_t(i)] + r)]
                                      [std::size_t(problem.starts[std::size_t(j)] + c)],
                               1e-9);
            }
        }
    }
    for (auto [i, j] : problem.pairs) {
        double block[36];
        CHECK(solver.inverse_block(i, j, block));
    }
}
// With all panels kept, and with small subtrees that share one place.
void check_problem(const Problem& problem, check::Random& random) {
    for (std::size_t subtree : {std::size_t(0), std::size_t(50), std::size_t(500), std::size_t(1) << 20})
        check_problem(problem, random, {0, subtree});
}

}  // namespace

TEST(factor_agrees_with_dense_elimination) {
    check::Random random{7};
    for (int trial = 0; trial < 60; ++trial) {
        const int blocks = 1 + random.below(40);
        check_problem(random_problem(random, blocks, random.below(3 * blocks), random.below(2) == 0), random);
    }
}

TEST(graphs_in_parts_and_without_edges) {
    check::Random random{11};
    check_problem(random_problem(random, 12, 0, false), random);
    check_problem(random_problem(random, 30, 6, false), random);
}

TEST(order_of_a_tree_has_no_fill) {
    std::vector<BlockPair> pairs;
    for (int i = 1; i < 200; ++i) pairs.push_back({i, (i - 1) / 3});
    const BlockGraph graph = cspace::make_block_graph(std::vector<int>(200, 1), pairs);
    const cspace::SymbolicFactor factor = cspace::analyze_pattern(graph, cspace::order_minimum_degree(graph),
                                                                  {0, 0, 0, 1e-9, 1e-9, 1e-9, 1 << 20});
    std::size_t stored = 0;
    for (const cspace::Supernode& at : factor.supernodes)
        stored += std::size_t(at.pivots * (at.pivots + 1) / 2 + at.pivots * at.below);
    CHECK(stored == 200 + 199);
}

TEST(indefinite_matrices_are_refused) {
    check::Random random{3};
    Problem problem = random_problem(random, 20, 30, true);
    problem.A[7][7] = -1;
    cspace::SparseCholesky<> solver(cspace::make_block_graph(problem.sizes, problem.pairs));
    CHECK(!solver.factor_matrix(values_of(problem, solver).data()));
    CHECK(solver.failed_block() >= 0);
}

TEST(added_diagonal_is_damping) {
    check::Random random{5};
    Problem problem = random_problem(random, 25, 40, true);
    const BlockGraph graph = cspace::make_block_graph(problem.sizes, problem.pairs);
    cspace::SparseCholesky<> solver(graph), damped(graph);
    const std::vector<double> values = values_of(problem, solver), added(std::size_t(solver.rows()), 0.7);
    for (std::size_t k = 0; k < problem.A.size(); ++k) problem.A[k][k] += 0.7;
    const std::vector<double> damped_values = values_of(problem, damped);
    CHECK(solver.factor_matrix(values.data(), added.data()) && damped.factor_matrix(damped_values.data()));
    std::vector<double> x(std::size_t(solver.rows()), 1.0), y = x;
    solver.solve(x.data()), damped.solve(y.data());
    for (std::size_t k = 0; k < x.size(); ++k) CHECK_NEAR(x[k], y[k], 1e-12);
}

namespace {

// A box of so many nodes along each side, with the edges of a grid.
BlockGraph make_grid(int width, int height, int depth, int size) {
    const auto number = [&](int x, int y, int z) { return (z * height + y) * width + x; };
    std::vector<BlockPair> pairs;
    for (int z = 0; z < depth; ++z) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (x > 0) pairs.push_back({number(x, y, z), number(x - 1, y, z)});
                if (y > 0) pairs.push_back({number(x, y, z), number(x, y - 1, z)});
                if (z > 0) pairs.push_back({number(x, y, z), number(x, y, z - 1)});
            }
        }
    }
    return cspace::make_block_graph(std::vector<int>(std::size_t(width * height * depth), size), pairs);
}
BlockGraph random_graph(check::Random& random, int blocks, int pairs) {
    std::vector<int> sizes;
    std::vector<BlockPair> drawn;
    for (int i = 0; i < blocks; ++i) sizes.push_back(1 + random.below(6));
    for (int k = 0; k < pairs; ++k) drawn.push_back({random.below(blocks), random.below(blocks)});
    return cspace::make_block_graph(std::move(sizes), drawn);
}
void check_order(std::vector<int> order) {
    std::sort(order.begin(), order.end());
    for (int k = 0; k < int(order.size()); ++k) CHECK(order[std::size_t(k)] == k);
}
cspace::WeightedGraph weigh_graph(const BlockGraph& graph) {
    return {graph.sizes, graph.starts, graph.neighbours, std::vector<int>(graph.neighbours.size(), 1)};
}

}  // namespace

TEST(separators_leave_no_edge_between_the_parts) {
    check::Random random{21};
    for (int trial = 0; trial < 60; ++trial) {
        const int blocks = 1 + random.below(3000);
        const BlockGraph graph = random_graph(random, blocks, random.below(3 * blocks));
        const std::vector<cspace::Part> parts = cspace::find_separator(weigh_graph(graph));
        CHECK(int(parts.size()) == blocks);
        for (int i = 0; i < blocks; ++i) {
            for (std::size_t k = graph.starts[std::size_t(i)]; k < graph.starts[std::size_t(i) + 1]; ++k) {
                const cspace::Part a = parts[std::size_t(i)], b = parts[std::size_t(graph.neighbours[k])];
                CHECK(a == b || a == cspace::Part::separator || b == cspace::Part::separator);
            }
        }
    }
}

TEST(separators_of_grids_are_short) {
    for (int side : {20, 60, 120}) {
        const auto parts = cspace::find_separator(weigh_graph(make_grid(side, side, 1, 1)));
        const auto count = std::count(parts.begin(), parts.end(), cspace::Part::separator);
        CHECK(count >= side / 2 && count <= side + side / 5);
    }
}

TEST(dissection_orders_every_block_once) {
    check::Random random{22};
    for (int trial = 0; trial < 40; ++trial) {
        const int blocks = 1 + random.below(2000);
        check_order(cspace::order_nested_dissection(random_graph(random, blocks, random.below(4 * blocks))));
    }
    std::vector<BlockPair> all;
    for (int i = 0; i < 300; ++i) {
        for (int j = 0; j < i; ++j) all.push_back({i, j});
    }
    check_order(cspace::order_nested_dissection(cspace::make_block_graph(std::vector<int>(300, 2), all)));
    check_order(cspace::order_nested_dissection(cspace::make_block_graph(std::vector<int>(900, 1), {})));
    CHECK(cspace::order_nested_dissection(cspace::make_block_graph({}, {})).empty());
}

TEST(dissection_fills_less_than_minimum_degree_on_large_grids) {
    for (const BlockGraph& graph : {make_grid(22, 22, 22, 1), make_grid(150, 150, 1, 3)}) {
        const double dissected = count_factor(graph, cspace::order_nested_dissection(graph));
        CHECK(dissected < count_factor(graph, cspace::order_minimum_degree(graph)));
    }
}

TEST(numbers_of_a_factor_are_counted_without_it) {
    check::Random random{23};
    for (int trial = 0; trial < 20; ++trial) {
        const int blocks = 1 + random.below(200);
        const BlockGraph graph = random_graph(random, blocks, random.below(3 * blocks));
        const std::vector<int> order = cspace::order_minimum_degree(graph);
        double stored = 0;
        for (const cspace::Supernode& at :
             cspace::analyze_pattern(graph, order, {0, 0, 0, 1e-9, 1e-9, 1e-9, 1 << 20}).supernodes)
            stored += 0.5 * at.pivots * (at.pivots + 1) + double(at.pivots) * at.below;
        CHECK(stored == count_factor(graph, order));
    }
}

TEST(factors_of_dissected_graphs_solve) {
    check::Random random{24};
    const BlockGraph graph = make_grid(12, 12, 12, 2);
    cspace::SparseCholesky<> solver(graph, cspace::order_nested_dissection(graph));
    std::vector<double> values(solver.value_count(), 0.0);
    for (int i = 0; i < graph.nodes(); ++i) {
        const cspace::BlockSlot own = solver.slot_of(i, i);
        values[own.at] = values[own.at + 3] = 7;
        for (std::size_t k = graph.starts[std::size_t(i)]; k < graph.starts[std::size_t(i) + 1]; ++k) {
            if (graph.neighbours[k] > i) continue;
            for (std::size_t m = 0; m < 4; ++m)
                values[solver.slot_of(i, graph.neighbours[k]).at + m] = random.uniform(-0.5, 0.5);
        }
    }
    CHECK(solver.factor_matrix(values.data()));
    std::vector<double> b(std::size_t(solver.rows()));
    for (double& value : b) value = random.uniform(-1, 1);
    std::vector<double> x = b, y(b.size());
    solver.solve(x.data());
    solver.multiply(values.data(), x.data(), y.data());
    for (std::size_t k = 0; k < b.size(); ++k) CHECK_NEAR(y[k], b[k], 1e-10);
}

TEST(wide_supernodes_are_chains_of_narrow_ones) {
    check::Random random{25};
    check_problem(random_problem(random, 60, 4000, true), random);
}
