// Order, opacity and rejections of a stack of colour layers.
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/LayerStack.h>

namespace {

using dspace::Error;
using dspace::LayerStack;

class Plain : public dspace::ColorLayer {
public:
  explicit Plain(double pixel) : Pixel_(pixel) {}
  const std::string& GetName() const override { return this->Name_; }
  bool Read(const dspace::ColorGrid&, const dspace::ColorBlock&, std::uint8_t*) const override {
    return false;
  }
  double PixelSize() const override { return this->Pixel_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }

private:
  std::string Name_ = "plain";
  double Pixel_;
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
