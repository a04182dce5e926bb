// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/version2.h"

#include <hdf5.h>

#include "io/version1.h"

namespace phiz::version2 {

void strip_head(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const int version = 2;
  const hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_INT32, &version);
  H5Aclose(attribute);
  for (const char* group : {"head/attachments", "head/identity"}) H5Ldelete(file, group, H5P_DEFAULT);
  const hid_t muscles = H5Gopen2(file, "head/muscles", H5P_DEFAULT);
  H5G_info_t info;
  H5Gget_info(muscles, &info);
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const hid_t muscle = H5Gopen2(muscles, std::to_string(i).c_str(), H5P_DEFAULT);
    H5Adelete(muscle, "ring");
    H5Ldelete(muscle, "surface", H5P_DEFAULT);
    H5Gclose(muscle);
  }
  H5Gclose(muscles);
  H5Fclose(file);
  version1::seal(path);
}

}  // namespace phiz::version2
