// SPDX-License-Identifier: GPL-3.0-or-later
/// Dense inner loops of the supernodal triangular solve, on vectors of four doubles per row (Highway, run-time
/// dispatch).
#pragma once

#include <cstddef>

namespace phiz {

/// y_i (+)= sum_j A_ij x_j for `rows` rows (a multiple of four), A row-major with `cols` columns, x and y four doubles
/// a row. The rows of y are contiguous. `first_column(i) = 0`; sign is +1.
void dense_multiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, double* y);

/// y_{index[i]} -= sum_j A_ij x_j for i < rows; A has its rows padded to a multiple of four.
void scatter_multiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, const int* index,
                      double* y);

/// y_j -= sum_i A_ij x_{index[i]} for i < rows.
void gather_multiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, const int* index,
                     double* y);

}  // namespace phiz
