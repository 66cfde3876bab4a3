#include <dspace/import/vrml/VrmlLetters.h>

#include <algorithm>
#include <map>

#include <dspace/Utf8.h>
#include <dspace/letters/OutlineFont.h>

namespace dspace {

namespace {

constexpr std::size_t MaximumCharacters = 4096;

using Justify = VrmlLetters::Justify;

// One line as it is set, its origin at the left of the baseline.
struct SetLine {
  std::vector<std::pair<double, const OutlineFont::Letter*>> letters; // x of each
  double width = 0.0;
};

class Setter {
public:
  explicit Setter(double size) : Font_(Font::Sans), Scale_(size / this->Font_.EmSize()) {}

  SetLine Set(const std::string& text) {
    SetLine line;
    for (std::size_t at = 0; at < text.size();) {
      const char32_t character = NextCharacter(text, at);
      if (character == NoCharacter) {
        ++at;
        continue;
      }
      auto found = this->Letters_.find(character);
      if (found == this->Letters_.end()) {
        found = this->Letters_.emplace(character, this->Font_.Read(character)).first;
      }
      line.letters.emplace_back(line.width, &found->second);
      line.width += this->Scale_ * found->second.advance;
    }
    return line;
  }

  void Draw(const SetLine& line, double stretch, const Eigen::Vector2d& origin, double size,
            Mesh& mesh) const {
    for (const auto& [x, letter] : line.letters) {
      const auto first = static_cast<std::uint32_t>(mesh.VertexCount());
      for (const Eigen::Vector2d& p : letter->area.points) {
        const Eigen::Vector2d at =
            origin + Eigen::Vector2d(stretch * (x + this->Scale_ * p.x()), this->Scale_ * p.y());
        mesh.positions.insert(mesh.positions.end(),
                              {static_cast<float>(at.x()), static_cast<float>(at.y()), 0.0f});
        mesh.normals.insert(mesh.normals.end(), {0.0f, 0.0f, 1.0f});
        mesh.tcoords.insert(mesh.tcoords.end(),
                            {static_cast<float>(at.x() / size), static_cast<float>(at.y() / size)});
      }
      for (const std::uint32_t index : letter->area.triangles) {
        mesh.indices.push_back(first + index);
      }
    }
  }

private:
  OutlineFont Font_;
  double Scale_; // of the font's unit
  std::map<char32_t, OutlineFont::Letter> Letters_;
};

double Start(Justify justify, double width) {
  return justify == Justify::Middle ? -0.5 * width : justify == Justify::End ? -width : 0.0;
}

// The first line's baseline. The nominal size is what a line stands above its baseline.
double FirstBaseline(const VrmlLetters& letters) {
  const double below = letters.size * letters.spacing * double(letters.lines.size() - 1);
  switch (letters.minor) {
  case Justify::Begin:
    return -letters.size;
  case Justify::Middle:
    return 0.5 * (below - letters.size);
  case Justify::End:
    return below;
  case Justify::First:
    break;
  }
  return 0.0;
}

} // namespace

VrmlLetters::Justify VrmlJustify(const std::string& word, VrmlLetters::Justify fallback) {
  return word == "BEGIN"    ? Justify::Begin
         : word == "FIRST"  ? Justify::First
         : word == "MIDDLE" ? Justify::Middle
         : word == "END"    ? Justify::End
                            : fallback;
}

Mesh MakeVrmlLetters(const VrmlLetters& letters, VrmlComplaints& complaints) {
  Mesh mesh;
  std::size_t bytes = 0;
  for (const std::string& line : letters.lines) {
    bytes += line.size();
  }
  if (!(letters.size > 0.0) || !(letters.spacing >= 0.0)) {
    complaints.emplace_back("text of a size that is not positive: left out");
    return mesh;
  }
  if (bytes > MaximumCharacters || letters.lines.size() > MaximumCharacters) {
    complaints.push_back("text of more than " + std::to_string(MaximumCharacters) +
                         " characters: left out");
    return mesh;
  }
  Setter setter(letters.size);
  std::vector<SetLine> lines;
  std::vector<double> widths;
  for (std::size_t i = 0; i < letters.lines.size(); ++i) {
    lines.push_back(setter.Set(letters.lines[i]));
    const double wanted = i < letters.lengths.size() ? letters.lengths[i] : 0.0;
    widths.push_back(wanted > 0.0 ? wanted : lines.back().width);
  }
  const double longest = widths.empty() ? 0.0 : *std::max_element(widths.begin(), widths.end());
  const double shrink = letters.maximumExtent > 0.0 && longest > letters.maximumExtent
                            ? letters.maximumExtent / longest
                            : 1.0;
  double y = FirstBaseline(letters);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double width = shrink * widths[i];
    if (lines[i].width > 0.0) {
      setter.Draw(lines[i], width / lines[i].width, {Start(letters.major, width), y}, letters.size,
                  mesh);
    }
    y -= letters.size * letters.spacing;
  }
  return mesh;
}

} // namespace dspace
