// One view's drawing of a terrain's layers: of its colours, or of its normals.
#ifndef DSPACE_LAYERS_LAYERDRAWING_H
#define DSPACE_LAYERS_LAYERDRAWING_H

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/VisibleTiles.h>
#include <dspace/clipmap/gl/LayerAtlas.h>
#include <dspace/render/CustomDrawer.h>

namespace dspace {

// Every function needs the view's context to be current.
class LayerDrawing {
public:
  LayerDrawing(const ClipmapTerrain& terrain, LayerContent content)
      : Terrain_(terrain), Content_(content) {}

  // Brings what the view sees of a chart, without what its filter hides. `styled`: the terrain's
  // style lies between the layers and the marks. False where some of it is not there yet; waits
  // with view.complete, and throws then what ColorTiles::Get throws.
  bool Prepare(const CustomDrawing& drawing, bool styled, std::size_t chart,
               const ClipmapLevels& levels, const ClipmapLevels::State& state,
               const ClipmapViewVolume& sight, const std::array<double, 2>& heights);
  // Whether there is something to draw.
  bool Shown() const { return !this->Planes_.empty(); }
  // Definitions for ClipmapLayers.frag.glsl and the vertex shaders; none where nothing is drawn.
  std::string Defines() const;

  // For all levels, then for one: `first` is its window's first post, `step` how many level-0 posts
  // are between two of its.
  void SetLook(vtkShaderProgram* program, int samples) const;
  void SetLevel(vtkShaderProgram* program, const Eigen::Vector2d& first, double step) const;

private:
  // What a uniform is called: "layerZoom", "normalsZoom".
  std::string Named(const char* name) const {
    return (this->Content_ == LayerContent::Normals ? "normals" : "layer") + std::string(name);
  }

  const ClipmapTerrain& Terrain_;
  LayerContent Content_;
  std::unique_ptr<LayerAtlas> Atlas_;
  int Slots_ = 0; // that it was asked for
  // Of the latest Prepare().
  std::vector<LayerChoice> Planes_;
  const ColorGrid* Grid_ = nullptr;
  int Finest_ = 0;
  Eigen::Vector2d Corner_ = Eigen::Vector2d::Zero(); // of the tile below the camera [tiles]
  Eigen::Vector2d Place_ = Eigen::Vector2d::Zero();  // below the camera [posts]
};

} // namespace dspace

#endif
