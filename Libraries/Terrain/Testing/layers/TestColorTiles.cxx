// Tiles of a stack: composed by the formula, in memory under a budget, never waited for in TryGet.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/ColorTiles.h>

#include "ColorBlocks.h"
#include "Gate.h"

namespace {

using dspace::ColorBlock;
using dspace::ColorGrid;
using dspace::ColorTile;
using dspace::ColorTiles;
using dspace::ColorTilesOptions;
using dspace::Error;
using dspace::LayerStack;
using dspace::testing::Gate;
using dspace::testing::GlobeGrid;
using dspace::testing::GridAt;

using Texel = std::array<std::uint8_t, 4>;
constexpr int Side = ColorTiles::Side;

// Texels by their column and row in the zoom.
class Formula : public dspace::ColorLayer {
public:
  using Function = std::function<Texel(std::int64_t column, std::int64_t row, int zoom)>;
  explicit Formula(Function function) : Function_(std::move(function)) {}
  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return 1.0; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }
  bool Read(const ColorGrid&, const ColorBlock& block, std::uint8_t* rgba) const override {
    ++this->reads;
    if (this->before)
      this->before(block);
    if (this->empty)
      return false;
    for (int y = 0; y < block.height; ++y)
      for (int x = 0; x < block.width; ++x) {
        const Texel texel = this->Function_(block.column + x, block.row + y, block.zoom);
        rgba = std::copy(texel.begin(), texel.end(), rgba);
      }
    return true;
  }

  mutable std::atomic<int> reads{0};
  std::function<void(const ColorBlock&)> before; // may block or throw
  bool empty = false;

private:
  Function Function_;
  std::string Name_ = "formula";
  std::vector<std::string> Warnings_;
};

std::shared_ptr<Formula> Plain(const Texel& color) {
  return std::make_shared<Formula>([color](std::int64_t, std::int64_t, int) { return color; });
}

std::shared_ptr<LayerStack> StackOf(const std::vector<std::shared_ptr<Formula>>& layers) {
  auto stack = std::make_shared<LayerStack>("terrain 'test'");
  for (std::size_t i = 0; i < layers.size(); ++i)
    stack->Add({std::string(1, char('a' + i)), layers[i], 1.0, true});
  return stack;
}

ColorGrid Ground() {
  return GridAt(dspace::Crs(), {0.0, 0.0}, {1.0, -1.0});
}

const std::uint8_t* At(const ColorTiles::TilePointer& tile, int x, int y) {
  return &tile->texels[4 * (std::size_t(y) * Side + x)];
}

double Decode(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// What an opaque texel of this sRGB value is stored as.
int Stored(int value) {
  return int(std::lround(255.0 * std::sqrt(Decode(value / 255.0))));
}

} // namespace

TEST(ColorTiles, ComposesByTheFormulaInLinearLight) {
  // Every grey against every grey, at some opacities of texel and layer.
  const auto bottom = std::make_shared<Formula>([](std::int64_t x, std::int64_t y, int) {
    return Texel{std::uint8_t(x), std::uint8_t(y), 30, std::uint8_t((x * 7 + y) % 256)};
  });
  const auto top = std::make_shared<Formula>([](std::int64_t x, std::int64_t y, int) {
    return Texel{std::uint8_t(y), std::uint8_t(255 - x), 200, std::uint8_t((x + y * 3) % 256)};
  });
  const auto stack = StackOf({bottom, top});
  stack->Change("a", 0.75, {}, {});
  stack->Change("b", 0.5, {}, {});
  ColorTiles tiles(stack, {Ground()});
  const auto tile = tiles.Get({ColorTile{0, 0, 0, 0}}, 60.0).at(0);
  EXPECT_EQ(tile->revision, stack->Revision());
  ASSERT_EQ(tile->texels.size(), std::size_t(4) * Side * Side);
  double worst = 0.0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const double a = ((x * 7 + y) % 256) / 255.0 * 0.75, b = ((x + y * 3) % 256) / 255.0 * 0.5;
      const double below[3] = {x / 255.0, y / 255.0, 30 / 255.0};
      const double above[3] = {y / 255.0, (255 - x) / 255.0, 200 / 255.0};
      const std::uint8_t* p = At(tile, x + 1, y + 1);
      for (int k = 0; k < 3; ++k) {
        const double sum = b * Decode(above[k]) + (1.0 - b) * a * Decode(below[k]);
        const double opacity = b + a * (1.0 - b);
        worst = std::max(worst, std::abs(p[k] - 255.0 * std::sqrt(sum * opacity)));
      }
      worst = std::max(worst, std::abs(p[3] - 255.0 * (b + a * (1.0 - b))));
    }
  EXPECT_LT(worst, 0.51); // rounding, and float sums
}

TEST(ColorTiles, TheBorderIsTheNeighboursAndAtTheEdgeItsOwn) {
  const auto layer = std::make_shared<Formula>([](std::int64_t x, std::int64_t y, int) {
    return Texel{std::uint8_t(x), std::uint8_t(y), std::uint8_t((x / 256 + 1) * 20), 255};
  });
  // Ground as far as the 300th column of zoom 1; the layer gives texels beyond it as well.
  const ColorGrid grid = GridAt(dspace::Crs(), {0.0, 0.0}, {1.0, -1.0}, 150.0);
  ColorTiles tiles(StackOf({layer}), {grid});
  const auto got = tiles.Get({{0, 1, 0, 0}, {0, 1, 1, 0}, {0, 1, 0, 1}, {0, 4, 15, 15}}, 60.0);
  EXPECT_EQ(At(got[0], 0, 5)[0], 0);            // a copy of column 0
  EXPECT_EQ(At(got[0], 257, 5)[2], Stored(40)); // column 256
  EXPECT_EQ(At(got[1], 0, 5)[0], Stored(255));  // column 255
  EXPECT_EQ(At(got[1], 44, 5)[0], Stored(43));  // column 299, the last on the ground
  EXPECT_EQ(At(got[1], 45, 5)[0], Stored(43));  // and once more
  EXPECT_EQ(At(got[2], 5, 45)[1], Stored(43));
  EXPECT_EQ(At(got[2], 5, 0)[1], Stored(255));
  EXPECT_TRUE(got[3]->texels.empty()); // no ground: nothing is read
  EXPECT_EQ(layer->reads, 3);
  // Around a body the first column's neighbour is the last.
  ColorTiles around(StackOf({layer}), {GlobeGrid(dspace::Crs())});
  const auto turn = around.Get({{0, 1, 0, 0}, {0, 1, 4, 0}, {0, 1, -4, 0}}, 60.0);
  EXPECT_EQ(turn[0], turn[1]);
  EXPECT_EQ(turn[0], turn[2]);
  EXPECT_EQ(At(turn[0], 0, 5)[0], Stored(255)); // column -1
}

TEST(ColorTiles, AChangeOfTheStackReadsNothingAnew) {
  const auto red = Plain({200, 0, 0, 255}), green = Plain({0, 200, 0, 255});
  const auto stack = StackOf({red, green});
  ColorTiles tiles(stack, {Ground()});
  const std::vector<ColorTile> wanted = {{0, 0, 0, 0}, {0, 1, 1, 1}};
  EXPECT_EQ(At(tiles.Get(wanted, 60.0)[0], 9, 9)[1], Stored(200));
  EXPECT_EQ(tiles.Statistics().reads, 4u);
  const std::uint64_t arrivals = tiles.Arrivals();
  stack->Change("b", {}, false, {});
  EXPECT_GT(tiles.Arrivals(), arrivals);
  // What is there is shown until the other comes.
  const auto old = tiles.TryGet(wanted);
  ASSERT_TRUE(old[0]);
  const auto fresh = tiles.Get(wanted, 60.0);
  EXPECT_EQ(fresh[0]->revision, stack->Revision());
  EXPECT_EQ(At(fresh[0], 9, 9)[0], Stored(200));
  EXPECT_EQ(At(fresh[0], 9, 9)[1], 0);
  stack->Change("b", 0.25, true, 0); // below
  EXPECT_EQ(At(tiles.Get(wanted, 60.0)[1], 9, 9)[0], Stored(200));
  EXPECT_EQ(tiles.Statistics().reads, 4u);
  stack->Remove("a");
  stack->Remove("b");
  EXPECT_TRUE(tiles.Get(wanted, 60.0)[0]->texels.empty());
  // Their tiles are not kept.
  EXPECT_EQ(red.use_count(), 1);
  EXPECT_LT(tiles.Statistics().bytes, 10000u);
  stack->Add({"c", red, 1.0, true});
  EXPECT_EQ(At(tiles.Get(wanted, 60.0)[0], 9, 9)[0], Stored(200));
  EXPECT_EQ(tiles.Statistics().reads, 6u);
}

TEST(ColorTiles, ALayerThatIsTakenAwayWhileItIsReadIsNotKept) {
  Gate gate;
  const auto layer = Plain({200, 0, 0, 255});
  layer->before = [&](const ColorBlock&) { gate.Wait(); };
  const auto stack = StackOf({layer});
  ColorTiles tiles(stack, {Ground()});
  tiles.TryGet({{0, 0, 0, 0}});
  while (layer->reads == 0)
    std::this_thread::yield();
  stack->Remove("a");
  tiles.Arrivals(); // the stack is taken as it is now
  gate.Open();
  EXPECT_TRUE(tiles.Get({{0, 0, 0, 0}}, 60.0)[0]->texels.empty());
  EXPECT_EQ(tiles.Statistics().reads, 1u);
  EXPECT_EQ(layer.use_count(), 1);
}

TEST(ColorTiles, TryGetNeverReads) {
  Gate gate;
  const auto layer = Plain({1, 2, 3, 255});
  layer->before = [&](const ColorBlock&) { gate.Wait(); };
  ColorTiles tiles(StackOf({layer}), {Ground()});
  for (int i = 0; i < 3; ++i)
    for (const auto& tile : tiles.TryGet({{0, 0, 0, 0}, {0, 1, 0, 0}, {0, 1, 1, 0}}))
      EXPECT_FALSE(tile); // and it has returned, though every read waits
  EXPECT_EQ(tiles.Statistics().pending, 3u);
  try { // a wait ends at its deadline
    tiles.Get({{0, 0, 0, 0}}, 0.05);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded);
  }
  gate.Open();
  EXPECT_EQ(At(tiles.Get({{0, 0, 0, 0}}, 60.0)[0], 0, 0)[2], Stored(3));
  EXPECT_TRUE(tiles.TryGet({{0, 0, 0, 0}})[0]);
}

TEST(ColorTiles, TheLatestViewComesFirstAndNearestFirst) {
  Gate gate;
  std::mutex mutex;
  std::vector<std::int64_t> order;
  const auto layer = Plain({1, 2, 3, 255});
  std::atomic<bool> first{true};
  layer->before = [&](const ColorBlock& block) {
    if (first.exchange(false)) {
      gate.Wait();
      return;
    }
    const std::lock_guard<std::mutex> lock(mutex);
    order.push_back((block.column + 1) / 256);
  };
  ColorTilesOptions options;
  options.threads = 1;
  ColorTiles tiles(StackOf({layer}), {Ground()}, options);
  tiles.TryGet({{0, 4, 0, 15}}); // holds the only thread, once it is read
  while (first)
    std::this_thread::yield();
  tiles.TryGet({{0, 4, 1, 0}, {0, 4, 2, 0}, {0, 4, 3, 0}});
  tiles.TryGet({{0, 4, 7, 0}, {0, 4, 3, 0}, {0, 4, 5, 0}});
  gate.Open();
  while (tiles.Statistics().pending > 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(order, (std::vector<std::int64_t>{7, 3, 5, 1, 2}));
}

TEST(ColorTiles, WhatNobodyLooksAtAnyMoreIsDropped) {
  Gate gate;
  const auto layer = Plain({1, 2, 3, 255});
  layer->before = [&](const ColorBlock&) { gate.Wait(); };
  ColorTilesOptions options;
  options.threads = 1;
  ColorTiles tiles(StackOf({layer}), {Ground()}, options);
  tiles.TryGet({{0, 4, 0, 0}});
  while (layer->reads == 0)
    std::this_thread::yield();
  tiles.TryGet({{0, 4, 1, 0}, {0, 4, 2, 0}});
  for (int i = 0; i < 200; ++i)
    tiles.TryGet({{0, 4, 3, 0}});
  gate.Open();
  while (tiles.Statistics().pending > 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(layer->reads, 2);
}

TEST(ColorTiles, TheBudgetHoldsAndEmptyTilesCostNothing) {
  const auto layer = Plain({1, 2, 3, 255}), nothing = Plain({0, 0, 0, 0});
  nothing->empty = true;
  ColorTilesOptions options;
  options.byteBudget = std::size_t(16) << 20; // 62 tiles
  ColorTiles tiles(StackOf({layer, nothing}), {Ground()}, options);
  std::vector<ColorTile> wanted;
  for (std::int64_t i = 0; i < 100; ++i)
    wanted.push_back({0, 4, i % 10, i / 10});
  const auto held = tiles.Get(wanted, 600.0); // more than the budget has room for
  EXPECT_EQ(At(held[99], 0, 0)[0], Stored(1));
  EXPECT_LE(tiles.Statistics().bytes, options.byteBudget);
  EXPECT_GT(tiles.Statistics().bytes, options.byteBudget - (std::size_t(1) << 20));
  EXPECT_GE(layer->reads, 100);
  const auto there = tiles.TryGet(wanted);
  const auto present =
      std::count_if(there.begin(), there.end(), [](const auto& t) { return bool(t); });
  EXPECT_GE(present, 1);
  EXPECT_LE(present, 62);
  ColorTiles none(StackOf({nothing}), {Ground()}, options);
  none.Get(wanted, 600.0);
  EXPECT_LT(none.Statistics().bytes, 100000u);
  none.Get(wanted, 600.0);
  EXPECT_EQ(none.Statistics().reads, 100u);
}

// Two views, one of which hides a layer: both are served, and neither displaces the other's tiles.
TEST(ColorTiles, CompositionsOfOneTileAreKeptBesideEachOther) {
  using Part = dspace::LayerChoice::Part;
  const auto low = Plain({200, 0, 0, 255}), high = Plain({0, 200, 0, 255});
  const auto mark = Plain({0, 0, 200, 255});
  auto stack = std::make_shared<LayerStack>("terrain 'test'");
  stack->Add({"mark", mark, 1.0, true, {}, true}); // lowest, and yet on top
  stack->Add({"low", low, 1.0, true, dspace::Membership::Physical()});
  stack->Add({"high", high, 1.0, true});
  ColorTiles tiles(stack, {Ground()});
  const int all = tiles.CompositionOf({});
  const int physical = tiles.CompositionOf({Part::All, {"ornamental"}});
  const int unmarked = tiles.CompositionOf({Part::Unmarked, {}});
  const int marks = tiles.CompositionOf({Part::Marks, {}});
  EXPECT_EQ(all, 0);
  EXPECT_EQ(tiles.CompositionOf({Part::All, {"ornamental", "unknown"}}), physical);
  const std::vector<ColorTile> wanted = {{0, 4, 2, 3}};
  for (int round = 0; round < 3; ++round) {
    const auto color = [&](int composition) {
      const auto tile = tiles.Get(wanted, 60.0, composition)[0];
      return Texel{At(tile, 7, 9)[0], At(tile, 7, 9)[1], At(tile, 7, 9)[2], At(tile, 7, 9)[3]};
    };
    const auto stored = std::uint8_t(Stored(200));
    EXPECT_EQ(color(all), (Texel{0, 0, stored, 255}));
    EXPECT_EQ(color(physical), (Texel{stored, 0, 0, 255}));
    EXPECT_EQ(color(unmarked), (Texel{0, stored, 0, 255}));
    EXPECT_EQ(color(marks), (Texel{0, 0, stored, 255}));
  }
  EXPECT_EQ(tiles.Statistics().compositions, 4u);
  EXPECT_EQ(tiles.Statistics().reads, 3u); // each layer once
}

TEST(ColorTiles, AFailingSourceIsTriedAgainAndReported) {
  const auto layer = Plain({1, 2, 3, 255});
  std::atomic<int> bad{2};
  layer->before = [&](const ColorBlock&) {
    if (bad-- > 0)
      throw Error(Error::Kind::Io, "image 'far.tif'", "the server is away");
  };
  ColorTilesOptions options;
  options.retryDelay = 0.001;
  ColorTiles tiles(StackOf({layer}), {Ground()}, options);
  EXPECT_EQ(At(tiles.Get({{0, 0, 0, 0}}, 60.0)[0], 0, 0)[0], Stored(1)); // the third attempt
  EXPECT_EQ(tiles.Statistics().failures, 2u);
  EXPECT_NE(tiles.Statistics().lastFailure.find("the server is away"), std::string::npos);
  bad = 1 << 30;
  for (int i = 0; i < 2; ++i) { // each call makes its own three attempts
    const std::uint64_t before = tiles.Statistics().failures;
    try {
      tiles.Get({{0, 1, 0, 0}}, 60.0);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Io);
      EXPECT_EQ(error.GetObjectName(), "image 'far.tif'");
    }
    EXPECT_GE(tiles.Statistics().failures - before, 3u);
  }
  bad = 0; // and without a caller it comes in the end
  tiles.TryGet({{0, 1, 0, 0}});
  while (!tiles.TryGet({{0, 1, 0, 0}})[0])
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(ColorTiles, RejectsWhatIsOutOfRange) {
  const auto stack = StackOf({});
  const auto expectRejected = [&](const std::function<void(ColorTilesOptions&)>& change) {
    ColorTilesOptions options;
    change(options);
    EXPECT_THROW(ColorTiles(stack, {Ground()}, options), Error);
  };
  expectRejected([](auto& o) { o.byteBudget = (16 << 20) - 1; });
  expectRejected([](auto& o) { o.threads = 0; });
  expectRejected([](auto& o) { o.threads = 65; });
  expectRejected([](auto& o) { o.retryDelay = 0.0; });
  expectRejected([](auto& o) { o.retryDelay = std::nan(""); });
  expectRejected([](auto& o) { o.attempts = 0; });
  EXPECT_THROW(ColorTiles(nullptr, {Ground()}), Error);
  EXPECT_THROW(ColorTiles(stack, {}), Error);
  ColorTiles tiles(stack, {Ground()});
  EXPECT_THROW(tiles.TryGet({{1, 0, 0, 0}}), Error);
  EXPECT_THROW(tiles.TryGet({{0, 31, 0, 0}}), Error);
  EXPECT_THROW(tiles.Get({{0, -1, 0, 0}}, 1.0), Error);
  EXPECT_TRUE(tiles.Get({{0, 2, 9, -1}}, 60.0)[0]->texels.empty()); // outside: nothing
}
