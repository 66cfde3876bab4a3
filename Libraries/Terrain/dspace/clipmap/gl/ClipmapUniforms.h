// The uniforms of a clipmap's shaders. Not a public header.
#ifndef DSPACE_TERRAIN_CLIPMAPUNIFORMS_H
#define DSPACE_TERRAIN_CLIPMAPUNIFORMS_H

#include <string>

#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/render/CustomDrawer.h>
#include <dspace/render/SurfaceShaders.h>

class vtkShaderProgram;

namespace dspace {

// The camera over one chart of a terrain, in double precision.
struct ClipmapCamera {
  Eigen::Affine3d X_VS = Eigen::Affine3d::Identity(); // view axes from the terrain's frame
  Eigen::Vector3d position = Eigen::Vector3d::Zero(); // in the terrain's frame
  Eigen::Vector3d posts = Eigen::Vector3d::Zero();    // of it: column, row, height
  float mirrored = 1.0f; // 1 where triangles turn counter-clockwise seen from above

  ClipmapCamera(const Eigen::Affine3d& X_VS, const PostPlacement& placement);
};

// [m] of a level-0 cell at the lattice's nearest place.
double CellSizeNear(const PostPlacement& placement, const PostLattice& lattice,
                    const Eigen::Vector2d& post);

// How the ground reflects light: by its object, the body whose ground it is, or the terrain's own.
Reflectance ReflectanceOf(const DrawCustom& drawn, const Material& material);
// Factor on its colours in linear light: of the body whose ground it is, else 1.
double BrightnessOf(const DrawCustom& drawn);

class ClipmapUniforms {
public:
  // `style`: what of the terrain's style is drawn.
  ClipmapUniforms(vtkShaderProgram* program, const ClipmapTerrain& terrain,
                  const ClipmapStyle& style, const PostPlacement& placement,
                  const ClipmapLevels& levels, const ClipmapLevels::State& state,
                  const ClipmapCamera& camera)
      : Program_(program), Terrain_(terrain), Style_(style), Placement_(placement), Levels_(levels),
        State_(state), Camera_(camera) {}

  // Lines of definitions that the placement and the style ask of the shaders.
  static std::string Defines(const PostPlacement& placement, const ClipmapStyle* style);

  void SetLook(const DrawCustom& drawn, SurfaceShaders::Features features) const; // not for labels
  void SetStyle(const CustomDrawing& drawing) const;
  void SetPlacement() const; // the same for all levels
  void SetLevel(int level) const;

private:
  void SetDetails(const CustomDrawing& drawing) const;
  void SetExtent(int level, const Eigen::Vector2d& first) const;
  void SetMaps(int level, const Eigen::Vector2d& first) const;

  vtkShaderProgram* Program_;
  const ClipmapTerrain& Terrain_;
  const ClipmapStyle& Style_;
  const PostPlacement& Placement_;
  const ClipmapLevels& Levels_;
  const ClipmapLevels::State& State_;
  const ClipmapCamera& Camera_;
};

} // namespace dspace

#endif
