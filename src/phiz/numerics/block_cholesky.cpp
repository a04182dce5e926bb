// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/block_cholesky.h"

#include <cholmod.h>
#include <hwy/aligned_allocator.h>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/numerics/front_kernel.h"

namespace phiz {

namespace {

using Floats = hwy::AlignedFreeUniquePtr<float[]>;

/// Subtrees of the elimination tree that are worked on side by side; a constant, so that sums do not depend on the
/// machine.
constexpr int bins = 4;
/// A subtree with more than this share of the work is divided.
constexpr double largest_share = 0.3;
/// Fronts with more work than this are worked on by all threads, multiplications.
constexpr double wide_front = 4e6;

Floats zeros(std::ptrdiff_t size) {
  Floats out = hwy::AllocateAligned<float>(static_cast<std::size_t>(std::max<std::ptrdiff_t>(size, 1)));
  std::fill_n(out.get(), size, 0.0F);
  return out;
}

/// While it lives, numbers too small to be normal count as zero in this thread: they are a hundred times slower.
class FlushTinyNumbers {
 public:
#if defined(__SSE__)
  FlushTinyNumbers() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | 0x8040U);
  }
  ~FlushTinyNumbers() {
    _mm_setcsr(before_);
  }
  FlushTinyNumbers(const FlushTinyNumbers&) = delete;
  FlushTinyNumbers& operator=(const FlushTinyNumbers&) = delete;

 private:
  unsigned before_;
#endif
};

/// Vertices that are eliminated together, and the vertices below them that they are coupled to.
struct Node {
  int first = 0, columns = 0;  ///< vertices
  std::vector<int> below;      ///< vertices, ascending
  int parent = -1;
};

/// Merges a node with the parent that follows it where that adds few zeros: longer loops are worth them.
bool worth_merging(const Node& child, const Node& parent) {
  const double columns = child.columns + parent.columns, rows = static_cast<double>(parent.below.size());
  const double stored = columns * (columns + 1) / 2 + columns * rows;
  const double zeros = child.columns * (parent.columns + rows - static_cast<double>(child.below.size()));
  const double share = zeros / stored;
  return columns <= 6 ? share < 0.4 : columns <= 16 ? share < 0.15 : share < 0.03;
}

/// Nodes of the elimination tree in the order of elimination.
std::vector<Node> find_nodes(const BlockMatrix& pattern) {
  const int n = pattern.columns();
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(n));
  std::vector<std::vector<int>> children(static_cast<std::size_t>(n));
  std::vector<int> mark(static_cast<std::size_t>(n), -1);
  std::vector<Node> nodes;
  for (int j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    std::vector<int>& mine = rows[u];
    mark[u] = j;
    const auto take = [&](int r) {
      if (mark[static_cast<std::size_t>(r)] == j) return;
      mark[static_cast<std::size_t>(r)] = j;
      mine.push_back(r);
    };
    for (int k = pattern.start[u]; k < pattern.start[u + 1]; ++k) take(pattern.row[static_cast<std::size_t>(k)]);
    for (const int child : children[u])
      for (const int r : rows[static_cast<std::size_t>(child)]) take(r);
    std::sort(mine.begin(), mine.end());
    if (!mine.empty()) children[static_cast<std::size_t>(mine.front())].push_back(j);
    Node node{j, 1, mine, -1};
    // A chain without a fork that only loses its own vertex is one node.
    if (!nodes.empty() && children[u].size() == 1 && children[u].front() == j - 1) {
      Node& last = nodes.back();
      if (last.below.size() == mine.size() + 1) {
        ++last.columns;
        last.below = mine;
        continue;
      }
    }
    while (!nodes.empty() && !nodes.back().below.empty() && nodes.back().below.front() == node.first &&
           nodes.back().first + nodes.back().columns == node.first && worth_merging(nodes.back(), node)) {
      node.first = nodes.back().first;
      node.columns += nodes.back().columns;
      nodes.pop_back();
    }
    nodes.push_back(std::move(node));
  }
  std::vector<int> node_of(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    std::fill_n(node_of.begin() + nodes[k].first, nodes[k].columns, static_cast<int>(k));
  for (Node& node : nodes)
    if (!node.below.empty()) node.parent = node_of[static_cast<std::size_t>(node.below.front())];
  return nodes;
}

}  // namespace

BlockMatrix block_pattern(const MatrixX4i& tets, const VectorXi& row_of, int size) {
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(size));
  for (int j = 0; j < size; ++j) rows[static_cast<std::size_t>(j)].push_back(j);
  for (Eigen::Index t = 0; t < tets.rows(); ++t)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const int row = row_of[tets(t, a)], column = row_of[tets(t, b)];
        if (column >= 0 && row > column) rows[static_cast<std::size_t>(column)].push_back(row);
      }
  BlockMatrix out;
  out.start.push_back(0);
  for (std::vector<int>& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    out.row.insert(out.row.end(), column.begin(), column.end());
    out.start.push_back(static_cast<int>(out.row.size()));
  }
  out.value.assign(9 * out.row.size(), 0.0F);
  return out;
}

VectorXi elimination_order(const BlockMatrix& pattern) {
  cholmod_common common;
  cholmod_start(&common);
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_METIS;
  common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse A = {};
  A.nrow = A.ncol = static_cast<std::size_t>(pattern.columns());
  A.nzmax = pattern.row.size();
  std::vector<int> start = pattern.start, row = pattern.row;
  A.p = start.data();
  A.i = row.data();
  A.stype = -1;
  A.itype = CHOLMOD_INT;
  A.xtype = CHOLMOD_PATTERN;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = 1;
  A.packed = 1;
  cholmod_factor* L = cholmod_analyze(&A, &common);
  VectorXi order;
  if (L != nullptr) order = Eigen::Map<const VectorXi>(static_cast<const int*>(L->Perm), pattern.columns());
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  if (order.size() != pattern.columns()) fail("cannot order the elastic system");
  return order;
}

struct BlockCholesky::Plan {
  /// Consecutive rows of a front that are consecutive in its parent's front, too; scalars.
  struct Run {
    int from = 0, length = 0;
    int to = 0;        ///< row of the parent's front, in whole groups
    int column = 0;    ///< column of the parent's front
    bool own = false;  ///< one of the parent's own columns
  };
  struct Node {
    int first = 0, columns = 0, below = 0;  ///< vertices
    std::ptrdiff_t index = 0;               ///< into `below_vertices`
    std::ptrdiff_t L1 = 0, L2 = 0;          ///< into the values
    std::ptrdiff_t update = 0;              ///< into the arena of the bin
    int runs = 0, runs_end = 0;             ///< into `runs`
    int parent = -1, bin = bins;            ///< bins: top
    std::vector<int> children;              ///< ascending
    std::ptrdiff_t p() const { return 3 * static_cast<std::ptrdiff_t>(columns); }
    std::ptrdiff_t r() const { return 3 * static_cast<std::ptrdiff_t>(below); }
    double work() const {
      const auto p_ = static_cast<double>(p()), r_ = static_cast<double>(r());
      return p_ * p_ * p_ / 6 + p_ * p_ * r_ / 2 + p_ * r_ * r_ / 2;
    }
  };
  int n = 0;
  std::vector<Node> nodes;
  std::vector<int> below_vertices;  ///< vertex, or n + number of the top vertex where a node of a bin meets the top
  std::vector<Run> runs;
  std::vector<int> members[bins + 1];  ///< nodes of each bin and of the top, ascending
  std::vector<int> top_vertices;
  std::vector<int> node_of;  ///< per vertex
  std::ptrdiff_t value_count = 0;
  FactorStorage storage = FactorStorage::single;
  std::array<std::ptrdiff_t, bins + 1> arena{}, widest_own{}, tallest{};
  std::vector<int>
      destination;  ///< per block of the pattern: node and place are found from the column; row in its front

  void divide();
  void place_updates();
  void find_runs();
  void find_destinations(const BlockMatrix& pattern);
  /// Row of vertex v in the front of a node, in whole groups; its column.
  std::pair<int, int> place(const Node& node, int v) const;
};

struct BlockCholesky::Values {
  Floats L, inverse_diagonal, sign;
  Floats diagonal;  ///< of the matrix
  std::vector<std::uint16_t> rounded;
  std::array<Floats, bins + 1> arena, own;
  std::array<Floats, bins + 1> y, z;  ///< of the solves
  Floats outside[bins];               ///< what the nodes of a bin give to top vertices

  explicit Values(const Plan& plan)
      : L(zeros(plan.value_count)),
        inverse_diagonal(zeros(3 * plan.n)),
        sign(zeros(3 * plan.n)),
        diagonal(zeros(3 * plan.n)),
        rounded(plan.storage == FactorStorage::rounded ? static_cast<std::size_t>(plan.value_count) : 0) {
    for (std::size_t b = 0; b <= bins; ++b) {
      y[b] = zeros(most_sides * plan.tallest[b]);
      z[b] = zeros(most_sides * plan.tallest[b]);
    }
    for (Floats& part : outside) part = zeros(most_sides * 3 * static_cast<std::ptrdiff_t>(plan.top_vertices.size()));
  }
  /// Room to factorise in, at the first call.
  void prepare(const Plan& plan) {
    if (arena[0]) return;
    for (std::size_t b = 0; b <= bins; ++b) {
      arena[b] = zeros(plan.arena[b]);
      own[b] = zeros(plan.widest_own[b]);
    }
  }
  Front front(const Plan::Node& node) {
    return {node.p(),
            node.r(),
            L.get() + node.L1,
            L.get() + node.L2,
            inverse_diagonal.get() + 3 * node.first,
            sign.get() + 3 * node.first,
            diagonal.get() + 3 * node.first,
            rounded.empty() ? nullptr : rounded.data() + node.L1,
            rounded.empty() ? nullptr : rounded.data() + node.L2};
  }
};

/// Cuts the tree into balanced bins of subtrees and the top above them.
void BlockCholesky::Plan::divide() {
  std::vector<double> work(nodes.size());
  std::vector<int> subtrees;
  double total = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    total += nodes[k].work();
    work[k] += nodes[k].work();
    if (nodes[k].parent < 0)
      subtrees.push_back(static_cast<int>(k));
    else
      work[static_cast<std::size_t>(nodes[k].parent)] += work[k];
  }
  const auto lighter = [&](int a, int b) {
    return work[static_cast<std::size_t>(a)] < work[static_cast<std::size_t>(b)];
  };
  while (!subtrees.empty()) {
    const auto largest = std::max_element(subtrees.begin(), subtrees.end(), lighter);
    const auto u = static_cast<std::size_t>(*largest);
    if (work[u] < largest_share * total || nodes[u].children.empty()) break;
    subtrees.erase(largest);
    subtrees.insert(subtrees.end(), nodes[u].children.begin(), nodes[u].children.end());
  }
  std::sort(subtrees.begin(), subtrees.end(), [&](int a, int b) { return lighter(b, a) || (!lighter(a, b) && a < b); });
  double load[bins] = {};
  for (const int root : subtrees) {
    const auto lightest = std::min_element(load, load + bins) - load;
    load[lightest] += work[static_cast<std::size_t>(root)];
    nodes[static_cast<std::size_t>(root)].bin = static_cast<int>(lightest);
  }
  for (auto k = nodes.rbegin(); k != nodes.rend(); ++k)
    if (k->parent >= 0 && nodes[static_cast<std::size_t>(k->parent)].bin != bins)
      k->bin = nodes[static_cast<std::size_t>(k->parent)].bin;
  for (std::size_t k = 0; k < nodes.size(); ++k) members[nodes[k].bin].push_back(static_cast<int>(k));
}

/// Places of the update matrices in the arenas: first fit among those that wait for their parents.
void BlockCholesky::Plan::place_updates() {
  std::array<std::vector<std::pair<std::ptrdiff_t, std::ptrdiff_t>>, bins + 1> held;  // sorted intervals
  const auto size_of = [](const Node& node) { return whole_groups(node.r()) * node.r(); };
  for (Node& node : nodes) {
    const auto b = static_cast<std::size_t>(node.bin);
    auto& mine = held[b];
    const std::ptrdiff_t size = size_of(node);
    std::ptrdiff_t at = 0;
    auto next = mine.begin();
    for (; next != mine.end() && next->first - at < size; ++next) at = std::max(at, next->second);
    node.update = at;
    if (size > 0) mine.insert(next, {at, at + size});
    arena[b] = std::max(arena[b], at + size);
    // The children's are done with, when the parent is in the same arena; those of bins wait for the top.
    for (const int child : node.children) {
      const Node& c = nodes[static_cast<std::size_t>(child)];
      if (c.bin != node.bin) continue;
      std::erase_if(mine, [&](const auto& interval) {
        return interval.first == c.update && interval.second == c.update + size_of(c);
      });
    }
    const std::ptrdiff_t rows = whole_groups(node.p()) + whole_groups(node.r());
    widest_own[b] = std::max(widest_own[b], rows * node.p());
    tallest[b] = std::max(tallest[b], rows);
  }
}

std::pair<int, int> BlockCholesky::Plan::place(const Node& node, int v) const {
  if (v < node.first + node.columns) return {3 * (v - node.first), 3 * (v - node.first)};
  const auto begin = below_vertices.begin() + node.index, end = begin + node.below;
  const int at = 3 * static_cast<int>(std::lower_bound(begin, end, v) - begin);
  return {static_cast<int>(whole_groups(node.p())) + at, at};
}

void BlockCholesky::Plan::find_runs() {
  for (Node& node : nodes) {
    node.runs = static_cast<int>(runs.size());
    if (node.parent >= 0) {
      const Node& parent = nodes[static_cast<std::size_t>(node.parent)];
      for (int i = 0; i < node.below; ++i) {
        const int v = below_vertices[static_cast<std::size_t>(node.index + i)];
        const auto [row, column] = place(parent, v);
        const bool own = v < parent.first + parent.columns;
        const bool goes_on = static_cast<int>(runs.size()) > node.runs && runs.back().own == own &&
                             runs.back().to + runs.back().length == row;
        if (goes_on)
          runs.back().length += 3;
        else
          runs.push_back({3 * i, 3, row, column, own});
      }
    }
    node.runs_end = static_cast<int>(runs.size());
  }
}

void BlockCholesky::Plan::find_destinations(const BlockMatrix& pattern) {
  destination.resize(pattern.row.size());
  for (const Node& node : nodes)
    for (int j = node.first; j < node.first + node.columns; ++j)
      for (int k = pattern.start[static_cast<std::size_t>(j)]; k < pattern.start[static_cast<std::size_t>(j) + 1]; ++k)
        destination[static_cast<std::size_t>(k)] = place(node, pattern.row[static_cast<std::size_t>(k)]).first;
}

namespace {

/// Adds the update matrix of a child to the front of its parent: its own columns F and its update U.
template <class Run>
void extend(const float* child, std::ptrdiff_t child_ld, const Run* begin, const Run* end, float* F, std::ptrdiff_t ld,
            float* U, std::ptrdiff_t own_rows) {
  for (const Run* columns = begin; columns != end; ++columns)
    for (int c = 0; c < columns->length; ++c) {
      const float* from = child + (columns->from + c) * child_ld;
      float* to =
          columns->own ? F + (columns->column + c) * ld : U + (columns->column + c) * (ld - own_rows) - own_rows;
      for (const Run* rows = columns; rows != end; ++rows) {
        const int skip = rows == columns ? c : 0;
        const float* source = from + rows->from;
        float* target = to + rows->to;
        for (int i = skip; i < rows->length; ++i) target[i] += source[i];
      }
    }
}

}  // namespace

BlockCholesky::BlockCholesky(const BlockMatrix& pattern, FactorStorage storage) {
  auto plan = std::make_shared<Plan>();
  plan->storage = storage;
  plan->n = pattern.columns();
  const std::vector<phiz::Node> found = find_nodes(pattern);
  for (const phiz::Node& node : found) {
    Plan::Node own;
    own.first = node.first;
    own.columns = node.columns;
    own.below = static_cast<int>(node.below.size());
    own.parent = node.parent;
    own.index = static_cast<std::ptrdiff_t>(plan->below_vertices.size());
    plan->below_vertices.insert(plan->below_vertices.end(), node.below.begin(), node.below.end());
    own.L1 = plan->value_count;
    own.L2 = own.L1 + whole_groups(own.p()) * own.p();
    plan->value_count = own.L2 + whole_groups(own.r()) * own.p();
    plan->nodes.push_back(std::move(own));
  }
  for (std::size_t k = 0; k < plan->nodes.size(); ++k)
    if (plan->nodes[k].parent >= 0)
      plan->nodes[static_cast<std::size_t>(plan->nodes[k].parent)].children.push_back(static_cast<int>(k));
  for (std::size_t k = 0; k < plan->nodes.size(); ++k)
    plan->node_of.insert(plan->node_of.end(), static_cast<std::size_t>(plan->nodes[k].columns), static_cast<int>(k));
  plan->divide();
  plan->place_updates();
  plan->find_runs();
  plan->find_destinations(pattern);
  // Where nodes of bins meet the top, solves go through buffers.
  std::vector<int> top_id(static_cast<std::size_t>(plan->n), -1);
  for (const int k : plan->members[bins]) {
    const Plan::Node& node = plan->nodes[static_cast<std::size_t>(k)];
    for (int j = node.first; j < node.first + node.columns; ++j) {
      top_id[static_cast<std::size_t>(j)] = static_cast<int>(plan->top_vertices.size());
      plan->top_vertices.push_back(j);
    }
  }
  for (const Plan::Node& node : plan->nodes)
    if (node.bin != bins)
      for (int i = 0; i < node.below; ++i) {
        int& v = plan->below_vertices[static_cast<std::size_t>(node.index + i)];
        if (top_id[static_cast<std::size_t>(v)] >= 0) v = plan->n + top_id[static_cast<std::size_t>(v)];
      }
  plan_ = std::move(plan);
  values_ = std::make_unique<Values>(*plan_);
}

BlockCholesky::BlockCholesky(std::shared_ptr<const Plan> plan)
    : plan_(std::move(plan)), values_(std::make_unique<Values>(*plan_)) {}
BlockCholesky::~BlockCholesky() = default;
BlockCholesky::BlockCholesky(BlockCholesky&&) noexcept = default;
BlockCholesky& BlockCholesky::operator=(BlockCholesky&&) noexcept = default;

BlockCholesky BlockCholesky::twin() const {
  return BlockCholesky(plan_);
}

int BlockCholesky::columns() const {
  return plan_->n;
}
std::ptrdiff_t BlockCholesky::side_stride() const {
  return whole_groups(3 * static_cast<std::ptrdiff_t>(plan_->n));
}
std::ptrdiff_t BlockCholesky::factor_entries() const {
  return plan_->value_count;
}
double BlockCholesky::flops() const {
  double work = 0;
  for (const Plan::Node& node : plan_->nodes) work += 2 * node.work();
  return work;
}

int BlockCholesky::factorise(const BlockMatrix& A, bool parallel) {
  const Plan& plan = *plan_;
  if (A.row.size() != plan.destination.size() || A.columns() != plan.n || A.value.size() != 9 * A.row.size())
    reject("block matrix", "does not have the pattern that was analysed");
  Values& values = *values_;
  values.prepare(plan);
  for (int j = 0; j < plan.n; ++j) {
    const float* block = A.value.data() + 9 * static_cast<std::ptrdiff_t>(A.start[static_cast<std::size_t>(j)]);
    const float largest = std::max({std::abs(block[0]), std::abs(block[4]), std::abs(block[8])});
    if (!(largest > 0) || !std::isfinite(largest)) return -1;
    constexpr float least = 1e-3F;
    for (int k = 0; k < 3; ++k)
      values.diagonal[static_cast<std::size_t>(3 * j + k)] = std::max(std::abs(block[4 * k]), least * largest);
  }
  const auto factorise_node = [&](const Plan::Node& node, bool wide) {
    const auto bin = static_cast<std::size_t>(node.bin);
    const Front front = values.front(node);
    const std::ptrdiff_t own_rows = whole_groups(front.p), below = whole_groups(front.r), ld = own_rows + below;
    float* F = values.own[bin].get();
    float* U = values.arena[bin].get() + node.update;
    std::fill_n(F, ld * front.p, 0.0F);
    std::fill_n(U, below * front.r, 0.0F);
    for (int j = 0; j < node.columns; ++j) {
      const auto column = static_cast<std::size_t>(node.first + j);
      for (int k = A.start[column]; k < A.start[column + 1]; ++k) {
        const float* block = A.value.data() + 9 * static_cast<std::ptrdiff_t>(k);
        float* to = F + 3 * j * ld + plan.destination[static_cast<std::size_t>(k)];
        for (int c = 0; c < 3; ++c)
          for (int i = 0; i < 3; ++i) to[c * ld + i] = block[3 * c + i];
      }
    }
    for (const int k : node.children) {
      const Plan::Node& child = plan.nodes[static_cast<std::size_t>(k)];
      extend(values.arena[static_cast<std::size_t>(child.bin)].get() + child.update, whole_groups(child.r()),
             plan.runs.data() + child.runs, plan.runs.data() + child.runs_end, F, ld, U, own_rows);
    }
    const FlushTinyNumbers flush;
    const int negative = factor_own(front, F, ld);
    if (negative < 0) return negative;
    if (!wide || node.work() < wide_front) {
      factor_below(front, negative > 0, F, ld, 0, below / front_group);
      update_front(front, negative > 0, U, 0, front.r);
      round_front(front);
      return negative;
    }
    parallel_chunks(below / front_group, 3, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const FlushTinyNumbers flush_here;
      factor_below(front, negative > 0, F, ld, begin, end);
    });
    parallel_chunks(front.r, 2 * front_group, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const FlushTinyNumbers flush_here;
      update_front(front, negative > 0, U, begin, end);
    });
    round_front(front);
    return negative;
  };
  std::array<int, bins + 1> negative_in{};
  const auto factorise_bin = [&](std::ptrdiff_t bin, bool wide) {
    const auto b = static_cast<std::size_t>(bin);
    for (const int k : plan.members[b]) {
      const int here = factorise_node(plan.nodes[static_cast<std::size_t>(k)], wide);
      if (here < 0) {
        negative_in[b] = here;
        return;
      }
      negative_in[b] += here;
    }
  };
  if (parallel)
    parallel_chunks(bins, 1, [&](std::ptrdiff_t bin, std::ptrdiff_t) { factorise_bin(bin, false); });
  else
    for (int bin = 0; bin < bins; ++bin) factorise_bin(bin, false);
  if (*std::min_element(negative_in.begin(), negative_in.end()) < 0) return -1;
  factorise_bin(bins, parallel);
  return negative_in[bins] < 0 ? -1 : std::accumulate(negative_in.begin(), negative_in.end(), 0);
}

void BlockCholesky::forward(float* x, int sides) const {
  const Plan& plan = *plan_;
  const std::ptrdiff_t apart = side_stride();
  const std::ptrdiff_t top_apart = 3 * static_cast<std::ptrdiff_t>(plan.top_vertices.size());
  const auto run = [&](std::size_t bin, float* top) {
    const FlushTinyNumbers flush;
    float* y = values_->y[bin].get();
    float* z = values_->z[bin].get();
    for (const int k : plan.members[bin]) {
      const Plan::Node& node = plan.nodes[static_cast<std::size_t>(k)];
      const Front front = values_->front(node);
      const std::ptrdiff_t own = whole_groups(front.p), below = whole_groups(front.r);
      for (int s = 0; s < sides; ++s) {
        float* to = y + s * own;
        std::copy_n(x + s * apart + 3 * node.first, front.p, to);
        std::fill(to + front.p, to + own, 0.0F);
      }
      forward_front(front, sides, y, z);
      for (int s = 0; s < sides; ++s) {
        std::copy_n(y + s * own, front.p, x + s * apart + 3 * node.first);
        for (int i = 0; i < node.below; ++i) {
          const int v = plan.below_vertices[static_cast<std::size_t>(node.index + i)];
          float* to = v < plan.n ? x + s * apart + 3 * static_cast<std::ptrdiff_t>(v)
                                 : top + s * top_apart + 3 * static_cast<std::ptrdiff_t>(v - plan.n);
          const float* from = z + s * below + 3 * static_cast<std::ptrdiff_t>(i);
          for (int c = 0; c < 3; ++c) to[c] -= from[c];
        }
      }
    }
  };
  parallel_chunks(bins, 1, [&](std::ptrdiff_t bin, std::ptrdiff_t) {
    float* outside = values_->outside[bin].get();
    std::fill_n(outside, sides * top_apart, 0.0F);
    run(static_cast<std::size_t>(bin), outside);
  });
  for (const Floats& outside : values_->outside)
    for (int s = 0; s < sides; ++s)
      for (std::size_t i = 0; i < plan.top_vertices.size(); ++i)
        for (int c = 0; c < 3; ++c)
          x[s * apart + 3 * static_cast<std::ptrdiff_t>(plan.top_vertices[i]) + c] +=
              outside[static_cast<std::size_t>(s * top_apart) + 3 * i + static_cast<std::size_t>(c)];
  run(bins, nullptr);
}

void BlockCholesky::backward(float* x, int sides) const {
  const Plan& plan = *plan_;
  const std::ptrdiff_t apart = side_stride();
  const auto run = [&](std::size_t bin) {
    const FlushTinyNumbers flush;
    float* y = values_->y[bin].get();
    float* z = values_->z[bin].get();
    for (auto k = plan.members[bin].rbegin(); k != plan.members[bin].rend(); ++k) {
      const Plan::Node& node = plan.nodes[static_cast<std::size_t>(*k)];
      const Front front = values_->front(node);
      const std::ptrdiff_t own = whole_groups(front.p), below = whole_groups(front.r);
      for (int s = 0; s < sides; ++s) {
        float* to = y + s * own;
        std::copy_n(x + s * apart + 3 * node.first, front.p, to);
        std::fill(to + front.p, to + own, 0.0F);
        float* gathered = z + s * below;
        for (int i = 0; i < node.below; ++i) {
          int v = plan.below_vertices[static_cast<std::size_t>(node.index + i)];
          if (v >= plan.n) v = plan.top_vertices[static_cast<std::size_t>(v - plan.n)];
          std::copy_n(x + s * apart + 3 * static_cast<std::ptrdiff_t>(v), 3,
                      gathered + 3 * static_cast<std::ptrdiff_t>(i));
        }
        std::fill(gathered + front.r, gathered + below, 0.0F);
      }
      backward_front(front, sides, y, z);
      for (int s = 0; s < sides; ++s) std::copy_n(y + s * own, front.p, x + s * apart + 3 * node.first);
    }
  };
  run(bins);
  parallel_chunks(bins, 1, [&](std::ptrdiff_t bin, std::ptrdiff_t) { run(static_cast<std::size_t>(bin)); });
}

SolvedRows BlockCholesky::forward_rows(const std::vector<SparseRow>& rows) const {
  const Plan& plan = *plan_;
  if (rows.size() > SolvedRows::most) reject("sparse rows", "more than 16 at once");
  SolvedRows out;
  for (const SparseRow& row : rows)
    for (int k = 0; k < row.count; ++k)
      for (int node = plan.node_of[static_cast<std::size_t>(row.column[k])]; node >= 0;
           node = plan.nodes[static_cast<std::size_t>(node)].parent)
        out.nodes.push_back(node);
  std::sort(out.nodes.begin(), out.nodes.end());
  out.nodes.erase(std::unique(out.nodes.begin(), out.nodes.end()), out.nodes.end());
  out.start.push_back(0);
  std::ptrdiff_t tallest = 0;
  for (const int k : out.nodes) {
    const Plan::Node& node = plan.nodes[static_cast<std::size_t>(k)];
    out.first.push_back(3 * node.first);
    out.start.push_back(out.start.back() + 3 * node.columns);
    tallest = std::max(tallest, node.r());
  }
  out.values.assign(static_cast<std::size_t>(SolvedRows::most) * static_cast<std::size_t>(out.start.back()), 0.0F);
  const auto column_of = [&](int vertex) {
    const auto at = static_cast<std::size_t>(
        std::lower_bound(out.nodes.begin(), out.nodes.end(), plan.node_of[static_cast<std::size_t>(vertex)]) -
        out.nodes.begin());
    return out.values.data() +
           static_cast<std::ptrdiff_t>(SolvedRows::most) * (out.start[at] + 3 * vertex - out.first[at]);
  };
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int k = 0; k < rows[r].count; ++k)
      for (int c = 0; c < 3; ++c)
        column_of(rows[r].column[k])[SolvedRows::most * c + static_cast<int>(r)] += rows[r].value[k][c];
  std::vector<float> passed(static_cast<std::size_t>(SolvedRows::most * whole_groups(tallest)));
  const FlushTinyNumbers flush;
  for (std::size_t k = 0; k < out.nodes.size(); ++k) {
    const Plan::Node& node = plan.nodes[static_cast<std::size_t>(out.nodes[k])];
    const Front front = values_->front(node);
    float* X = out.values.data() + SolvedRows::most * static_cast<std::ptrdiff_t>(out.start[k]);
    finish_rows(front, X);
    pass_rows(front, X, passed.data());
    const float* from = passed.data();
    for (int i = 0; i < node.below; ++i, from += 3 * SolvedRows::most) {
      int v = plan.below_vertices[static_cast<std::size_t>(node.index + i)];
      if (v >= plan.n) v = plan.top_vertices[static_cast<std::size_t>(v - plan.n)];
      float* to = column_of(v);
      for (int e = 0; e < 3 * SolvedRows::most; ++e) to[e] += from[e];
    }
  }
  return out;
}

Eigen::Matrix<float, SolvedRows::most, SolvedRows::most> SolvedRows::gram(const SolvedRows& other) const {
  Eigen::Matrix<float, most, most> M = Eigen::Matrix<float, most, most>::Zero();
  for (std::size_t a = 0, b = 0; a < nodes.size() && b < other.nodes.size();) {
    if (nodes[a] != other.nodes[b]) {
      ++(nodes[a] < other.nodes[b] ? a : b);
      continue;
    }
    subtract_gram(start[a + 1] - start[a], values.data() + most * static_cast<std::ptrdiff_t>(start[a]),
                  other.values.data() + most * static_cast<std::ptrdiff_t>(other.start[b]), M.data());
    ++a;
    ++b;
  }
  return -M;
}

Eigen::Matrix<float, SolvedRows::most, 1> SolvedRows::products(const float* v) const {
  Eigen::Matrix<float, most, 1> out = Eigen::Matrix<float, most, 1>::Zero();
  for (std::size_t k = 0; k < nodes.size(); ++k)
    subtract_row_products(start[k + 1] - start[k], values.data() + most * static_cast<std::ptrdiff_t>(start[k]),
                          v + first[k], out.data());
  return -out;
}

void SolvedRows::add(const Eigen::Matrix<float, most, 1>& w, float* v) const {
  const Eigen::Matrix<float, most, 1> negative = -w;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    subtract_rows(start[k + 1] - start[k], values.data() + most * static_cast<std::ptrdiff_t>(start[k]),
                  negative.data(), v + first[k]);
}

void BlockCholesky::solve(float* x, int sides) const {
  forward(x, sides);
  backward(x, sides);
}

}  // namespace phiz
