// The frame tree's structure: names, paths, ids, removal, reparenting, rejections.
#include <limits>

#include "FrameTestSupport.h"

namespace {

using namespace dspace;
using dspace::testing::ExpectRejected;
using dspace::testing::RandomPose;
using dspace::testing::Shift;
using Kind = Error::Kind;
using Ids = std::vector<FrameId>;

} // namespace

TEST(FrameTree, HasItsRootFromTheStart) {
  const FrameTree tree;
  EXPECT_EQ(tree.Size(), 1u);
  EXPECT_TRUE(tree.Contains(RootFrame));
  EXPECT_FALSE(tree.Contains(NoFrame));
  EXPECT_EQ(RootFrame, 1u);
  EXPECT_EQ(tree.Name(RootFrame), "root");
  EXPECT_EQ(tree.Path(RootFrame), "/");
  EXPECT_EQ(tree.Find("/"), RootFrame);
  EXPECT_EQ(tree.Parent(RootFrame), NoFrame);
  EXPECT_EQ(tree.Slot(RootFrame), 0u);
  EXPECT_EQ(tree.WorldPose(RootFrame), Pose());
}

TEST(FrameTree, FindsByPath) {
  FrameTree tree;
  const FrameId rover = tree.Create(RootFrame, "rover");
  const FrameId mast = tree.Create(rover, "mast");
  const FrameId camera = tree.Create(mast, "camera");
  const FrameId lander = tree.Create(RootFrame, "lander");
  const FrameId other = tree.Create(lander, "mast"); // the same name elsewhere
  const FrameId named = tree.Create(RootFrame, "root");
  EXPECT_EQ(tree.Path(camera), "rover/mast/camera");
  EXPECT_EQ(tree.Find("rover/mast/camera"), camera);
  EXPECT_EQ(tree.Find("lander/mast"), other);
  EXPECT_EQ(tree.Find("mast/camera", rover), camera);
  EXPECT_EQ(tree.Find("/", mast), mast);
  EXPECT_EQ(tree.Find("root"), named);
  for (const char* absent :
       {"", "mast", "rover/", "/rover", "rover//mast", "rover/mast/camera/x"}) {
    EXPECT_EQ(tree.Find(absent), NoFrame) << absent;
  }
  EXPECT_EQ(tree.Children(RootFrame), (Ids{rover, lander, named}));
  EXPECT_EQ(tree.Parent(camera), mast);

  tree.Rename(mast, "pole");
  EXPECT_EQ(tree.Find("rover/mast/camera"), NoFrame);
  EXPECT_EQ(tree.Find("rover/pole/camera"), camera);
  tree.Rename(mast, "pole");                        // no change, no rejection of its own name
  EXPECT_EQ(tree.Create(rover, "mast"), named + 1); // the old name is free
}

// The same tree as one frame at a time makes.
TEST(FrameTree, CreatesManyFramesAtOnce) {
  std::mt19937 random(3);
  FrameTree tree, one;
  const FrameId base = tree.Create(RootFrame, "base");
  one.Create(RootFrame, "base");
  std::vector<std::string> names;
  std::vector<FrameId> parents;
  std::vector<double> rows;
  for (std::size_t i = 0; i < 300; ++i) {
    names.push_back("f" + std::to_string(i));
    parents.push_back(i < 3 ? base : base + 1 + random() % i); // of those before it, too
    const Pose X = RandomPose(random);
    dspace::testing::AppendRow(rows, X);
    one.Create(parents.back(), names.back(), X);
  }
  std::vector<FrameEvent> events;
  tree.AddListener([&](const FrameEvent& event) { events.push_back(event); });
  EXPECT_EQ(tree.CreateMany(names, parents, rows.data()), base + 1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].type, FrameEvent::Type::Created);
  ASSERT_EQ(events[0].ids.size(), 300u);
  EXPECT_EQ(events[0].ids[299], base + 300);
  for (FrameId id = RootFrame; id <= base + 300; ++id) {
    EXPECT_EQ(tree.Path(id), one.Path(id));
    EXPECT_EQ(tree.Find(tree.Path(id)), id);
    EXPECT_EQ(tree.Children(id), one.Children(id));
    EXPECT_EQ(tree.LocalPose(id), one.LocalPose(id));
    EXPECT_EQ(tree.WorldPose(id), one.WorldPose(id));
  }
  EXPECT_EQ(tree.CreateMany({"x", "y"}, {base}, nullptr, 1000), 1000u);
  EXPECT_EQ(tree.LocalPose(1001), Pose());
  EXPECT_EQ(tree.Create(RootFrame, "after"), 1002u);
}

TEST(FrameTree, CreatesAllOfManyFramesOrNone) {
  FrameTree tree;
  const FrameId base = tree.Create(RootFrame, "base");
  const FrameId gone = tree.Create(base, "gone");
  tree.Create(base, "taken");
  tree.Remove(gone);
  std::vector<double> rows;
  for (int i = 0; i < 3; ++i) {
    dspace::testing::AppendRow(rows, Shift(i));
  }
  const auto rejected = [&](Kind kind, const std::vector<std::string>& words,
                            std::vector<std::string> names, const std::vector<FrameId>& parents,
                            FrameId first = NoFrame) {
    ExpectRejected(tree, kind, words, [&] { tree.CreateMany(names, parents, rows.data(), first); });
  };
  rejected(Kind::AlreadyExists, {"'taken'"}, {"a", "b", "taken"}, {base});
  rejected(Kind::AlreadyExists, {"'a'"}, {"a", "b", "a"}, {base});
  rejected(Kind::InvalidArgument, {"'x/y'"}, {"a", "x/y", "b"}, {base});
  rejected(Kind::NotFound, {"77"}, {"a", "b", "c"}, {base, base, 77});
  rejected(Kind::NotFound, {"5"}, {"a", "b"}, {5, base}); // not yet there
  rejected(Kind::AlreadyExists, {"removed"}, {"a", "b", "c"}, {base}, gone - 1 == base ? gone : 2);
  rejected(Kind::InvalidArgument, {"9223372036854775808"}, {"a", "b"}, {base},
           std::numeric_limits<std::int64_t>::max());
  rejected(Kind::InvalidArgument, {"0 names"}, {}, {base});
  rejected(Kind::InvalidArgument, {"3 names and 2 parents"}, {"a", "b", "c"}, {base, base});
  rows[8 * 2 + 7] = 0.0;
  rejected(Kind::InvalidArgument, {"c'", "scale 0"}, {"a", "b", "c"}, {base});
  rows[8 * 2 + 7] = 1.0;
  EXPECT_EQ(tree.CreateMany({"a", "b", "c"}, {base}, rows.data()), 5u); // as if none had been
  EXPECT_EQ(tree.Children(base).size(), 4u);
}

TEST(FrameTree, NeverReusesAnId) {
  FrameTree tree;
  EXPECT_EQ(tree.Create(RootFrame, "a"), 2u);
  EXPECT_EQ(tree.Create(RootFrame, "b", {}, 100), 100u);
  EXPECT_EQ(tree.Create(RootFrame, "c"), 101u);
  EXPECT_EQ(tree.Create(RootFrame, "d", {}, 50), 50u); // below the largest, never used
  EXPECT_EQ(tree.Create(RootFrame, "e"), 102u);
  tree.Remove(102);
  EXPECT_EQ(tree.Create(RootFrame, "f"), 103u);
  ExpectRejected(tree, Kind::AlreadyExists, {"g", "102", "removed"},
                 [&] { tree.Create(RootFrame, "g", {}, 102); });
  ExpectRejected(tree, Kind::AlreadyExists, {"g", "50", "'d'"},
                 [&] { tree.Create(RootFrame, "g", {}, 50); });
  ExpectRejected(tree, Kind::AlreadyExists, {"g", "1 "},
                 [&] { tree.Create(RootFrame, "g", {}, RootFrame); });
  const FrameId largest = std::numeric_limits<std::int64_t>::max();
  ExpectRejected(tree, Kind::InvalidArgument, {"g", "9223372036854775808"},
                 [&] { tree.Create(RootFrame, "g", {}, largest + 1); });
  EXPECT_EQ(tree.Create(RootFrame, "last", {}, largest), largest);
  ExpectRejected(tree, Kind::InvalidArgument, {"g", "2^63"}, [&] { tree.Create(RootFrame, "g"); });
}

TEST(FrameTree, RemovesSubtreesChildrenFirst) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  const FrameId b = tree.Create(RootFrame, "b", Shift(1));
  const FrameId aa = tree.Create(a, "aa");
  const FrameId bb = tree.Create(b, "bb", Shift(2));
  const FrameId aaa = tree.Create(aa, "aaa");
  const FrameId bbb = tree.Create(bb, "bbb", Shift(3));
  EXPECT_EQ(tree.Remove(a), (Ids{aaa, aa, a}));
  EXPECT_EQ(tree.Size(), 4u);
  for (const FrameId gone : {a, aa, aaa}) {
    EXPECT_FALSE(tree.Contains(gone));
  }
  EXPECT_EQ(tree.Find("a"), NoFrame);
  EXPECT_EQ(tree.Find("b/bb/bbb"), bbb);
  EXPECT_EQ(tree.WorldPose(bbb).position.x(), 6.0);
  EXPECT_EQ(tree.Slot(bbb), 3u); // compacted
  EXPECT_EQ(tree.Children(RootFrame), Ids{b});
  EXPECT_NE(tree.Create(RootFrame, "a"), a);
}

TEST(FrameTree, ReparentsBehindAYoungerFrame) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a", Shift(1));
  const FrameId aa = tree.Create(a, "aa", Shift(1));
  const FrameId b = tree.Create(RootFrame, "b", Shift(10));
  const FrameId c = tree.Create(b, "c", Shift(10));
  const FrameId aaa = tree.Create(aa, "aaa", Shift(1));
  tree.Update();
  tree.Reparent(a, c, false);
  EXPECT_EQ(tree.Path(aaa), "b/c/a/aa/aaa");
  EXPECT_EQ(tree.Find("b/c/a/aa/aaa"), aaa);
  EXPECT_EQ(tree.Find("a"), NoFrame);
  for (std::size_t slot = 1; slot < tree.Size(); ++slot) {
    const FrameId id = tree.IdAt(slot);
    EXPECT_EQ(tree.Slot(id), slot);
    EXPECT_LT(tree.Slot(tree.Parent(id)), slot);
  }
  EXPECT_EQ(tree.LocalPose(a), Shift(1));
  EXPECT_EQ(tree.WorldPose(aaa), Shift(23));
  tree.Reparent(aa, RootFrame, true); // an older frame: nothing moves in the arrays
  EXPECT_EQ(tree.LocalPose(aa), Shift(22));
  EXPECT_EQ(tree.WorldPose(aaa), Shift(23));
  EXPECT_EQ(tree.Children(RootFrame), (Ids{b, aa}));
  const std::uint64_t revision = tree.Revision();
  tree.Reparent(aa, RootFrame, false); // the present parent
  EXPECT_EQ(tree.Revision(), revision);
}

TEST(FrameTree, ReparentKeepsTheWorldPoseThroughTheCommonAncestor) {
  std::mt19937 random(7);
  FrameTree tree;
  const FrameId far = tree.Create(RootFrame, "far", Shift(149597870700.0, 1e10, -3e9));
  const FrameId left = tree.Create(far, "left", RandomPose(random));
  const FrameId right = tree.Create(far, "right", RandomPose(random));
  const FrameId part = tree.Create(left, "part", RandomPose(random));
  const Pose before = tree.RelativePose(far, part);
  tree.Reparent(part, right, true);
  const Pose after = tree.RelativePose(far, part);
  // Through the root it would be off by 1 au * 2^-53 = 17 micrometres.
  EXPECT_LT((after.Matrix() - before.Matrix()).norm(), 1e-13);
}

TEST(FrameTree, RejectsWhatIsNotThere) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  const FrameId gone = tree.Create(RootFrame, "gone");
  tree.Remove(gone);
  std::vector<Pose> out;
  const double row[8] = {0, 0, 0, 1, 0, 0, 0, 1};
  for (const FrameId bad : {NoFrame, gone, FrameId(77)}) {
    const std::vector<std::string> words = {"frame " + std::to_string(bad)};
    const auto rejected = [&](auto change) { ExpectRejected(tree, Kind::NotFound, words, change); };
    rejected([&] { tree.Create(bad, "x"); });
    rejected([&] { tree.Remove(bad); });
    rejected([&] { tree.Reparent(bad, a, true); });
    rejected([&] { tree.Reparent(a, bad, true); });
    rejected([&] { tree.Rename(bad, "x"); });
    rejected([&] { tree.Find("a", bad); });
    rejected([&] { tree.Path(bad); });
    rejected([&] { tree.Name(bad); });
    rejected([&] { tree.Parent(bad); });
    rejected([&] { tree.Children(bad); });
    rejected([&] { tree.SetLocalPose(bad, Pose()); });
    rejected([&] { tree.SetLocalPoses(&bad, row, 1); });
    rejected([&] { tree.LocalPose(bad); });
    rejected([&] { tree.RelativePose(bad, a); });
    rejected([&] { tree.RelativePose(a, bad); });
    rejected([&] { tree.RelativePoses(bad, out); });
    rejected([&] { tree.WorldPose(bad); });
    rejected([&] { tree.ChangedAt(bad); });
    rejected([&] { tree.Slot(bad); });
  }
  ExpectRejected(tree, Kind::NotFound, {"slot 2", "2 frames"}, [&] { tree.IdAt(2); });
}

TEST(FrameTree, RejectsToTouchTheRoot) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  const double row[8] = {1, 0, 0, 1, 0, 0, 0, 1};
  const auto rejected = [&](const char* word, auto change) {
    ExpectRejected(tree, Kind::InvalidArgument, {"frame '/'", word}, change);
  };
  rejected("removed", [&] { tree.Remove(RootFrame); });
  rejected("renamed", [&] { tree.Rename(RootFrame, "world"); });
  rejected("reparented", [&] { tree.Reparent(RootFrame, a, false); });
  rejected("posed", [&] { tree.SetLocalPose(RootFrame, Shift(1)); });
  rejected("posed", [&] { tree.SetLocalPoses(&RootFrame, row, 1); });
}

TEST(FrameTree, RejectsBadNames) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  const FrameId b = tree.Create(a, "b");
  tree.Create(a, "c");
  tree.Create(RootFrame, "b");
  const std::pair<std::string, std::string> bad[] = {
      {"", "''"},
      {"x/y", "'x/y'"},
      {"/", "'/'"},
      {"line\nbreak", "'line\\x0abreak'"},
      {std::string("nul\0byte", 8), "'nul\\x00byte'"},
      {"\x7f", "'\\x7f'"},
      {".", "'.'"},
      {"..", "'..'"},
      {std::string(256, 'n'), "nnn...', 256 bytes long"},
      // Sixty bytes would end within a letter: two bytes each, after one of one.
      {"a" +
           [] {
             std::string letters;
             for (int i = 0; i < 500000; ++i) {
               letters += "\u00e9";
             }
             return letters;
           }(),
       "\u00e9...', 1000001 bytes long"}};
  for (const auto& [name, shown] : bad) {
    ExpectRejected(tree, Kind::InvalidArgument, {"child of frame 'a'", shown},
                   [&] { tree.Create(a, name); });
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a/b'", shown},
                   [&] { tree.Rename(b, name); });
  }
  ExpectRejected(tree, Kind::AlreadyExists, {"frame 'a/b'"}, [&] { tree.Create(a, "b"); });
  ExpectRejected(tree, Kind::AlreadyExists, {"frame 'a/c'"}, [&] { tree.Rename(b, "c"); });
  ExpectRejected(tree, Kind::AlreadyExists, {"frame 'b'"},
                 [&] { tree.Reparent(b, RootFrame, false); });
  for (const std::string& good : std::vector<std::string>{" ", "...", ".a", "mât", "a b",
                                                          "left\\right", std::string(255, 'n')}) {
    EXPECT_EQ(tree.Find(good), NoFrame);
    EXPECT_EQ(tree.Name(tree.Create(RootFrame, good)), good);
  }
}

TEST(FrameTree, RejectsCycles) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  const FrameId b = tree.Create(a, "b");
  const FrameId c = tree.Create(b, "c");
  for (const bool keep : {false, true}) {
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a'"}, [&] { tree.Reparent(a, a, keep); });
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a'", "'a/b'"},
                   [&] { tree.Reparent(a, b, keep); });
    ExpectRejected(tree, Kind::InvalidArgument, {"frame 'a'", "'a/b/c'"},
                   [&] { tree.Reparent(a, c, keep); });
  }
}

TEST(FrameTree, RejectsToKeepAWorldPoseThatNoPoseInTheParentGives) {
  FrameTree tree;
  Pose tiny, huge;
  tiny.scale = 1e-12;
  huge.scale = 1e12;
  const FrameId a = tree.Create(RootFrame, "a", tiny);
  const FrameId b = tree.Create(RootFrame, "b", huge);
  ExpectRejected(tree, Kind::InvalidArgument, {"frame 'b'", "scale 1e+24"},
                 [&] { tree.Reparent(b, a, true); });
  tree.Reparent(b, a, false);
}

TEST(FrameTree, HoldsAHundredThousandFramesAndDeepChains) {
  FrameTree tree;
  FrameId tip = RootFrame;
  for (int i = 0; i < 20000; ++i) {
    tip = tree.Create(tip, "link", Shift(1));
  }
  EXPECT_EQ(tree.WorldPose(tip).position.x(), 20000.0);
  EXPECT_EQ(tree.RelativePose(tip, RootFrame).position.x(), -20000.0);
  EXPECT_EQ(tree.Path(tip).size(), 20000u * 5 - 1);
  EXPECT_EQ(tree.Find(tree.Path(tip)), tip);
  Ids ids;
  std::vector<double> rows;
  for (int i = 0; i < 80000; ++i) {
    ids.push_back(tree.Create(RootFrame, "leaf" + std::to_string(i)));
    dspace::testing::AppendRow(rows, Shift(i));
  }
  EXPECT_EQ(tree.Size(), 100001u);
  tree.SetLocalPoses(ids.data(), rows.data(), ids.size());
  EXPECT_EQ(tree.WorldPose(ids.back()).position.x(), 79999.0);
  // The whole chain moves behind the youngest frame and back into place.
  tree.Reparent(tree.Find("link"), ids.back(), true);
  EXPECT_EQ(tree.WorldPose(tip).position.x(), 20000.0);
  EXPECT_EQ(tree.Remove(ids.back()).size(), 20001u);
  EXPECT_EQ(tree.Size(), 80000u);
}
