// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/pca.h"

#include <gtest/gtest.h>

#include "phiz/core/error.h"
#include "phiz/core/random.h"

namespace phiz {
namespace {

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed);
  return MatrixXd::NullaryExpr(rows, cols, [&random] { return random.normal(); });
}

TEST(ThinSvd, RestoresTallAndWideMatricesAndFindsTheRank) {
  for (const auto& [rows, cols] : {std::pair{200, 7}, std::pair{7, 200}, std::pair{5, 5}}) {
    const MatrixXd A = random_matrix(rows, cols, 1);
    const ThinSvd svd = thin_svd(A);
    EXPECT_LE((svd.U * svd.s.asDiagonal() * svd.V.transpose() - A).norm(), 1e-12 * A.norm());
    EXPECT_LE((svd.U.transpose() * svd.U - MatrixXd::Identity(svd.s.size(), svd.s.size())).norm(), 1e-12);
  }
  EXPECT_EQ(thin_svd(random_matrix(100, 3, 2) * random_matrix(3, 20, 3)).s.size(), 3);
}

TEST(ThinSvd, SignsDoNotDependOnTheSignOfTheInput) {
  const MatrixXd A = random_matrix(50, 6, 4);
  EXPECT_LE((thin_svd(A).U - thin_svd(-A).U).norm(), 1e-12);
}

TEST(PrincipalComponents, FindTheAxesOfAStretchedCloud) {
  MatrixXd X = random_matrix(3, 20000, 5);
  X.row(0) *= 3;
  X.row(2) *= 0.1;
  X.colwise() += Vector3d(10, 20, 30);
  const PrincipalComponents pca = principal_components(X);
  EXPECT_NEAR(pca.deviation[0], 3, 0.05);
  EXPECT_NEAR(pca.deviation[1], 1, 0.02);
  EXPECT_NEAR(pca.deviation[2], 0.1, 0.002);
  EXPECT_LE((pca.mean - Vector3d(10, 20, 30)).norm(), 0.05);
  EXPECT_GT(pca.basis(0, 0), 0.999);
  EXPECT_NEAR(pca.explained, 1, 1e-12);
}

TEST(PrincipalComponents, KeepWhatIsAskedForAndReconstructTheSamples) {
  const MatrixXd X = random_matrix(500, 4, 6) * random_matrix(4, 30, 7);
  const PrincipalComponents all = principal_components(X);
  EXPECT_LE(all.basis.cols(), 4);
  EXPECT_LE((reconstruct(all, project(all, X.col(3))) - X.col(3)).norm(), 1e-10 * X.col(3).norm());
  PcaOptions options;
  options.most = 2;
  EXPECT_EQ(principal_components(X, options).basis.cols(), 2);
  options.most = 0;
  options.variance = 0.5;
  const PrincipalComponents half = principal_components(X, options);
  EXPECT_GE(half.explained, 0.5);
  EXPECT_LT(half.basis.cols(), all.basis.cols());
}

TEST(PrincipalComponents, OfEqualSamplesAreNone) {
  const PrincipalComponents pca = principal_components(MatrixXd::Ones(10, 5));
  EXPECT_EQ(pca.basis.cols(), 0);
  EXPECT_EQ(pca.explained, 1);
}

TEST(PrincipalComponents, RefuseEmptyAndBrokenInput) {
  EXPECT_THROW(principal_components(MatrixXd(0, 0)), Error);
  MatrixXd X = MatrixXd::Ones(3, 3);
  X(1, 1) = std::nan("");
  EXPECT_THROW(principal_components(X), Error);
}

}  // namespace
}  // namespace phiz
