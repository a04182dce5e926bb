// SPDX-License-Identifier: GPL-3.0-or-later
/// Long vectors in single precision, with Highway, in parallel and with the same bits for any number of threads.
#pragma once

#include <hwy/aligned_allocator.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace phiz {

/// 64-byte aligned, with zeros up to the next multiple of 16 at least.
using FloatVector = hwy::AlignedFreeUniquePtr<float[]>;
FloatVector float_vector(std::ptrdiff_t size);

/// Products left_k . right in one pass; partial sums of some hundred terms in single precision, the rest in double.
Eigen::VectorXd dots(const std::vector<const float*>& left, const float* right, std::ptrdiff_t size);
double dot(const float* left, const float* right, std::ptrdiff_t size);

/// out = sum_k weights_k columns_k in one pass. `out` may be one of the columns.
void combine(const std::vector<const float*>& columns, const Eigen::VectorXf& weights, float* out, std::ptrdiff_t size);

}  // namespace phiz
