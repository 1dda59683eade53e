// Laws of the clique tree: after each update its solution and inverse are those of the dense matrix.
#include <cmath>
#include <cstddef>
#include <vector>

#include "check.hpp"
#include "cspace/math/sparse/clique_tree.hpp"
#include "dense_matrices.hpp"
#include "random.hpp"

namespace {

using check::Dense;

// Random factors J = (Ja, Jb) of one row more than its columns, and their sum as a dense matrix.
class Growing {
  public:
    explicit Growing(std::uint64_t seed) : random_{seed} {}

    void add_variable() {
        const int size = 1 + random_.below(6);
        starts_.push_back(int(gradient_.size()));
        sizes_.push_back(size);
        gradient_.resize(gradient_.size() + std::size_t(size), 0.0);
        for (auto& row : A_) row.resize(gradient_.size(), 0.0);
        A_.resize(gradient_.size(), std::vector<double>(gradient_.size(), 0.0));
        const int variable = tree_.add_variable(size);
        // A factor to a known one, or to one before.
        touch(add_factor(variable, variable == 0 || random_.below(10) == 0 ? -1 : random_.below(variable)));
    }
    void add_loop() {
        const int n = int(sizes_.size()), a = random_.below(n), b = random_.below(n);
        if (a != b) touch(add_factor(a, b));
    }
    void change_factor() {
        const int f = random_.below(int(factors_.size()));
        write_factor(f, -1);
        make_factor(f);
        write_factor(f, 1);
        touch(f);
    }
    bool update() {
        const bool is_updated = tree_.update(touched_, int(sizes_.size()) - 1);
        touched_.clear();
        tree_.substitute(0.0);
        return is_updated;
    }
    void spoil() { tree_.spoil(); }
    void check() {
        const Dense inverse = check::invert_dense(A_);
        const std::size_t n = gradient_.size();
        for (std::size_t v = 0; v < sizes_.size(); ++v) {
            for (int i = 0; i < sizes_[v]; ++i) {
                const auto row = std::size_t(starts_[v] + i);
                double expected = 0;
                for (std::size_t k = 0; k < n; ++k) expected -= inverse[row][k] * gradient_[k];
                CHECK_NEAR(tree_.solution(int(v))[i], expected, 1e-7 * (1 + std::fabs(expected)));
            }
        }
        double block[36];
        for (int trial = 0; trial < 10; ++trial) {
            const int a = random_.below(int(sizes_.size())), b = random_.below(int(sizes_.size()));
            tree_.inverse_block(a, b, block);
            for (int i = 0; i < sizes_[std::size_t(a)]; ++i) {
                for (int j = 0; j < sizes_[std::size_t(b)]; ++j) {
                    const double expected = inverse[std::size_t(starts_[std::size_t(a)] + i)]
                                                   [std::size_t(starts_[std::size_t(b)] + j)];
                    CHECK_NEAR(block[i * sizes_[std::size_t(b)] + j], expected,
                               1e-7 * (1 + std::fabs(expected)));
                }
            }
        }
    }
    int eliminated() const { return tree_.eliminated(); }

  private:
    struct Factor {
        int a, b;
        std::vector<double> aa, ab, bb, ga, gb;
    };
    int add_factor(int a, int b) {
        const int f = tree_.add_factor(a, b);
        factors_.push_back({a, b, {}, {}, {}, {}, {}});
        make_factor(f);
        write_factor(f, 1);
        return f;
    }
    int size(int variable) const { return variable < 0 ? 0 : sizes_[std::size_t(variable)]; }
    void make_factor(int f) {
        Factor& made = factors_[std::size_t(f)];
        const int na = size(made.a), nb = size(made.b), rows = na + nb + 1;
        std::vector<std::vector<double>> J(std::size_t(rows), std::vector<double>(std::size_t(na + nb)));
        std::vector<double> e(J.size());
        for (std::size_t r = 0; r < J.size(); ++r) {
            for (double& x : J[r]) x = random_.uniform(-1, 1);
            e[r] = random_.uniform(-1, 1);
        }
        const auto product = [&](int i, int j) {
            double sum = 0;
            for (const auto& row : J) sum += row[std::size_t(i)] * row[std::size_t(j)];
            return sum;
        };
        made.aa.clear(), made.ab.clear(), made.bb.clear(), made.ga.clear(), made.gb.clear();
        for (int i = 0; i < na + nb; ++i) {
            double g = 0;
            for (std::size_t r = 0; r < J.size(); ++r) g += J[r][std::size_t(i)] * e[r];
            (i < na ? made.ga : made.gb).push_back(g);
            for (int j = 0; j < na + nb; ++j) {
                if (i < na) (j < na ? made.aa : made.ab).push_back(product(i, j));
                if (i >= na && j >= na) made.bb.push_back(product(i, j));
            }
        }
        tree_.write_factor(f, made.aa.data(), made.ab.data(), made.bb.data(), made.ga.data(), made.gb.data());
    }
    // Into the dense matrix, or out of it.
    void write_factor(int f, double sign) {
        const Factor& at = factors_[std::size_t(f)];
        const auto add = [&](int v, int w, const std::vector<double>& block, bool is_mirrored) {
            for (int i = 0; i < size(v); ++i) {
                for (int j = 0; j < size(w); ++j) {
                    const auto r = std::size_t(starts_[std::size_t(v)] + i),
                               c = std::size_t(starts_[std::size_t(w)] + j);
                    A_[r][c] += sign * block[std::size_t(i * size(w) + j)];
                    if (is_mirrored) A_[c][r] += sign * block[std::size_t(i * size(w) + j)];
                }
            }
        };
        add(at.a, at.a, at.aa, false);
        if (at.b >= 0) add(at.a, at.b, at.ab, true), add(at.b, at.b, at.bb, false);
        for (int i = 0; i < size(at.a); ++i)
            gradient_[std::size_t(starts_[std::size_t(at.a)] + i)] += sign * at.ga[std::size_t(i)];
        for (int i = 0; i < size(at.b); ++i)
            gradient_[std::size_t(starts_[std::size_t(at.b)] + i)] += sign * at.gb[std::size_t(i)];
    }
    void touch(int f) {
        touched_.push_back(factors_[std::size_t(f)].a);
        if (factors_[std::size_t(f)].b >= 0) touched_.push_back(factors_[std::size_t(f)].b);
    }

    check::Random random_;
    cspace::CliqueTree<> tree_;
    std::vector<int> sizes_, starts_, touched_;
    std::vector<Factor> factors_;
    Dense A_;
    std::vector<double> gradient_;
};

}  // namespace

TEST(growing_problems_agree_with_dense_ones) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Growing problem{seed};
        check::Random random{seed + 100};
        for (int step = 0; step < 40; ++step) {
            const int kind = random.below(6);
            if (step < 2 || kind < 3) {
                problem.add_variable();
            } else if (kind == 3) {
                problem.change_factor();
            } else {
                problem.add_loop();
            }
            if (random.below(4) == 0) continue;  // several at once
            if (random.below(15) == 0) problem.spoil();
            CHECK(problem.update());
            problem.check();
        }
    }
}

TEST(a_chain_touches_its_end_only) {
    cspace::CliqueTree<> tree;
    const double one = 1, minus = -1, none = 0;
    for (int k = 0; k < 2000; ++k) {
        tree.add_variable(1);
        const int f = tree.add_factor(k, k == 0 ? -1 : k - 1);
        tree.write_factor(f, &one, &minus, &one, &none, &none);
        CHECK(tree.update(k == 0 ? std::vector<int>{0} : std::vector<int>{k, k - 1}, k));
        CHECK(tree.eliminated() <= 26);  // a clique and the new variable
    }
}
