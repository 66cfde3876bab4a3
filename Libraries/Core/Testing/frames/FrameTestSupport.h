// What the tests of the frame tree share.
#ifndef DSPACE_FRAME_TEST_SUPPORT_H
#define DSPACE_FRAME_TEST_SUPPORT_H

#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/FrameTree.h>

namespace dspace::testing {

inline Pose RandomPose(std::mt19937& random, double metres = 10.0) {
  std::uniform_real_distribution<double> coordinate(-metres, metres);
  std::uniform_real_distribution<double> factor(0.8, 1.25);
  std::normal_distribution<double> normal;
  Pose X;
  X.position = {coordinate(random), coordinate(random), coordinate(random)};
  X.rotation = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                   .normalized();
  X.scale = factor(random);
  return X;
}

inline Pose Shift(double x, double y = 0.0, double z = 0.0) {
  Pose X;
  X.position = {x, y, z};
  return X;
}

// Eigen's own composition, another path than Pose::operator*.
inline Eigen::Affine3d ToAffine(const Pose& X) {
  return Eigen::Translation3d(X.position) * X.rotation * Eigen::UniformScaling<double>(X.scale);
}

inline void AppendRow(std::vector<double>& rows, const Pose& X) {
  const Eigen::Quaterniond& q = X.rotation;
  for (const double value :
       {X.position.x(), X.position.y(), X.position.z(), q.w(), q.x(), q.y(), q.z(), X.scale}) {
    rows.push_back(value);
  }
}

// Everything that can be asked of a tree, doubles to the bit. It evaluates the tree.
inline std::string Dump(const FrameTree& tree) {
  std::ostringstream text;
  text << "revision " << tree.Revision() << " size " << tree.Size() << "\n" << std::hexfloat;
  for (std::size_t slot = 0; slot < tree.Size(); ++slot) {
    const FrameId id = tree.IdAt(slot);
    text << slot << " id " << id << " parent " << tree.Parent(id) << " name " << tree.Name(id)
         << " path " << tree.Path(id) << " found " << tree.Find(tree.Path(id)) << " slot "
         << tree.Slot(id) << " changed " << tree.ChangedAt(id) << " children";
    for (const FrameId child : tree.Children(id)) {
      text << " " << child;
    }
    for (const Pose* X : {&tree.LocalPose(id), &tree.WorldPose(id)}) {
      text << " |";
      std::vector<double> row;
      AppendRow(row, *X);
      for (const double value : row) {
        text << " " << value;
      }
    }
    text << "\n";
  }
  return text.str();
}

// `change` throws an Error of this kind whose message holds each of `words`; the tree stays equal.
template<class Change>
void ExpectRejected(FrameTree& tree, Error::Kind kind, const std::vector<std::string>& words,
                    Change change) {
  const std::string before = Dump(tree);
  bool rejected = false;
  try {
    change();
  } catch (const Error& error) {
    rejected = true;
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    for (const std::string& word : words) {
      EXPECT_NE(std::strstr(error.what(), word.c_str()), nullptr)
          << "'" << word << "' is not in: " << error.what();
    }
  }
  EXPECT_TRUE(rejected) << "no error; expected one with '" << (words.empty() ? "" : words[0])
                        << "'";
  EXPECT_EQ(Dump(tree), before);
}

} // namespace dspace::testing

#endif
