// Props of VTK in a scene: depth and labels against a sphere and against the same mesh of a scene,
// precision far from the root, fragments, removal, and what is rejected.
#include <cmath>

#include "RenderingTestSupport.h"

#include "vtkActor.h"
#include "vtkAssembly.h"
#include "vtkCellArray.h"
#include "vtkDspaceHubWindow.h"
#include "vtkFollower.h"
#include "vtkGlyph3DMapper.h"
#include "vtkImageSlice.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLActor.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTransform.h"
#include "vtkVolume.h"

#include <dspace/render/props/VtkPropDrawer.h>
#include <dspace/render/props/VtkPropGeometry.h>

namespace dspace {
namespace {

vtkSmartPointer<vtkPolyData> ToPolyData(const Mesh& mesh) {
  vtkNew<vtkPoints> points;
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    points->InsertNextPoint(&mesh.positions[i]);
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const vtkIdType corners[3] = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    cells->InsertNextCell(3, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

void SetMesh(vtkActor* actor, const Mesh& mesh) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(ToPolyData(mesh));
  actor->SetMapper(mapper);
}

// Counts what a window's context is asked to release.
class CountedActor : public vtkOpenGLActor {
public:
  static CountedActor* New();
  vtkTypeMacro(CountedActor, vtkOpenGLActor);
  void ReleaseGraphicsResources(vtkWindow* window) override {
    auto* hub = vtkDspaceHubWindow::SafeDownCast(window);
    this->Released += hub && hub->IsCurrent() ? 1 : 1000;
    this->Superclass::ReleaseGraphicsResources(window);
  }
  int Released = 0;
};
vtkStandardNewMacro(CountedActor);

struct VtkProps : RenderingFixture {
  VtkProps() {
    RegisterVtkPropDrawer(this->context->GetDrawers());
    this->Look({});
  }

  ObjectId Add(vtkProp3D* prop, const std::string& name, FrameId frame,
               const std::string& fragment = "physical") {
    GraphicsObject object;
    object.name = name;
    object.frame = frame;
    object.fragment = fragment;
    object.custom = std::make_shared<VtkPropGeometry>(prop, "object '" + name + "'");
    return this->scene->AddObject(object);
  }

  // Makes the actor a ball of radius 1, 6 m before the camera.
  ObjectId AddBall(vtkActor* actor, int segments, const std::string& fragment = "physical") {
    const FrameId place = this->scene->Frames().Create(RootFrame, "place");
    this->scene->Frames().SetLocalPose(place, At(6, 0, 0));
    SetMesh(actor, MakeSphere(1.0, segments));
    return this->Add(actor, "ball", place, fragment);
  }
};

std::string Rejection(vtkProp3D* prop) {
  try {
    const VtkPropGeometry made(prop, "object 'it'");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST_F(VtkProps, AnOpaqueSphereIsAsDeepAsTheExactOneFarFromTheRoot) {
  const FrameId far = scene->Frames().Create(RootFrame, "far");
  scene->Frames().SetLocalPose(far, At(1e8, -2e8, 3e7));
  const FrameId ball = scene->Frames().Create(far, "ball");
  const double range = 9.0;
  scene->Frames().SetLocalPose(ball, At(range, 0.3, -0.2));
  Look({}, far);
  vtkNew<vtkActor> actor;
  SetMesh(actor, MakeSphere(1.0, 512));
  const ObjectId id = Add(actor, "ball", ball);
  auto view = View(640, 480);
  CaptureRequest request;
  request.color = false;
  request.depth = request.label = true;
  const Capture capture = view->GetCapture(request);
  const Projection projection = scene->Vantage("main").ActiveCamera().projection;
  const Eigen::Vector3d center(-0.3, 0.2, range); // in the camera: X right, Y down, Z forward
  int compared = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      const Eigen::Vector3d ray = projection.PixelRay(x, y, 640, 480).direction.normalized();
      const double along = ray.dot(center);
      const double square = along * along - center.squaredNorm() + 1.0;
      const std::size_t i = std::size_t(y) * 640 + x;
      if (square < 0.4) { // grazed, or missed: a chord's sag or 1/256 pixel counts there
        EXPECT_TRUE(square > -0.1 || capture.label[i] == 0) << x << ", " << y;
        continue;
      }
      const double exact = ((along - std::sqrt(square)) * ray).z();
      ASSERT_EQ(capture.label[i], id) << x << ", " << y;
      ASSERT_NEAR(capture.depth[i], exact, 1e-5 * exact) << x << ", " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 6000);
  const PickResult pick = view->Pick(320, 240, 40);
  EXPECT_EQ(pick.object, id);
  EXPECT_EQ(pick.frame, ball);
  EXPECT_NEAR(pick.p_frame.norm(), 1.0, 1e-4);
}

// The same mesh as an actor and as an object of the scene, before and behind a plane that cuts it.
TEST_F(VtkProps, ThePlanesEqualThoseOfTheSameMeshInTheScene) {
  const FrameId place = scene->Frames().Create(RootFrame, "place");
  scene->Frames().SetLocalPose(place, At(6, 0.4, 0.1));
  scene->AddObject(
      dspace::Object("wall", place, PlaneTowardsCamera(3.0, 3.0), Unlit({0.2, 0.2, 0.8})));
  const Mesh sphere = MakeSphere(1.0, 48);
  vtkNew<vtkActor> actor;
  SetMesh(actor, sphere);
  vtkNew<vtkTransform> own; // the prop's own place counts, too
  own->Translate(0.0, 0.25, 0.0);
  actor->SetUserTransform(own);
  const ObjectId prop = Add(actor, "prop", place);
  GraphicsObject same = dspace::Object("same", place, sphere, Unlit({1, 0, 0}));
  same.X_FO.translation() = Eigen::Vector3d(0.0, 0.25, 0.0);
  const ObjectId mesh = scene->AddObject(same);
  auto view = View(200, 160);
  CaptureRequest request;
  request.color = false;
  request.depth = request.label = true;
  scene->SetObjectVisible(mesh, false);
  const Capture drawn = view->GetCapture(request);
  scene->SetObjectVisible(mesh, true);
  scene->SetObjectVisible(prop, false);
  const Capture expected = view->GetCapture(request);
  int ours = 0;
  int walls = 0;
  int edges = 0;
  for (std::size_t i = 0; i < drawn.label.size(); ++i) {
    const std::uint32_t label = drawn.label[i] == prop ? mesh : drawn.label[i];
    ours += drawn.label[i] == prop;
    walls += drawn.label[i] != prop && drawn.label[i] != 0;
    if (label != expected.label[i]) {
      ++edges; // a vertex that rounds to the other side of 1/256 pixel
      continue;
    }
    if (std::isfinite(expected.depth[i])) {
      ASSERT_NEAR(drawn.depth[i], expected.depth[i], 2e-6 * expected.depth[i]) << i;
    }
  }
  EXPECT_GT(ours, 1500);
  EXPECT_GT(walls, 1500);
  EXPECT_LE(edges, 2);
  EXPECT_EQ(actor->GetUserTransform(), own.Get()) << "the user's transform is restored";
}

TEST_F(VtkProps, TheColourPictureHasItsOpaqueColourBeforeAndBehindAWall) {
  vtkNew<vtkActor> actor;
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(0.2, 0.6, 0.4);
  AddBall(actor, 64);
  const FrameId wall = scene->Frames().Create(RootFrame, "wall");
  scene->AddObject(
      dspace::Object("wall", wall, PlaneTowardsCamera(0.6, 0.6), Unlit({0.8, 0.8, 0.1})));
  auto view = View(100, 100, 1);
  for (const double distance : {4.0, 6.5}) {
    scene->Frames().SetLocalPose(wall, At(distance, 0, 0));
    const Capture capture = view->GetCapture({});
    const std::uint8_t* middle = &capture.color[4 * (50 * 100 + 50)];
    const std::uint8_t* beside = &capture.color[4 * (50 * 100 + 35)];
    const std::array<int, 3> ball = {51, 153, 102};
    const std::array<int, 3> yellow = {204, 204, 26};
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(middle[c], distance < 5 ? yellow[c] : ball[c], 1) << distance;
      EXPECT_NEAR(beside[c], ball[c], 1) << distance;
    }
  }
}

TEST_F(VtkProps, AFragmentHidesItInOneViewport) {
  scene->CreateFragment("extra", Nature::Physical);
  vtkNew<vtkActor> actor;
  const ObjectId id = AddBall(actor, 32, "extra");
  auto here = View(64, 64);
  auto there = View(64, 64);
  here->SetFragmentVisible("extra", false);
  CaptureRequest request;
  request.label = true;
  const auto shows = [&](vtkDspaceViewport* view) {
    return ExtentOf(view->GetCapture(request), id).right >= 0;
  };
  EXPECT_FALSE(shows(here));
  EXPECT_TRUE(shows(there));
  scene->SetObjectVisible(id, false);
  EXPECT_FALSE(shows(there));
  scene->SetObjectVisible(id, true);
  actor->VisibilityOff();
  EXPECT_FALSE(shows(there));
  actor->VisibilityOn();
  EXPECT_TRUE(shows(there));
}

TEST_F(VtkProps, AChangeOfThePropMakesThePictureOutdatedAndADrawingDoesNot) {
  vtkNew<vtkActor> actor;
  AddBall(actor, 32);
  auto view = View(64, 64);
  EXPECT_TRUE(view->Render());
  EXPECT_FALSE(view->Render());
  EXPECT_TRUE(view->Pick(32, 32).object);
  EXPECT_FALSE(view->Render());
  actor->GetProperty()->SetColor(1, 0, 0);
  EXPECT_TRUE(view->Render());
  EXPECT_FALSE(view->Render());
  actor->SetPosition(0, 0, 100);
  EXPECT_FALSE(view->Pick(32, 32).object);
  vtkPolyData::SafeDownCast(actor->GetMapper()->GetInputDataObject(0, 0))->Modified();
  EXPECT_TRUE(view->Render());
  EXPECT_FALSE(view->Render());
}

// vtkProp::GetRedrawMTime leaves out all inputs of a mapper but the first.
TEST_F(VtkProps, AChangeOfAGlyphsSourceIsSeen) {
  const auto source = ToPolyData(MakeBox({1, 1, 1}));
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(ToPolyData(MakeBox({9, 9, 9})));
  mapper->SetSourceData(source);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  const VtkPropGeometry glyphs(actor, "object 'glyphs'");
  const std::uint64_t before = glyphs.Revision();
  EXPECT_EQ(glyphs.Revision(), before);
  source->GetPoints()->Modified();
  source->Modified();
  EXPECT_EQ(glyphs.Revision(), before + 1);
  EXPECT_EQ(glyphs.Revision(), before + 1);
  actor->GetProperty()->SetColor(1, 0, 0);
  EXPECT_EQ(glyphs.Revision(), before + 2);
}

TEST_F(VtkProps, ARemovedObjectReleasesItsResourcesOnceWithTheContext) {
  vtkNew<CountedActor> actor;
  const ObjectId id = AddBall(actor, 32);
  auto view = View(64, 64);
  auto other = View(64, 64);
  EXPECT_TRUE(view->Render());
  EXPECT_TRUE(other->Render());
  EXPECT_EQ(view->Pick(32, 32).object, id);
  EXPECT_EQ(actor->Released, 0);
  EXPECT_EQ(actor->GetNumberOfConsumers(), 1);
  scene->RemoveObject(id);
  EXPECT_EQ(actor->GetNumberOfConsumers(), 0);
  EXPECT_TRUE(view->Render());
  EXPECT_TRUE(other->Render());
  EXPECT_EQ(view->Pick(32, 32).object, 0u);
  EXPECT_EQ(actor->Released, 1);
  EXPECT_EQ(actor->GetReferenceCount(), 1) << "nothing of the scene has it any more";
}

TEST_F(VtkProps, WhatElseDrawsOrCannotBeDrawnIsRejectedByName) {
  const auto expect = [](vtkProp3D* prop, const char* word) {
    const std::string why = Rejection(prop);
    EXPECT_NE(why.find("object 'it'"), std::string::npos) << why;
    EXPECT_NE(why.find(word), std::string::npos) << why;
  };
  vtkNew<vtkActor> actor;
  expect(actor, "no mapper");
  SetMesh(actor, MakeSphere(1.0, 8));
  EXPECT_EQ(Rejection(actor), "");
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  expect(actor, "also in a renderer");
  renderer->RemoveActor(actor);
  EXPECT_EQ(Rejection(actor), "");
  {
    const VtkPropGeometry owner(actor, "object 'first'");
    expect(actor, "a scene");
    EXPECT_NO_THROW(owner.RequireOwned());
    renderer->AddActor(actor);
    EXPECT_THROW(owner.RequireOwned(), Error);
    renderer->RemoveActor(actor);
  }
  expect(vtkNew<vtkFollower>(), "camera");
  expect(vtkNew<vtkVolume>(), "no mapper");
  expect(vtkNew<vtkImageSlice>(), "no mapper");
  expect(nullptr, "no prop");
  vtkNew<vtkAssembly> assembly;
  assembly->AddPart(actor);
  EXPECT_EQ(Rejection(assembly), "");
  expect(actor, "an assembly");
  assembly->AddPart(vtkNew<vtkFollower>());
  expect(assembly, "camera");
}

TEST_F(VtkProps, APropThatARendererTakesLaterIsAnErrorOfTheNextPicture) {
  vtkNew<vtkActor> actor;
  AddBall(actor, 8);
  auto view = View(32, 32);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  try {
    view->GetCapture({});
    ADD_FAILURE() << "drawn";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("object 'ball'"), std::string::npos) << error.what();
  }
  renderer->RemoveActor(actor);
  EXPECT_NO_THROW(view->GetCapture({}));
}

} // namespace
} // namespace dspace
