// SPDX-License-Identifier: GPL-3.0-or-later
#include <mutex>

#include "phiz/core/error.h"
#include "phiz/io/container.h"
#include "phiz/io/container_file.h"

namespace phiz {

void save(const std::string& path, const Performance& performance) {
  write_container(path, name_of(ContainerKind::performance), [&](const Hdf5Group& root) {
    root.set("frame_rate", performance.frame_rate);
    root.write_strings("expressions", performance.expressions);
    root.write("time", performance.time);
    root.write("weights", performance.weights);
    root.write("head", performance.head);
    root.write("left_eye", performance.left_eye);
    root.write("right_eye", performance.right_eye);
  });
}

Performance load_performance(const std::string& path) {
  const std::scoped_lock lock(hdf5_lock());
  const ContainerFile file = ContainerFile::open(path);
  file.require_kind(name_of(ContainerKind::performance));
  const Hdf5Group& root = file.root();
  Performance p;
  p.frame_rate = root.number("frame_rate");
  p.expressions = root.read_strings("expressions");
  p.time = root.read<VectorXd>("time");
  p.weights = root.read<MatrixXd>("weights");
  p.head = root.read<MatrixX3d>("head");
  p.left_eye = root.read<MatrixX3d>("left_eye");
  p.right_eye = root.read<MatrixX3d>("right_eye");
  validate(p, path);
  return p;
}

}  // namespace phiz
