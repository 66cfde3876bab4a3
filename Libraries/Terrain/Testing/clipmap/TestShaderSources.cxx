// Every shader program of Dspace is valid GLSL 3.30 of the core profile, by the reference compiler:
// drivers differ in what they accept. Nothing is drawn.
#include <algorithm>
#include <cstring>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <dspace/clipmap/gl/ClipmapShaders.h>
#include <dspace/clipmap/gl/ClipmapUniforms.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/ShaderCode.h>

#include "MissingPackage.h"
#include "ShaderValidator.h"

namespace dspace {
namespace {

namespace fs = std::filesystem;
using Shaders = SurfaceShaders;

const std::vector<unsigned> LightCounts = {0, 1, 3, Shaders::MaximumLights};

// Where sources of shaders are.
const std::vector<std::string> Folders = {"Libraries/Core/Shaders", "Libraries/Terrain/Shaders",
                                          "Examples/own_object", "Testing/Benchmarks/Shaders"};

std::string TextOf(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<fs::path> ShaderFiles() {
  std::vector<fs::path> files;
  for (const std::string& folder : Folders) {
    for (const auto& entry : fs::directory_iterator(fs::path(DSPACE_SOURCES) / folder)) {
      if (entry.path().extension() == ".glsl") {
        files.push_back(entry.path());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The bits that change a program's text: a feature that is added later is among them.
std::vector<Shaders::Features> FeatureBits(const ShaderCode* code) {
  const Shaders::Sources none = Shaders::SourcesFor(0, {}, code);
  std::vector<Shaders::Features> bits;
  for (unsigned shift = 0; shift < Shaders::LightShift; ++shift) {
    const Shaders::Features bit = Shaders::Features(1) << shift;
    const Shaders::Sources with = Shaders::SourcesFor(bit, {}, code);
    if (with.vertex != none.vertex || with.fragment != none.fragment) {
      bits.push_back(bit);
    }
  }
  return bits;
}

// Whether the drawing code asks for them together. A feature that is not named here goes with all.
bool Together(Shaders::Features features, unsigned lights, bool coded) {
  const auto has = [&](Shaders::Features feature) { return (features & feature) != 0; };
  const Shaders::Features geometry = Shaders::Texture | Shaders::Normals | Shaders::Flat;
  if (has(Shaders::Mixed)) { // only with pages that have mixedColor()
    return false;
  }
  if (has(Shaders::Normals) && has(Shaders::Flat)) {
    return false;
  }
  if (coded ? has(Shaders::Billboard | Shaders::Emissive | Shaders::NormalMap |
                  Shaders::ObjectNormals)
            : has(Shaders::Normals | Shaders::Flat)) {
    return false;
  }
  if (has(Shaders::Planes)) {
    return lights == 0 && features == (Shaders::Planes | Shaders::Lit);
  }
  if (has(Shaders::Label)) {
    const Shaders::Features plain = geometry | Shaders::Label | Shaders::Billboard |
                                    (coded ? Shaders::Features(Shaders::VertexColor) : 0u);
    return lights == 0 && (features & ~plain) == 0;
  }
  if (!has(Shaders::Lit)) {
    return lights == 0 && !has(Shaders::Specular | Shaders::PlacedLights | Shaders::DiscLights |
                               Shaders::NormalMap | Shaders::ObjectNormals | Shaders::SunPlace);
  }
  return !has(Shaders::Billboard) &&
         (lights > 0 || !has(Shaders::PlacedLights | Shaders::DiscLights | Shaders::SunPlace)) &&
         !(has(Shaders::NormalMap) && has(Shaders::ObjectNormals));
}

struct Programs {
  testing::ShaderValidator validator;
  int count = 0;

  void Add(const std::string& name, Shaders::Features features, const ShaderPages& pages,
           const ShaderCode* code, bool link) {
    std::ostringstream full;
    full << name << ", features 0x" << std::hex << features;
    const Shaders::Sources made = Shaders::SourcesFor(features, pages, code);
    EXPECT_EQ(made.vertex.rfind("#version 330 core\n", 0), 0u) << full.str();
    EXPECT_EQ(made.fragment.rfind("#version 330 core\n", 0), 0u) << full.str();
    this->validator.Add(full.str(), made.vertex, made.fragment, link);
    ++this->count;
  }

  // Photometric models under lights, angles, and display colours.
  void AddPhotometry(const std::string& name, const ShaderCode* code) {
    const Shaders::Features plain = code ? Shaders::Features(Shaders::Normals) : 0u;
    for (unsigned model = 2; model <= 4; ++model) { // Lommel-Seeliger to Hapke
      for (const Shaders::Features more :
           {Shaders::Features(0), Shaders::Features(Shaders::PlacedLights),
            Shaders::Features(Shaders::DiscLights), Shaders::Features(Shaders::Peel)}) {
        this->Add(name,
                  plain | Shaders::Lit | more | 2u << Shaders::LightShift |
                      model << Shaders::ReflectanceShift,
                  {}, code, true);
      }
    }
    // Shadows of ground on other things, in several maps.
    for (const unsigned maps : {1u, 4u, 8u}) {
      for (const unsigned grounds : {1u, 3u}) {
        this->Add(name,
                  plain | Shaders::Lit | grounds << Shaders::GroundShift |
                      maps << Shaders::CascadeShift | 1u << Shaders::LightShift,
                  {}, code, true);
      }
    }
    for (const Shaders::Features more :
         {Shaders::Features(0), Shaders::Features(Shaders::Specular)}) {
      if (!code) {
        this->Add(name, Shaders::Lit | Shaders::LitMask | more | 1u << Shaders::LightShift, {},
                  code, true);
      }
    }
    for (const Shaders::Features more : {Shaders::Features(0), Shaders::Features(Shaders::Lit),
                                         Shaders::Features(Shaders::Texture),
                                         Shaders::Lit | Shaders::Texture | Shaders::VertexColor}) {
      this->Add(name, plain | Shaders::Angles | more, {}, code, true);
    }
    this->Add(name, plain | Shaders::DisplayColor, {}, code, true);
  }

  // All features together that may be. Those with at most one more than a lit, an unlit or a
  // label's program are linked.
  void AddSurfaces(const std::string& name, const ShaderCode* code) {
    const std::vector<Shaders::Features> bits = FeatureBits(code);
    for (unsigned choice = 0; choice < 1u << bits.size(); ++choice) {
      Shaders::Features features = 0;
      int more = 0;
      for (std::size_t i = 0; i < bits.size(); ++i) {
        if (choice >> i & 1u) {
          features |= bits[i];
          more += bits[i] != Shaders::Lit && bits[i] != Shaders::Label;
        }
      }
      for (const unsigned lights : LightCounts) {
        if (Together(features, lights, code != nullptr)) {
          this->Add(name, features | lights << Shaders::LightShift, {}, code,
                    more <= 1 && lights <= 1);
        }
      }
    }
  }

  void AddClipmaps();
  void AddScreens();
  void AddSunMasks();
  void AddStars();
  void AddTrajectories();
  void AddBodies();
  void AddExample();
  void AddBenchmark();

  void AddEverything() {
    this->AddSurfaces("surface", nullptr);
    this->AddPhotometry("surface", nullptr);
    for (const auto& code : {ShaderCode(), UsersCode()}) {
      this->AddSurfaces("surface with code", &code);
      this->AddPhotometry("surface with code", &code);
    }
    this->AddClipmaps();
    this->AddScreens();
    this->AddSunMasks();
    this->AddStars();
    this->AddTrajectories();
    this->AddBodies();
    this->AddExample();
    this->AddBenchmark();
  }

  static ShaderCode UsersCode() {
    using Stage = ShaderReplacement::Stage;
    ShaderCode code;
    code.replacements = {
        {Stage::Vertex, "//VTK::Normal::Dec", true,
         "//VTK::Normal::Dec\nout vec3 ours;\nuniform float wave;\n", true},
        {Stage::Vertex, "//VTK::PositionVC::Impl", true,
         "  vertexMC.z += wave;\n  ours = vertexMC.xyz;\n//VTK::PositionVC::Impl\n", true},
        {Stage::Fragment, "//VTK::Normal::Dec", true, "//VTK::Normal::Dec\nin vec3 ours;\n", true},
        {Stage::Fragment, "//VTK::Color::Impl", true,
         "//VTK::Color::Impl\n  diffuseColor = abs(ours) * tints[1] * lightColor0;\n", true}};
    code.uniforms = {{"wave", ShaderUniform::Kind::Float, 1, {0.5}},
                     {"tints", ShaderUniform::Kind::Vector3, 2, {1, 0, 0, 0, 1, 0}}};
    return code;
  }
};

struct Named {
  std::string name;
  std::string defines;
};

// What the style adds, by ClipmapUniforms, and what ClipmapDrawer and LayerDrawing add beside it.
std::vector<Named> ClipmapLooks(const PostPlacement& placement) {
  std::vector<Named> looks;
  const auto styled = [&](const std::string& name, const ClipmapStyle& style) {
    looks.push_back({name, ClipmapUniforms::Defines(placement, &style)});
  };
  ClipmapStyle all;
  styled("no style", all);
  for (const int count : {1, 2}) {
    ClipmapStyle style;
    style.details.resize(std::size_t(count));
    styled(std::to_string(count) + " details", style);
  }
  for (const auto by : {ClipmapStyle::Ramp::By::Height, ClipmapStyle::Ramp::By::Slope,
                        ClipmapStyle::Ramp::By::Aspect, ClipmapStyle::Ramp::By::Normal}) {
    ClipmapStyle style;
    style.ramp.emplace();
    style.ramp->by = by;
    styled("ramp " + std::to_string(int(by)), style);
    style.ramp->shaded = true;
    styled("shaded ramp " + std::to_string(int(by)), style);
  }
  ClipmapStyle levels;
  levels.levels = 0.5;
  styled("levels", levels);
  ClipmapStyle contours;
  contours.contours.emplace();
  styled("contours", contours);
  ClipmapStyle grid;
  grid.grid.emplace();
  styled("grid", grid);
  const std::vector<Named> beside = {
      {"holes", "#define DSPACE_HOLES\n"},
      {"tracks", "#define DSPACE_TRACKS\n"},
      {"ground of a body", "#define DSPACE_BRIGHTNESS\n"},
      {"paint", "#define DSPACE_LAYERS\n#define DSPACE_PAINT 0\n"},
      {"marks", "#define DSPACE_LAYERS\n#define DSPACE_MARKS 0\n"},
      {"layers", "#define DSPACE_LAYERS\n#define DSPACE_PAINT 0\n#define DSPACE_MARKS 16\n"},
      {"normals", "#define DSPACE_LAYER_NORMALS 0\n"},
      {"horizon", "#define DSPACE_HORIZON\n"}};
  std::string everything;
  const std::string plain = ClipmapUniforms::Defines(placement, &all);
  for (const Named& each : beside) {
    looks.push_back({each.name, plain + each.defines});
    everything += each.name == "paint" || each.name == "marks" ? "" : each.defines;
  }
  all.details.resize(2);
  all.ramp.emplace();
  all.ramp->by = ClipmapStyle::Ramp::By::Aspect;
  all.levels = 0.5;
  all.contours.emplace();
  all.grid.emplace();
  looks.push_back({"everything", ClipmapUniforms::Defines(placement, &all) + everything});
  return looks;
}

void Programs::AddClipmaps() {
  const BodyEllipsoid oblate(6378137.0, 6356752.3);
  const Eigen::Vector2d first(-180, 90);
  const Eigen::Vector2d step(0.1, -0.1);
  const std::vector<std::pair<std::string, PostPlacement>> placements = {
      {"plane", PostPlacement::OnPlane(Eigen::Affine2d::Identity())},
      {"sphere", PostPlacement::OnSphere(first, step, 1737400.0)},
      {"ellipsoid", PostPlacement::OnEllipsoid(first, step, oblate)},
      {"pole", PostPlacement::OnPole(false, 100.0, 512.0, 1737400.0)},
      {"ellipsoid's pole", PostPlacement::OnPole(true, 100.0, 512.0, oblate)}};
  const Shaders::Features lit = Shaders::Lit | 1u << Shaders::LightShift;
  const Shaders::Features bright =
      Shaders::Lit | Shaders::Specular | Shaders::PlacedLights | 3u << Shaders::LightShift;
  for (const auto& [name, placement] : placements) {
    const bool pole = placement.GetKind() == PostPlacement::Kind::Pole;
    const std::string called = "clipmap of a " + name;
    ShaderPages bare;
    bare.vertex = ClipmapVertexShader(placement.GetKind());
    bare.defines = ClipmapUniforms::Defines(placement, nullptr);
    for (const char* holes : {"", "#define DSPACE_HOLES\n"}) {
      ShaderPages pages = bare;
      pages.defines += holes;
      for (const Shaders::Features features :
           {Shaders::Features(0), lit, bright, Shaders::Features(Shaders::Label)}) {
        this->Add(called, features, pages, nullptr, !*holes);
        if (features != Shaders::Label) {
          this->Add(called, features | Shaders::Texture, pages, nullptr, false);
        }
      }
    }
    for (const Named& look : ClipmapLooks(placement)) {
      ShaderPages pages = bare;
      pages.fragment = ClipmapFragmentFunctions();
      for (const char* texture : {"", "#define DSPACE_POLE_TEXTURE\n"}) {
        if (*texture && !pole) {
          continue;
        }
        pages.defines = look.defines + texture;
        for (const Shaders::Features features :
             {Shaders::Features(0), lit, bright, lit | 4u << Shaders::CascadeShift,
              lit | 4u << Shaders::CascadeShift | 2u << Shaders::GroundShift}) {
          if (!(features & Shaders::Lit) &&
              (pages.defines.find("DSPACE_LAYER_NORMALS") != std::string::npos ||
               pages.defines.find("DSPACE_HORIZON") != std::string::npos)) {
            continue; // ClipmapDrawer asks for normals and horizons where there is light
          }
          this->Add(called + ", " + look.name, features | Shaders::Mixed, pages, nullptr,
                    look.name == "everything");
        }
      }
    }
  }
}

// Complete fragment shaders of files go with Screen.vert, as SurfaceShaders::Screen joins them.
void Programs::AddScreens() {
  const fs::path folder = fs::path(DSPACE_SOURCES) / "Libraries/Core/Shaders";
  const std::string vertex = TextOf(folder / "Screen.vert.glsl");
  const std::string marker = "//DSPACE::Defines";
  for (const fs::path& path : ShaderFiles()) {
    const std::string name = path.filename().string();
    const std::string text = TextOf(path);
    if (path.parent_path() != folder || name.find(".frag.glsl") == std::string::npos ||
        text.rfind("#version", 0) != 0 || name == "Surface.frag.glsl" ||
        name == "Label.frag.glsl" || name == "Coded.frag.glsl" || name == "Star.frag.glsl" ||
        name.rfind("Trajectory", 0) == 0 || name.rfind("Body", 0) == 0 ||
        name == "Plane.frag.glsl" || name == "SunMask.frag.glsl") {
      continue;
    }
    EXPECT_EQ(text.rfind("#version 330 core\n" + marker, 0), 0u) << name;
    const std::string numbers = "#define DSPACE_SAMPLES 3\n#define DSPACE_GRID 256\n"
                                "#define DSPACE_ALPHA 0.0\n";
    for (const char* more : {"", "#define DSPACE_OVER\n", "#define DSPACE_UNKNOWN\n"}) {
      std::string with = text;
      const std::string tone = "//DSPACE::Tone";
      if (with.find(tone) != std::string::npos) {
        with.replace(with.find(tone), tone.size(), TextOf(folder / "Tone.glsl"));
      }
      with.replace(with.find(marker), marker.size(), numbers + more);
      if (*more && text.find(std::string(more, 8, std::strlen(more) - 9)) == std::string::npos) {
        continue;
      }
      this->validator.Add(name + " " + more, vertex, with, true);
      ++this->count;
    }
  }
}

void Programs::AddSunMasks() {
  for (const unsigned maps : {1u, 4u, 8u}) {
    for (const unsigned grounds : {0u, 1u, 3u}) {
      const Shaders::Sources made = Shaders::SunMaskSources(
          Shaders::Lit | maps << Shaders::CascadeShift | grounds << Shaders::GroundShift);
      this->validator.Add("mask of the Sun", made.vertex, made.fragment, true);
      ++this->count;
    }
  }
  this->Add("planes for it", Shaders::Planes | Shaders::Lit, {}, nullptr, true);
}

void Programs::AddExample() {
  const fs::path folder = fs::path(DSPACE_SOURCES) / "Examples/own_object";
  const std::string vertex = TextOf(folder / "sail.vert.glsl");
  const std::string fragment = TextOf(folder / "sail.frag.glsl");
  ShaderPages pages;
  pages.vertex = vertex.c_str();
  this->Add("sail", Shaders::Label, pages, nullptr, true);
  pages.fragment = fragment.c_str();
  for (const unsigned lights : LightCounts) {
    this->Add("sail", Shaders::Lit | Shaders::Mixed | lights << Shaders::LightShift, pages, nullptr,
              true);
  }
}

// As BodyDrawer asks for them.
void Programs::AddBodies() {
  const fs::path folder = fs::path(DSPACE_SOURCES) / "Libraries/Core/Shaders";
  const std::string vertex = TextOf(folder / "Body.vert.glsl");
  const std::string rays = TextOf(folder / "BodyRays.glsl");
  const std::string surface = TextOf(folder / "Body.frag.glsl");
  const std::string air = TextOf(folder / "BodyAir.frag.glsl");
  const std::string ring = TextOf(folder / "BodyRing.frag.glsl");
  ShaderPages pages;
  pages.vertex = vertex.c_str();
  pages.fragment = rays.c_str();
  pages.whole = surface.c_str();
  const Shaders::Features lit = Shaders::Lit | 1u << Shaders::LightShift;
  const Shaders::Features placed = lit | Shaders::SunPlace;
  for (const char* disc :
       {"", "#define DSPACE_DISC 12\n", "#define DSPACE_DISC 16\n#define DSPACE_SPREAD\n"}) {
    pages.defines = disc;
    for (const Shaders::Features features :
         {Shaders::Features(0), lit, placed, placed | Shaders::Eclipses,
          Shaders::Features(Shaders::Label), lit | Shaders::DiscLights, lit | Shaders::PlacedLights,
          Shaders::Features(Shaders::DisplayColor),
          placed | Shaders::Texture | 3u << Shaders::ReflectanceShift}) {
      this->Add("body", features, pages, nullptr, true);
    }
  }
  pages.defines.clear();
  for (const Shaders::Features features :
       {Shaders::Angles | Shaders::Lit, Shaders::Angles | Shaders::Lit | Shaders::Eclipses,
        Shaders::Features(Shaders::Angles)}) {
    this->Add("body", features, pages, nullptr, true);
  }
  this->Add("body", lit | 4u << Shaders::CascadeShift, pages, nullptr, true);
  this->Add("surface", placed | Shaders::Eclipses, {}, nullptr, true);
  this->Add("surface", Shaders::Angles | Shaders::Lit | Shaders::Eclipses, {}, nullptr, true);
  for (const Shaders::Features features :
       {Shaders::Features(0), Shaders::Features(Shaders::Eclipses)}) {
    pages.whole = air.c_str();
    pages.defines = "#define DSPACE_AIR_STEPS 24\n";
    this->Add("air", features, pages, nullptr, true);
    pages.whole = ring.c_str();
    pages.defines = "#define DSPACE_RINGS 16\n";
    this->Add("rings", features, pages, nullptr, true);
  }
}

void Programs::AddStars() {
  const fs::path folder = fs::path(DSPACE_SOURCES) / "Libraries/Core/Shaders";
  this->validator.Add("Star", TextOf(folder / "Star.vert.glsl"), TextOf(folder / "Star.frag.glsl"),
                      true);
  ++this->count;
}

void Programs::AddTrajectories() {
  const fs::path benchmark = fs::path(DSPACE_SOURCES) / "Testing/Benchmarks/Shaders";
  this->validator.Add("BareLine", TextOf(benchmark / "BareLine.vert.glsl"),
                      TextOf(benchmark / "BareLine.frag.glsl"), true);
  ++this->count;
  const fs::path folder = fs::path(DSPACE_SOURCES) / "Libraries/Core/Shaders";
  for (const char* name : {"TrajectoryPlain", "TrajectoryTimed", "TrajectoryLabel"}) {
    this->validator.Add(name, TextOf(folder / "TrajectoryLine.vert.glsl"),
                        TextOf(folder / (std::string(name) + ".frag.glsl")), true);
    ++this->count;
  }
}

// Of OpenSceneGraph, whose ground is drawn with OpenGL 2's fixed functions: no core profile.
void Programs::AddBenchmark() {
  const fs::path folder = fs::path(DSPACE_SOURCES) / "Testing/Benchmarks/Shaders";
  this->validator.Add("OsgGround", TextOf(folder / "OsgGround.vert.glsl"),
                      TextOf(folder / "OsgGround.frag.glsl"), true);
  ++this->count;
}

// Made once for all cases.
Programs& Everything() {
  static Programs programs;
  if (programs.count == 0) {
    programs.AddEverything();
  }
  return programs;
}

// Names of macros after `directive`.
std::set<std::string> Macros(const std::string& text, const std::regex& directive) {
  static const std::regex word("DSPACE_[A-Z0-9_]+");
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, directive)) {
      for (std::sregex_iterator at(line.begin(), line.end(), word), end; at != end; ++at) {
        names.insert(at->str());
      }
    }
  }
  return names;
}

} // namespace

TEST(ShaderSources, EveryProgramIsValid) {
  if (!testing::ShaderValidator::Installed()) {
    DSPACE_MISSING_PACKAGE("glslang-tools");
  }
  Programs& programs = Everything();
  EXPECT_EQ(programs.validator.Check(), "");
  std::cout << programs.count << " programs, " << programs.validator.Texts().size()
            << " different shaders, " << programs.validator.Links() << " programs linked\n";
}

// A new file or macro of shaders that this test does not reach is an error here.
TEST(ShaderSources, EveryFileAndFeatureIsAmongThem) {
  Programs& programs = Everything();
  std::string corpus;
  for (const auto& text : programs.validator.Texts()) {
    corpus += text.first;
  }
  std::set<std::string> lines;
  std::istringstream stream(corpus);
  for (std::string line; std::getline(stream, line);) {
    lines.insert(line);
  }
  std::string all;
  for (const fs::path& path : ShaderFiles()) {
    const std::string text = TextOf(path);
    all += text;
    // Its longest line of code stands for it.
    std::string longest;
    std::istringstream own(text);
    for (std::string line; std::getline(own, line);) {
      if (line.size() > longest.size() && line.find("//") == std::string::npos &&
          line.find("{N}") == std::string::npos) {
        longest = line;
      }
    }
    EXPECT_TRUE(lines.count(longest)) << path << " is in no program: " << longest;
  }
  const std::set<std::string> asked = Macros(all, std::regex("^\\s*#\\s*(if|elif)"));
  const std::set<std::string> defined = Macros(corpus, std::regex("^\\s*#\\s*define"));
  EXPECT_GE(asked.size(), 20u);
  for (const std::string& name : asked) {
    EXPECT_TRUE(defined.count(name)) << name << " is defined in no program of this test";
  }
}

TEST(ShaderSources, InvalidProgramsAreFound) {
  if (!testing::ShaderValidator::Installed()) {
    DSPACE_MISSING_PACKAGE("glslang-tools");
  }
  const std::string head = "#version 330 core\n";
  const std::string vertex =
      head + "out vec2 place;\nvoid main() { place = vec2(0.0); gl_Position = vec4(0.0); }\n";
  const auto errors = [&](const std::string& fragment) {
    testing::ShaderValidator validator;
    validator.Add("broken", vertex, head + fragment, true);
    return validator.Check();
  };
  const std::string out = "layout(location = 0) out vec4 color;\n";
  EXPECT_EQ(errors(out + "in vec2 place;\nvoid main() { color = place.xyxy; }\n"), "");
  for (const std::string& wrong :
       {out + "void main() { color = vec4(nothing); }\n", // not declared
        out + "void main() { color = gl_Color; }\n",      // of the compatibility profile
        out + "void main() { color = vec4(1 % 2.0); }\n", // float modulo
        out + "in vec3 place;\nvoid main() { color = place.xyzx; }\n",         // linked: types
        out + "float f(float x);\nvoid main() { color = vec4(f(1.0)); }\n"}) { // linked: no body
    const std::string found = errors(wrong);
    EXPECT_NE(found.find("broken"), std::string::npos) << wrong;
    EXPECT_NE(found.find("ERROR"), std::string::npos) << wrong;
  }
}

} // namespace dspace
