// Draws a ClipmapTerrain with OpenGL.
#ifndef DSPACE_TERRAIN_CLIPMAPDRAWER_H
#define DSPACE_TERRAIN_CLIPMAPDRAWER_H

#include <memory>
#include <vector>

#include <dspace/render/CustomDrawer.h>
#include <dspace/terrain/ClipmapIndices.h>
#include <dspace/terrain/ClipmapLevels.h>
#include <dspace/terrain/ClipmapTerrain.h>

class vtkShaderProgram;

namespace dspace {

// From now on scenes may hold a ClipmapTerrain. Any number of calls.
void RegisterClipmapDrawer();

// One layer of a texture array holds a level's posts; each level is drawn as a ring around the next
// finer one with indices that all levels share, in blocks that are left out where the view does not
// see them.
class ClipmapDrawer : public CustomDrawer {
public:
  explicit ClipmapDrawer(std::shared_ptr<const ClipmapTerrain> terrain);
  ~ClipmapDrawer() override;

  bool Prepare(const CustomDrawing& drawing) override;
  void DrawColor(const CustomDrawing& drawing) override;
  void DrawLabels(const CustomDrawing& drawing) override;

  const ClipmapLevels& Levels() const { return this->Levels_; }
  const ClipmapLevels::State& State() const { return this->State_; }
  unsigned int Texture() const { return this->Texture_; } // OpenGL's name, for tests

private:
  struct Placed; // the camera and the view's axes, in double precision
  Placed Place(const CustomDrawing& drawing) const;
  void Create();
  void Draw(const CustomDrawing& drawing, unsigned features);
  void SetLevel(vtkShaderProgram* program, const Placed& placed, int level, bool sphere) const;
  void SetGrid(vtkShaderProgram* program, const Eigen::Vector2d& firstPost, double step) const;
  Eigen::AlignedBox2d BlockPosts(int level, int column, int row) const;
  bool OutsideOnPlane(const std::vector<Eigen::Vector4d>& planes,
                      const Eigen::AlignedBox2d& block) const;
  bool HiddenOnBody(const Placed& placed, const std::vector<Eigen::Vector4d>& planes,
                    const Eigen::AlignedBox2d& block) const;
  void ChooseBlocks(const Placed& placed, const std::vector<Eigen::Vector4d>& planes, int level,
                    std::vector<ClipmapIndices::Run>& runs) const;

  std::shared_ptr<const ClipmapTerrain> Terrain_;
  ClipmapLevels Levels_;
  ClipmapIndices Indices_;
  ClipmapLevels::State State_;
  unsigned int Texture_ = 0;
  unsigned int VertexArray_ = 0;
  unsigned int VertexBuffer_ = 0;
  unsigned int IndexBuffer_ = 0;
};

} // namespace dspace

#endif
