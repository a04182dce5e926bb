// SPDX-License-Identifier: GPL-3.0-or-later
/// Dense inner loops of the multifrontal factorisation in single precision, with Highway and run-time dispatch.
///
/// A front has p columns of its own and r rows below them. Finished columns are held in groups of 16 rows: entry (i, k)
/// is at (i / 16 * p + k) * 16 + i % 16, for its own rows (L1, lower triangle, zeros on the diagonal and above) and for
/// the rows below (L2) apart; row counts are rounded up to groups, with zeros. The diagonal is kept as its inverse.
/// Everything that is still to be eliminated is held column by column.
#pragma once

#include <cstddef>
#include <cstdint>

namespace phiz {

constexpr std::ptrdiff_t front_group = 16;

/// Rows rounded up to whole groups.
constexpr std::ptrdiff_t whole_groups(std::ptrdiff_t rows) {
  return (rows + front_group - 1) / front_group * front_group;
}

struct Front {
  std::ptrdiff_t p = 0, r = 0;
  float* L1 = nullptr;                ///< whole_groups(p) x p
  float* L2 = nullptr;                ///< whole_groups(r) x p
  float* inverse_diagonal = nullptr;  ///< p
  float* sign = nullptr;              ///< p: of the pivots, 1 or -1
  const float* diagonal = nullptr;    ///< p: size of that of the matrix, positive
  std::uint16_t* rounded1 = nullptr;  ///< L1 and L2 as the upper halves of their floats, for solves; or null
  std::uint16_t* rounded2 = nullptr;
};

/// Factorises the own rows of F (whole_groups(p) + whole_groups(r) rows, p columns; rows below start at a group) as L S
/// L^T with signs S. Returns how many are negative, or -1 where something is not finite. The steps below are to know
/// it.
int factor_own(const Front& front, const float* F, std::ptrdiff_t ld);
/// L2 <- F2 L1^-T S for the groups [begin, end) of rows below.
void factor_below(const Front& front, bool has_negative, const float* F, std::ptrdiff_t ld, std::ptrdiff_t begin,
                  std::ptrdiff_t end);
/// U <- U - L2 S L2^T for the columns [begin, end), `begin` a multiple of 16; U: whole_groups(r) x r, lower triangle.
void update_front(const Front& front, bool has_negative, float* U, std::ptrdiff_t begin, std::ptrdiff_t end);

/// Makes rounded1 and rounded2 where they are wanted.
void round_front(const Front& front);

/// Most right-hand sides of one call.
constexpr int most_sides = 4;
/// y <- L1^-1 y, z <- L2 y for `sides` right-hand sides (1, 2 or 4), one after the other: y whole_groups(p) apart with
/// zeros at its end, z whole_groups(r) apart.
void forward_front(const Front& front, int sides, float* y, float* z);
/// y <- L1^-T (y - L2^T z), z with zeros at its end.
void backward_front(const Front& front, int sides, float* y, const float* z);

/// Sixteen sparse rows that go through the front: X holds 16 values per own column, one after the other.
/// X <- X L1^-T.
void finish_rows(const Front& front, float* X);
/// W <- -X L2^T, 16 values per row below.
void pass_rows(const Front& front, const float* X, float* W);
/// M <- M - X Y^T over p columns; M: 16 x 16 by columns.
void subtract_gram(std::ptrdiff_t p, const float* X, const float* Y, float* M);
/// out <- out - X v over p columns: 16 values.
void subtract_row_products(std::ptrdiff_t p, const float* X, const float* v, float* out);
/// v <- v - X^T w.
void subtract_rows(std::ptrdiff_t p, const float* X, const float* w, float* v);

}  // namespace phiz
