// Rows of floats in leaves of 64 that lie near to each other, with a box around each: of many rows the
// nearest are found in few leaves.
//
// Rows come one by one. Each batch of them is cut into leaves at the medians of their widest coordinates, as
// in a k-d tree (Bentley 1975, "Multidimensional binary search trees used for associative searching"),
// together with as many batches before it as a binary counter carries (Bentley & Saxe 1980, "Decomposable
// searching problems I"): so a row is moved log n times.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/nearest_leaf.hpp"

namespace cspace::search {

class RowLeaves {
  public:
    static constexpr int batch = 512;

    // The first rows of the tree are in leaves; the others, fewer than a batch, are not.
    int size() const { return int(numbers_.size()); }
    LeafView view() const {
        return {blocks_.data(), numbers_.data(), boxes_.data(), size() / LeafView::leaf_rows};
    }
    // One number per leaf, for a search.
    float* scratch() { return scratch_.data(); }

    // Takes in what a tree has gained.
    void update(const ConfigurationTree& tree) {
        while (tree.size() - size() >= batch) {
            const int batches = size() / batch + 1;
            take_in(tree, (batches - (batches & -batches)) * batch, batches * batch);
        }
    }
    void clear() { *this = {}; }

  private:
    std::vector<float> blocks_, boxes_, scratch_;
    std::vector<std::int32_t> numbers_;

    // Cuts the rows from `first` on into leaves anew.
    void take_in(const ConfigurationTree& tree, int first, int end) {
        const std::size_t width = std::size_t(tree.width());
        numbers_.resize(std::size_t(end));
        std::iota(numbers_.begin() + first, numbers_.end(), first);
        blocks_.resize(std::size_t(end) * width);
        boxes_.resize(std::size_t(2 * end / LeafView::leaf_rows) * width);
        scratch_.resize(std::size_t(end / LeafView::leaf_rows));
        cut(tree, first, end);
    }
    void cut(const ConfigurationTree& tree, int first, int end) {
        if (end - first == LeafView::leaf_rows) return write_leaf(tree, first);
        const int k = widest_coordinate(tree, first, end), middle = first + (end - first) / 2;
        InterruptPoll poll(1024);
        std::nth_element(numbers_.begin() + first, numbers_.begin() + middle, numbers_.begin() + end,
                         [&](std::int32_t i, std::int32_t j) {
                             poll.step();
                             return tree.coordinate(i, k) < tree.coordinate(j, k);
                         });
        cut(tree, first, middle);
        cut(tree, middle, end);
    }
    int widest_coordinate(const ConfigurationTree& tree, int first, int end) const {
        InterruptPoll poll(128);
        int widest = 0;
        float most = -1;
        for (int k = 0; k < tree.width(); ++k) {
            float low = tree.coordinate(numbers_[std::size_t(first)], k), high = low;
            for (int i = first; i < end; ++i) {
                poll.step();
                const float x = tree.coordinate(numbers_[std::size_t(i)], k);
                low = std::min(low, x), high = std::max(high, x);
            }
            if (high - low > most) widest = k, most = high - low;
        }
        return widest;
    }
    void write_leaf(const ConfigurationTree& tree, int first) {
        constexpr int lanes = ConfigurationTree::lanes;
        const int width = tree.width(), leaf = first / LeafView::leaf_rows;
        // Of eight leaves: the lower and upper bounds, coordinate by coordinate.
        float* const box = &boxes_[std::size_t(2 * lanes * width * (leaf / lanes) + leaf % lanes)];
        for (int k = 0; k < width; ++k) {
            float low = tree.coordinate(numbers_[std::size_t(first)], k), high = low;
            for (int i = 0; i < LeafView::leaf_rows; ++i) {
                const float x = tree.coordinate(numbers_[std::size_t(first + i)], k);
                const int block = (first + i) / lanes;
                blocks_[std::size_t((block * width + k) * lanes + i % lanes)] = x;
                low = std::min(low, x), high = std::max(high, x);
            }
            box[2 * lanes * k] = low, box[2 * lanes * k + lanes] = high;
        }
    }
};

}  // namespace cspace::search
