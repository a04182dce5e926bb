// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/open_data.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/file_set.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/obj.h"

namespace phiz {

namespace {

constexpr double centimetre = 0.01, millimetre = 0.001;

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

/// Names joined for a message, the first few of them.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

std::set<std::string> face_kit_names() {
  std::set<std::string> names{"generic_neutral_mesh"};
  for (const std::string& name : face_kit_expressions()) names.insert(name);
  for (const std::string& name : face_kit_identities()) names.insert(name);
  return names;
}

/// Where the wanted .obj files are: plain files first; archives are for what is missing then.
struct FaceKitFiles {
  std::map<std::string, std::string> plain;  // path by stem
  std::vector<std::string> archives;
};

FaceKitFiles find_face_kit(const std::string& folder) {
  const std::set<std::string> names = face_kit_names();
  FaceKitFiles files;
  std::vector<std::string> archives;
  for (const std::string& path : files_under(folder)) {
    if (is_archive(path)) archives.push_back(path);
    if (lower_extension(path) == ".obj" && names.contains(stem(path))) files.plain.emplace(stem(path), path);
  }
  if (files.plain.size() < names.size()) files.archives = archives;
  return files;
}

/// The texts of the wanted files by stem, and where each comes from.
struct NamedText {
  std::string name, where, text;
};
std::vector<NamedText> read_texts(const FaceKitFiles& files) {
  const std::set<std::string> names = face_kit_names();
  std::vector<NamedText> texts;
  for (const auto& [name, path] : files.plain) texts.push_back({name, path, read_bytes(path)});
  std::set<std::string> found;
  for (const NamedText& text : texts) found.insert(text.name);
  for (const std::string& archive : files.archives) {
    const auto wanted = [&](const std::string& entry) {
      return lower_extension(entry) == ".obj" && names.contains(stem(entry)) && !found.contains(stem(entry));
    };
    read_archive(archive, wanted, [&](const std::string& entry, std::string bytes) {
      found.insert(stem(entry));
      texts.push_back({stem(entry), archive + ":" + entry, std::move(bytes)});
    });
  }
  return texts;
}

std::optional<int> fma_number(const std::string& path) {
  const std::string name = stem(path);
  if (!name.starts_with("FMA") || name.size() < 4 || std::isdigit(static_cast<unsigned char>(name[3])) == 0)
    return std::nullopt;
  long number = 0;
  for (std::size_t i = 3; i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])) != 0; ++i)
    if ((number = 10 * number + (name[i] - '0')) > 100'000'000) return std::nullopt;
  return static_cast<int>(number);
}

std::map<int, std::string> find_body_parts(const std::string& folder) {
  std::map<int, std::string> files;
  for (const std::string& path : files_under(folder)) {
    const std::string extension = lower_extension(path);
    if (extension != ".ply" && extension != ".stl" && extension != ".obj") continue;
    if (const auto number = fma_number(path)) files.emplace(*number, path);
  }
  return files;
}

/// All parts are of one head: none is far from where most are.
void require_one_place(const BodyParts& parts, const std::map<int, std::string>& files) {
  constexpr double reach = 0.35;  // metres from the middle of the parts' centres
  const auto centre = [](const TriangleMesh& mesh) { return Vector3d(mesh.V.colwise().mean()); };
  std::array<std::vector<double>, 3> centres;
  for (const auto& [fma, mesh] : parts.meshes)
    for (int k = 0; k < 3; ++k) centres[static_cast<std::size_t>(k)].push_back(centre(mesh)[k]);
  Vector3d middle;
  for (int k = 0; k < 3; ++k) {
    std::vector<double>& values = centres[static_cast<std::size_t>(k)];
    const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), half, values.end());
    middle[k] = *half;
  }
  for (const auto& [fma, mesh] : parts.meshes)
    if ((centre(mesh) - middle).norm() > reach)
      reject(files.at(fma), "lies far away from the other parts of the head", "use the files as they are given out");
}

std::uint64_t fingerprint(const std::vector<std::string>& paths) {
  std::uint64_t sum = 1469598103934665603ULL;
  for (const std::string& path : paths) {
    const std::string bytes = read_bytes(path);
    const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    for (const std::uint64_t part : {std::uint64_t{crc}, std::uint64_t{bytes.size()}})
      sum = (sum ^ part) * 1099511628211ULL;
  }
  return sum;
}

}  // namespace

FaceKit read_face_kit(const std::string& folder) {
  const std::vector<NamedText> texts = read_texts(find_face_kit(folder));
  std::map<std::string, const NamedText*> by_name;
  for (const NamedText& text : texts) by_name[text.name] = &text;
  std::vector<std::string> missing;
  for (const std::string& name : face_kit_names())
    if (!by_name.contains(name)) missing.push_back(name + ".obj");
  if (!missing.empty())
    reject(folder, "lacks " + listed(missing),
           "give the folder FaceXModel of github.com/ICT-VGL/ICT-FaceKit, complete");

  FaceKit kit;
  const NamedText& neutral = *by_name.at("generic_neutral_mesh");
  kit.neutral = parse_obj(neutral.text, neutral.where);
  const SuspectedUnit unit = suspect_unit(kit.neutral.V);
  if (unit.name != "centimetres")
    reject(neutral.where, fmt::format("is {:.3g} units large; the model comes in centimetres", unit.extent),
           "use the files as they are given out");
  const auto displacements = [&](const std::string& name) {
    const NamedText& text = *by_name.at(name);
    const MatrixX3d V = parse_obj(text.text, text.where).V;
    if (V.rows() != kit.neutral.V.rows())
      reject(text.where,
             fmt::format("has {} vertices, generic_neutral_mesh.obj has {}", V.rows(), kit.neutral.V.rows()),
             "all files must be of one release of the model");
    MatrixX3d moved = (V - kit.neutral.V) * centimetre;
    constexpr double farthest = 0.2;  // metres
    Eigen::Index vertex = 0;
    if (moved.rowwise().norm().maxCoeff(&vertex) > farthest)
      reject(text.where, fmt::format("moves vertex {} by {:.3g} m", vertex, moved.row(vertex).norm()),
             "fetch it again");
    return moved;
  };
  const std::vector<std::string>& expressions = face_kit_expressions();
  std::vector<std::string> all = face_kit_identities();
  const std::size_t identities = all.size();
  all.insert(all.end(), expressions.begin(), expressions.end());
  std::vector<MatrixX3d> moved(all.size());
  std::vector<std::exception_ptr> errors(all.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(all.size()),
      [&](std::ptrdiff_t i) {
        const auto k = static_cast<std::size_t>(i);
        try {
          moved[k] = displacements(all[k]);
        } catch (...) {
          errors[k] = std::current_exception();
        }
      },
      1);
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  kit.identities.assign(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(identities));
  for (std::size_t i = identities; i < all.size(); ++i) kit.expressions[all[i]] = std::move(moved[i]);
  kit.neutral.V *= centimetre;
  return kit;
}

BodyParts read_body_parts(const std::string& folder) {
  const std::map<int, std::string> files = find_body_parts(folder);
  std::vector<std::string> missing;
  for (const BodyPartName& part : needed_body_parts())
    if (!files.contains(part.fma)) missing.push_back(fmt::format("FMA{} ({})", part.fma, part.name));
  if (!missing.empty())
    reject(folder, "lacks " + listed(missing),
           "give a folder with the files of BodyParts3D, named by their FMA numbers (.ply, .stl or .obj)");
  BodyParts parts;
  for (const auto* list : {&needed_body_parts(), &optional_body_parts()}) {
    for (const BodyPartName& part : *list) {
      const auto file = files.find(part.fma);
      if (file == files.end()) continue;
      TriangleMesh mesh = triangulate(read_mesh(file->second));
      if (mesh.F.rows() == 0) reject(file->second, "has no triangles");
      const Vector3d low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
      if (!((high - low).maxCoeff() > 2 && high.cwiseAbs().maxCoeff() > 200 && high.cwiseAbs().maxCoeff() < 5000))
        reject(file->second, "does not lie in the frame of BodyParts3D in millimetres, feet at z = 0",
               "use the files as they are given out");
      constexpr double most_open = 0.001, some_open = 12;  // of three edges per triangle; edges
      std::size_t open_edges = 0;
      for (const auto& loop : boundary_loops(mesh.F)) open_edges += loop.size();
      if (static_cast<double>(open_edges) > std::max(some_open, most_open * 3 * static_cast<double>(mesh.F.rows())))
        reject(file->second, fmt::format("is incomplete: {} edges have a triangle on one side only", open_edges),
               "fetch it again");
      constexpr double least_volume = 10;  // cubic millimetres; the smallest part has 94
      if (!(signed_volume(mesh.V, mesh.F) > least_volume))
        reject(file->second, "encloses no volume: it is flat or inside out", "fetch it again");
      mesh.V = (MatrixX3d(mesh.V.rows(), 3) << mesh.V.col(0), mesh.V.col(2), -mesh.V.col(1)).finished() * millimetre;
      parts.meshes[part.fma] = std::move(mesh);
    }
  }
  require_one_place(parts, files);
  return parts;
}

std::uint64_t fingerprint_face_kit(const std::string& folder) {
  const FaceKitFiles files = find_face_kit(folder);
  std::vector<std::string> paths = files.archives;
  for (const auto& [name, path] : files.plain) paths.push_back(path);
  return fingerprint(paths);
}

std::uint64_t fingerprint_body_parts(const std::string& folder) {
  std::set<int> used;
  for (const auto* list : {&needed_body_parts(), &optional_body_parts()})
    for (const BodyPartName& part : *list) used.insert(part.fma);
  std::vector<std::string> paths;
  for (const auto& [fma, path] : find_body_parts(folder))
    if (used.contains(fma)) paths.push_back(path);
  return fingerprint(paths);
}

}  // namespace phiz
