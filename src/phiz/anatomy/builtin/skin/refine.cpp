// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/refine.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <memory>

#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// A sparse row of weights that OpenSubdiv can interpolate like a vertex.
struct StencilRow {
  std::vector<std::pair<int, double>> weights;  // sorted by column
  void Clear(void* = nullptr) { weights.clear(); }
  void AddWithWeight(const StencilRow& other, double w) {
    if (w == 0) return;
    std::vector<std::pair<int, double>> sum;
    sum.reserve(weights.size() + other.weights.size());
    auto a = weights.begin();
    for (const auto& [column, value] : other.weights) {
      while (a != weights.end() && a->first < column) sum.push_back(*a++);
      if (a != weights.end() && a->first == column)
        sum.emplace_back(column, (a++)->second + w * value);
      else
        sum.emplace_back(column, w * value);
    }
    sum.insert(sum.end(), a, weights.end());
    weights.swap(sum);
  }
};

struct UvPoint {
  double u = 0, v = 0;
  void Clear(void* = nullptr) { u = v = 0; }
  void AddWithWeight(const UvPoint& other, double w) { u += w * other.u, v += w * other.v; }
};

std::unique_ptr<Far::TopologyRefiner> make_refiner(const PolygonMesh& cage, int level) {
  std::vector<int> counts, indices, uv_indices;
  for (const auto& face : cage.faces) {
    counts.push_back(static_cast<int>(face.size()));
    indices.insert(indices.end(), face.begin(), face.end());
  }
  for (const auto& face : cage.face_uvs) uv_indices.insert(uv_indices.end(), face.begin(), face.end());
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(cage.V.rows());
  descriptor.numFaces = static_cast<int>(counts.size());
  descriptor.numVertsPerFace = counts.data();
  descriptor.vertIndicesPerFace = indices.data();
  Far::TopologyDescriptor::FVarChannel channel;
  channel.numValues = static_cast<int>(cage.UV.rows());
  channel.valueIndices = uv_indices.data();
  if (!uv_indices.empty()) {
    descriptor.numFVarChannels = 1;
    descriptor.fvarChannels = &channel;
  }
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, options)));
  if (!refiner) fail("the cage of the skin could not be subdivided", "is its topology valid?");
  Far::TopologyRefiner::UniformOptions uniform(level);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  return refiner;
}

std::vector<StencilRow> unit_rows(int n) {
  std::vector<StencilRow> rows(n);
  for (int v = 0; v < n; ++v) rows[v].weights = {{v, 1.0}};
  return rows;
}

SparseMatrixd to_matrix(const std::vector<StencilRow>& rows, int columns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < rows.size(); ++v)
    for (const auto& [column, value] : rows[v].weights) entries.emplace_back(static_cast<int>(v), column, value);
  SparseMatrixd matrix(static_cast<Eigen::Index>(rows.size()), columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The vertices of a finer level along an ordered path of coarser vertices.
std::vector<int> refine_path(const Far::TopologyLevel& level, const std::vector<int>& path) {
  std::vector<int> finer;
  for (std::size_t k = 0; k < path.size(); ++k) {
    finer.push_back(level.GetVertexChildVertex(path[k]));
    if (k + 1 == path.size()) break;
    const int edge = level.FindEdge(path[k], path[k + 1]);
    if (edge < 0) fail("a loop of the skin does not follow its edges");
    finer.push_back(level.GetEdgeChildVertex(edge));
  }
  return finer;
}

}  // namespace

Subdivision subdivide(const PolygonMesh& cage, int level) {
  const auto refiner = make_refiner(cage, level);
  const Far::PrimvarRefinerReal<double> primvar(*refiner);
  const int n = static_cast<int>(cage.V.rows());
  std::vector<StencilRow> rows = unit_rows(n);
  for (int k = 1; k <= level; ++k) {
    std::vector<StencilRow> finer(refiner->GetLevel(k).GetNumVertices());
    primvar.Interpolate(k, rows, finer);
    rows.swap(finer);
  }
  Subdivision result;
  result.points = to_matrix(rows, n);
  std::vector<StencilRow> limit(rows.size());
  primvar.Limit(rows, limit);
  result.limit = to_matrix(limit, n);

  const Far::TopologyLevel& last = refiner->GetLevel(level);
  for (int f = 0; f < last.GetNumFaces(); ++f) {
    const auto corners = last.GetFaceVertices(f);
    result.faces.emplace_back(corners.begin(), corners.end());
  }
  if (!cage.face_uvs.empty()) {
    std::vector<UvPoint> uvs(cage.UV.rows());
    for (Eigen::Index k = 0; k < cage.UV.rows(); ++k) uvs[k] = {cage.UV(k, 0), cage.UV(k, 1)};
    for (int k = 1; k <= level; ++k) {
      std::vector<UvPoint> finer(refiner->GetLevel(k).GetNumFVarValues(0));
      primvar.InterpolateFaceVarying(k, uvs, finer, 0);
      uvs.swap(finer);
    }
    result.UV.resize(static_cast<Eigen::Index>(uvs.size()), 2);
    for (std::size_t k = 0; k < uvs.size(); ++k) result.UV.row(static_cast<Eigen::Index>(k)) << uvs[k].u, uvs[k].v;
    for (int f = 0; f < last.GetNumFaces(); ++f) {
      const auto corners = last.GetFaceFVarValues(f, 0);
      result.face_uvs.emplace_back(corners.begin(), corners.end());
    }
  }
  return result;
}

std::vector<int> subdivide_path(const PolygonMesh& cage, int level, std::vector<int> path) {
  const auto refiner = make_refiner(cage, level);
  for (int k = 0; k < level; ++k) path = refine_path(refiner->GetLevel(k), path);
  return path;
}

namespace {

/// Indicator functions spread with the surface: a vertex belongs to a set when more than half of its weight does.
VectorXi refine_set(const SparseMatrixd& points, const VectorXi& set) {
  VectorXd indicator = VectorXd::Zero(points.cols());
  for (int v : set) indicator[v] = 1;
  const VectorXd share = points * indicator;
  std::vector<int> members;
  for (Eigen::Index v = 0; v < share.size(); ++v)
    if (share[v] > 0.5) members.push_back(static_cast<int>(v));
  return Eigen::Map<VectorXi>(members.data(), static_cast<Eigen::Index>(members.size()));
}

/// Cuts each quad along the diagonal that bends the surface less, the first one at a tie within rounding. `form` gives
/// the positions to judge by: those of the mean person, so that everybody has the same triangles.
void triangulate(const PolygonMesh& quads, const MatrixX3d& form, TriangleMesh& mesh) {
  const Eigen::Index n = static_cast<Eigen::Index>(quads.faces.size());
  mesh.V = quads.V;
  mesh.UV = quads.UV;
  mesh.F.resize(2 * n, 3);
  mesh.FUV.resize(2 * n, 3);
  const auto fold = [&](const std::vector<int>& q, int k) {  // cosine between the halves cut from corner k
    const auto at = [&](int step) -> Vector3d { return form.row(q[(k + step) % 4]); };
    const Vector3d a = at(0), b = at(1), c = at(2), d = at(3);
    return (b - a).cross(c - a).normalized().dot((c - a).cross(d - a).normalized());
  };
  for (Eigen::Index f = 0; f < n; ++f) {
    const auto& q = quads.faces[f];
    const auto& t = quads.face_uvs[f];
    const int k = fold(q, 1) > fold(q, 0) + 1e-9 ? 1 : 0;
    const auto at = [&](const std::vector<int>& corners, int step) { return corners[(k + step) % 4]; };
    mesh.F.row(2 * f) << at(q, 0), at(q, 1), at(q, 2);
    mesh.F.row(2 * f + 1) << at(q, 0), at(q, 2), at(q, 3);
    mesh.FUV.row(2 * f) << at(t, 0), at(t, 1), at(t, 2);
    mesh.FUV.row(2 * f + 1) << at(t, 0), at(t, 2), at(t, 3);
  }
}

void check_level(int level) {
  if (level < 0 || level > 4) reject("skin level " + std::to_string(level), "the level must lie between 0 and 4");
}

}  // namespace

RefinedSkin refine(const SkinSurface& skin, int level) {
  check_level(level);
  Subdivision fine = subdivide(skin.cage, level);
  RefinedSkin refined;
  refined.from_cage.swap(fine.limit);
  refined.quads.V = refined.from_cage * skin.cage.V;
  refined.quads.faces = std::move(fine.faces);
  refined.quads.UV = std::move(fine.UV);
  refined.quads.face_uvs = std::move(fine.face_uvs);
  static const MatrixX3d mean = build_skin({}, {}).cage.V;
  triangulate(refined.quads, refined.from_cage * mean, refined.mesh);
  for (const auto& [name, members] : skin.regions) {
    if (name.starts_with("loop:")) {
      const std::vector<int> path = subdivide_path(skin.cage, level, {members.begin(), members.end()});
      refined.regions[name] = Eigen::Map<const VectorXi>(path.data(), static_cast<Eigen::Index>(path.size()));
    } else {
      refined.regions[name] = refine_set(fine.points, members);
    }
  }
  return refined;
}

SparseMatrixd skin_interpolation_between(const SkinSurface& skin, int coarse, int fine) {
  check_level(coarse);
  check_level(fine);
  if (coarse > fine) reject("skin levels", "the coarse level must not be above the fine one");
  PolygonMesh mesh = skin.cage;
  if (coarse > 0) {
    Subdivision start = subdivide(skin.cage, coarse);
    mesh.V = start.points * skin.cage.V;
    mesh.faces = std::move(start.faces);
  }
  mesh.UV.resize(0, 2);
  mesh.face_uvs.clear();
  const Subdivision finer = subdivide(mesh, fine - coarse);
  // Subdividing the coarse level afresh numbers the vertices on edges differently from going down from the cage; the
  // faces keep their order.
  const Subdivision wanted = subdivide(skin.cage, fine);
  Eigen::PermutationMatrix<Eigen::Dynamic> renumbering(finer.limit.rows());
  for (std::size_t f = 0; f < wanted.faces.size(); ++f)
    for (std::size_t k = 0; k < 4; ++k) renumbering.indices()[finer.faces[f][k]] = wanted.faces[f][k];
  const SparseMatrixd to_fine = renumbering * finer.limit;
  // Control displacements that reproduce the given ones on the limit: 3 I - 3 B + B^2 nearly inverts B, the limit mask.
  SparseMatrixd B = subdivide(mesh, 0).limit;
  SparseMatrixd identity(B.rows(), B.cols());
  identity.setIdentity();
  const SparseMatrixd square = B * B;
  const SparseMatrixd correction = 3.0 * identity - 3.0 * B + square;
  SparseMatrixd carry = (to_fine * correction).pruned(1e-3, 1.0);
  // What was left out goes to the others in proportion.
  const VectorXd sums = carry * VectorXd::Ones(carry.cols());
  return sums.cwiseInverse().asDiagonal() * carry;
}

}  // namespace phiz
