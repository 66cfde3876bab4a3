// The shader programs of surfaces, by feature, and the uniforms that all of them share.
#ifndef DSPACE_RENDER_SURFACE_SHADERS_H
#define DSPACE_RENDER_SURFACE_SHADERS_H

#include <map>
#include <string>
#include <tuple>

#include <dspace/render/DrawList.h>

class vtkDspaceHubWindow;
class vtkShaderProgram;

namespace dspace {

// Texture units above those that VTK hands out.
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
};

class SurfaceShaders {
public:
  static constexpr int MaximumLights = 8;

  enum Feature : unsigned {
    Lit = 1,
    Texture = 2,
    VertexColor = 4,
    Billboard = 8,
    Peel = 16,
    Label = 32,
    Emissive = 64,
    Specular = 128,
    PlacedLights = 256, // some light is not directional
    Mixed = 512         // a function mixedColor() of the pages stands for the texture
  };
  static constexpr unsigned LightShift = 16; // above the features: the number of lights

  explicit SurfaceShaders(vtkDspaceHubWindow* window) : Window_(window) {}

  // The features that the list's lights require of a lit surface's program.
  static unsigned LightFeatures(const DrawList& list);

  // Ready to draw with. Throws Error(Internal) when the driver rejects it.
  vtkShaderProgram* Surface(unsigned features, const ShaderPages& pages = {});
  vtkShaderProgram* Screen(const char* fragment, const std::string& defines = "");

  // Projection, lights and what else is the same for everything in one picture.
  void SetView(vtkShaderProgram* program, const DrawList& list, const DrawView& view, int samples,
               bool firstLayer = false);
  void Release();

private:
  vtkDspaceHubWindow* Window_;
  std::map<std::tuple<unsigned, const char*, const char*, std::string>, vtkShaderProgram*>
      Surfaces_;
  std::map<std::pair<const char*, std::string>, vtkShaderProgram*> Screens_;
};

// Binds `name` to a texture unit of the window's state.
void BindTextureUnit(vtkDspaceHubWindow* window, int unit, unsigned int target, unsigned int name);

} // namespace dspace

#endif
