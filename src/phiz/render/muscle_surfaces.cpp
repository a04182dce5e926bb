// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/muscle_surfaces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/core/nearest_words.h"
#include "phiz/core/parallel.h"
#include "phiz/render/materials.h"
#include "phiz/render/palette.h"

namespace phiz::detail {

namespace {

/// Letters and digits only, so that "Zygomaticus major" finds zygomaticusMajor.
std::string plain(std::string_view name) {
  std::string letters;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

/// The line a muscle follows at one place.
struct FibreSample {
  Vector3d position, direction;
  double from_origin = 0, to_insertion = 0;  // metres along the fibre; negative where it is not known
};

std::vector<FibreSample> fibre_samples(const HeadTemplate& head, const Muscle& muscle) {
  std::vector<FibreSample> samples;
  for (const MatrixX3d& fibre : muscle.fibres) {
    const Eigen::Index n = fibre.rows();
    VectorXd length = VectorXd::Zero(n);
    for (Eigen::Index i = 1; i < n; ++i) length[i] = length[i - 1] + (fibre.row(i) - fibre.row(i - 1)).norm();
    for (Eigen::Index i = 0; i < n && n > 1; ++i) {
      const Vector3d along = fibre.row(std::min(i + 1, n - 1)) - fibre.row(std::max<Eigen::Index>(i - 1, 0));
      samples.push_back({fibre.row(i), along.stableNormalized(), length[i], length[n - 1] - length[i]});
    }
  }
  if (!samples.empty()) return samples;
  for (Eigen::Index i = 0; i < muscle.direction.rows(); ++i) {
    Vector3d centre = Vector3d::Zero();
    for (int k = 0; k < 4; ++k) centre += head.volume.V.row(head.volume.T(muscle.tets[i], k)).transpose() / 4;
    samples.push_back({centre, muscle.direction.row(i), -1, -1});
  }
  return samples;
}

/// The samples near p, weighted by the inverse fourth power of their distance: the direction from close by, the
/// distance to the ends from farther off, so that a single fibre that ends early does not count.
FibreSample blended(const std::vector<FibreSample>& samples, const Vector3d& p) {
  constexpr double blur = 0.0012, wide_blur = 0.005;  // metres
  FibreSample mean{p, Vector3d::Zero(), 0, 0};
  double total = 0;
  for (const FibreSample& s : samples) {
    const double squared = (s.position - p).squaredNorm(), near = 1 / (squared + blur * blur),
                 wide = 1 / (squared + wide_blur * wide_blur), w = wide * wide;
    total += w;
    mean.direction += near * near * s.direction;
    mean.from_origin += w * s.from_origin;
    mean.to_insertion += w * s.to_insertion;
  }
  mean.direction = mean.direction.stableNormalized();
  mean.from_origin /= total;
  mean.to_insertion /= total;
  return mean;
}

/// Tendon shows in the first and last millimetres of a muscle: 1 at the very end.
double tendon_share(double distance, double reach) {
  const double t = std::clamp(1 - distance / reach, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Muscles under skin that is left on are not shown: skin is thin, and they may come too close to it.
void push_peeled(Scene& scene, Surface muscle, const std::optional<CutPlane>& peel) {
  if (peel) muscle = cut_surface(muscle, {peel->point, -peel->normal});
  if (muscle.mesh.F.rows() > 0) scene.surfaces.push_back(std::move(muscle));
}

/// Mesh of tubes of six sides round polylines.
struct Tubes {
  std::vector<Vector3d> points, colours;
  std::vector<Eigen::Vector3i> triangles;

  void add(const MatrixX3d& line, double radius, const Vector3d& first_colour, const Vector3d& last_colour) {
    constexpr int sides = 6;
    const Eigen::Index n = line.rows();
    const int first = static_cast<int>(points.size());
    Vector3d normal = Vector3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector3d along = (line.row(std::min(i + 1, n - 1)) - line.row(std::max<Eigen::Index>(i - 1, 0)))
                                 .transpose()
                                 .stableNormalized();
      normal = normal.norm() < 0.5 ? along.unitOrthogonal()
                                   : Vector3d((normal - along * along.dot(normal)).stableNormalized());
      const Vector3d side = along.cross(normal);
      const double t = static_cast<double>(i) / static_cast<double>(n - 1);
      for (int k = 0; k < sides; ++k) {
        const double a = 2 * M_PI * k / sides;
        points.emplace_back(line.row(i).transpose() + radius * (std::cos(a) * normal + std::sin(a) * side));
        colours.emplace_back(first_colour + t * (last_colour - first_colour));
      }
    }
    for (int i = 0; i + 1 < n; ++i) {
      for (int k = 0; k < sides; ++k) {
        const int a = first + i * sides + k, b = first + i * sides + (k + 1) % sides;
        triangles.emplace_back(a, b, b + sides);
        triangles.emplace_back(a, b + sides, a + sides);
      }
    }
  }
};

template <class Rows, class Matrix>
void copy_rows(const Rows& rows, Matrix& matrix) {
  matrix.resize(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
}

}  // namespace

TissueMotion::TissueMotion(const PosedHead& posed) {
  const TetMesh& volume = posed.head->volume;
  if (posed.volume_now.rows() == 0 || volume.T.rows() == 0 || posed.volume_now == volume.V) return;
  tets_.emplace(volume);
  T_ = &volume.T;
  moved_ = posed.volume_now - volume.V;
}

MatrixX3d TissueMotion::operator()(const MatrixX3d& points) const {
  if (!tets_) return points;
  return points + interpolation_matrix(tets_->nearest_all(points), *T_, moved_.rows()) * moved_;
}

std::string muscle_stem(const std::string& name) {
  for (const std::string_view side : {"Left", "Right"})
    if (name.size() > side.size() && name.ends_with(side)) return name.substr(0, name.size() - side.size());
  return name;
}

std::vector<ShownMuscle> shown_muscles(const HeadTemplate& head, const HeadViewOptions& options) {
  std::map<std::string, int> kinds;
  std::vector<std::string> stems;
  std::vector<ShownMuscle> all;
  for (std::size_t i = 0; i < head.muscles.size(); ++i) {
    const std::string stem = muscle_stem(head.muscles[i].name);
    const auto [kind, fresh] = kinds.try_emplace(stem, static_cast<int>(kinds.size()));
    if (fresh) stems.push_back(stem);
    all.push_back({static_cast<int>(i), kind->second});
  }
  if (options.muscles.empty()) return all;
  std::vector<bool> chosen(all.size(), false);
  for (const std::string& asked : options.muscles) {
    bool found = false;
    for (const ShownMuscle& muscle : all) {
      const std::string& name = head.muscles[muscle.row].name;
      if (plain(asked) != plain(name) && plain(asked) != plain(muscle_stem(name))) continue;
      chosen[muscle.row] = found = true;
    }
    if (found) continue;
    if (stems.empty()) throw Error(ErrorKind::usage, head.name + " has no muscles");
    throw Error(ErrorKind::usage, fmt::format("{} has no muscle '{}'; the nearest names are {}", head.name, asked,
                                              fmt::join(nearest_words(plain(asked), stems, 3), ", ")));
  }
  std::erase_if(all, [&](const ShownMuscle& muscle) { return !chosen[muscle.row]; });
  return all;
}

Vector3d colour_of(const ShownMuscle& muscle, const HeadViewOptions& options) {
  return options.muscle_colours ? category_colour(muscle.kind) : muscle_colour(muscle.kind);
}

Vector3d origin_colour() {
  return {0.96, 0.92, 0.80};
}
Vector3d insertion_colour() {
  return {0.60, 0.045, 0.035};
}

Surface muscle_belly(const PosedHead& posed, const TissueMotion& motion, const ShownMuscle& shown,
                     const HeadViewOptions& options) {
  const Muscle& muscle = posed.head->muscles[shown.row];
  Surface s;
  s.name = muscle.name;
  s.mesh.F = muscle.surface.F;
  s.mesh.V = motion(muscle.surface.V);
  s.rest = muscle.surface.V;
  s.material = muscle_material();
  s.outline = 0.55;
  const Eigen::Index n = s.rest.rows();
  s.colour = colour_of(shown, options).transpose().replicate(n, 1);
  const std::vector<FibreSample> samples = fibre_samples(*posed.head, muscle);
  if (samples.empty()) return s;
  s.fibre.resize(n, 3);
  parallel_for(n, [&](std::ptrdiff_t v) {
    const FibreSample line = blended(samples, s.rest.row(v));
    s.fibre.row(v) = line.direction.transpose();
    if (muscle.ring || line.from_origin < 0 || options.muscle_colours) return;
    const double pale =
        std::max(0.8 * tendon_share(line.from_origin, 0.010), 0.5 * tendon_share(line.to_insertion, 0.007));
    s.colour.row(v) += pale * (tissue_colour::tendon.transpose() - s.colour.row(v));
  });
  return s;
}

Surface fibre_tubes(const PosedHead& posed, const TissueMotion& motion, const ShownMuscle& shown,
                    const HeadViewOptions& options, double radius, bool graded) {
  const Muscle& muscle = posed.head->muscles[shown.row];
  const Vector3d own = colour_of(shown, options);
  Tubes tubes;
  for (const MatrixX3d& fibre : muscle.fibres)
    if (fibre.rows() > 1)
      tubes.add(motion(fibre), radius, graded ? origin_colour() : own, graded ? insertion_colour() : own);
  Surface s;
  s.name = muscle.name;
  s.material = muscle_material();
  s.material.striation = 0;
  copy_rows(tubes.points, s.mesh.V);
  copy_rows(tubes.triangles, s.mesh.F);
  copy_rows(tubes.colours, s.colour);
  return s;
}

void add_muscles(Scene& scene, const PosedHead& posed, const HeadViewOptions& options) {
  const TissueMotion motion(posed);
  for (const ShownMuscle& muscle : shown_muscles(*posed.head, options)) {
    const bool belly = posed.head->muscles[muscle.row].surface.F.rows() > 0;
    push_peeled(scene,
                belly ? muscle_belly(posed, motion, muscle, options)
                      : fibre_tubes(posed, motion, muscle, options, 0.00075, false),
                options.peel);
  }
}

void add_fibres(Scene& scene, const PosedHead& posed, const HeadViewOptions& options) {
  const TissueMotion motion(posed);
  for (const ShownMuscle& muscle : shown_muscles(*posed.head, options))
    push_peeled(scene, fibre_tubes(posed, motion, muscle, options, 0.0004, !options.muscle_colours), options.peel);
}

}  // namespace phiz::detail
