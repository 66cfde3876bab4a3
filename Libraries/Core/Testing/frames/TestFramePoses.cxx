// The frame tree's poses: against a naive tree of Eigen matrices, far from the root, evaluation.
#include <cmath>
#include <limits>
#include <map>

#include "FrameTestSupport.h"

namespace {

using namespace dspace;
using dspace::testing::AppendRow;
using dspace::testing::Dump;
using dspace::testing::ExpectRejected;
using dspace::testing::RandomPose;
using dspace::testing::Shift;
using dspace::testing::ToAffine;
using Kind = Error::Kind;
using Ids = std::vector<FrameId>;

// The plainest tree there is: a map of records with 4 × 4 matrices, every answer by recursion.
class NaiveTree {
public:
  struct Record {
    FrameId parent;
    std::string name;
    Eigen::Matrix4d X_PF;
  };
  std::map<FrameId, Record> records{{RootFrame, {NoFrame, "root", Eigen::Matrix4d::Identity()}}};

  Eigen::Matrix4d World(FrameId id) const {
    if (id == RootFrame) {
      return Eigen::Matrix4d::Identity();
    }
    const Record& record = this->records.at(id);
    return this->World(record.parent) * record.X_PF;
  }
  bool IsBelow(FrameId id, FrameId ancestor) const {
    return id == ancestor ||
           (id != RootFrame && this->IsBelow(this->records.at(id).parent, ancestor));
  }
  std::string Path(FrameId id) const {
    const Record& record = this->records.at(id);
    return record.parent == RootFrame ? record.name : this->Path(record.parent) + "/" + record.name;
  }
  void Remove(FrameId id) {
    for (auto it = this->records.begin(); it != this->records.end();) {
      const FrameId other = it->first;
      ++it;
      if (this->records.count(other) && this->records.at(other).parent == id) {
        this->Remove(other);
        it = this->records.begin();
      }
    }
    this->records.erase(id);
  }
  FrameId Pick(std::mt19937& random) const {
    auto it = this->records.begin();
    std::advance(it,
                 std::uniform_int_distribution<std::size_t>(0, this->records.size() - 1)(random));
    return it->first;
  }
};

void ExpectEqual(const FrameTree& tree, const NaiveTree& naive, std::mt19937& random) {
  ASSERT_EQ(tree.Size(), naive.records.size());
  const FrameId W = naive.Pick(random);
  const Eigen::Matrix4d X_WRoot = naive.World(W).inverse();
  std::vector<Pose> fromW;
  tree.RelativePoses(W, fromW);
  ASSERT_EQ(fromW.size(), tree.Size());
  for (std::size_t slot = 0; slot < tree.Size(); ++slot) {
    const FrameId id = tree.IdAt(slot);
    ASSERT_EQ(naive.records.count(id), 1u);
    ASSERT_EQ(tree.Slot(id), slot);
    ASSERT_EQ(tree.Parent(id), naive.records.at(id).parent);
    const Eigen::Matrix4d expected = naive.World(id);
    // Chains of tens of frames of 10 m and scales about 1: sizes of 100 m, relative to them 1e-13.
    const double size = 1.0 + expected.norm();
    EXPECT_LT((tree.WorldPose(id).Matrix() - expected).norm(), 1e-13 * size);
    const Eigen::Matrix4d relative = X_WRoot * expected;
    EXPECT_LT((fromW[slot].Matrix() - relative).norm(),
              1e-12 * (1.0 + X_WRoot.norm()) * (1.0 + expected.norm()));
    EXPECT_EQ(fromW[slot], tree.RelativePose(W, id)); // to the bit
    EXPECT_EQ(tree.WorldPose(id), tree.RelativePose(RootFrame, id));
    if (id != RootFrame) {
      EXPECT_LT(tree.Slot(tree.Parent(id)), slot);
      EXPECT_EQ(tree.Path(id), naive.Path(id));
      EXPECT_EQ(tree.Find(naive.Path(id)), id);
      EXPECT_EQ(tree.RelativePose(tree.Parent(id), id), tree.LocalPose(id));
    }
  }
}

} // namespace

TEST(FramePoses, EqualEigensOnRandomTrees) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    FrameTree tree;
    NaiveTree naive;
    std::uniform_int_distribution<int> percent(0, 99);
    int reparented = 0, removed = 0, posed = 0;
    for (int step = 0; step < 1200; ++step) {
      const int what = percent(random);
      const FrameId id = naive.Pick(random);
      if (what < 45) {
        const Pose X = RandomPose(random);
        const std::string name = "f" + std::to_string(step);
        const FrameId made = tree.Create(id, name, X);
        naive.records[made] = {id, name, ToAffine(X).matrix()};
      } else if (what < 65 && id != RootFrame) {
        const Pose X = RandomPose(random);
        tree.SetLocalPose(id, X);
        naive.records.at(id).X_PF = ToAffine(X).matrix();
        ++posed;
      } else if (what < 90 && id != RootFrame) {
        const FrameId target = naive.Pick(random);
        if (naive.IsBelow(target, id)) {
          EXPECT_THROW(tree.Reparent(id, target, false), Error);
          continue;
        }
        const bool keep = what % 2 == 0;
        if (keep) {
          naive.records.at(id).X_PF = naive.World(target).inverse() * naive.World(id);
        }
        tree.Reparent(id, target, keep);
        naive.records.at(id).parent = target;
        // Errors of kept poses would add up over hundreds of moves, on both sides alike.
        naive.records.at(id).X_PF = ToAffine(tree.LocalPose(id)).matrix();
        ++reparented;
      } else if (what < 95 && id != RootFrame) {
        const Ids gone = tree.Remove(id);
        for (const FrameId one : gone) {
          EXPECT_TRUE(naive.IsBelow(one, id));
        }
        const std::size_t before = naive.records.size();
        naive.Remove(id);
        EXPECT_EQ(naive.records.size() + gone.size(), before);
        ++removed;
      } else if (id != RootFrame) {
        const std::string name = "r" + std::to_string(step);
        tree.Rename(id, name);
        naive.records.at(id).name = name;
      }
      if (step % 40 == 0) {
        ExpectEqual(tree, naive, random);
      }
    }
    ExpectEqual(tree, naive, random);
    EXPECT_GT(reparented, 50);
    EXPECT_GT(removed, 10);
    EXPECT_GT(posed, 50);
  }
}

TEST(FramePoses, KeptWorldPosesEqualEigens) {
  std::mt19937 random(3);
  FrameTree tree;
  Ids ids{RootFrame};
  for (int i = 0; i < 60; ++i) {
    ids.push_back(tree.Create(ids[random() % ids.size()], std::to_string(i), RandomPose(random)));
  }
  int moved = 0;
  for (int i = 0; i < 200; ++i) {
    const FrameId id = ids[1 + random() % 60], target = ids[random() % ids.size()];
    const Eigen::Matrix4d before = tree.WorldPose(id).Matrix();
    try {
      tree.Reparent(id, target, true);
      ++moved;
    } catch (const Error&) {
      continue; // a cycle
    }
    EXPECT_LT((tree.WorldPose(id).Matrix() - before).norm(), 1e-11 * (1.0 + before.norm()));
  }
  EXPECT_GT(moved, 50);
}

TEST(FramePoses, DoNotFeelAnAncestorsAstronomicalUnit) {
  constexpr double Au = 149597870700.0;
  std::mt19937 random(11);
  FrameTree tree;
  const FrameId body = tree.Create(RootFrame, "body", RandomPose(random));
  const FrameId site = tree.Create(body, "site", RandomPose(random, 1e6));
  const FrameId rover = tree.Create(site, "rover", RandomPose(random));
  const FrameId wheel = tree.Create(rover, "wheel", RandomPose(random));
  const FrameId mast = tree.Create(rover, "mast", RandomPose(random));
  const FrameId camera = tree.Create(mast, "camera", RandomPose(random));
  const FrameId rock = tree.Create(site, "rock", RandomPose(random));
  const Ids below{site, rover, wheel, mast, camera, rock};
  const auto all = [&] {
    std::vector<Pose> poses, some;
    for (const FrameId W : below) {
      tree.RelativePoses(W, some);
      for (const FrameId G : below) {
        poses.push_back(tree.RelativePose(W, G));
        poses.push_back(some[tree.Slot(G)]);
      }
    }
    return poses;
  };
  const std::vector<Pose> before = all();
  const Pose near = tree.WorldPose(wheel);
  Pose X = tree.LocalPose(body);
  X.position += Eigen::Vector3d(Au, -Au, Au);
  X.rotation = RandomPose(random).rotation;
  tree.SetLocalPose(body, X);
  EXPECT_GT((tree.WorldPose(wheel).position - near.position).norm(), Au);
  EXPECT_EQ(all(), before);
  // The detour over the root is what would not hold.
  const Pose detour = tree.WorldPose(camera).Inverse() * tree.WorldPose(wheel);
  EXPECT_NE(detour.position, tree.RelativePose(camera, wheel).position);
}

TEST(FramePoses, HoldLightYearsAndNanometres) {
  FrameTree tree;
  Pose X = Shift(1e18);
  X.scale = 1e-12;
  const FrameId a = tree.Create(RootFrame, "a", X);
  X.position.x() = -1e18;
  X.scale = 1e12;
  const FrameId b = tree.Create(a, "b", X);
  EXPECT_EQ(tree.WorldPose(b).position.x(), 1e18 - 1e6);
  EXPECT_DOUBLE_EQ(tree.WorldPose(b).scale, 1.0);
}

TEST(FramePoses, AreRejectedWhenInvalid) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a", Shift(1));
  const FrameId b = tree.Create(a, "b", Shift(2));
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    int index;
    double value;
    const char* word;
  };
  const Case cases[] = {{0, nan, "nan"},
                        {1, inf, "inf"},
                        {2, -inf, "-inf"},
                        {3, nan, "nan"},
                        {4, inf, "inf"},
                        {3, 1.0 + 2e-6, "1.000002"},
                        {3, 1.0 - 2e-6, "0.999998"},
                        {3, 0.0, "norm 0"},
                        {5, 0.5, "0.5"},
                        {6, 1e300, "1e+300"},
                        {0, 1e300, "1e+300"},
                        {1, -1.000001e18, "within 1e18 m"},
                        {7, 0.0, "scale 0"},
                        {7, 1e-300, "scale 1e-300"},
                        {7, 0.999e-12, "from 1e-12 to 1e12"},
                        {7, 1.001e12, "from 1e-12 to 1e12"},
                        {7, -1.0, "scale -1"},
                        {7, inf, "scale inf"},
                        {7, nan, "scale nan"}};
  for (const Case& c : cases) {
    std::vector<double> rows;
    AppendRow(rows, Shift(5));
    AppendRow(rows, Pose());
    rows[8 + c.index] = c.value;
    Pose X;
    X.position = {rows[8], rows[9], rows[10]};
    X.rotation = Eigen::Quaterniond(rows[11], rows[12], rows[13], rows[14]);
    X.scale = rows[15];
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a/b'", c.word},
                   [&] { tree.SetLocalPose(b, X); });
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a/b/c'", c.word},
                   [&] { tree.Create(b, "c", X); });
    const FrameId ids[] = {a, b}; // the first row is good and must not be applied
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a/b'", "row 1", c.word},
                   [&] { tree.SetLocalPoses(ids, rows.data(), 2); });
  }
  std::vector<double> rows;
  AppendRow(rows, Shift(5));
  AppendRow(rows, Shift(6));
  for (const FrameId bad : {NoFrame, FrameId(99)}) {
    const FrameId ids[] = {a, bad};
    ExpectRejected(tree, Kind::NotFound, {"frame " + std::to_string(bad)},
                   [&] { tree.SetLocalPoses(ids, rows.data(), 2); });
  }
  const FrameId withRoot[] = {a, RootFrame};
  ExpectRejected(tree, Kind::InvalidArgument, {"root"},
                 [&] { tree.SetLocalPoses(withRoot, rows.data(), 2); });
  ExpectRejected(tree, Kind::InvalidArgument, {"2 frames", "missing"},
                 [&] { tree.SetLocalPoses(withRoot, nullptr, 2); });
  const FrameId good[] = {a, b}; // the same rows are accepted where all is well
  tree.SetLocalPoses(good, rows.data(), 2);
  EXPECT_EQ(tree.WorldPose(b), Shift(11));
}

TEST(FramePoses, AreStoredNormalisedAndStayTheSameWhenSetAgain) {
  std::mt19937 random(5);
  FrameTree tree;
  const FrameId id = tree.Create(RootFrame, "a");
  for (int i = 0; i < 1000; ++i) {
    Pose X = RandomPose(random);
    X.rotation.coeffs() *= 1.0 + 9e-7 * (i % 3 - 1);
    tree.SetLocalPose(id, X);
    const Pose stored = tree.LocalPose(id);
    EXPECT_NEAR(stored.rotation.norm(), 1.0, 1e-15);
    EXPECT_LT((stored.rotation.coeffs() - X.rotation.coeffs()).norm(), 1e-6);
    const std::uint64_t revision = tree.Revision();
    tree.SetLocalPose(id, stored);
    EXPECT_EQ(tree.LocalPose(id), stored);
    EXPECT_EQ(tree.Revision(), revision);
  }
}

TEST(FramePoses, AFrameComesOnce) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  const FrameId b = tree.Create(RootFrame, "b");
  const FrameId ids[] = {a, b, a};
  std::vector<double> rows;
  AppendRow(rows, Shift(1));
  AppendRow(rows, Shift(2));
  AppendRow(rows, Shift(3));
  for (int i = 0; i < 2; ++i) { // a rejected call leaves nothing behind for the next one
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a'", "twice", "rows 0 and 2"},
                   [&] { tree.SetLocalPoses(ids, rows.data(), 3); });
  }
  ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a'", "rows 0 and 1"}, [&] {
    const FrameId same[] = {a, a};
    tree.SetLocalPoses(same, rows.data(), 2);
  });
  tree.SetLocalPoses(ids, rows.data(), 2);
  tree.SetLocalPoses(ids, rows.data(), 1);
  tree.SetLocalPoses(ids + 1, rows.data() + 8, 2); // frames and slots that other calls had
  EXPECT_EQ(tree.LocalPose(a), Shift(3));
  EXPECT_EQ(tree.LocalPose(b), Shift(2));
}

TEST(FrameEvaluation, HappensOnceAndOnlyWhereSomethingChanged) {
  FrameTree tree; // root - a - (b - c), d;  root - e
  const FrameId a = tree.Create(RootFrame, "a", Shift(1));
  const FrameId b = tree.Create(a, "b", Shift(1));
  const FrameId e = tree.Create(RootFrame, "e", Shift(1));
  const FrameId c = tree.Create(b, "c", Shift(1));
  const FrameId d = tree.Create(a, "d", Shift(1));
  EXPECT_EQ(tree.Evaluations(), 0u);
  EXPECT_EQ(tree.Update(), (Ids{a, b, e, c, d}));
  EXPECT_EQ(tree.Evaluations(), 5u);
  EXPECT_EQ(tree.Update(), Ids{}); // unchanged: nothing
  EXPECT_EQ(tree.WorldPose(c), Shift(3));
  EXPECT_EQ(tree.Evaluations(), 5u);

  tree.SetLocalPose(b, Shift(1)); // the same pose
  EXPECT_EQ(tree.Update(), Ids{});
  EXPECT_EQ(tree.Evaluations(), 5u);

  const std::uint64_t old = tree.ChangedAt(e);
  tree.SetLocalPose(b, Shift(2));
  tree.SetLocalPose(b, Shift(3)); // evaluated once for both
  EXPECT_EQ(tree.Update(), (Ids{b, c}));
  EXPECT_EQ(tree.Evaluations(), 7u);
  EXPECT_EQ(tree.ChangedAt(b), tree.Revision());
  EXPECT_EQ(tree.ChangedAt(c), tree.Revision());
  EXPECT_EQ(tree.ChangedAt(a), old);
  EXPECT_EQ(tree.ChangedAt(e), old);
  EXPECT_EQ(tree.ChangedAt(RootFrame), 0u);
  EXPECT_EQ(tree.WorldPose(c), Shift(5));

  // Ancestor and descendant in one batch: each frame once.
  const FrameId ids[] = {c, a};
  std::vector<double> rows;
  AppendRow(rows, Shift(7));
  AppendRow(rows, Shift(9));
  tree.SetLocalPoses(ids, rows.data(), 2);
  EXPECT_EQ(tree.Update(), (Ids{a, b, c, d}));
  EXPECT_EQ(tree.Evaluations(), 11u);

  // Reading in between loses nothing of the next Update's list.
  tree.SetLocalPose(e, Shift(2));
  EXPECT_EQ(tree.WorldPose(e), Shift(2));
  tree.SetLocalPose(c, Shift(8));
  EXPECT_EQ(tree.Update(), (Ids{e, c}));
  EXPECT_EQ(tree.Evaluations(), 13u);

  tree.Rename(a, "A");
  EXPECT_EQ(tree.Update(), Ids{});
  const std::uint64_t before = tree.ChangedAt(e);
  tree.Reparent(b, e, false); // e and b change places in the arrays
  EXPECT_EQ(tree.ChangedAt(e), before);
  EXPECT_EQ(tree.Update(), (Ids{b, c}));
  EXPECT_EQ(tree.Evaluations(), 15u);
  tree.SetLocalPose(c, Shift(4));
  tree.Remove(a); // moves slots under a change that waits
  EXPECT_EQ(tree.ChangedAt(e), before);
  EXPECT_EQ(tree.Update(), Ids{c});
  EXPECT_EQ(tree.Evaluations(), 16u);
  EXPECT_EQ(tree.WorldPose(c), Shift(9)); // e 2, b 3, c 4
}

TEST(FrameEvaluation, RelativePosesNeedNone) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a", Shift(1));
  const FrameId b = tree.Create(RootFrame, "b", Shift(5));
  std::vector<Pose> out;
  tree.RelativePoses(a, out);
  EXPECT_EQ(tree.RelativePose(a, b), Shift(4));
  EXPECT_EQ(tree.Evaluations(), 0u);
}

TEST(FrameEvaluation, RevisionGrowsWithEveryChange) {
  FrameTree tree;
  std::uint64_t last = tree.Revision();
  const auto grew = [&] {
    const bool more = tree.Revision() > last;
    last = tree.Revision();
    return more;
  };
  const FrameId a = tree.Create(RootFrame, "a");
  EXPECT_TRUE(grew());
  const FrameId b = tree.Create(RootFrame, "b");
  EXPECT_TRUE(grew());
  tree.SetLocalPose(a, Shift(1));
  EXPECT_TRUE(grew());
  tree.Rename(a, "c");
  EXPECT_TRUE(grew());
  tree.Reparent(a, b, false);
  EXPECT_TRUE(grew());
  tree.Update();
  EXPECT_FALSE(grew());
  tree.SetLocalPoses(nullptr, nullptr, 0);
  EXPECT_FALSE(grew());
  tree.Remove(b);
  EXPECT_TRUE(grew());
}
