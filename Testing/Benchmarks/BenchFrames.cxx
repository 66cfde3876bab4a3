// 1,000 frames in a tree ten deep, against as many vtkTransforms whose inputs are their parents'.
// A step gives every frame a new pose, evaluates, and reads the matrix of each leaf. VTK gets its
// poses as ready 4 × 4 matrices, its cheapest way; the frame tree gets the rows of a message and
// checks them.
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkTransform.h>

#include <dspace/FrameTree.h>

#include "Alternate.h"

namespace {

using namespace dspace;

constexpr int Levels = 10;
constexpr int PerLevel = 100;
constexpr int Frames = Levels * PerLevel;
constexpr int Sets = 2;   // of poses, in turn, so that each step changes every frame
constexpr int Steps = 20; // in a turn
constexpr int Pairs = 51;

struct Scene {
  std::vector<int> parents = std::vector<int>(Frames, -1); // -1: the root
  std::vector<int> leaves;
  std::vector<double> rows[Sets];     // PoseSize a frame
  std::vector<double> matrices[Sets]; // 16 a frame, row by row

  Scene() {
    std::mt19937 random(1);
    std::vector<char> hasChildren(Frames, 0);
    for (int i = PerLevel; i < Frames; ++i) {
      const int above = i / PerLevel - 1;
      this->parents[i] =
          above * PerLevel + std::uniform_int_distribution<int>(0, PerLevel - 1)(random);
      hasChildren[this->parents[i]] = 1;
    }
    for (int i = 0; i < Frames; ++i) {
      if (!hasChildren[i]) {
        this->leaves.push_back(i);
      }
    }
    std::normal_distribution<double> normal;
    for (int set = 0; set < Sets; ++set) {
      for (int i = 0; i < Frames; ++i) {
        Pose X;
        X.position = {normal(random), normal(random), normal(random)};
        X.rotation =
            Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                .normalized();
        const Eigen::Quaterniond& q = X.rotation;
        for (const double value : {X.position.x(), X.position.y(), X.position.z(), q.w(), q.x(),
                                   q.y(), q.z(), X.scale}) {
          this->rows[set].push_back(value);
        }
        const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m = X.Matrix();
        this->matrices[set].insert(this->matrices[set].end(), m.data(), m.data() + 16);
      }
    }
  }
};

class Tree {
public:
  explicit Tree(const Scene& scene) : Scene_(scene) {
    for (int i = 0; i < Frames; ++i) {
      const int parent = scene.parents[i];
      this->Ids_.push_back(
          this->Frames_.Create(parent < 0 ? RootFrame : this->Ids_[parent], std::to_string(i)));
    }
  }
  void SetPoses(int set) {
    this->Frames_.SetLocalPoses(this->Ids_.data(), this->Scene_.rows[set].data(), Frames);
  }
  // Sum over the leaves' positions, which also keeps the work from being dropped.
  Eigen::Vector3d Read() {
    this->Frames_.Update();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int leaf : this->Scene_.leaves) {
      const Eigen::Matrix4d m = this->Frames_.WorldPose(this->Ids_[leaf]).Matrix();
      sum += m.topRightCorner<3, 1>();
    }
    return sum;
  }

private:
  const Scene& Scene_;
  FrameTree Frames_;
  std::vector<FrameId> Ids_;
};

class Transforms {
public:
  explicit Transforms(const Scene& scene) : Scene_(scene), Transforms_(Frames) {
    for (int i = 0; i < Frames; ++i) {
      if (scene.parents[i] >= 0) {
        this->Transforms_[i]->SetInput(this->Transforms_[scene.parents[i]]);
      }
    }
  }
  void SetPoses(int set) {
    for (int i = 0; i < Frames; ++i) {
      this->Transforms_[i]->SetMatrix(&this->Scene_.matrices[set][16 * i]);
    }
  }
  Eigen::Vector3d Read() {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int leaf : this->Scene_.leaves) {
      const vtkMatrix4x4* m = this->Transforms_[leaf]->GetMatrix();
      sum += Eigen::Vector3d(m->Element[0][3], m->Element[1][3], m->Element[2][3]);
    }
    return sum;
  }

private:
  const Scene& Scene_;
  std::vector<vtkNew<vtkTransform>> Transforms_;
};

} // namespace

int main() {
  const Scene scene;
  Tree tree(scene);
  Transforms transforms(scene);
  for (int set = 0; set < Sets; ++set) {
    tree.SetPoses(set);
    transforms.SetPoses(set);
    const double difference = (tree.Read() - transforms.Read()).norm();
    if (!(difference < 1e-9)) {
      std::fprintf(stderr, "frames: the two sides differ by %g m\n", difference);
      return 1;
    }
  }

  Eigen::Vector3d sink = Eigen::Vector3d::Zero();
  const auto changing = [&](auto& side) {
    return [&] {
      for (int step = 0; step < Steps; ++step) {
        side.SetPoses(step % Sets);
        sink += side.Read();
      }
    };
  };
  const auto still = [&](auto& side) {
    return [&] {
      for (int step = 0; step < Steps; ++step) {
        sink += side.Read();
      }
    };
  };
  const std::string behind = std::to_string(Frames) + " frames, " + std::to_string(Levels) +
                             " deep, " + std::to_string(scene.leaves.size()) +
                             " leaves read a step";
  bench::Print("frames", bench::Alternate(Pairs, changing(tree), changing(transforms)), Steps,
               (behind + ", all poses set").c_str());
  bench::Print("frames, unchanged", bench::Alternate(Pairs, still(tree), still(transforms)), Steps,
               (behind + ", none set").c_str());
  return std::isfinite(sink.sum()) ? 0 : 1;
}
