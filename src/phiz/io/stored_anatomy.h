// SPDX-License-Identifier: GPL-3.0-or-later
/// The parts of the nouns that several kinds of .phiz files hold. Private to the container.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/io/hdf5_group.h"

namespace phiz {

/// Arrays V, F, UV, FUV; an invalid mesh is refused when read.
void store_mesh(const Hdf5Group& group, const TriangleMesh& mesh);
TriangleMesh stored_mesh(const Hdf5Group& group);

/// Attributes rows, cols; arrays row_start, column, value. Read: the size is as expected, indices are in range and
/// columns ascend in each row.
void store_sparse(const Hdf5Group& group, const SparseMatrixd& matrix);
SparseMatrixd stored_sparse(const Hdf5Group& group, Eigen::Index expected_rows, Eigen::Index expected_cols);

/// Children "0", "1", ... with an attribute "count" on the group.
void store_count(const Hdf5Group& group, std::size_t count);
int stored_count(const Hdf5Group& group);

void store_parts(const Hdf5Group& group, const std::vector<Part>& parts);
std::vector<Part> stored_parts(const Hdf5Group& group);

void store_joint(const Hdf5Group& group, const JawJoint& joint);
JawJoint stored_joint(const Hdf5Group& group);

void store_head(const Hdf5Group& group, const HeadTemplate& head);
/// Checked with validate(HeadTemplate).
HeadTemplate stored_head(const Hdf5Group& group);

}  // namespace phiz
