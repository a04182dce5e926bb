// SPDX-License-Identifier: GPL-3.0-or-later
/// The form of the skin while it is built: where the vertices of the cage should be, in MILLIMETRES. Private to
/// anatomy.
#pragma once

#include <functional>
#include <vector>

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/builtin/skin/identity.h"
#include "phiz/anatomy/builtin/skin/topology.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

struct SkinForm {
  SkinForm();

  /// Wants vertex v of the left half (and its mirror image) at p; the larger the weight, the firmer. Vertices without a
  /// place lie where the surface is smoothest.
  void place(int v, const Vector3d& p, double weight = 1);
  /// The place of v (and of its mirror image) is meant for the control vertex, not for the limit surface.
  void keep_control(int v);
  Vector3d at(int v) const { return X.row(v).transpose(); }
  bool placed(int v) const { return weight[v] > 0; }

  MatrixX3d X;                 ///< vertex_count x 3
  std::vector<double> weight;  ///< 0: free
  std::vector<char> on_limit;  ///< 1: the place is wanted for the limit surface, 0: for the control vertex
};

/// The sheet: brow, cheeks, nose, chin, scalp and neck of the mean head.
void place_sheet(SkinForm& form);
/// The back of the head and of the neck, behind the ears.
void place_back(SkinForm& form);
/// Lays the scalp before and above the ears on the vault of the skull, and fills the crown.
void place_vault(SkinForm& form);
/// The neck, with its cut face at the foot.
void place_neck(SkinForm& form);
/// Point (u, v) of the Coons patch that fills a grid 0..p x 0..q of placed border vertices and the midline u = 0.
Vector3d coons(const SkinForm& form, const std::function<int(int, int)>& vertex, int u, int p, int v, int q);
/// Lips and their surroundings of the mean head: mouth rings 1 to 7.
void place_lips(SkinForm& form);
/// The nostrils' tunnels.
void place_nostrils(SkinForm& form);
/// The auricle.
void place_ears(SkinForm& form, const IdentityParameters& identity);
/// Moves everything placed so far from the mean proportions to a person's, smoothly; then applies what the proportions
/// do not hold (lip fullness, cheeks, ...).
void fit_person(SkinForm& form, const Proportions& proportions, const IdentityParameters& identity);
/// Lids and the socket behind the eyeball: eye rings 1 to 9, from the proportions.
void place_lids(SkinForm& form, const Proportions& proportions, const IdentityParameters& identity);
/// The oral cavity: mouth rings 8 to 11 and the throat, from the dental arch.
void place_mouth_bag(SkinForm& form, const Proportions& proportions);

/// Moves the vertices to where the bending energy of the surface plus the weighted squared distance from the places is
/// least.
/// `limit_mask`: positions of the limit surface at the vertices, from the control vertices.
void fair(SkinForm& form, const SparseMatrixd& limit_mask);

/// Pushes lids and sockets outwards until the surface, sampled by `fine_limit` (rows: vertices of a fine level of the
/// limit surface, columns: control vertices), keeps clear of the eyeballs.
void clear_eyeballs(SkinForm& form, const Proportions& proportions, const SparseMatrixd& fine_limit);

}  // namespace phiz
