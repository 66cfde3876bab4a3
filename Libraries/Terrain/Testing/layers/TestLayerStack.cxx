// Order, opacity and rejections of a stack of colour layers.
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/LayerStack.h>

namespace {

using dspace::Error;
using dspace::LayerStack;

class Plain : public dspace::ColorLayer {
public:
  explicit Plain(double pixel, dspace::LayerContent content = dspace::LayerContent::Colors)
      : Pixel_(pixel), Content_(content) {}
  dspace::LayerContent Content() const override { return this->Content_; }
  const std::string& GetName() const override { return this->Name_; }
  bool Read(const dspace::ColorGrid&, const dspace::ColorBlock&, std::uint8_t*) const override {
    return false;
  }
  double PixelSize() const override { return this->Pixel_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }

private:
  std::string Name_ = "plain";
  double Pixel_;
  dspace::LayerContent Content_;
  std::vector<std::string> Warnings_;
};

dspace::StackedLayer Named(const std::string& name, double pixel = 1.0, double opacity = 1.0) {
  return {name, std::make_shared<Plain>(pixel), opacity, true};
}

std::string Order(const LayerStack& stack) {
  std::string names;
  for (const dspace::StackedLayer& layer : stack.Layers())
    names += layer.name;
  return names;
}

void ExpectRejected(LayerStack& stack, Error::Kind kind, const std::string& words,
                    const std::function<void()>& call) {
  const std::uint64_t revision = stack.Revision();
  const std::string order = Order(stack);
  try {
    call();
    ADD_FAILURE() << words;
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    EXPECT_NE(std::string(error.what()).find("terrain 'gale'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
  EXPECT_EQ(stack.Revision(), revision);
  EXPECT_EQ(Order(stack), order);
}

} // namespace

TEST(LayerStack, KeepsTheOrderThatIsAskedFor) {
  LayerStack stack("terrain 'gale'");
  stack.Add(Named("a"));
  stack.Add(Named("b"));
  stack.Add(Named("c"), 0);
  stack.Add(Named("d"), 3);
  stack.Add(Named("e"), 2);
  EXPECT_EQ(Order(stack), "caebd");
  stack.Change("a", {}, {}, 3); // to where it is to stand afterwards
  EXPECT_EQ(Order(stack), "cebad");
  stack.Change("a", {}, {}, 0);
  EXPECT_EQ(Order(stack), "acebd");
  stack.Change("e", {}, {}, 4);
  EXPECT_EQ(Order(stack), "acbde");
  stack.Change("b", {}, {}, 2);
  EXPECT_EQ(Order(stack), "acbde");
  stack.Remove("b");
  EXPECT_EQ(Order(stack), "acde");
  EXPECT_EQ(stack.Revision(), 10u); // a change each
}

TEST(LayerStack, OnlyWhatIsSeenCounts) {
  LayerStack stack("terrain 'gale'");
  EXPECT_TRUE(stack.Empty());
  EXPECT_EQ(stack.PixelSize(), std::numeric_limits<double>::infinity());
  stack.Add(Named("coarse", 100.0));
  stack.Add(Named("fine", 0.25, 0.5));
  EXPECT_FALSE(stack.Empty());
  EXPECT_EQ(stack.PixelSize(), 0.25);
  stack.Change("fine", 0.0, {}, {});
  EXPECT_EQ(stack.PixelSize(), 100.0);
  stack.Change("fine", 1.0, false, {});
  EXPECT_EQ(stack.PixelSize(), 100.0);
  EXPECT_EQ(stack.Layers()[1].opacity, 1.0);
  EXPECT_FALSE(stack.Layers()[1].visible);
  stack.Change("coarse", {}, false, {});
  EXPECT_TRUE(stack.Empty());
  EXPECT_EQ(stack.Layers()[0].opacity, 1.0);
  stack.Change("fine", {}, true, {});
  EXPECT_EQ(stack.PixelSize(), 0.25);
}

TEST(LayerStack, RejectionsNameTheTerrainAndChangeNothing) {
  LayerStack stack("terrain 'gale'");
  stack.Add(Named("a"));
  stack.Add(Named("b"));
  const auto bad = Error::Kind::InvalidArgument;
  ExpectRejected(stack, bad, "name", [&] { stack.Add(Named("")); });
  ExpectRejected(stack, bad, "'a' is taken", [&] { stack.Add(Named("a")); });
  ExpectRejected(stack, bad, "needed", [&] { stack.Add({"c", nullptr, 1.0, true}); });
  for (double opacity : {-0.1, 1.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    ExpectRejected(stack, bad, "0 to 1", [&] { stack.Add(Named("c", 1.0, opacity)); });
    ExpectRejected(stack, bad, "0 to 1", [&] { stack.Change("a", opacity, false, 1); });
  }
  EXPECT_TRUE(stack.Layers()[0].visible);
  ExpectRejected(stack, bad, "to 2", [&] { stack.Add(Named("c"), 3); });
  ExpectRejected(stack, bad, "to 1", [&] { stack.Change("a", 0.5, false, 2); });
  EXPECT_EQ(stack.Layers()[0].opacity, 1.0);
  ExpectRejected(stack, Error::Kind::NotFound, "'a', 'b'", [&] { stack.Change("x", {}, {}, {}); });
  ExpectRejected(stack, Error::Kind::NotFound, "'x'", [&] { stack.Remove("x"); });
  for (std::size_t i = 2; i < LayerStack::Most; ++i)
    stack.Add(Named("n" + std::to_string(i)));
  ExpectRejected(stack, bad, "64", [&] { stack.Add(Named("c")); });
}

TEST(LayerStack, AChoiceTakesWhatItsFragmentsAndItsPartLeave) {
  using dspace::LayerChoice;
  using Part = LayerChoice::Part;
  LayerStack stack("terrain 'gale'");
  stack.Add(Named("a", 8.0));
  stack.Add(Named("b", 2.0));
  stack.Add(Named("c", 1.0));
  stack.Change("a", {}, {}, {}, "photographs");
  stack.Change("b", {}, {}, {}, "map");
  const auto size = [&](Part part, const std::set<std::string>& hidden) {
    return stack.PixelSize({part, hidden});
  };
  EXPECT_EQ(size(Part::All, {}), 1.0);
  EXPECT_EQ(size(Part::All, {"ornamental"}), 2.0);
  EXPECT_EQ(size(Part::All, {"ornamental", "map"}), 8.0);
  EXPECT_TRUE(stack.Empty({Part::All, {"ornamental", "map", "photographs"}}));
  EXPECT_TRUE(stack.Empty({Part::Marks, {}}));
  // What makes no difference is not named: hiding another fragment composes nothing again.
  EXPECT_TRUE(stack.Reduced({Part::Unmarked, {"other"}}).hiddenFragments.empty());
  EXPECT_EQ(stack.Reduced({Part::Unmarked, {"other"}}).part, Part::All);
  EXPECT_EQ(stack.Reduced({Part::All, {"other", "map"}}).hiddenFragments,
            std::set<std::string>{"map"});
  stack.Change("b", {}, false, {});
  EXPECT_TRUE(stack.Reduced({Part::All, {"map"}}).hiddenFragments.empty());

  dspace::StackedLayer mark = Named("mark", 0.5);
  mark.mark = true;
  stack.Add(mark, 0);
  EXPECT_EQ(size(Part::Marks, {}), 0.5);
  EXPECT_EQ(size(Part::Unmarked, {}), 1.0);
  EXPECT_TRUE(stack.Empty({Part::Marks, {"ornamental"}}));
  EXPECT_EQ(stack.Reduced({Part::Unmarked, {}}).part, Part::Unmarked);
}

TEST(LayerStack, NormalsAreApartFromColors) {
  using Part = dspace::LayerChoice::Part;
  LayerStack stack("terrain 'gale'");
  stack.Add(Named("color", 4.0));
  dspace::StackedLayer normals = Named("normals", 1.0);
  normals.layer = std::make_shared<Plain>(1.0, dspace::LayerContent::Normals);
  normals.member.fragment = "details";
  stack.Add(normals);
  EXPECT_EQ(stack.PixelSize(), 4.0);
  EXPECT_EQ(stack.PixelSize({Part::Normals, {}}), 1.0);
  EXPECT_FALSE(stack.Empty({Part::Normals, {}}));
  EXPECT_TRUE(stack.Empty({Part::Normals, {"details"}}));
  EXPECT_TRUE(stack.Empty({Part::Marks, {}}));
  // Colours are composed as before where normals alone are hidden.
  EXPECT_TRUE(stack.Reduced({Part::All, {"details"}}).hiddenFragments.empty());
  EXPECT_EQ(stack.Reduced({Part::Normals, {"details"}}).hiddenFragments.size(), 1u);
  stack.Change("normals", 0.0, {}, {});
  EXPECT_TRUE(stack.Empty({Part::Normals, {}}));
  stack.Remove("color");
  EXPECT_TRUE(stack.Empty());
}
