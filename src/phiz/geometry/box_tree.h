// SPDX-License-Identifier: GPL-3.0-or-later
/// A bounding volume hierarchy over boxes, for queries of nearest things (not a public header).
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

using AlignedBox = Eigen::AlignedBox3d;

/// Binary tree, split at the median of the longest axis of the box centres; nodes in depth-first order: the left child
/// of node i is i + 1. Shape and order depend on the boxes only.
class BoxTree {
 public:
  struct Node {
    AlignedBox box;
    int right = -1;          ///< right child, -1 for a leaf
    int begin = 0, end = 0;  ///< range of order() below this node
    bool is_leaf() const { return right < 0; }
  };

  static constexpr int leaf_size = 4;

  explicit BoxTree(const std::vector<AlignedBox>& boxes) : order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.reserve(boxes.size());
    if (!boxes.empty()) build(boxes, 0, static_cast<int>(boxes.size()));
  }

  const std::vector<Node>& nodes() const { return nodes_; }
  /// Elements, those of a node contiguous.
  const std::vector<int>& order() const { return order_; }

  /// New boxes for the same elements.
  void refit(const std::vector<AlignedBox>& boxes) {
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      Node& node = nodes_[n];
      if (node.is_leaf()) {
        node.box.setEmpty();
        for (int i = node.begin; i < node.end; ++i)
          node.box.extend(boxes[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]);
      } else {
        node.box = nodes_[n + 1].box.merged(nodes_[static_cast<std::size_t>(node.right)].box);
      }
    }
  }

  /// Visits leaves nearest first. `squared_bound()` is the current squared search radius, `visit(element)` may shrink
  /// it.
  template <class Bound, class Visit>
  void nearest_first(const Vector3d& p, Bound&& squared_bound, Visit&& visit) const {
    struct Entry {
      int node;
      double squared;
    };
    if (nodes_.empty()) return;
    Entry stack[64];
    int top = 0;
    stack[top++] = {0, nodes_[0].box.squaredExteriorDistance(p)};
    while (top > 0) {
      const Entry entry = stack[--top];
      if (entry.squared > squared_bound()) continue;
      const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
      if (node.is_leaf()) {
        for (int i = node.begin; i < node.end; ++i) visit(order_[static_cast<std::size_t>(i)]);
        continue;
      }
      Entry near{entry.node + 1, nodes_[static_cast<std::size_t>(entry.node) + 1].box.squaredExteriorDistance(p)};
      Entry far{node.right, nodes_[static_cast<std::size_t>(node.right)].box.squaredExteriorDistance(p)};
      if (far.squared < near.squared) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
    }
  }

  /// Visits the elements of every leaf whose path of boxes passes `overlaps(box)`.
  template <class Overlaps, class Visit>
  void each_overlapping(Overlaps&& overlaps, Visit&& visit) const {
    if (nodes_.empty()) return;
    int stack[64];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const int n = stack[--top];
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      if (!overlaps(node.box)) continue;
      if (node.is_leaf()) {
        for (int i = node.begin; i < node.end; ++i) visit(order_[static_cast<std::size_t>(i)]);
      } else {
        stack[top++] = node.right;
        stack[top++] = n + 1;
      }
    }
  }

 private:
  int build(const std::vector<AlignedBox>& boxes, int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    AlignedBox box, centres;
    for (int i = begin; i < end; ++i) {
      const AlignedBox& b = boxes[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])];
      box.extend(b);
      centres.extend(b.center());
    }
    int right = -1;
    if (end - begin > leaf_size) {
      Eigen::Index axis = 0;
      centres.sizes().maxCoeff(&axis);
      const int middle = begin + (end - begin) / 2;
      std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int l, int r) {
        const double cl = boxes[static_cast<std::size_t>(l)].center()[axis];
        const double cr = boxes[static_cast<std::size_t>(r)].center()[axis];
        return cl < cr || (cl == cr && l < r);
      });
      build(boxes, begin, middle);
      right = build(boxes, middle, end);
    }
    Node& node = nodes_[static_cast<std::size_t>(index)];
    node.box = box;
    node.right = right;
    node.begin = begin;
    node.end = end;
    return index;
  }

  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace phiz
