// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/tetrahedralise.h"

#include <spdlog/fmt/fmt.h>

// The library form of TetGen throws integers instead of ending the process.
#define TETLIBRARY
#include <tetgen.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "phiz/core/error.h"
#include "phiz/geometry/improve_tets.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

/// All surfaces in one index space.
struct Boundary {
  MatrixX3d V;
  MatrixX3i F;
  std::vector<int> surface_of_triangle;
  std::vector<Eigen::Index> first_triangle;
};

Boundary join(std::span<const RegionSurface> surfaces) {
  Eigen::Index vertices = 0, triangles = 0;
  for (const auto& s : surfaces) {
    vertices += s.surface.V.rows();
    triangles += s.surface.F.rows();
  }
  Boundary all{MatrixX3d(vertices, 3), MatrixX3i(triangles, 3), {}, {}};
  Eigen::Index v = 0, f = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const TriangleMesh& mesh = surfaces[s].surface;
    all.V.middleRows(v, mesh.V.rows()) = mesh.V;
    all.F.middleRows(f, mesh.F.rows()) = mesh.F.array() + static_cast<int>(v);
    all.surface_of_triangle.insert(all.surface_of_triangle.end(), static_cast<std::size_t>(mesh.F.rows()),
                                   static_cast<int>(s));
    all.first_triangle.push_back(f);
    v += mesh.V.rows();
    f += mesh.F.rows();
  }
  return all;
}

void check_options(const TetrahedraliseOptions& options) {
  if (!(options.radius_edge_ratio > 1.1)) throw Error(ErrorKind::usage, "radius_edge_ratio must be greater than 1.1");
  if (!(options.min_dihedral >= 0 && options.min_dihedral <= 18))
    throw Error(ErrorKind::usage, "min_dihedral must lie between 0 and 18 degrees");
  if (!(options.max_edge >= 0) || options.target_tets < 0 || options.smoothing_passes < 0)
    throw Error(ErrorKind::usage, "max_edge, target_tets and smoothing_passes must not be negative");
  if (!(options.improve_below >= 0 && options.improve_below < 60) || !(options.insert_below >= 0))
    throw Error(ErrorKind::usage, "improve_below must lie between 0 and 60 degrees, insert_below must not be negative");
}

/// TetGen needs all of this; crossing surfaces make it crash.
void check_surfaces(std::span<const RegionSurface> surfaces, const Boundary& all) {
  if (surfaces.empty()) reject("tetrahedralise", "there is no surface");
  for (const auto& s : surfaces) {
    if (s.give.size() > 0 && (s.give.size() != s.surface.V.rows() || !(s.give.minCoeff() >= 0)))
      throw Error(ErrorKind::usage, s.name + ": give must hold one number for each vertex, none negative");
    validate(s.surface, s.name);
    require_closed_manifold(s.surface, s.name);
    const CompactMesh compact = remove_unused_vertices(s.surface.V, s.surface.F);
    if (compact.kept.size() != s.surface.V.rows())
      reject(s.name, fmt::format("{} vertices belong to no triangle", s.surface.V.rows() - compact.kept.size()),
             "remove them (remove_unused_vertices)");
    require_no_degenerate_triangles(s.surface, s.name, 1e-18);
    if (!(signed_volume(s.surface.V, s.surface.F) > 0))
      reject(s.name, "the surface faces inward", "reverse its triangles");
  }
  const auto pairs = self_intersections({all.V, all.F, {}, {}});
  if (pairs.empty()) return;
  const auto name = [&](int triangle) {
    const auto s = static_cast<std::size_t>(all.surface_of_triangle[static_cast<std::size_t>(triangle)]);
    return fmt::format("triangle {} of {}", triangle - all.first_triangle[s], surfaces[s].name);
  };
  reject("tetrahedralise",
         fmt::format("{} intersects {} ({} such pairs)", name(pairs[0].first), name(pairs[0].second), pairs.size()),
         "the surfaces must not touch or cross");
}

/// Wanted edge length at a point for the callback of TetGen, which carries no context. Guarded by the mutex of
/// run_tetgen.
const std::function<double(const Vector3d&)>* current_sizing = nullptr;
double current_sizing_scale = 1;

double regular_tet_volume(double edge) {
  return edge * edge * edge / (6 * std::sqrt(2.0));
}

bool is_too_large(REAL* a, REAL* b, REAL* c, REAL* d, REAL*, REAL) {
  using Point = Eigen::Map<const Vector3d>;
  const Vector3d p0 = Point(a), p1 = Point(b), p2 = Point(c), p3 = Point(d);
  const double wanted = current_sizing_scale * (*current_sizing)(0.25 * (p0 + p1 + p2 + p3));
  return wanted > 0 && std::abs((p1 - p0).cross(p2 - p0).dot(p3 - p0)) / 6 > regular_tet_volume(wanted);
}

/// Tets with a larger dihedral angle are improved by flips, degrees. TetGen's own 165 leaves slivers in thin gaps;
/// smaller values than this gain little.
constexpr double worst_dihedral = 145;

struct Seed {
  Vector3d position;
  double max_volume = -1;
  bool hole = false;
  int surface = 0;
};

const char* reason(int code) {
  switch (code) {
    case 1:
      return "out of memory";
    case 3:
      return "the surfaces intersect";
    case 4:
      return "a feature is too small for its arithmetic";
    case 5:
      return "two facets nearly touch";
    default:
      return "an internal error";
  }
}

void fill(tetgenio& in, const Boundary& all, const std::vector<Seed>& seeds) {
  in.numberofpoints = static_cast<int>(all.V.rows());
  in.pointlist = new REAL[static_cast<std::size_t>(all.V.size())];
  for (Eigen::Index v = 0; v < all.V.rows(); ++v)
    for (int k = 0; k < 3; ++k) in.pointlist[3 * v + k] = all.V(v, k);
  in.numberoffacets = static_cast<int>(all.F.rows());
  in.facetlist = new tetgenio::facet[static_cast<std::size_t>(all.F.rows())];
  in.facetmarkerlist = new int[static_cast<std::size_t>(all.F.rows())];
  for (int f = 0; f < all.F.rows(); ++f) {
    tetgenio::facet& facet = in.facetlist[f];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(&facet.polygonlist[0]);
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new int[3]{all.F(f, 0), all.F(f, 1), all.F(f, 2)};
    in.facetmarkerlist[f] = f + 1;
  }
  in.numberofregions =
      static_cast<int>(std::count_if(seeds.begin(), seeds.end(), [](const Seed& s) { return !s.hole; }));
  in.numberofholes = static_cast<int>(seeds.size()) - in.numberofregions;
  if (in.numberofregions > 0) in.regionlist = new REAL[5 * static_cast<std::size_t>(in.numberofregions)];
  if (in.numberofholes > 0) in.holelist = new REAL[3 * static_cast<std::size_t>(in.numberofholes)];
  REAL* region = in.regionlist;
  REAL* hole = in.holelist;
  for (const Seed& seed : seeds) {
    REAL*& out = seed.hole ? hole : region;
    for (int k = 0; k < 3; ++k) *out++ = seed.position[k];
    if (seed.hole) continue;
    *out++ = seed.surface + 1;
    *out++ = seed.max_volume;
  }
}

/// One run of TetGen. The `region` of the result is the surface that a tet lies directly inside of (by `seeds`), else
/// 0.
TetMesh run_tetgen(const Boundary& all, const std::vector<Seed>& seeds, const std::string& switches,
                   const std::function<double(const Vector3d&)>& sizing, double sizing_scale) {
  static std::mutex one_at_a_time;  // TetGen's predicates keep global state
  const std::lock_guard lock(one_at_a_time);
  tetgenio in, out;
  fill(in, all, seeds);
  if (sizing) {
    current_sizing = &sizing;
    current_sizing_scale = sizing_scale;
    in.tetunsuitable = is_too_large;
  }
  try {
    tetgenbehavior behavior;
    std::string line = switches;
    if (!behavior.parse_commandline(line.data())) fail("TetGen does not accept the switches " + switches);
    if (behavior.quality != 0) behavior.optmaxdihedral = worst_dihedral;
    ::tetrahedralize(&behavior, &in, &out, nullptr, nullptr);
  } catch (int code) {
    fail(fmt::format("the tetrahedral mesher failed: {}", reason(code)),
         "look for nearly touching or very thin parts of the surfaces");
  }
  TetMesh mesh;
  mesh.V =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(out.pointlist, out.numberofpoints, 3);
  mesh.T.resize(out.numberoftetrahedra, 4);
  mesh.region = VectorXi::Zero(out.numberoftetrahedra);
  for (int t = 0; t < out.numberoftetrahedra; ++t) {
    for (int k = 0; k < 4; ++k) mesh.T(t, k) = out.tetrahedronlist[t * out.numberofcorners + k];
    if (out.numberoftetrahedronattributes > 0)
      mesh.region[t] =
          static_cast<int>(std::lround(out.tetrahedronattributelist[t * out.numberoftetrahedronattributes])) - 1;
  }
  return mesh;
}

void orient(TetMesh& mesh) {
  const VectorXd volumes = tet_volumes(mesh.V, mesh.T);
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t)
    if (volumes[t] < 0) std::swap(mesh.T(t, 0), mesh.T(t, 1));
}

using Face = std::array<int, 3>;

/// Corners with the lowest first, orientation kept.
Face canonical(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

/// The tet behind each input triangle (the triangle is one of its outward faces).
std::vector<int> inner_tets(const MatrixX4i& T, const MatrixX3i& F) {
  constexpr int corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::map<Face, int> triangle_of;
  for (int f = 0; f < F.rows(); ++f) triangle_of.emplace(canonical({F(f, 0), F(f, 1), F(f, 2)}), f);
  std::vector<int> tets(static_cast<std::size_t>(F.rows()), -1);
  for (int t = 0; t < T.rows(); ++t)
    for (const auto& c : corners) {
      const auto it = triangle_of.find(canonical({T(t, c[0]), T(t, c[1]), T(t, c[2])}));
      if (it != triangle_of.end()) tets[static_cast<std::size_t>(it->second)] = t;
    }
  return tets;
}

/// Numbers of the tet components that the input triangles separate.
VectorXi flood(const MatrixX4i& T, const MatrixX3i& F) {
  std::map<Face, bool> walls;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    Face face{F(f, 0), F(f, 1), F(f, 2)};
    std::sort(face.begin(), face.end());
    walls[face] = true;
  }
  const MatrixX4i neighbours = tet_neighbours(T);
  VectorXi component = VectorXi::Constant(T.rows(), -1);
  std::vector<int> stack;
  int count = 0;
  for (int start = 0; start < T.rows(); ++start) {
    if (component[start] >= 0) continue;
    component[start] = count;
    stack.push_back(start);
    while (!stack.empty()) {
      const int t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 4; ++k) {
        const int other = neighbours(t, k);
        if (other < 0 || component[other] >= 0) continue;
        Face face{T(t, (k + 1) % 4), T(t, (k + 2) % 4), T(t, (k + 3) % 4)};
        std::sort(face.begin(), face.end());
        if (walls.count(face)) continue;
        component[other] = count;
        stack.push_back(other);
      }
    }
    ++count;
  }
  return component;
}

double inradius(const MatrixX3d& V, const MatrixX4i& T, Eigen::Index t) {
  const Vector3d a = V.row(T(t, 0)), u = V.row(T(t, 1)).transpose() - a, v = V.row(T(t, 2)).transpose() - a,
                 w = V.row(T(t, 3)).transpose() - a;
  return u.cross(v).dot(w) / (u.cross(v).norm() + v.cross(w).norm() + w.cross(u).norm() + (v - u).cross(w - u).norm());
}

/// A point in every part of space that the surfaces enclose: the middle of the fattest tet there of a mesh without
/// added points. A part that no surface has directly inside of it (a void with triangles facing into it) becomes a
/// hole.
std::vector<Seed> find_seeds(std::span<const RegionSurface> surfaces, const Boundary& all) {
  TetMesh mesh = run_tetgen(all, {}, "pYQ", {}, 1);
  orient(mesh);
  const VectorXi component = flood(mesh.T, all.F);
  const std::vector<int> inner = inner_tets(mesh.T, all.F);
  std::vector<int> fattest(static_cast<std::size_t>(component.maxCoeff()) + 1, -1);
  for (int t = 0; t < mesh.T.rows(); ++t) {
    int& best = fattest[static_cast<std::size_t>(component[t])];
    if (best < 0 || inradius(mesh.V, mesh.T, t) > inradius(mesh.V, mesh.T, best)) best = t;
  }
  std::vector<Seed> seeds(fattest.size());
  for (std::size_t c = 0; c < seeds.size(); ++c) {
    const auto corners = mesh.T.row(fattest[c]);
    seeds[c].position = mesh.V(corners, Eigen::all).colwise().mean();
    seeds[c].hole = true;
    seeds[c].surface = -1;
  }
  for (std::size_t f = 0; f < inner.size(); ++f) {
    const int s = all.surface_of_triangle[f];
    const RegionSurface& surface = surfaces[static_cast<std::size_t>(s)];
    if (inner[f] < 0)
      fail(fmt::format("the tetrahedral mesher lost triangle {} of {}",
                       static_cast<Eigen::Index>(f) - all.first_triangle[static_cast<std::size_t>(s)], surface.name));
    Seed& seed = seeds[static_cast<std::size_t>(component[inner[f]])];
    if (seed.surface >= 0 && seed.surface != s)
      reject(surface.name,
             fmt::format("it has the same space directly inside of it as {}",
                         surfaces[static_cast<std::size_t>(seed.surface)].name),
             "each surface must bound its own space, facing outward");
    seed.surface = s;
    seed.hole = surface.hole;
  }
  return seeds;
}

TetMesh mesh_at_scale(std::span<const RegionSurface> surfaces, const Boundary& all, std::vector<Seed> seeds,
                      const TetrahedraliseOptions& options, double scale) {
  bool volumes = false;
  for (Seed& seed : seeds) {
    if (seed.hole) continue;
    const RegionSurface& s = surfaces[static_cast<std::size_t>(seed.surface)];
    const double edge = s.max_edge > 0 ? s.max_edge : options.max_edge;
    if (edge > 0) {
      seed.max_volume = regular_tet_volume(scale * edge);
      volumes = true;
    }
  }
  const std::string switches =
      fmt::format("pYA{}q{}/{}Q", volumes ? "a" : "", options.radius_edge_ratio, options.min_dihedral);
  return run_tetgen(all, seeds, switches, options.sizing, scale);
}

TetMesh mesh_with_target(std::span<const RegionSurface> surfaces, const Boundary& all, const std::vector<Seed>& seeds,
                         TetrahedraliseOptions options) {
  bool sized = options.max_edge > 0 || options.sizing;
  for (const auto& s : surfaces) sized = sized || s.max_edge > 0;
  if (options.target_tets == 0) return mesh_at_scale(surfaces, all, seeds, options, 1);
  if (!sized) {
    double volume = 0;
    for (const auto& s : surfaces) volume = std::max(volume, signed_volume(s.surface.V, s.surface.F));
    options.max_edge = std::cbrt(volume / options.target_tets * 6 * std::sqrt(2.0) * 2);
  }
  // Secant steps on log(scale), kept inside the bracket; the count falls with the scale.
  double low = 0, high = 0, scale = 1;  // scales with too many and too few tets; 0: none yet
  TetMesh best;
  double best_miss = 1e30;
  for (int run = 0; run < 12; ++run) {
    TetMesh mesh = mesh_at_scale(surfaces, all, seeds, options, scale);
    const double ratio = static_cast<double>(mesh.T.rows()) / options.target_tets;
    if (std::abs(ratio - 1) < best_miss) {
      best_miss = std::abs(ratio - 1);
      best = std::move(mesh);
    }
    if (best_miss <= 0.05) break;
    (ratio > 1 ? low : high) = scale;
    double next = scale * std::clamp(std::cbrt(ratio), 0.5, 2.0);
    if (low > 0 && high > 0 && !(next > low && next < high)) next = std::sqrt(low * high);
    if (std::abs(next / scale - 1) < 1e-3 || next > 1e3) break;
    scale = next;
  }
  return best;
}

void check_result(std::span<const RegionSurface> surfaces, const Boundary& all, TetMesh& mesh) {
  const Eigen::Index given = all.V.rows();
  if (mesh.V.rows() < given || (mesh.V.topRows(given) - all.V).cwiseAbs().maxCoeff() > 0)
    fail("the tetrahedral mesher changed the surface vertices", "look for coinciding vertices");
  const std::vector<int> inner = inner_tets(mesh.T, all.F);
  for (std::size_t f = 0; f < inner.size(); ++f) {
    const auto s = static_cast<std::size_t>(all.surface_of_triangle[f]);
    if (surfaces[s].hole) continue;
    const auto local = static_cast<Eigen::Index>(f) - all.first_triangle[s];
    if (inner[f] < 0)
      fail(fmt::format("the tetrahedral mesher did not keep triangle {} of {}", local, surfaces[s].name));
    if (mesh.region[inner[f]] != static_cast<int>(s))
      fail(fmt::format("the region inside triangle {} of {} leaks", local, surfaces[s].name));
  }
  for (Eigen::Index t = 0; t < mesh.region.size(); ++t)
    mesh.region[t] = surfaces[static_cast<std::size_t>(mesh.region[t])].region;
}

/// Better tets of the same regions, with every input triangle kept, even one that parts two tets of the same tag.
void improve(std::span<const RegionSurface> surfaces, const Boundary& all, const TetrahedraliseOptions& options,
             TetMesh& mesh) {
  const VectorXi component = flood(mesh.T, all.F);
  std::vector<int> tag(static_cast<std::size_t>(component.maxCoeff()) + 1);
  for (Eigen::Index t = 0; t < component.size(); ++t) tag[static_cast<std::size_t>(component[t])] = mesh.region[t];
  mesh.region = component;
  ImproveOptions how;
  how.target = options.improve_below;
  how.insert_below = options.insert_below;
  how.give = VectorXd::Zero(mesh.V.rows());
  Eigen::Index first = 0;
  for (const auto& s : surfaces) {
    if (s.give.size() > 0) how.give.segment(first, s.give.size()) = s.give;
    first += s.surface.V.rows();
  }
  improve_tets(mesh, how);
  for (int& region : mesh.region) region = tag[static_cast<std::size_t>(region)];
}

}  // namespace

TetMesh tetrahedralise(std::span<const RegionSurface> surfaces, const TetrahedraliseOptions& options) {
  check_options(options);
  const Boundary all = join(surfaces);
  check_surfaces(surfaces, all);
  const std::vector<Seed> seeds = find_seeds(surfaces, all);
  TetMesh mesh = mesh_with_target(surfaces, all, seeds, options);
  orient(mesh);
  check_result(surfaces, all, mesh);
  const auto smooth = [&](double kept_angle) {
    std::vector<char> fixed(static_cast<std::size_t>(mesh.V.rows()), 0);
    std::fill_n(fixed.begin(), all.V.rows(), char{1});
    smooth_interior(mesh, fixed, options.smoothing_passes, kept_angle);
  };
  smooth(0);
  if (options.improve_below > 0) {
    improve(surfaces, all, options, mesh);
    smooth(options.improve_below);
  }
  validate(mesh, "tetrahedralise");
  return mesh;
}

}  // namespace phiz
