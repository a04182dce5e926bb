// SPDX-License-Identifier: GPL-3.0-or-later
/// HDF5 keeps what belonged to a file that could not be written until the process ends; not a leak of ours.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}
