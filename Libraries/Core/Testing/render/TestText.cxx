// Letters of any alphabet the fonts have: each is drawn, in labels, tables and as triangles; the
// others are rejected by name.
#include "RenderingTestSupport.h"

#include <functional>
#include <set>

#include <dspace/overlay/Overlay.h>
#include <dspace/render/text/TextShapes.h>

using namespace dspace;

namespace {

// Where a picture holds ink, row by row.
struct Ink {
  int width = 0;
  int height = 0;
  std::vector<bool> there;

  bool operator()(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height && there[std::size_t(y) * width + x];
  }
  bool operator<(const Ink& o) const {
    return std::tie(width, height, there) < std::tie(o.width, o.height, o.there);
  }
  bool operator==(const Ink& o) const { return !(*this < o) && !(o < *this); }
  int Rightmost(int top, int bottom) const {
    int last = -1;
    for (int y = top; y < bottom; ++y) {
      for (int x = 0; x < width; ++x) {
        last = (*this)(x, y) ? std::max(last, x) : last;
      }
    }
    return last;
  }
};

// Pieces of ink that touch, corners too.
int Pieces(Ink ink) {
  int pieces = 0;
  std::vector<std::pair<int, int>> todo;
  for (int i = 0; i < ink.width * ink.height; ++i) {
    if (!ink.there[i]) {
      continue;
    }
    ++pieces;
    todo = {{i % ink.width, i / ink.width}};
    while (!todo.empty()) {
      const auto [x, y] = todo.back();
      todo.pop_back();
      if (!ink(x, y)) {
        continue;
      }
      ink.there[std::size_t(y) * ink.width + x] = false;
      for (int k = 0; k < 9; ++k) {
        todo.emplace_back(x + k % 3 - 1, y + k / 3 - 1);
      }
    }
  }
  return pieces;
}

Ink LabelInk(const std::string& text, int size = 80) {
  LabelStyle style;
  style.fontSize = size;
  style.backgroundOpacity = 0;
  const Part label = MakeLabel(text, style);
  const Image& image = *label.material->texture;
  Ink ink{image.width, image.height, {}};
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) {
    ink.there.push_back(image.pixels[i] > 127);
  }
  return ink;
}

// The part of a picture that holds ink.
Ink Cropped(const Ink& ink) {
  Extent at;
  for (int y = 0; y < ink.height; ++y) {
    for (int x = 0; x < ink.width; ++x) {
      if (ink(x, y)) {
        at = {std::min(at.left, x), std::max(at.right, x), std::min(at.top, y),
              std::max(at.bottom, y)};
      }
    }
  }
  Ink part{at.right - at.left + 1, at.bottom - at.top + 1, {}};
  for (int y = at.top; y <= at.bottom; ++y) {
    for (int x = at.left; x <= at.right; ++x) {
      part.there.push_back(ink(x, y));
    }
  }
  return part;
}

// Pixels whose centres lie in a mesh's triangles, the mesh filling the picture.
Ink MeshInk(const Mesh& mesh, int width, int height) {
  Eigen::AlignedBox2d box;
  const auto at = [&](std::uint32_t i) {
    return Eigen::Vector2d(mesh.positions[3 * i], mesh.positions[3 * i + 1]);
  };
  for (const std::uint32_t i : mesh.indices) {
    box.extend(at(i));
  }
  Ink ink{width, height, std::vector<bool>(std::size_t(width) * height)};
  const auto left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& p) {
    return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x() >= 0;
  };
  for (int i = 0; i < width * height; ++i) {
    const Eigen::Vector2d p(box.min().x() + box.sizes().x() * (i % width + 0.5) / width,
                            box.max().y() - box.sizes().y() * (int(i / width) + 0.5) / height);
    for (std::size_t k = 0; k < mesh.indices.size() && !ink.there[i]; k += 3) {
      const Eigen::Vector2d a = at(mesh.indices[k]);
      const Eigen::Vector2d b = at(mesh.indices[k + 1]);
      const Eigen::Vector2d c = at(mesh.indices[k + 2]);
      ink.there[i] = left(a, b, p) && left(b, c, p) && left(c, a, p);
    }
  }
  return ink;
}

double MeshArea(const Mesh& mesh) {
  double area = 0;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    Eigen::Vector2d p[3];
    for (int i = 0; i < 3; ++i) {
      p[i] = {mesh.positions[3 * mesh.indices[k + i]], mesh.positions[3 * mesh.indices[k + i] + 1]};
    }
    const double twice =
        (p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
    EXPECT_GT(twice, 0.0); // it faces +Z
    area += twice / 2;
  }
  return area;
}

// UTF-8 of one character.
std::string Utf8(int c) {
  std::string text;
  for (int shift = c < 0x80 ? 0 : c < 0x800 ? 6 : c < 0x10000 ? 12 : 18; shift >= 0; shift -= 6) {
    const int first = c < 0x80 ? 0 : c < 0x800 ? 0xC0 : c < 0x10000 ? 0xE0 : 0xF0;
    text += char(text.empty() ? first | (c >> shift) : 0x80 | ((c >> shift) & 0x3F));
  }
  return text;
}

void ExpectRejected(const std::vector<std::string>& parts, const std::function<void()>& f) {
  try {
    f();
    ADD_FAILURE() << "accepted, not rejected with " << parts[0];
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

struct TextTableTest : RenderingFixture {
  vtkSmartPointer<vtkDspaceViewport> viewport;

  void SetUp() override {
    Look({});
    viewport = View(700, 200);
  }
  static TextTable Table(std::vector<std::pair<std::string, std::string>> rows) {
    TextTable table;
    table.name = "state";
    table.rows = std::move(rows);
    table.fontSize = 40;
    table.backgroundColor = {0, 0, 0, 1};
    return table;
  }
  Ink Drawn(const TextTable& table) {
    viewport->SetBackground({0, 0, 0}, {0, 0, 0});
    viewport->SetTextTable(table);
    const Capture capture = viewport->GetCapture({});
    Ink ink{capture.width, capture.height, {}};
    for (std::size_t i = 0; i < capture.color.size(); i += 4) {
      ink.there.push_back(capture.color[i] > 127);
    }
    return ink;
  }
};

} // namespace

TEST(LabelText, EachLetterOfAnyAlphabetIsInk) {
  EXPECT_EQ(Pieces(LabelInk("abc")), 3); // what is counted is letters
  EXPECT_EQ(Pieces(LabelInk("Δv 3 м/с")), 6);
  EXPECT_EQ(Pieces(LabelInk("αβγ")), 3);
  EXPECT_EQ(Pieces(LabelInk("ΣΩ ж∞")), 4);
  EXPECT_EQ(Pieces(LabelInk("й")), 2); // with its breve
  EXPECT_EQ(Pieces(LabelInk("λ\nж")), 2);
  EXPECT_EQ(Pieces(LabelInk("→°√")), 3);
}

TEST(LabelText, LettersAreThemselvesAndNoBoxes) {
  std::set<Ink> seen;
  const std::vector<std::string> letters = {"Δ", "м", "ж", "Щ", "λ", "Ω",
                                            "≥", "→", "ř", "ő", "Ա", "ა"};
  for (const std::string& letter : letters) {
    const Ink ink = LabelInk(letter);
    EXPECT_GT(Pieces(ink), 0) << letter;
    EXPECT_TRUE(seen.insert(ink).second) << letter << " looks like another";
  }
  // Letters that look alike in two alphabets do so.
  EXPECT_TRUE(LabelInk("Ω") == LabelInk("Ω"));
  EXPECT_TRUE(LabelInk("А") == LabelInk("A"));
}

TEST(LabelText, WhateverIsAcceptedIsDrawn) {
  const std::set<int> blanks = {0xA0, 0x202F, 0x205F, 0x2800, 0x3000};
  int accepted = 0;
  for (int c = 0x21; c < 0x20000; ++c) {
    const std::string text = Utf8(c);
    try {
      const Part label = MakeLabel(text, {40, {1, 1, 1}, {0, 0, 0}, 0.0});
      ++accepted;
      const std::vector<std::uint8_t>& pixels = label.material->texture->pixels;
      bool ink = false;
      for (std::size_t i = 3; i < pixels.size() && !ink; i += 4) {
        ink = pixels[i] > 63;
      }
      EXPECT_NE(ink, blanks.count(c) > 0 || (c >= 0x2000 && c <= 0x200A)) << std::hex << c;
    } catch (const Error&) {
    }
  }
  EXPECT_GT(accepted, 4000);
}

TEST(LabelText, WhatTheFontLacksIsRejectedByName) {
  ExpectRejected({"label 'Ziel 中国'", "U+4E2D '中'", "accepted"}, [] { MakeLabel("Ziel 中国"); });
  ExpectRejected({"U+1F680"}, [] { MakeLabel("\xF0\x9F\x9A\x80"); });
  ExpectRejected({"U+1F600"}, [] { MakeLabel("\xF0\x9F\x98\x80"); });
  ExpectRejected({"U+05D0", "right to left"}, [] { MakeLabel("אב"); });
  ExpectRejected({"label 'a?b'", "U+0009", "accepted"}, [] { MakeLabel("a\tb"); });
  ExpectRejected({"U+200B"}, [] { MakeLabel("a\xE2\x80\x8B"); });
  for (const char* bad : {"a\xFF", "\xC3", "a\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80"}) {
    ExpectRejected({"label '", "0x", "accepted: UTF-8"}, [&] { MakeLabel(bad); });
  }
  std::string greek; // a message keeps to whole characters, also where a text is shortened
  for (int i = 0; i < 5000; ++i) {
    greek += "λ";
  }
  ExpectRejected({"λλλ...'", "5000"}, [&] { MakeLabel(greek); });
  ExpectRejected({"λλλ...'", "5000"}, [&] { MakeTextMesh("a" + greek.substr(2), 1); });
}

TEST(SolidText, LettersAreThoseOfLabels) {
  // FreeType's own pixels against our triangles: form, holes, crossing outlines (Ф is two).
  for (const std::string text : {"a", "B", "8", "Ф", "й", "Ξ", "∞", "♖", "Δv 3 м/с"}) {
    const Ink label = Cropped(LabelInk(text, 200));
    const Ink mesh = MeshInk(MakeTextMesh(text, 1), label.width, label.height);
    int both = 0;
    int either = 0;
    for (std::size_t i = 0; i < label.there.size(); ++i) {
      both += label.there[i] && mesh.there[i];
      either += label.there[i] || mesh.there[i];
    }
    EXPECT_GT(both, 0.93 * either) << text;
    EXPECT_EQ(Pieces(mesh), Pieces(label)) << text;
  }
}

TEST(SolidText, EachLetterCoversItsArea) {
  // A capital of DejaVu Sans is 1493 of 2048 units high. FreeType fits stems to whole pixels.
  const double capital = 200 * 1493 / 2048.0;
  int compared = 0;
  for (int c = 0x21; c < 0x10000; ++c) {
    try {
      const Part label = MakeLabel(Utf8(c), {200, {1, 1, 1}, {0, 0, 0}, 0.0});
      double ink = 0;
      for (std::size_t i = 3; i < label.material->texture->pixels.size(); i += 4) {
        ink += label.material->texture->pixels[i] / 255.0;
      }
      const double area = ink / (capital * capital);
      if (area > 0) {
        EXPECT_NEAR(MeshArea(MakeTextMesh(Utf8(c), 1)), area, 0.01 + 0.07 * area) << std::hex << c;
        ++compared;
      }
    } catch (const Error&) {
    }
  }
  EXPECT_GT(compared, 4000);
}

TEST(SolidText, CapitalsAreAsHighAsAskedAndLinesFollow) {
  const auto bounds = [](const Mesh& mesh) {
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
      box.extend(Eigen::Vector3f(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]));
    }
    return box;
  };
  const auto one = bounds(MakeTextMesh("H", 2));
  EXPECT_NEAR(one.min().y(), 0.0, 1e-5);
  EXPECT_NEAR(one.max().y(), 2.0, 1e-5);
  EXPECT_EQ(one.sizes().z(), 0.0f);
  // From baseline to baseline 2384 of 2048 units, a capital's 1493.
  EXPECT_NEAR(bounds(MakeTextMesh("H\nH", 2)).min().y(), -2.0 * 2384 / 1493, 1e-5);
  // H is 1540 units wide to the next letter's origin.
  EXPECT_NEAR(bounds(MakeTextMesh("HH", 2)).max().x(), one.max().x() + 2.0 * 1540 / 1493, 1e-5);
}

TEST(SolidText, WhatTheFontLacksIsRejectedByName) {
  ExpectRejected({"text 'Ziel 中国'", "U+4E2D '中'", "accepted"},
                 [] { MakeTextMesh("Ziel 中国", 1); });
  ExpectRejected({"U+0009"}, [] { MakeTextMesh("a\tb", 1); });
  ExpectRejected({"blank"}, [] { MakeTextMesh("\xC2\xA0", 1); });
}

TEST_F(TextTableTest, EachLetterOfAnyAlphabetIsInk) {
  EXPECT_EQ(Pieces(Drawn(Table({{"ab", "cde"}}))), 5);
  EXPECT_EQ(Pieces(Drawn(Table({{"Δv", "3 м/с"}}))), 6);
  TextTable titled = Table({{"λ", "5°"}, {"ж", "→"}});
  titled.title = "ΣΩ";
  EXPECT_EQ(Pieces(Drawn(titled)), 7);
}

TEST_F(TextTableTest, ColumnsStayInLineInAnyAlphabet) {
  const Ink ink = Drawn(Table({{"speed", "12 H"}, {"скорость", "3 м H"}, {"λ", "Δv H"}}));
  // Three lines of text from the margin down, each ending with the same letter.
  const int line = 47; // 40 pixels, and what the font leaves between lines
  const int last = ink.Rightmost(8, 8 + line);
  EXPECT_GT(last, 300);
  EXPECT_EQ(ink.Rightmost(8 + line, 8 + 2 * line), last);
  EXPECT_EQ(ink.Rightmost(8 + 2 * line, 8 + 3 * line), last);
}

TEST_F(TextTableTest, WhatWouldNotBeDrawnRightIsRejectedAndChangesNothing) {
  const Ink before = Drawn(Table({{"a", "b"}}));
  const auto rejected = [&](const std::vector<std::string>& parts, const TextTable& table) {
    ExpectRejected(parts, [&] { viewport->SetTextTable(table); });
    EXPECT_FALSE(viewport->IsOutdated());
  };
  rejected({"text table 'state'", "a label", "U+000A", "accepted"}, Table({{"a\nb", "c"}}));
  rejected({"text table 'state'", "the value of 'a'", "U+0009"}, Table({{"a", "b\tc"}}));
  rejected({"the value of 'a'", "U+000A"}, Table({{"a", "b\n"}}));
  rejected({"a label", "U+0085"}, Table({{"\xC2\x85", "c"}}));
  rejected({"the value of 'target'", "U+4E2D '中'", "accepted"}, Table({{"target", "中"}}));
  rejected({"a label", "U+4E2D"}, Table({{"中", "1"}}));
  TextTable titled = Table({{"a", "b"}});
  titled.title = "a\nb";
  rejected({"its title", "U+000A"}, titled);
  titled.title = "中";
  rejected({"its title", "U+4E2D"}, titled);
  EXPECT_TRUE(Drawn(Table({{"a", "b"}})) == before);
}
