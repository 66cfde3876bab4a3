#include <dspace/commands/viewports/MeasuringPictures.h>

#include <utility>

#include <vtkSmartPointer.h>

#include <dspace/commands/viewports/ViewportCommands.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

constexpr const char* CameraName = "camera";

// A vantage of its own, removed at the end.
class OwnVantage {
public:
  explicit OwnVantage(std::shared_ptr<Scene> scene) : Scene_(std::move(scene)) {
    const std::vector<std::string> names = this->Scene_->VantageNames();
    const std::set<std::string> taken(names.begin(), names.end());
    this->Name_ = "measurement";
    while (taken.count(this->Name_)) {
      this->Name_ += "'";
    }
    this->Scene_->CreateVantage(this->Name_);
  }
  ~OwnVantage() { this->Scene_->RemoveVantage(this->Name_); }
  OwnVantage(const OwnVantage&) = delete;
  OwnVantage& operator=(const OwnVantage&) = delete;

  const std::string& Name() const { return this->Name_; }
  void Place(const Projection& projection, const Pose& X_RC) {
    Camera camera;
    camera.name = CameraName;
    camera.projection = projection;
    camera.mount.frame = RootFrame;
    camera.mount.X_FC = X_RC;
    this->Scene_->SetCamera(this->Name_, camera);
    this->Scene_->SetActiveCamera(this->Name_, CameraName);
  }

private:
  std::shared_ptr<Scene> Scene_;
  std::string Name_;
};

class ViewportSeries final : public PictureSeries {
public:
  ViewportSeries(vtkDspaceRenderContext* context, const std::shared_ptr<Scene>& scene, int width,
                 int height, std::set<std::string> hiddenFragments)
      : Vantage_(scene), Viewport_(vtkSmartPointer<vtkDspaceViewport>::New()) {
    this->Vantage_.Place({}, {});
    this->Viewport_->Initialize(context, scene, "measurement", this->Vantage_.Name(), width, height,
                                1);
    ViewLook look = this->Viewport_->GetLook();
    look.shadows.shown = false;
    this->Viewport_->SetLook(look);
    this->Request_.color = false;
    this->Request_.range = true;
    this->Request_.label = true;
    this->Request_.physicalOnly = true;
    this->Request_.hiddenFragments = std::move(hiddenFragments);
  }

  Picture Take(const Projection& projection, const Pose& X_RC) override {
    this->Vantage_.Place(projection, X_RC);
    Capture taken = this->Viewport_->GetCapture(this->Request_);
    return {taken.width, taken.height, std::move(taken.range), std::move(taken.label)};
  }

private:
  OwnVantage Vantage_; // outlives the viewport
  vtkSmartPointer<vtkDspaceViewport> Viewport_;
  CaptureRequest Request_;
};

} // namespace

std::unique_ptr<PictureSeries>
MeasuringPictures::Begin(const std::shared_ptr<Scene>& scene, int width, int height,
                         const std::set<std::string>& hiddenFragments) {
  return std::make_unique<ViewportSeries>(this->Viewports_.GetRenderContext(), scene, width, height,
                                          hiddenFragments);
}

} // namespace dspace::session
