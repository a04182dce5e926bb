// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/take_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>

#include "phiz/core/error.h"
#include "phiz/io/container.h"
#include "phiz/io/container_file.h"
#include "phiz/io/output_file.h"
#include "phiz/io/stored_anatomy.h"
#include "phiz/io/stored_frames.h"

namespace phiz {

namespace {

constexpr const char* count_name = "frames";  // the number of finished frames; written after each of them

constexpr double slowest_rate = 1e-3, fastest_rate = 1e5;  // frames per second

std::string part_name(const std::string& path) {
  return path + ".part";
}

void require_near(const MatrixX3d& points, const std::string& where) {
  if (!is_near(points)) reject(where, fmt::format("a point is more than {} m away from the head", farthest));
}

void store_take_head(const Hdf5Group& root, const Take& take) {
  root.set(count_name, 0);
  root.set("frames_planned", take.frames_planned);
  root.set("frame_rate", take.frame_rate);
  root.set("model", take.model);
  root.write_strings("expressions", take.expressions);
  store_mesh(root.create_group("skin"), take.skin);
  store_parts(root.create_group("parts"), take.parts);
  store_joint(root.create_group("jaw"), take.joint);
  root.write("left_eye_centre", take.left_eye_centre);
  root.write("right_eye_centre", take.right_eye_centre);
  root.create_group("frame_data");
}

Take stored_take_head(const Hdf5Group& root) {
  Take take;
  take.frames_planned = root.integer("frames_planned");
  take.frame_rate = root.number("frame_rate");
  take.model = root.text("model");
  take.expressions = root.read_strings("expressions");
  take.skin = stored_mesh(root.group("skin"));
  take.parts = stored_parts(root.group("parts"));
  take.joint = stored_joint(root.group("jaw"));
  take.left_eye_centre = root.read<Vector3d>("left_eye_centre");
  take.right_eye_centre = root.read<Vector3d>("right_eye_centre");
  if (take.frames_planned < 0) reject(root.where("frames_planned"), fmt::format("{} frames", take.frames_planned));
  if (!(take.frame_rate >= slowest_rate && take.frame_rate <= fastest_rate)) {
    reject(root.where("frame_rate"), fmt::format("{} is no frame rate", take.frame_rate));
  }
  require_near(take.skin.V, root.where("skin"));
  for (const Part& part : take.parts) require_near(part.mesh.V, root.where("part " + part.name));
  require_near(take.left_eye_centre.transpose(), root.where("left_eye_centre"));
  require_near(take.right_eye_centre.transpose(), root.where("right_eye_centre"));
  return take;
}

int stored_frame_count(const Hdf5Group& root) {
  const int frames = root.integer(count_name);
  if (frames < 0) reject(root.where(count_name), fmt::format("{} frames", frames));
  return frames;
}

/// What differs between the head of a take that is there and of one that is to go on; empty when nothing does.
std::string difference(const Take& a, const Take& b) {
  if (a.model != b.model) return fmt::format("its head is '{}', not '{}'", a.model, b.model);
  if (a.frame_rate != b.frame_rate) return fmt::format("its frame rate is {}, not {}", a.frame_rate, b.frame_rate);
  if (a.frames_planned != b.frames_planned) {
    return fmt::format("its performance has {} frames, not {}", a.frames_planned, b.frames_planned);
  }
  if (a.expressions != b.expressions) return "its performance has other expressions";
  if (a.skin.V.rows() != b.skin.V.rows() || a.skin.V != b.skin.V || a.skin.F.rows() != b.skin.F.rows() ||
      a.skin.F != b.skin.F) {
    return "its skin is another one";
  }
  if (a.parts.size() != b.parts.size()) return "its head has other parts";
  return {};
}

/// What the frames of a file have in common, and how many there are.
struct FrameList {
  Eigen::Index skin_vertices = 0;
  Eigen::Index expressions = 0;
  int frames = 0;
  std::optional<FrameSizes> sizes;  ///< known from the first frame on
};

FrameList no_frames(const Take& head) {
  return {head.skin.V.rows(), static_cast<Eigen::Index>(head.expressions.size()), 0, std::nullopt};
}

/// Refuses a frame that does not fit the others, before anything is written.
void check_frame(const FrameList& list, const TakeFrame& frame, const std::string& path) {
  const FrameSizes sizes = sizes_of(frame);
  const std::string here = fmt::format("{}: frame {}", path, list.frames);
  if (sizes.skin != list.skin_vertices || sizes.weights != list.expressions) {
    fail(fmt::format("{} has {} vertices and {} weights, the take {} and {}", here, sizes.skin, sizes.weights,
                     list.skin_vertices, list.expressions));
  }
  const std::string defect = defect_of(frame);
  if (!defect.empty()) fail(here + ": " + defect);
  if (list.sizes && !(*list.sizes == sizes)) {
    fail(here + " has a volume or velocities and others do not, or of another size");
  }
}

/// Fails while the file is still whole: what HDF5 could only write by half would cost the frames before, too.
void require_room(const std::string& path, const TakeFrame& frame) {
  constexpr std::uintmax_t spare = 1 << 20;
  const auto numbers = static_cast<std::uintmax_t>(frame.skin.size() + frame.volume.size() + frame.velocity.size());
  std::error_code unknown;
  const auto space = std::filesystem::space(std::filesystem::absolute(path).parent_path(), unknown);
  if (!unknown && space.available < numbers * sizeof(float) + spare) {
    fail(fmt::format("the disk of {} is full", path), "free some space; the same command with --resume goes on");
  }
}

void add_frame(const Hdf5Group& root, FrameList& list, const TakeFrame& frame) {
  const Hdf5Group group = root.group("frame_data");
  if (!list.sizes) {
    list.sizes = sizes_of(frame);
    create_frames(group, *list.sizes);
  }
  store_frame(group, list.frames, frame);
  ++list.frames;
}

}  // namespace

struct TakeWriter::State {
  std::string path;
  ContainerFile file;
  FrameList list;

  /// Starts the .part file with the frames that another file has. It is whole from its first moment on, so that
  /// whatever a killed program leaves can be resumed.
  static std::unique_ptr<State> begin(const std::string& path, const Take& head, const TakeReader* other,
                                      const std::function<void(const TakeFrame& frame)>& show) {
    require_writable(path);
    const DelayInterrupts delay;
    ContainerFile file = ContainerFile::create(part_name(path), name_of(ContainerKind::take));
    store_take_head(file.root(), head);
    FrameList list = no_frames(head);
    for (int i = 0; other != nullptr && i < other->frames(); ++i) {
      const TakeFrame frame = other->frame(i);
      if (show) show(frame);
      add_frame(file.root(), list, frame);
    }
    file.root().set(count_name, list.frames);
    file.flush();
    file.publish();
    return std::make_unique<State>(State{path, std::move(file), list});
  }
};

TakeWriter::TakeWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}

TakeWriter::TakeWriter(const std::string& path, const Take& head) {
  const std::scoped_lock lock(hdf5_lock());
  state_ = State::begin(path, head, nullptr, {});
}

namespace {

TakeReader open_to_resume(const std::string& path) {
  try {
    return TakeReader(path);
  } catch (const Error& error) {
    throw Error(error.kind(), std::string(error.what()) + "; leave out --resume to start anew");
  }
}

}  // namespace

TakeWriter TakeWriter::resume(const std::string& path, const Take& head,
                              const std::function<void(const TakeFrame& frame)>& finished) {
  const std::scoped_lock lock(hdf5_lock());
  const std::string part = part_name(path);
  const std::string there = std::filesystem::exists(part) ? part : path;
  if (!std::filesystem::exists(there)) return {path, head};
  const TakeReader reader = open_to_resume(there);
  std::string different = difference(reader.head(), head);
  if (different.empty() && reader.frames() > head.frames_planned) different = "it has more frames";
  if (!different.empty())
    reject(there, "the take there cannot be resumed: " + different, "choose another file or start anew");
  return TakeWriter(State::begin(path, head, &reader, finished));
}

TakeWriter::TakeWriter(TakeWriter&&) noexcept = default;
TakeWriter& TakeWriter::operator=(TakeWriter&&) noexcept = default;

TakeWriter::~TakeWriter() {
  if (!state_) return;
  try {
    finish();
  } catch (const Error&) {
    // The frames stay in the .part file; a destructor cannot report more.
  }
}

int TakeWriter::frames() const {
  return state_ ? state_->list.frames : 0;
}

void TakeWriter::append(const TakeFrame& frame) {
  const std::scoped_lock lock(hdf5_lock());
  if (!state_) fail("a frame was appended to a take that is finished");
  check_frame(state_->list, frame, state_->path);
  require_room(state_->path, frame);
  // A frame is on the disk before it is counted: whenever the program is killed, what is counted is there.
  add_frame(state_->file.root(), state_->list, frame);
  state_->file.flush();
  state_->file.root().set(count_name, state_->list.frames);
  state_->file.flush();
}

void TakeWriter::finish() {
  const std::scoped_lock lock(hdf5_lock());
  if (!state_) return;
  const std::unique_ptr<State> state = std::move(state_);
  state->file.finish();
  rename_file(part_name(state->path), state->path);
}

struct TakeReader::State {
  ContainerFile file;
  Take head;
  int frames = 0;
  FrameSizes sizes;
};

TakeReader::TakeReader(const std::string& path) {
  const std::scoped_lock lock(hdf5_lock());
  state_ = std::make_unique<State>(State{ContainerFile::open(path), {}, 0, {}});
  state_->file.require_kind(name_of(ContainerKind::take));
  const Hdf5Group& root = state_->file.root();
  state_->head = stored_take_head(root);
  state_->frames = stored_frame_count(root);
  if (state_->frames == 0) return;
  const Hdf5Group group = root.group("frame_data");
  state_->sizes = stored_sizes(group, state_->frames);
  if (state_->sizes.skin != state_->head.skin.V.rows()) {
    reject(group.where("skin"),
           fmt::format("frames of {} vertices for a skin of {}", state_->sizes.skin, state_->head.skin.V.rows()));
  }
  if (state_->sizes.weights != static_cast<Eigen::Index>(state_->head.expressions.size())) {
    reject(group.where("weights"), "frames have another number of weights than there are expressions");
  }
}

TakeReader::TakeReader(TakeReader&&) noexcept = default;
TakeReader& TakeReader::operator=(TakeReader&&) noexcept = default;
TakeReader::~TakeReader() {
  const std::scoped_lock lock(hdf5_lock());
  state_.reset();
}

const Take& TakeReader::head() const {
  return state_->head;
}
int TakeReader::frames() const {
  return state_->frames;
}

TakeFrame TakeReader::frame(int index) const {
  const std::scoped_lock lock(hdf5_lock());
  if (index < 0 || index >= state_->frames) {
    throw Error(ErrorKind::usage, fmt::format("frame {} of a take that has {} frames", index, state_->frames));
  }
  return stored_frame(state_->file.root().group("frame_data"), index, state_->sizes);
}

void save(const std::string& path, const Take& take) {
  write_container(path, name_of(ContainerKind::take), [&](const Hdf5Group& root) {
    store_take_head(root, take);
    FrameList list = no_frames(take);
    for (const TakeFrame& frame : take.frames) {
      check_frame(list, frame, path);
      add_frame(root, list, frame);
    }
    root.set(count_name, list.frames);
  });
}

Take load_take(const std::string& path) {
  const TakeReader reader(path);
  Take take = reader.head();
  for (int i = 0; i < reader.frames(); ++i) take.frames.push_back(reader.frame(i));
  return take;
}

}  // namespace phiz
