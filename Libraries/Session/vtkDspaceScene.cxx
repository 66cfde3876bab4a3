#include "vtkDspaceScene.h"

#include <algorithm>
#include <map>

#include "vtkActorCollection.h"
#include "vtkDspaceActors.h"
#include "vtkDspaceFrame.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkTransform.h"

#include <dspace/Error.h>

vtkStandardNewMacro(vtkDspaceScene);

struct vtkDspaceScene::Internals {
  std::shared_ptr<dspace::Scene> scene;
  std::map<dspace::FrameId, vtkSmartPointer<vtkDspaceFrame>> frames;
  dspace::FrameNotifier::Token token = 0;
  Ground ground;
  std::map<std::string, vtkSmartPointer<vtkDspaceActors>> actors; // by fragment

  void SetPose(vtkDspaceFrame* frame, vtkTransform* transform) const {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m =
        this->scene->Frames().LocalPose(frame->GetId()).Matrix();
    transform->SetMatrix(m.data());
  }
};

vtkDspaceScene::vtkDspaceScene() : Impl(new Internals) {}

vtkDspaceScene::~vtkDspaceScene() {
  if (this->Impl->scene) {
    this->Impl->scene->Frames().RemoveListener(this->Impl->token);
  }
}

vtkActorCollection* vtkDspaceScene::GetActors(const std::string& fragment) {
  vtkSmartPointer<vtkDspaceActors>& actors = this->Impl->actors[fragment];
  if (!actors) {
    constexpr int StandardTriangles = 200000;
    actors.TakeReference(this->MakeActors(fragment, StandardTriangles));
  }
  actors->Update();
  return actors->GetActors();
}

vtkDspaceActors* vtkDspaceScene::MakeActors(const std::string& fragment, int triangleBudget) {
  vtkDspaceActors* made = vtkDspaceActors::New();
  const Ground& ground = this->Impl->ground;
  vtkDspaceActors::Terrains terrains;
  if (ground) {
    terrains = [ground, triangleBudget](const dspace::GraphicsObject& object) {
      return ground(object, static_cast<std::size_t>(std::max(1, triangleBudget)));
    };
  }
  made->SetSource(this, this->Impl->scene, fragment, std::move(terrains));
  made->Update();
  return made;
}

void vtkDspaceScene::SetScene(std::shared_ptr<dspace::Scene> scene, Ground ground) {
  this->Impl->scene = std::move(scene);
  this->Impl->ground = std::move(ground);
  Internals& impl = *this->Impl;
  impl.token = impl.scene->Frames().AddListener([this, &impl](const dspace::FrameEvent& event) {
    for (const dspace::FrameId id : event.ids) {
      const auto found = impl.frames.find(id);
      if (found == impl.frames.end()) {
        continue;
      }
      vtkDspaceFrame* frame = found->second;
      if (!impl.scene->Frames().Contains(id)) {
        frame->Alive = false;
        impl.frames.erase(found);
        continue;
      }
      if (event.type == dspace::FrameEvent::Type::Reparented) {
        frame->Transform->SetInput(
            this->GetFrame(static_cast<unsigned long long>(impl.scene->Frames().Parent(id)))
                ->Transform);
      }
      impl.SetPose(frame, frame->Transform);
    }
  });
}

bool vtkDspaceScene::Mirrors(const dspace::Scene& scene) const {
  return this->Impl->scene.get() == &scene;
}

std::string vtkDspaceScene::GetName() {
  return this->Impl->scene ? this->Impl->scene->Name() : std::string();
}

vtkDspaceFrame* vtkDspaceScene::GetFrame(unsigned long long id) {
  Internals& impl = *this->Impl;
  const auto found = impl.frames.find(id);
  if (found != impl.frames.end()) {
    return found->second;
  }
  if (!impl.scene || !impl.scene->Frames().Contains(id)) {
    return nullptr;
  }
  vtkSmartPointer<vtkDspaceFrame> frame = vtkSmartPointer<vtkDspaceFrame>::New();
  frame->Id = id;
  const dspace::FrameId parent = impl.scene->Frames().Parent(id);
  if (parent != dspace::NoFrame) {
    frame->Transform->SetInput(this->GetFrame(static_cast<unsigned long long>(parent))->Transform);
  }
  impl.SetPose(frame, frame->Transform);
  impl.frames[id] = frame;
  return frame;
}

vtkDspaceFrame* vtkDspaceScene::GetFrame(const std::string& path) {
  if (!this->Impl->scene) {
    return nullptr;
  }
  try {
    return this->GetFrame(static_cast<unsigned long long>(this->Impl->scene->Frames().Find(path)));
  } catch (const dspace::Error&) {
    return nullptr;
  }
}

void vtkDspaceScene::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Name: " << this->GetName() << "\n"
     << indent << "Mirrored frames: " << this->Impl->frames.size() << "\n";
}
