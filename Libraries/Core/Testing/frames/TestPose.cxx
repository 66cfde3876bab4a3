// Pose algebra against Eigen's affine maps.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Pose.h>

namespace {

using dspace::Pose;

class Poses {
public:
  Pose Next() {
    std::uniform_real_distribution<double> metre(-10.0, 10.0);
    std::uniform_real_distribution<double> factor(0.5, 2.0);
    std::normal_distribution<double> normal;
    Pose X;
    X.position = {metre(this->Random_), metre(this->Random_), metre(this->Random_)};
    X.rotation = Eigen::Quaterniond(normal(this->Random_), normal(this->Random_),
                                    normal(this->Random_), normal(this->Random_))
                     .normalized();
    X.scale = factor(this->Random_);
    return X;
  }

private:
  std::mt19937 Random_{20240501};
};

// Built from Eigen's own pieces, by another path than Pose::Matrix.
Eigen::Affine3d ToAffine(const Pose& X) {
  return Eigen::Translation3d(X.position) * X.rotation * Eigen::UniformScaling<double>(X.scale);
}

constexpr double Tolerance = 1e-12; // numbers of order 10, a few operations

} // namespace

TEST(Pose, IsTheIdentityByDefault) {
  EXPECT_EQ(Pose().Matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(Pose(), Pose().Inverse());
}

TEST(Pose, QuarterTurnAboutZByHand) {
  Pose X;
  X.position = {1.0, 2.0, 3.0};
  X.rotation = Eigen::Quaterniond(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5));
  X.scale = 2.0;
  // x goes to y, doubled, then moved.
  EXPECT_LT((X.Apply({1.0, 0.0, 0.0}) - Eigen::Vector3d(1.0, 4.0, 3.0)).norm(), 1e-15);
  EXPECT_LT((X.Apply({0.0, 1.0, 0.5}) - Eigen::Vector3d(-1.0, 2.0, 4.0)).norm(), 1e-15);
}

TEST(Pose, MatrixEqualsEigens) {
  Poses poses;
  for (int i = 0; i < 200; ++i) {
    const Pose X = poses.Next();
    EXPECT_LT((X.Matrix() - ToAffine(X).matrix()).norm(), Tolerance);
  }
}

TEST(Pose, ApplyEqualsEigens) {
  Poses poses;
  for (int i = 0; i < 200; ++i) {
    const Pose X = poses.Next();
    const Eigen::Vector3d p = poses.Next().position;
    EXPECT_LT((X.Apply(p) - ToAffine(X) * p).norm(), 10 * Tolerance);
  }
}

TEST(Pose, CompositionEqualsEigens) {
  Poses poses;
  for (int i = 0; i < 200; ++i) {
    const Pose A = poses.Next(), B = poses.Next(), C = poses.Next();
    const Eigen::Affine3d expected = ToAffine(A) * ToAffine(B) * ToAffine(C);
    EXPECT_LT(((A * B * C).Matrix() - expected.matrix()).norm(), 10 * Tolerance);
    EXPECT_LT(((A * (B * C)).Matrix() - expected.matrix()).norm(), 10 * Tolerance);
  }
}

TEST(Pose, InverseEqualsEigens) {
  Poses poses;
  for (int i = 0; i < 200; ++i) {
    const Pose X = poses.Next();
    EXPECT_LT((X.Inverse().Matrix() - ToAffine(X).inverse().matrix()).norm(), 10 * Tolerance);
    EXPECT_LT(((X * X.Inverse()).Matrix() - Eigen::Matrix4d::Identity()).norm(), 10 * Tolerance);
    EXPECT_LT(((X.Inverse() * X).Matrix() - Eigen::Matrix4d::Identity()).norm(), 10 * Tolerance);
  }
}

TEST(Pose, StaysUnitOverManyCompositions) {
  Poses poses;
  Pose X;
  for (int i = 0; i < 100000; ++i) {
    Pose step = poses.Next();
    step.scale = 1.0;
    X = X * step;
  }
  EXPECT_NEAR(X.rotation.norm(), 1.0, 1e-15);
  EXPECT_EQ(X.scale, 1.0);
}

TEST(Pose, EqualityIsOfAllEightNumbers) {
  const Pose X = Poses().Next();
  for (int i = 0; i < dspace::PoseSize; ++i) {
    Pose Y = X;
    double& value = i < 3 ? Y.position[i] : i < 7 ? Y.rotation.coeffs()[i - 3] : Y.scale;
    value = std::nextafter(value, 100.0);
    EXPECT_NE(X, Y) << i;
  }
  EXPECT_EQ(X, Pose(X));
}
