// SPDX-License-Identifier: GPL-3.0-or-later
/// Damage to .phiz files: to their bytes, which the checksum must notice, and to their content behind a right checksum,
/// which the loaders' own checks must notice.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <limits>

#include "io/mutate.h"
#include "io/sample_nouns.h"
#include "io/temporary_folder.h"
#include "io/version1.h"
#include "phiz/core/error.h"
#include "phiz/io/container.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/take_file.h"

namespace phiz {
namespace {

void load_any(const std::string& path) {
  switch (kind_of(path)) {
    case ContainerKind::head_template:
      load_head_template(path);
      break;
    case ContainerKind::face_model:
      load_face_model(path);
      break;
    case ContainerKind::performance:
      load_performance(path);
      break;
    case ContainerKind::take:
      load_take(path);
      break;
  }
}

void save_samples(const TemporaryFolder& folder) {
  save(folder.file("0"), sample_head());
  save(folder.file("1"), sample_model());
  save(folder.file("2"), sample_performance());
  save(folder.file("3"), sample_take(3));
}

TEST(FuzzContainer, damaged_bytes_are_noticed) {
  const TemporaryFolder folder;
  save_samples(folder);
  std::vector<std::string> seeds;
  for (const char* name : {"0", "1", "2", "3"}) seeds.push_back(read_bytes(folder.file(name)));
  const std::string path = folder.file("damaged.phiz");
  expect_survives(seeds, 500, [&path](const std::string& bytes) {
    write_bytes(path, bytes);
    load_any(path);
  });
}

/// All arrays and attributes of a file: "group/array" or "group@attribute".
std::vector<std::string> items_of(const std::string& path) {
  std::vector<std::string> items;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto visit = [](hid_t place, const char* name, const H5O_info_t* info, void* data) -> herr_t {
    auto& list = *static_cast<std::vector<std::string>*>(data);
    if (info->type == H5O_TYPE_DATASET) list.emplace_back(name);
    const hid_t object = H5Oopen(place, name, H5P_DEFAULT);
    for (hsize_t i = 0; i < info->num_attrs; ++i) {
      std::array<char, 64> attribute{};
      H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, attribute.data(), attribute.size(), H5P_DEFAULT);
      list.push_back(std::string(name) + "@" + attribute.data());
    }
    H5Oclose(object);
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &items, H5O_INFO_BASIC | H5O_INFO_NUM_ATTRS);
  H5Fclose(file);
  std::sort(items.begin(), items.end());
  return items;
}

void damage_attribute(hid_t file, const std::string& item, Random& random) {
  const std::size_t at = item.find('@');
  const hid_t object = H5Oopen(file, item.substr(0, at).c_str(), H5P_DEFAULT);
  const std::string name = item.substr(at + 1);
  const std::uint32_t action = random.below(3);
  if (action == 0) {
    H5Adelete(object, name.c_str());
  } else {
    const std::array<double, 6> values = {
        -1, 0, 1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 3};
    const double value = values[random.below(values.size())];
    const hid_t attribute = H5Aopen(object, name.c_str(), H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    if (H5Tget_class(type) != H5T_STRING) H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
    H5Tclose(type);
    H5Aclose(attribute);
  }
  H5Oclose(object);
}

/// Puts one array of another type or shape in the place of an array.
void replace_array(hid_t file, const std::string& name, Random& random) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  if (random.below(3) == 0) return;
  const std::array<hid_t, 3> types = {H5T_IEEE_F64LE, H5T_STD_I32LE, H5T_STD_U8LE};
  const hsize_t longest = random.below(4) == 0 ? hsize_t{1} << 40 : 12;
  const std::array<hsize_t, 3> sizes = {random.below(8), random.below(5), longest};
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const std::array<hsize_t, 3> chunk = {1, 1, 4};
  const int rank = static_cast<int>(random.below(3)) + 1;
  const std::array<hsize_t, 3> reversed = {sizes[2], sizes[1], sizes[0]};
  H5Pset_chunk(properties, rank, chunk.data());
  const hid_t space = H5Screate_simple(rank, reversed.data(), nullptr);
  const hid_t array =
      H5Dcreate2(file, name.c_str(), types[random.below(types.size())], space, H5P_DEFAULT, properties, H5P_DEFAULT);
  if (array >= 0) H5Dclose(array);
  H5Sclose(space);
  H5Pclose(properties);
}

void damage_values(hid_t file, const std::string& name, Random& random) {
  const hid_t array = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  const hid_t type = H5Dget_type(array);
  const hid_t space = H5Dget_space(array);
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  if (count > 0 && H5Tget_class(type) != H5T_STRING) {
    std::vector<double> values(count);
    H5Dread(array, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    const std::array<double, 8> extremes = {-1,
                                            0,
                                            1e9,
                                            -2147483648.0,
                                            2147483647.0,
                                            1e300,
                                            std::numeric_limits<double>::quiet_NaN(),
                                            std::numeric_limits<double>::infinity()};
    values[random.below(static_cast<std::uint32_t>(count))] = extremes[random.below(extremes.size())];
    H5Dwrite(array, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(array);
}

TEST(FuzzContainer, wrong_content_behind_a_right_checksum_is_refused_or_harmless) {
  const TemporaryFolder folder;
  save_samples(folder);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  for (const char* name : {"0", "1", "2", "3"}) {
    const std::string seed = read_bytes(folder.file(name));
    const std::vector<std::string> items = items_of(folder.file(name));
    ASSERT_GT(items.size(), 5u);
    int refused = 0;
    const int rounds = 8 * static_cast<int>(items.size());
    for (int i = 0; i < rounds; ++i) {
      const std::string path = folder.file("damaged.phiz");
      write_bytes(path, seed);
      Random random(static_cast<std::uint64_t>(i), 99);
      const std::string& item = items[static_cast<std::size_t>(i) % items.size()];
      const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
      if (item.find('@') != std::string::npos) {
        damage_attribute(file, item, random);
      } else if (random.below(3) == 0) {
        replace_array(file, item, random);
      } else {
        damage_values(file, item, random);
      }
      H5Fclose(file);
      version1::seal(path);
      try {
        load_any(path);
      } catch (const Error&) {
        ++refused;
      } catch (const std::exception& error) {
        ADD_FAILURE() << name << ", " << item << ", round " << i << ": " << error.what();
      }
    }
    EXPECT_GT(refused, rounds / 4);
  }
}

}  // namespace
}  // namespace phiz
