// What listeners of a frame tree hear, and when.
#include <stdexcept>

#include "FrameTestSupport.h"

namespace dspace {
// In the namespace of its operands, where GoogleTest looks for it.
static bool operator==(const FrameEvent& a, const FrameEvent& b) {
  return a.type == b.type && a.ids == b.ids && a.revision == b.revision;
}

} // namespace dspace

namespace {

using namespace dspace;
using dspace::testing::AppendRow;
using dspace::testing::Dump;
using dspace::testing::Shift;
using Ids = std::vector<FrameId>;
using Type = FrameEvent::Type;

struct Recorder {
  std::vector<FrameEvent> events;
  FrameNotifier::Listener Listener() {
    return [this](const FrameEvent& event) { this->events.push_back(event); };
  }
};

} // namespace

TEST(FrameEvents, TellEachChangeOnce) {
  FrameTree tree;
  Recorder recorder;
  tree.AddListener(recorder.Listener());
  const auto last = [&] {
    EXPECT_EQ(recorder.events.size(), 1u);
    const FrameEvent event = recorder.events.at(0);
    recorder.events.clear();
    EXPECT_EQ(event.revision, tree.Revision());
    return event;
  };
  const FrameId a = tree.Create(RootFrame, "a");
  EXPECT_EQ(last(), (FrameEvent{Type::Created, {a}, 1}));
  const FrameId b = tree.Create(a, "b");
  EXPECT_EQ(last(), (FrameEvent{Type::Created, {b}, 2}));
  const FrameId c = tree.Create(RootFrame, "c");
  last();

  const FrameId ids[] = {c, b, a};
  std::vector<double> rows;
  AppendRow(rows, Shift(1));
  AppendRow(rows, Shift(2));
  AppendRow(rows, Pose()); // as it is already
  tree.SetLocalPoses(ids, rows.data(), 3);
  EXPECT_EQ(last(), (FrameEvent{Type::PosesChanged, {b, c}, 4}));
  tree.SetLocalPoses(ids, rows.data() + 8, 1);
  EXPECT_EQ(last(), (FrameEvent{Type::PosesChanged, {c}, 5}));
  tree.SetLocalPose(b, Shift(4));
  EXPECT_EQ(last(), (FrameEvent{Type::PosesChanged, {b}, 6}));

  tree.Rename(b, "bb");
  EXPECT_EQ(last(), (FrameEvent{Type::Renamed, {b}, 7}));
  tree.Reparent(a, c, true);
  EXPECT_EQ(last(), (FrameEvent{Type::Reparented, {a}, 8}));
  tree.Remove(c);
  EXPECT_EQ(last(), (FrameEvent{Type::Removed, {b, a, c}, 9}));
}

TEST(FrameEvents, AreSilentWhenNothingChanges) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a", Shift(1));
  Recorder recorder;
  tree.AddListener(recorder.Listener());
  tree.SetLocalPose(a, Shift(1));
  tree.Rename(a, "a");
  tree.Reparent(a, RootFrame, true);
  tree.SetLocalPoses(nullptr, nullptr, 0);
  tree.Update();
  EXPECT_THROW(tree.Rename(a, ""), Error);
  EXPECT_THROW(tree.Create(RootFrame, "a"), Error);
  EXPECT_TRUE(recorder.events.empty());
}

TEST(FrameEvents, ComeAfterTheChange) {
  FrameTree tree;
  int heard = 0;
  tree.AddListener([&](const FrameEvent& event) {
    const FrameId id = event.ids.front();
    if (event.type == Type::Created) {
      EXPECT_EQ(tree.Find("a"), id);
    } else if (event.type == Type::PosesChanged) {
      EXPECT_EQ(tree.WorldPose(id), Shift(1));
    } else if (event.type == Type::Removed) {
      EXPECT_FALSE(tree.Contains(id));
      EXPECT_EQ(tree.Size(), 1u);
    }
    ++heard;
  });
  const FrameId a = tree.Create(RootFrame, "a");
  tree.SetLocalPose(a, Shift(1));
  tree.Remove(a);
  EXPECT_EQ(heard, 3);
}

TEST(FrameEvents, ListenersMayRemoveThemselvesAndOthers) {
  FrameTree tree;
  int first = 0, second = 0, third = 0;
  FrameNotifier::Token own = 0, others = 0;
  own = tree.AddListener([&](const FrameEvent&) {
    ++first;
    EXPECT_TRUE(tree.RemoveListener(own));
    EXPECT_TRUE(tree.RemoveListener(others));
    EXPECT_FALSE(tree.RemoveListener(own));
  });
  others = tree.AddListener([&](const FrameEvent&) { ++second; });
  const auto kept = tree.AddListener([&](const FrameEvent&) { ++third; });
  tree.Create(RootFrame, "a");
  tree.Create(RootFrame, "b");
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 0); // removed before its turn
  EXPECT_EQ(third, 2);
  EXPECT_TRUE(tree.RemoveListener(kept));
  EXPECT_FALSE(tree.RemoveListener(kept));
  EXPECT_FALSE(tree.RemoveListener(0));
  tree.Create(RootFrame, "c");
  EXPECT_EQ(third, 2);
  EXPECT_THROW(tree.AddListener(nullptr), Error);
}

TEST(FrameEvents, ReachEveryListenerInTheOrderOfTheChanges) {
  FrameTree tree;
  Recorder late;
  int added = 0;
  tree.AddListener([&](const FrameEvent& event) {
    if (event.type == Type::Created && tree.Size() == 2) {
      tree.Create(event.ids.front(), "child"); // takes effect at once
      EXPECT_EQ(tree.Size(), 3u);
      tree.AddListener([&](const FrameEvent&) { ++added; }); // hears later changes only
    }
  });
  tree.AddListener(late.Listener());
  const FrameId parent = tree.Create(RootFrame, "parent");
  ASSERT_EQ(late.events.size(), 2u);
  EXPECT_EQ(late.events[0], (FrameEvent{Type::Created, {parent}, 1}));
  EXPECT_EQ(late.events[1], (FrameEvent{Type::Created, {parent + 1}, 2}));
  EXPECT_EQ(added, 0);
  tree.Rename(parent, "p");
  EXPECT_EQ(added, 1);
}

TEST(FrameEvents, AThrowingListenerHarmsNeitherTreeNorOthers) {
  FrameTree tree, quiet;
  Recorder after;
  tree.AddListener([](const FrameEvent&) { throw std::logic_error("first"); });
  tree.AddListener([](const FrameEvent&) { throw std::runtime_error("second"); });
  tree.AddListener(after.Listener());
  FrameId ids[2];
  const auto change = [&](FrameTree& t, auto step) {
    if (&t == &tree) {
      EXPECT_THROW(step(), std::logic_error); // the first one's
    } else {
      step();
    }
  };
  for (FrameTree* t : {&tree, &quiet}) {
    change(*t, [&] { t->Create(RootFrame, "a", Shift(1)); });
    ids[0] = t->Find("a");
    change(*t, [&] { t->Create(RootFrame, "b", Shift(2)); });
    ids[1] = t->Find("b");
    change(*t, [&] { t->Reparent(ids[0], ids[1], true); });
    change(*t, [&] { t->SetLocalPose(ids[0], Shift(3)); });
    change(*t, [&] { t->Rename(ids[0], "c"); });
  }
  EXPECT_EQ(Dump(tree), Dump(quiet));
  EXPECT_EQ(after.events.size(), 5u);
  change(tree, [&] { tree.Remove(ids[1]); });
  EXPECT_EQ(tree.Size(), 1u);
}

TEST(FrameEvents, AListenerThatAlwaysChangesIsStopped) {
  FrameTree tree;
  Recorder after;
  const FrameId a = tree.Create(RootFrame, "a");
  int calls = 0;
  const auto token =
      tree.AddListener([&](const FrameEvent&) { tree.SetLocalPose(a, Shift(++calls)); });
  tree.AddListener(after.Listener());
  const auto run = [&](const char* listener) {
    calls = 0;
    after.events.clear();
    try {
      tree.SetLocalPose(a, Shift(-1));
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
      EXPECT_NE(std::string(error.what()).find(listener), std::string::npos) << error.what();
    }
  };
  run("frame listener 1: ");
  EXPECT_EQ(calls, FrameNotifier::MaximumRounds + 1);
  EXPECT_EQ(after.events.size(), std::size_t(calls) + 1); // who causes nothing hears everything
  EXPECT_EQ(tree.LocalPose(a), Shift(calls));
  run("frame listener 1: "); // it is heard again by the next change

  // Two of them double their events each round: a bound on rounds alone would not do.
  tree.AddListener([&](const FrameEvent&) { tree.SetLocalPose(a, Shift(++calls)); });
  run("frame listener ");
  EXPECT_GT(calls, FrameNotifier::MaximumCaused);
  EXPECT_LT(calls, 3 * FrameNotifier::MaximumCaused);
  EXPECT_TRUE(tree.RemoveListener(token));
}

TEST(FrameEvents, AnswersThatComeToAnEndAreLeftAlone) {
  FrameTree tree;
  Recorder after;
  tree.AddListener([&](const FrameEvent& event) {
    if (tree.Size() < 101) { // a chain, a round each
      tree.Create(event.ids.front(), "child");
    }
  });
  tree.AddListener(after.Listener());
  tree.Create(RootFrame, "a");
  EXPECT_EQ(after.events.size(), 100u);
}
