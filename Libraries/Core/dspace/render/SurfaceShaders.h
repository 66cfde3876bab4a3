// The shader programs of surfaces, by feature, and the uniforms that all of them share.
#ifndef DSPACE_RENDER_SURFACE_SHADERS_H
#define DSPACE_RENDER_SURFACE_SHADERS_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <dspace/render/DrawList.h>

class vtkDspaceHubWindow;
class vtkShaderProgram;

namespace dspace {

// Texture units above those that VTK hands out.
constexpr int ShadowUnit = 8; // and 9: CasterTiles
constexpr int NormalUnit = 10;
constexpr int TerrainUnit = 11; // and 12
constexpr int ColorUnit = 13;
constexpr int OpaqueDepthUnit = 14;
constexpr int PeeledDepthUnit = 15;

// Pages of a geometry's own: the vertex shader in place of Instance.vert, and functions that the
// fragment shader uses. The pointers tell pages apart: they are those of static strings.
struct ShaderPages {
  const char* vertex = nullptr;   // null: Instance.vert
  const char* fragment = nullptr; // null: none
  std::string defines;            // whole lines
  // A fragment shader in place of Surface.frag and Label.frag, with the same markers. Null: none.
  const char* whole = nullptr;
};

class SurfaceShaders {
public:
  static constexpr int MaximumLights = 8;
  static constexpr int MaximumEclipsing = 8; // bodies: those that look largest

  using Features = std::uint64_t; // a sum of what follows
  static constexpr Features Lit = 1;
  static constexpr Features Texture = 2;
  static constexpr Features VertexColor = 4;
  static constexpr Features Billboard = 8;
  static constexpr Features Peel = 16;
  static constexpr Features Label = 32;
  static constexpr Features Emissive = 64;
  static constexpr Features Specular = 128;
  static constexpr Features PlacedLights = 256; // some light is not directional
  static constexpr Features Mixed =
      512; // a function mixedColor() of the pages stands for the texture
  static constexpr Features Normals = 1024; // of objects with shader code: the mesh has normals
  static constexpr Features Flat = 2048; // of objects with shader code: triangles without normals
  static constexpr Features NormalMap = 4096;     // a texture of normals, with Lit
  static constexpr Features ObjectNormals = 8192; // one in the mesh's own axes, with opacity
  static constexpr Features DiscLights =
      16384; // the disc of some light but the Sun is so wide that it sets slowly
  static constexpr Features SunPlace = 32768;   // the Sun is a body of the scene, at a place
  static constexpr Features LitMask = 1u << 27; // SunMask() has what the shadow maps say
  static constexpr Features Angles =
      1u << 28; // photometric angles in place of the colour; with Lit where it is lit
  static constexpr Features DisplayColor =
      1u << 29; // the colour is a display value in a picture that is exposed later
  static constexpr Features Eclipses = Features(1) << 32; // bodies may hide the Sun, with SunPlace
  static constexpr Features Planes =
      Features(1) << 33; // with Lit alone: what SunMask() reads, in place of the colour
  static constexpr unsigned LightShift = 16;       // above the features: the number of lights,
  static constexpr unsigned CascadeShift = 20;     // of the Sun's shadow maps,
  static constexpr unsigned ReflectanceShift = 24; // the photometric model, 3 bits,
  static constexpr unsigned GroundShift = 30;      // and the layers of maps of ground, 2 bits

  explicit SurfaceShaders(vtkDspaceHubWindow* window) : Window_(window) {}

  // The features that the list's lights and the view's shadows require of a lit surface's program.
  static Features LightFeatures(const DrawList& list, const DrawView& view);

  // Those of a surface that is lit or not by the view's shadows alone, without lights.
  static Features ShadowFeatures(const DrawView& view);

  // Those of a surface on which the view's maps throw no shadow.
  static Features WithoutMaps(Features features) {
    return WithoutGrounds(features) & ~(Features(15) << CascadeShift);
  }
  // Those of a surface that takes what the maps say from SunMask().
  static Features Masked(Features features) { return WithoutMaps(features) | LitMask; }
  // Those of ground on which no other ground throws a shadow.
  static Features WithoutGrounds(Features features) {
    return features & ~(Features(3) << GroundShift);
  }

  // Those of photometric angles; lit ones with the part of the Sun's disc that shadows and bodies
  // leave.
  static Features AngleFeatures(const DrawList& list, const DrawView& view, bool lit);

  // The feature of a lit surface's photometric model; 0: that of the default, or of Lambert.
  static Features ReflectanceFeature(const Reflectance& reflectance);
  // Sets its parameters in a program with this feature.
  static void SetReflectance(vtkShaderProgram* program, const Reflectance& reflectance);

  // The features that a mesh's program has for shader code, lit or not.
  static Features CodeFeatures(const Mesh& mesh, bool textured);

  // The text of a surface's program. `code`: of the object (CodedShaders.h); null: none.
  struct Sources {
    std::string vertex;
    std::string fragment;
  };
  static Sources SourcesFor(Features features, const ShaderPages& pages, const ShaderCode* code);

  // Ready to draw with. Throws Error(Internal) when the driver rejects it.
  vtkShaderProgram* Surface(Features features, const ShaderPages& pages = {},
                            const std::shared_ptr<const ShaderCode>& code = nullptr);
  // Of two pages that are no surface's; they are told apart as those of ShaderPages.
  vtkShaderProgram* Program(const char* vertex, const char* fragment);
  vtkShaderProgram* Screen(const char* fragment, const std::string& defines = "");

  // How much of the Sun's disc is seen, by the view's maps, from what was drawn with Planes into a
  // texture of the view's size.
  vtkShaderProgram* SunMask(const DrawList& list, const DrawView& view, unsigned int planes);
  static Sources SunMaskSources(Features features);

  // Whether the uniforms of a program have the values of which `bytes` is an image, from the last
  // call with that program; else they are to be set now. All that sets them must ask.
  bool HasUniforms(vtkShaderProgram* program, const void* bytes, std::size_t size);

  // Projection, lights and what else is the same for everything in one picture.
  void SetView(vtkShaderProgram* program, const DrawList& list, const DrawView& view, int samples,
               bool firstLayer = false);
  // Replaces the bodies that SetView() set (feature Eclipses): those of `bodies`, at most
  // MaximumEclipsing, and the Sun, in other axes: `X` takes view axes to them.
  static void SetEclipses(vtkShaderProgram* program, const std::vector<DrawBody>& bodies,
                          const DrawBody& sun, const Eigen::Affine3d& X);
  // The view's shadow maps and their tiles (ShadowMaps), OpenGL texture arrays.
  void SetShadowMaps(unsigned int maps, unsigned int tiles) {
    this->ShadowMaps_ = maps;
    this->ShadowTiles_ = tiles;
  }
  // What SunMask() drew; an OpenGL texture.
  void SetLitMask(unsigned int mask) { this->LitMask_ = mask; }
  void Release();

private:
  void SetShadows(vtkShaderProgram* program, const CascadeFit& fit) const;

  vtkDspaceHubWindow* Window_;
  unsigned int ShadowMaps_ = 0;
  unsigned int ShadowTiles_ = 0;
  unsigned int LitMask_ = 0;
  std::map<Features, vtkShaderProgram*> SunMasks_; // by features
  std::map<std::tuple<Features, const char*, const char*, const char*, std::string>,
           vtkShaderProgram*>
      Surfaces_;
  // By the code, which is kept, so that its address is not used again.
  struct Coded {
    std::shared_ptr<const ShaderCode> code;
    std::map<Features, vtkShaderProgram*> programs; // by features
  };
  std::map<const ShaderCode*, Coded> Coded_;
  std::map<std::pair<const char*, std::string>, vtkShaderProgram*> Screens_;
  std::map<std::pair<const char*, const char*>, vtkShaderProgram*> Programs_;
  std::map<vtkShaderProgram*, std::vector<unsigned char>> Uniforms_; // HasUniforms()
};

// Binds `name` to a texture unit of the window's state.
void BindTextureUnit(vtkDspaceHubWindow* window, int unit, unsigned int target, unsigned int name);

} // namespace dspace

#endif
