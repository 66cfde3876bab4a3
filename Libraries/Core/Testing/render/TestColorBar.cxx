// Colour bars: round values by hand, and where they are found in the picture.
#include <cmath>
#include <limits>

#include "RenderingTestSupport.h"

#include <dspace/overlay/RoundNumbers.h>

namespace dspace::testing {
namespace {

ColorBar Bar() {
  ColorBar bar;
  bar.name = "height";
  bar.low = -1000.0;
  bar.high = 3000.0;
  bar.colors = {{0, 0, 0.2}, {1, 0, 0}, {0.4, 1, 0.6}};
  bar.ticks = 5;
  bar.backgroundColor = {0, 0, 0, 1};
  bar.textColor = {1, 1, 1, 1};
  return bar;
}

struct ColorBarTest : RenderingFixture {
  vtkSmartPointer<vtkDspaceViewport> view;
  void SetUp() override {
    Look({});
    view = View(400, 300);
    view->SetBackground({0, 0.5, 0}, {0, 0.5, 0});
  }
  static std::array<int, 3> Pixel(const Capture& capture, int x, int y) {
    const std::size_t at = 4 * (std::size_t(y) * capture.width + x);
    return {capture.color[at], capture.color[at + 1], capture.color[at + 2]};
  }
  static bool White(const Capture& capture, int x, int y) {
    return Pixel(capture, x, y) == std::array<int, 3>{255, 255, 255};
  }
  // The bar's frame, found in the picture: runs of white around what is not.
  struct Frame {
    int left, right, top, bottom; // first and last column, row of the frame
  };
  // `length` and `thickness` are the bar's.
  static Frame Find(const Capture& capture, int across, int down) {
    for (int y = 0; y + down + 1 < capture.height; ++y) {
      for (int x = 0; x + across + 1 < capture.width; ++x) {
        bool whole = true;
        for (int i = 0; whole && i < across + 2; ++i) {
          whole = White(capture, x + i, y) && White(capture, x + i, y + down + 1);
        }
        for (int i = 0; whole && i < down + 2; ++i) {
          whole = White(capture, x, y + i) && White(capture, x + across + 1, y + i);
        }
        if (whole) {
          return {x, x + across + 1, y, y + down + 1};
        }
      }
    }
    ADD_FAILURE() << "no frame of " << across << " x " << down;
    return {0, 1, 0, 1};
  }
};

} // namespace

TEST(RoundNumbers, StepsAreRoundAndFew) {
  EXPECT_EQ(RoundStep(0, 10, 6, false), 2.0);
  EXPECT_EQ(RoundStep(-8068, 21134, 6, false), 5000.0);
  EXPECT_EQ(RoundStep(0, 1, 11, false), 0.1);
  EXPECT_EQ(RoundStep(0.013, 0.027, 4, false), 0.005);
  EXPECT_EQ(RoundStep(0, 360, 6, true), 90.0);
  EXPECT_EQ(RoundStep(0, 360, 6, false), 100.0);
  EXPECT_EQ(RoundStep(0, 45, 6, true), 10.0);
  EXPECT_EQ(RoundStep(0, 45, 4, true), 15.0);
  for (const int count : {1, 2, 3, 7, 20}) {
    for (const double low : {-7.3, 0.0, 1e5, -2e-7}) {
      for (const double range : {1e-4, 0.7, 19.0, 3e6}) {
        const double step = RoundStep(low, low + range, count, false);
        const auto values = Multiples(step, low, low + range);
        EXPECT_LE(values.size(), std::size_t(count));
        // A third of the most that fit, and more, but for what rounding the range's ends takes.
        EXPECT_GE(values.size() + 2, std::size_t(range / step)) << low << " " << range;
        for (const double value : values) {
          EXPECT_NEAR(std::remainder(value, step), 0.0, 1e-6 * step);
          EXPECT_GE(value, low - 1e-6 * step);
          EXPECT_LE(value, low + range + 1e-6 * step);
        }
      }
    }
  }
}

TEST(RoundNumbers, TextsHaveTheDecimalsOfTheirStep) {
  EXPECT_EQ(RoundText(1234567, 1), "1,234,567");
  EXPECT_EQ(RoundText(-12000, 2000), "-12,000");
  EXPECT_EQ(RoundText(-999, 1), "-999");
  EXPECT_EQ(RoundText(0.25, 0.05), "0.25");
  EXPECT_EQ(RoundText(0.5, 0.25), "0.50");
  EXPECT_EQ(RoundText(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(RoundText(-1e-17, 0.1), "0.0");
  EXPECT_EQ(RoundText(1234.5, 0.5), "1,234.5");
  EXPECT_EQ(RoundText(3e15, 1e15), "3e+15");
}

TEST_F(ColorBarTest, TicksAndColoursAreThoseOfTheirValues) {
  for (const bool horizontal : {false, true}) {
    for (const int length : {horizontal ? 250 : 100, horizontal ? 301 : 201}) {
      ColorBar bar = Bar();
      bar.horizontal = horizontal;
      bar.length = length;
      bar.fontSize = 10;
      view->SetColorBar(bar);
      const Capture capture = view->GetCapture({});
      const Frame frame =
          horizontal ? Find(capture, length, bar.thickness) : Find(capture, bar.thickness, length);
      std::vector<double> found; // values of the marks, at the middles of their pixels
      for (int i = 0; i < length; ++i) {
        const int x = horizontal ? frame.left + 1 + i : frame.right + 1;
        const int y = horizontal ? frame.bottom + 1 : frame.bottom - 1 - i;
        const double value = -1000.0 + 4000.0 * (i + 0.5) / length;
        if (White(capture, x, y)) {
          found.push_back(value);
        }
        // sRGB, linear between three colours; 255 levels.
        const double at = 2.0 * (i + 0.5) / length;
        const int k = at < 1.0 ? 0 : 1;
        const auto shown =
            Pixel(capture, horizontal ? x : frame.left + 3, horizontal ? frame.top + 3 : y);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(shown[c],
                      255.0 *
                          (bar.colors[k][c] + (at - k) * (bar.colors[k + 1][c] - bar.colors[k][c])),
                      1.0)
              << i;
        }
      }
      ASSERT_EQ(found.size(), 5u);
      for (int k = 0; k < 5; ++k) {
        EXPECT_NEAR(found[k], -1000.0 + 1000.0 * k, 0.51 * 4000.0 / length); // half a pixel
      }
      view->RemoveColorBar("height");
    }
  }
}

TEST_F(ColorBarTest, ItStandsInItsCornerAndGoesWithoutTrace) {
  const Capture without = view->GetCapture({});
  ColorBar bar = Bar();
  bar.title = "Height";
  bar.unit = "m";
  for (const auto anchor : {TextTable::Anchor::TopLeft, TextTable::Anchor::TopRight,
                            TextTable::Anchor::BottomLeft, TextTable::Anchor::BottomRight}) {
    bar.anchor = anchor;
    view->SetColorBar(bar);
    EXPECT_TRUE(view->IsOutdated());
    const Capture capture = view->GetCapture({});
    int left = 400, right = -1, top = 300, bottom = -1;
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 400; ++x) {
        if (Pixel(capture, x, y) != Pixel(without, x, y)) {
          left = std::min(left, x), right = std::max(right, x);
          top = std::min(top, y), bottom = std::max(bottom, y);
        }
      }
    }
    const bool west =
        anchor == TextTable::Anchor::TopLeft || anchor == TextTable::Anchor::BottomLeft;
    const bool north =
        anchor == TextTable::Anchor::TopLeft || anchor == TextTable::Anchor::TopRight;
    EXPECT_EQ(west ? left : 399 - right, 8);
    EXPECT_EQ(north ? top : 299 - bottom, 8);
    EXPECT_GT(bottom - top, 200);
    EXPECT_LT(right - left, 120);
    view->SetColorBar(bar); // the same again
    EXPECT_FALSE(view->IsOutdated());
  }
  CaptureRequest physical;
  physical.physicalOnly = true;
  EXPECT_EQ(view->GetCapture(physical).color, without.color);
  view->RemoveColorBar("height");
  EXPECT_EQ(view->GetCapture({}).color, without.color);
  EXPECT_THROW(view->RemoveColorBar("height"), Error);
}

TEST_F(ColorBarTest, ItsTextsAreInkBesideTheirTicks) {
  ColorBar bar = Bar();
  bar.ticks = 0;
  view->SetColorBar(bar);
  const Capture bare = view->GetCapture({});
  const Frame frame = Find(bare, bar.thickness, bar.length);
  const auto ink = [&](const Capture& capture, int x0, int x1, int y0, int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        count += Pixel(capture, x, y)[0] > 127 && Pixel(capture, x, y)[1] > 127;
      }
    }
    return count;
  };
  EXPECT_EQ(ink(bare, frame.right + 2, 400, 0, 300), 0);
  bar.values = {-1000.0, 1000.0, 3000.0};
  bar.title = "H";
  view->SetColorBar(bar);
  const Capture capture = view->GetCapture({});
  const Frame at = Find(capture, bar.thickness, bar.length);
  for (const int y : {at.bottom - 1, (at.bottom + at.top) / 2, at.top + 1}) {
    EXPECT_GT(ink(capture, at.right + 8, 400, y - 7, y + 8), 60) << y;
    // Upright and about its tick: as much above as below.
    const int above = ink(capture, at.right + 8, 400, y - 7, y);
    const int below = ink(capture, at.right + 8, 400, y + 1, y + 8);
    EXPECT_NEAR(above, below, 0.45 * (above + below)) << y;
  }
  EXPECT_EQ(ink(capture, at.right + 8, 400, at.top + 20, at.top + 80), 0);
  EXPECT_GT(ink(capture, at.left, 400, at.top - 30, at.top - 8), 20); // the title
  EXPECT_EQ(bar.Ticks()[0].second, "-1000");
  bar.values.clear();
  bar.ticks = 5;
  EXPECT_EQ(bar.Ticks()[4].second, "3,000");
  bar.unit = "m";
  EXPECT_EQ(bar.Heading(), "H [m]");
  bar.length = 16; // room for one line of text
  EXPECT_LE(bar.Ticks().size(), 1u);
}

TEST_F(ColorBarTest, WhatCannotBeShownIsRejectedAndChangesNothing) {
  const auto rejected = [&](const std::vector<std::string>& parts, auto change) {
    ColorBar bar = Bar();
    change(bar);
    try {
      view->SetColorBar(bar);
      ADD_FAILURE() << "accepted, not rejected with " << parts[0];
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      for (const std::string& part : parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      }
    }
    EXPECT_FALSE(view->IsOutdated());
  };
  view->SetColorBar(Bar());
  view->GetCapture({});
  constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
  rejected({"colour bar 'height'", "3000 to 3000"}, [](ColorBar& b) { b.low = 3000; });
  rejected({"nan"}, [](ColorBar& b) { b.high = NaN; });
  rejected({"inf"}, [](ColorBar& b) { b.high = std::numeric_limits<double>::infinity(); });
  rejected({"too close"}, [](ColorBar& b) { b.low = 1e12, b.high = 1e12 + 1; });
  rejected({"0 colours", "1 to 1024"}, [](ColorBar& b) { b.colors.clear(); });
  rejected({"1.5", "0 to 1"}, [](ColorBar& b) { b.colors[0][1] = 1.5; });
  rejected({"nan", "0 to 1"}, [](ColorBar& b) { b.colors[0][1] = NaN; });
  rejected({"a tick", "3001", "-1000 to 3000"}, [](ColorBar& b) { b.values = {3001}; });
  rejected({"a tick", "nan"}, [](ColorBar& b) { b.values = {NaN}; });
  rejected({"-3 ticks"}, [](ColorBar& b) { b.ticks = -3; });
  rejected({"101 ticks"}, [](ColorBar& b) { b.values.assign(101, 0.0); });
  rejected({"length", "8193"}, [](ColorBar& b) { b.length = 8193; });
  rejected({"thickness", "1"}, [](ColorBar& b) { b.thickness = 1; });
  rejected({"font size", "3"}, [](ColorBar& b) { b.fontSize = 3; });
  rejected({"margin", "-1"}, [](ColorBar& b) { b.margin = -1; });
  rejected({"its title", "U+000A"}, [](ColorBar& b) { b.title = "a\nb"; });
  rejected({"its unit", "U+4E2D"}, [](ColorBar& b) { b.unit = "中"; });
  rejected({"pixels large"}, [](ColorBar& b) {
    b.title = std::string(4096, 'x');
    b.fontSize = 100;
  });
  rejected({"colour bar ''"}, [](ColorBar& b) { b.name = ""; });
}

} // namespace dspace::testing
