#include "vtkDspaceActors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <dspace/render/VtkMirror.h>
#include <dspace/scene/LinearLight.h>
#include <dspace/scene/PartLook.h>

#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkDspaceFrame.h"
#include "vtkDspaceScene.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTexture.h"
#include "vtkTransform.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkWeakPointer.h"

vtkStandardNewMacro(vtkDspaceActors);

namespace {

using dspace::GraphicsObject;
using dspace::Image;
using dspace::Material;
using dspace::Mesh;
using dspace::Part;

double Display(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

unsigned char DisplayByte(double linear) {
  return static_cast<unsigned char>(std::lround(255.0 * std::clamp(Display(linear), 0.0, 1.0)));
}

vtkSmartPointer<vtkFloatArray> Floats(const char* name, const std::vector<float>& values, int n) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(n);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / n);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkCellArray> Cells(const std::vector<std::uint32_t>& indices, int corners) {
  vtkNew<vtkTypeInt64Array> offsets;
  vtkNew<vtkTypeInt64Array> connectivity;
  const auto count = static_cast<vtkIdType>(indices.size()) / corners;
  offsets->SetNumberOfValues(count + 1);
  for (vtkIdType i = 0; i <= count; ++i) {
    offsets->SetValue(i, i * corners);
  }
  connectivity->SetNumberOfValues(count * corners);
  std::copy_n(indices.begin(), count * corners, connectivity->GetPointer(0));
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

// Vertex colours multiply the material's, in linear light as in Dspace's pictures.
vtkSmartPointer<vtkPolyData> ToPolyData(const Mesh& mesh, const Material& look) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(Floats("Points", mesh.positions, 3));
  data->SetPoints(points);
  switch (mesh.primitive) {
  case Mesh::Primitive::Triangles:
    data->SetPolys(Cells(mesh.indices, 3));
    break;
  case Mesh::Primitive::Lines:
    data->SetLines(Cells(mesh.indices, 2));
    break;
  case Mesh::Primitive::Points:
    data->SetVerts(Cells(mesh.indices, 1));
    break;
  }
  if (!mesh.normals.empty()) {
    data->GetPointData()->SetNormals(Floats("Normals", mesh.normals, 3));
  }
  if (!mesh.tcoords.empty()) {
    data->GetPointData()->SetTCoords(Floats("TCoords", mesh.tcoords, 2));
  }
  if (!mesh.colors.empty()) {
    const auto own = dspace::LinearColor(look.color);
    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetName("Colors");
    colors->SetNumberOfComponents(4);
    colors->SetNumberOfTuples(static_cast<vtkIdType>(mesh.colors.size() / 4));
    for (std::size_t i = 0; i < mesh.colors.size(); ++i) {
      const std::size_t k = i % 4;
      colors->SetValue(static_cast<vtkIdType>(i),
                       k == 3
                           ? mesh.colors[i]
                           : DisplayByte(own[k] * dspace::LinearFromSrgb(mesh.colors[i] / 255.0)));
    }
    data->GetPointData()->SetScalars(colors);
  }
  return data;
}

// Multiplied by the material's colour in linear light.
vtkSmartPointer<vtkTexture> ToTexture(const Image& image, const std::array<double, 3>& color,
                                      bool repeat) {
  const auto own = dspace::LinearColor(color);
  std::array<std::array<unsigned char, 256>, 3> tables;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 256; ++i) {
      tables[k][i] = DisplayByte(own[k] * dspace::LinearFromSrgb(double(i) / 255.0));
    }
  }
  const bool alpha = image.channels % 2 == 0;
  const int channels = alpha ? 4 : 3;
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, channels);
  auto* to = static_cast<unsigned char*>(data->GetScalarPointer());
  for (int y = image.height - 1; y >= 0; --y) { // VTK's first row is the bottom one
    const std::uint8_t* from =
        &image.pixels[std::size_t(y) * std::size_t(image.width) * std::size_t(image.channels)];
    for (int x = 0; x < image.width; ++x, from += image.channels) {
      for (std::size_t k = 0; k < 3; ++k) {
        *to++ = tables[k][from[image.channels < 3 ? 0 : k]];
      }
      if (alpha) {
        *to++ = from[image.channels - 1];
      }
    }
  }
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(data);
  texture->SetInterpolate(true);
  texture->SetMipmap(true);
  texture->SetRepeat(repeat);
  texture->SetEdgeClamp(!repeat);
  return texture;
}

// The look of a part as VTK's property. `ambient`: of the scene, linear light.
void SetProperty(const GraphicsObject& object, const Material& look, bool wireframe,
                 const std::array<double, 3>& ambient, vtkProperty* property) {
  const auto own = dspace::LinearColor(look.color);
  const auto emissive = dspace::LinearColor(look.emissive);
  double diffuse[3];
  double base[3];
  for (int k = 0; k < 3; ++k) {
    const double tint = look.texture ? 1.0 : own[std::size_t(k)]; // the texture contains it
    const double light = emissive[std::size_t(k)];
    diffuse[k] = std::clamp(Display(look.lit ? tint : tint + light), 0.0, 1.0);
    base[k] = std::clamp(Display(light + tint * ambient[std::size_t(k)]), 0.0, 1.0);
  }
  property->SetLighting(look.lit);
  property->SetColor(diffuse);
  property->SetDiffuse(1.0);
  property->SetSpecular(0.0);
  property->SetAmbient(look.lit ? 1.0 : 0.0);
  property->SetAmbientColor(base);
  property->SetOpacity(look.opacity);
  property->SetRepresentation(wireframe ? VTK_WIREFRAME : VTK_SURFACE);
  property->SetLineWidth(static_cast<float>(object.lineWidth));
  property->SetPointSize(static_cast<float>(object.pointSize));
}

} // namespace

struct vtkDspaceActors::Internals {
  struct Item {
    vtkSmartPointer<vtkActor> actor;
    vtkSmartPointer<vtkTransform> transform;
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const Image> image;
    std::array<double, 3> color = {-1.0, -1.0, -1.0}; // that the texture or the scalars contain
    bool repeat = false;
  };
  using Key = std::pair<dspace::ObjectId, std::size_t>; // object, part
  struct Ground {
    std::weak_ptr<const void> source; // its geometry, or its first mesh
    std::vector<Part> parts;
  };

  vtkWeakPointer<vtkDspaceScene> frames;
  std::shared_ptr<dspace::Scene> scene;
  std::string fragment;
  Terrains terrains;
  std::map<Key, Item> items;
  std::map<dspace::ObjectId, Ground> grounds;
  vtkNew<vtkActorCollection> actors;
  std::vector<std::string> leftOut;
  std::string failure;
  std::uint64_t revision = 0;

  vtkWeakPointer<vtkRenderer> renderer; // which keeps this object by its observer
  unsigned long observer = 0;
  bool lights = true;
  bool earlierCreation = true; // of lights, by the renderer itself
  std::vector<vtkSmartPointer<vtkLight>> earlierLights;
  bool follows = false; // a camera
  std::string vantage;
  std::string camera;

  const std::vector<Part>& PartsOf(const GraphicsObject& object) {
    static const std::vector<Part> none;
    const std::vector<Part>& own = object.levels.empty() ? none : object.levels.front().parts;
    std::shared_ptr<const void> source = object.custom;
    if (!source && !own.empty()) {
      source = own.front().mesh;
    }
    if (!source) {
      return none;
    }
    Ground& ground = this->grounds[object.id];
    if (ground.source.lock() != source) {
      ground = {source, this->terrains ? this->terrains(object) : std::vector<Part>()};
    }
    return ground.parts.empty() ? own : ground.parts;
  }

  bool IsWanted(const GraphicsObject& object) const {
    return object.visible && this->scene->Fragments().Get(object.fragment).visible &&
           (this->fragment.empty() || object.fragment == this->fragment);
  }

  void Set(Item& item, const GraphicsObject& object, const Part& part,
           const std::array<double, 3>& ambient) {
    const Material look = dspace::LookOf(object, part);
    if (!item.actor) {
      item.actor = vtkSmartPointer<vtkActor>::New();
      item.actor->SetMapper(vtkSmartPointer<vtkPolyDataMapper>::New());
      item.transform = vtkSmartPointer<vtkTransform>::New();
      item.actor->SetUserTransform(item.transform);
    }
    const bool tinted = look.texture || !part.mesh->colors.empty();
    const bool sameColor = !tinted || item.color == look.color;
    if (item.mesh != part.mesh || !sameColor) {
      auto* mapper = vtkPolyDataMapper::SafeDownCast(item.actor->GetMapper());
      mapper->SetInputData(ToPolyData(*part.mesh, look));
      mapper->SetScalarVisibility(!part.mesh->colors.empty());
      item.mesh = part.mesh;
    }
    if (item.image != look.texture || !sameColor || item.repeat != look.repeatTexture) {
      item.actor->SetTexture(look.texture ? ToTexture(*look.texture,
                                                      part.mesh->colors.empty()
                                                          ? look.color
                                                          : std::array<double, 3>{1.0, 1.0, 1.0},
                                                      look.repeatTexture)
                                          : nullptr);
      item.image = look.texture;
      item.repeat = look.repeatTexture;
    }
    item.color = look.color;
    SetProperty(object, look, dspace::OverrideOf(object, part).wireframe.value_or(false), ambient,
                item.actor->GetProperty());
    item.actor->SetPickable(object.pickable);
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> X_FP = (object.X_FO * part.X_OP).matrix();
    vtkNew<vtkMatrix4x4> matrix;
    matrix->DeepCopy(X_FP.data());
    vtkTransform* frame =
        this->frames->GetFrame(static_cast<unsigned long long>(object.frame))->GetTransform();
    if (item.transform->GetInput() != frame) {
      item.transform->SetInput(frame);
    }
    vtkNew<vtkTransform> own;
    own->SetMatrix(matrix);
    item.transform->Identity();
    item.transform->Concatenate(own);
  }

  std::array<double, 3> Ambient() const {
    std::array<double, 3> sum = {0.0, 0.0, 0.0};
    for (const dspace::Light& light : this->scene->Fragments().Lights()) {
      if (light.enabled && light.kind == dspace::Light::Kind::Ambient) {
        const auto color = dspace::LinearColor(light.color);
        for (std::size_t k = 0; k < 3; ++k) {
          sum[k] += color[k] * light.intensity;
        }
      }
    }
    return sum;
  }

  void Rebuild() {
    std::set<Key> wanted;
    std::vector<std::string> missing;
    const std::array<double, 3> ambient = this->Ambient();
    for (const auto& [id, object] : this->scene->Objects()) {
      if (!this->IsWanted(object)) {
        continue;
      }
      const std::vector<Part>& parts = this->PartsOf(object);
      if (object.billboard || (object.custom && parts.empty())) {
        missing.push_back(object.name);
        continue;
      }
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!parts[i].mesh || parts[i].mesh->indices.empty() ||
            !dspace::IsPartVisible(object, parts[i])) {
          continue;
        }
        const Key key(id, i);
        wanted.insert(key);
        const bool fresh = this->items.count(key) == 0;
        Item& item = this->items[key];
        this->Set(item, object, parts[i], ambient);
        if (fresh) {
          this->actors->AddItem(item.actor);
          if (this->renderer) {
            this->renderer->AddActor(item.actor);
          }
        }
      }
    }
    for (auto it = this->items.begin(); it != this->items.end();) {
      it = wanted.count(it->first) != 0 ? std::next(it) : this->Remove(it);
    }
    this->leftOut = std::move(missing);
  }

  std::map<Key, Item>::iterator Remove(std::map<Key, Item>::iterator item) {
    this->actors->RemoveItem(item->second.actor);
    if (this->renderer) {
      this->renderer->RemoveActor(item->second.actor);
    }
    return this->items.erase(item);
  }

  void FollowCamera() {
    const dspace::CameraPose placed = this->scene->PlaceCamera(this->vantage, this->camera);
    dspace::DrawView view;
    view.camera = placed;
    view.projection = this->scene->Vantage(this->vantage).GetCamera(this->camera).projection;
    const int* size = this->renderer->GetSize();
    view.width = std::max(1, size[0]);
    view.height = std::max(1, size[1]);
    dspace::MirrorCamera(*this->scene, view, this->renderer);
    vtkCamera* camera = this->renderer->GetActiveCamera();
    if (!view.projection.nearDistance || !view.projection.farDistance) {
      this->renderer->ResetCameraClippingRange();
      double range[2];
      camera->GetClippingRange(range);
      dspace::Projection& projection = view.projection;
      projection.nearDistance = projection.nearDistance.value_or(range[0]);
      projection.farDistance =
          projection.farDistance.value_or(std::max(range[1], 2.0 * *projection.nearDistance));
    }
    // From reversed depth, 1 to 0, to VTK's, -1 to 1.
    Eigen::Matrix4d clip = view.projection.ClipFromView(view.width, view.height);
    clip.row(2) = clip.row(3) - 2.0 * clip.row(2);
    vtkNew<vtkMatrix4x4> matrix;
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = clip;
    matrix->DeepCopy(rows.data());
    camera->SetExplicitProjectionTransformMatrix(matrix);
  }
};

vtkDspaceActors::vtkDspaceActors() : Impl(new Internals) {}

vtkDspaceActors::~vtkDspaceActors() = default; // a renderer's observer keeps it: there is none

void vtkDspaceActors::SetSource(vtkDspaceScene* frames, std::shared_ptr<dspace::Scene> scene,
                                const std::string& fragment, Terrains terrains) {
  this->Impl->frames = frames;
  this->Impl->scene = std::move(scene);
  this->Impl->fragment = fragment;
  this->Impl->terrains = std::move(terrains);
}

vtkActorCollection* vtkDspaceActors::GetActors() {
  return this->Impl->actors;
}

std::string vtkDspaceActors::GetLeftOut() {
  std::string lines;
  for (const std::string& name : this->Impl->leftOut) {
    lines += (lines.empty() ? "" : "\n") + name;
  }
  return lines;
}

std::string vtkDspaceActors::GetFailure() {
  return this->Impl->failure;
}

void vtkDspaceActors::SetCamera(const std::string& vantage, const std::string& camera) {
  this->Impl->follows = true;
  this->Impl->vantage = vantage;
  this->Impl->camera = camera;
}

void vtkDspaceActors::SetLights(bool lights) {
  this->Impl->lights = lights;
}

void vtkDspaceActors::SetRenderer(vtkRenderer* renderer) {
  Internals& impl = *this->Impl;
  if (vtkRenderer* old = impl.renderer) {
    for (const auto& [key, item] : impl.items) {
      old->RemoveActor(item.actor);
    }
    if (impl.lights) {
      old->RemoveAllLights();
      for (const auto& light : impl.earlierLights) {
        old->AddLight(light);
      }
      old->SetAutomaticLightCreation(impl.earlierCreation);
    }
    impl.renderer = nullptr;
    const vtkSmartPointer<vtkDspaceActors> self = this; // the observer may be the last owner
    old->RemoveObserver(impl.observer);
  }
  impl.earlierLights.clear();
  if (!renderer) {
    return;
  }
  impl.renderer = renderer;
  for (const auto& [key, item] : impl.items) {
    renderer->AddActor(item.actor);
  }
  if (impl.lights) {
    vtkLightCollection* lights = renderer->GetLights();
    lights->InitTraversal();
    while (vtkLight* light = lights->GetNextItem()) {
      impl.earlierLights.emplace_back(light);
    }
    impl.earlierCreation = renderer->GetAutomaticLightCreation() != 0;
    renderer->AutomaticLightCreationOff();
  }
  // The renderer keeps this object until Release() or its own end.
  this->Register(nullptr);
  vtkNew<vtkCallbackCommand> drawing;
  drawing->SetClientData(this);
  drawing->SetCallback([](vtkObject*, unsigned long, void* self, void*) {
    static_cast<vtkDspaceActors*>(self)->Update();
  });
  drawing->SetClientDataDeleteCallback(
      [](void* self) { static_cast<vtkDspaceActors*>(self)->UnRegister(nullptr); });
  impl.observer = renderer->AddObserver(vtkCommand::StartEvent, drawing);
  this->Update();
}

void vtkDspaceActors::Update() {
  Internals& impl = *this->Impl;
  if (!impl.scene || !impl.frames) {
    return; // released, or the session has let the scene go
  }
  impl.failure.clear();
  try {
    const std::uint64_t revision = impl.scene->ContentRevision();
    if (impl.revision != revision) {
      impl.Rebuild();
      impl.revision = revision;
    }
    if (impl.renderer) {
      if (impl.lights) {
        dspace::MirrorLights(*impl.scene, impl.renderer);
      }
      if (impl.follows) {
        impl.FollowCamera();
      }
    }
  } catch (const std::exception& error) { // none may pass through VTK
    impl.failure = error.what();
  }
}

void vtkDspaceActors::Release() {
  const vtkSmartPointer<vtkDspaceActors> self = this;
  this->SetRenderer(nullptr);
  this->Impl->items.clear();
  this->Impl->grounds.clear();
  this->Impl->actors->RemoveAllItems();
  this->Impl->scene = nullptr;
  this->Impl->terrains = nullptr;
}

void vtkDspaceActors::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Actors: " << this->Impl->actors->GetNumberOfItems() << "\n"
     << indent << "Failure: " << this->Impl->failure << "\n";
}
