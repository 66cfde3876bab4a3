// Draws a TrajectoryLine with OpenGL.
#ifndef DSPACE_RENDER_TRAJECTORY_DRAWER_H
#define DSPACE_RENDER_TRAJECTORY_DRAWER_H

#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/render/CustomDrawer.h>
#include <dspace/scene/trajectories/TrajectoryLine.h>

class vtkShaderProgram;

namespace dspace {

class CustomDrawers;

// From now on the context with these drawers draws trajectories. Any number of calls.
void RegisterTrajectoryDrawer(CustomDrawers& drawers);

// One line strip for each part of the trajectory, of the object's line width. What is translucent
// is blended over the opaque picture; in pictures that are exposed later, opacity is the share of
// samples that are drawn. Lines throw no shadows.
class TrajectoryDrawer : public CustomDrawer {
public:
  explicit TrajectoryDrawer(std::shared_ptr<const TrajectoryLine> line) : Line_(std::move(line)) {}
  TrajectoryDrawer(const TrajectoryDrawer&) = delete;
  TrajectoryDrawer& operator=(const TrajectoryDrawer&) = delete;
  ~TrajectoryDrawer() override;

  bool Prepare(const CustomDrawing& drawing) override;
  double NearestDepth(const CustomDrawing& drawing) override;
  void DrawColor(const CustomDrawing& drawing) override;
  void DrawLabels(const CustomDrawing& drawing) override;
  bool AddTo(DrawKey&, const CustomDrawing&) override { return true; } // lines throw no shadow
  void DrawTranslucent(const CustomDrawing& drawing, const RenderTarget& target) override;
  // The labels of ticks that are seen, of the longest intervals first, none over another.
  std::vector<Caption> Captions(const CustomDrawing& drawing, const RenderTarget& target) override;

private:
  struct Buffer {
    unsigned int array = 0;
    unsigned int vertices = 0;
  };
  void Upload(Buffer& buffer, const std::vector<TrajectoryLine::Strip>& strips, bool dynamic);
  void Draw(const CustomDrawing& drawing, const char* fragment, bool translucent);
  static void SetUniforms(const CustomDrawing& drawing, const TrajectoryLine& line,
                          vtkShaderProgram* program, const char* fragment, bool translucent);
  void DrawLines(const TrajectoryLine& line) const;

  std::weak_ptr<const TrajectoryLine> Line_; // the scene has it while it is drawn
  Buffer Whole_;
  Buffer Detail_;
  Buffer Ticks_;
  std::vector<int> Firsts_;    // of the strips, in Whole_
  std::uint64_t Uploaded_ = 0; // PointsRevision()
  int DetailCount_ = 0;
  double DetailTime_ = 0.0;
  bool DetailKnown_ = false;
};

} // namespace dspace

#endif
