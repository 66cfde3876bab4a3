// A scene as vtkActors: VTK's own pictures of them equal ours where lighting is off, and follow.
#include "PlainWindow.h"

#include <fstream>

#include "TemporaryFolder.h"
#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkDspaceActors.h"
#include "vtkDspaceScene.h"
#include "vtkLightCollection.h"
#include "vtkMatrix4x4.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"

namespace dspace::testing {
namespace {

class SceneActorsTest : public PlainWindowTest {
protected:
  void SetUp() override {
    PlainWindowTest::SetUp();
    this->Run("create_scene {}");
    this->Run("create_frame { id: 10 parent: 1 name: 'base' "
              "pose { position { x: 1 y: 2 z: 3 } rotation { w: 0.8 x: 0.6 } scale: 1.5 } }");
    this->Run("create_frame { id: 11 parent: 10 name: 'arm' pose { position { z: 1 } } }");
    this->Run("create_primitive { object { id: 1 name: 'box' frame: 11 "
              "material { color { r: 0.9 g: 0.3 b: 0.05 } lit: false } "
              "offset { position { x: 0.5 } scale { x: 1 y: 2 z: -1 } } } "
              "box { size { x: 1 y: 1 z: 1 } } }");
    this->Run("create_primitive { object { id: 2 name: 'ball' frame: 10 "
              "material { color { r: 0.1 g: 0.5 b: 0.9 } lit: false } "
              "offset { position { x: -2 } } } sphere { radius: 1 } }");
    this->Run("set_camera { name: 'eye' mount { look_at { eye { x: 9 y: -11 z: 6 } "
              "target { x: 1 y: 2 z: 3 } } } }");
    this->MakeView();
  }

  vtkDspaceScene* Scene() { return this->Session_->GetScene("scene"); }

  vtkSmartPointer<vtkDspaceActors> Show(const std::string& fragment = "") {
    auto actors = vtkSmartPointer<vtkDspaceActors>::Take(this->Scene()->MakeActors(fragment, 5000));
    actors->SetCamera("main", "eye");
    actors->SetRenderer(this->Renderer_);
    EXPECT_EQ(actors->GetFailure(), "");
    return actors;
  }
};

TEST_F(SceneActorsTest, UnlitPicturesAreEqualAndFollow) {
  const auto actors = this->Show();
  EXPECT_EQ(actors->GetActors()->GetNumberOfItems(), 2);
  const Picture before = this->Plain();
  EXPECT_GT(Compare(this->Ours(), before, 1), 1500);

  this->Run("set_poses { frame: 10 pose: [1, 3, 2, 1, 0, 0, 0, 1.2] }");
  const Picture moved = this->Plain();
  EXPECT_NE(moved.color, before.color);
  EXPECT_GT(Compare(this->Ours(), moved, 1), 1000);

  this->Run("set_material { object: 1 material { color { r: 0.2 g: 0.8 b: 0.4 } } }");
  this->Run("set_object_visible { object: 2 visible: false }");
  const Picture painted = this->Plain();
  EXPECT_NE(painted.color, moved.color);
  EXPECT_GT(Compare(this->Ours(), painted, 1), 400);
  EXPECT_EQ(actors->GetActors()->GetNumberOfItems(), 1);

  this->Run("set_camera { name: 'eye' projection { orthographic { height: 9 } } mount { look_at { "
            "eye { x: -9 y: -3 z: 6 } target { x: 1 y: 2 z: 3 } } } }");
  EXPECT_GT(Compare(this->Ours(), this->Plain(), 1), 400);
}

TEST_F(SceneActorsTest, TexturesAndTranslucency) {
  const TemporaryFolder folder;
  {
    std::ofstream image(folder / "four.ppm"); // squares of 8 x 8 pixels
    image << "P3 16 16 255\n";
    const char* const colors[] = {"255 0 0 ", "0 255 0 ", "0 0 255 ", "200 100 50 "};
    for (int i = 0; i < 256; ++i) {
      image << colors[2 * (i / 128) + i % 16 / 8];
    }
  }
  this->Run("create_primitive { object { id: 3 name: 'sheet' frame: 1 "
            "material { color { r: 1 g: 1 b: 1 } lit: false texture: '" +
            (folder / "four.ppm") +
            "' } offset { position { z: -1 } } } plane { width: 9 height: 9 } }");
  const auto actors = this->Show();
  // Inside the squares: at their edges VTK interpolates display values.
  EXPECT_EQ(actors->GetActors()->GetNumberOfItems(), 3);
  const Picture ours = this->Ours();
  const Picture plain = this->Plain();
  int equal = 0;
  int sheet = 0;
  for (std::size_t i = 0; i < ours.label.size(); ++i) {
    if (ours.label[i] == 3) {
      ++sheet;
      bool same = true;
      for (std::size_t k = 0; k < 3; ++k) {
        same &= std::abs(int(ours.color[4 * i + k]) - int(plain.color[4 * i + k])) <= 1;
      }
      equal += same;
    }
  }
  EXPECT_GT(sheet, 3000);
  EXPECT_GT(equal, sheet / 2);
}

TEST_F(SceneActorsTest, LeavesTheRendererAsItWas) {
  vtkNew<vtkActor> other;
  this->Renderer_->AddActor(other);
  this->Renderer_->CreateLight();
  const auto actors = this->Show();
  EXPECT_EQ(this->Renderer_->GetActors()->GetNumberOfItems(), 3);
  actors->Release();
  EXPECT_EQ(this->Renderer_->GetActors()->GetNumberOfItems(), 1);
  EXPECT_EQ(this->Renderer_->GetLights()->GetNumberOfItems(), 1);
  EXPECT_EQ(actors->GetActors()->GetNumberOfItems(), 0);
  actors->Release();
  actors->Update(); // does nothing
  this->Plain();
}

TEST_F(SceneActorsTest, TheRendererKeepsThem) {
  this->Show(); // without a reference
  EXPECT_EQ(this->Renderer_->GetActors()->GetNumberOfItems(), 2);
  EXPECT_GT(Compare(this->Ours(), this->Plain(), 1), 1500);
  vtkSmartPointer<vtkDspaceActors> actors;
  {
    vtkNew<vtkRenderer> other;
    actors.TakeReference(this->Scene()->MakeActors("", 5000));
    actors->SetRenderer(other);
  }
  EXPECT_EQ(actors->GetReferenceCount(), 1);
  actors->Update();
}

TEST_F(SceneActorsTest, FragmentsAndWhatIsLeftOut) {
  this->Run("create_fragment { name: 'parts' nature: PHYSICAL }");
  this->Run("move_to_fragment { object: 2 fragment: 'parts' }");
  this->Run("create_text { object { id: 5 name: 'words' } text: 'words' label {} }");
  vtkActorCollection* parts = this->Scene()->GetActors("parts");
  EXPECT_EQ(parts->GetNumberOfItems(), 1);
  vtkActor* ball = vtkActor::SafeDownCast(parts->GetItemAsObject(0));
  const double before = ball->GetCenter()[1];
  this->Run("set_poses { frame: 10 pose: [1, 7, 3, 1, 0, 0, 0, 1] }");
  EXPECT_NEAR(ball->GetCenter()[1], 7.0, 1e-6) << before; // without another call
  EXPECT_EQ(this->Scene()->GetActors("parts"), parts);
  this->Run("remove_object { object: 2 }");
  EXPECT_EQ(this->Scene()->GetActors("parts")->GetNumberOfItems(), 0);
  EXPECT_EQ(this->Show()->GetLeftOut(), "words");
}

TEST_F(SceneActorsTest, TerrainsAreMeshesWithinTheirBudget) {
  const TemporaryFolder folder;
  std::ofstream file(folder / "hills.asc");
  file << "ncols 200\nnrows 150\nxllcorner 100\nyllcorner 200\ncellsize 2\n";
  for (int r = 0; r < 150; ++r) {
    for (int c = 0; c < 200; ++c) {
      file << 3.0 * std::sin(0.1 * c) + 2.0 * std::cos(0.07 * r) << " ";
    }
    file << "\n";
  }
  file.close();
  for (const char* mode : {"CLIPMAP", "TRIANGLES"}) {
    this->Run("open_terrain { name: 'ground' object_name: 'ground' path: '" +
              (folder / "hills.asc") + "' mode: " + mode +
              " build_overviews: false overview_cache: '' }");
    auto actors = vtkSmartPointer<vtkDspaceActors>::Take(this->Scene()->MakeActors("", 5000));
    EXPECT_EQ(actors->GetFailure(), "");
    EXPECT_EQ(actors->GetLeftOut(), "");
    vtkIdType triangles = 0;
    double error = 0.0;
    v1::Command query;
    query.mutable_query_terrain()->set_terrain("ground");
    query.mutable_query_terrain()->set_height(true);
    std::vector<double> drawn;
    double bounds[4] = {1e9, -1e9, 1e9, -1e9};
    vtkActorCollection* all = actors->GetActors();
    for (int i = 2; i < all->GetNumberOfItems(); ++i) { // after box and ball
      vtkActor* actor = vtkActor::SafeDownCast(all->GetItemAsObject(i));
      auto* mesh = vtkPolyDataMapper::SafeDownCast(actor->GetMapper())->GetInput();
      triangles += mesh->GetNumberOfPolys();
      for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p) {
        double at[4] = {0, 0, 0, 1};
        mesh->GetPoint(p, at);
        actor->GetMatrix()->MultiplyPoint(at, at);
        for (int k = 0; k < 2; ++k) {
          bounds[2 * k] = std::min(bounds[2 * k], at[k]);
          bounds[2 * k + 1] = std::max(bounds[2 * k + 1], at[k]);
          query.mutable_query_terrain()->add_point(
              std::clamp(at[k], k ? -148.999 : -198.999, k ? 148.999 : 198.999));
        }
        drawn.push_back(at[2]);
      }
    }
    const v1::TerrainQueryReply heights = this->Execute(query).terrain_values();
    ASSERT_EQ(std::size_t(heights.height_size()), drawn.size());
    for (int i = 0; i < heights.height_size(); ++i) {
      error = std::max(error, std::abs(heights.height(i) - drawn[std::size_t(i)]));
    }
    EXPECT_LE(triangles, 5000) << mode;
    EXPECT_GT(triangles, 1000) << mode;
    EXPECT_LT(error, 0.3) << mode; // coarser posts are means over their cells
    EXPECT_NEAR(bounds[0], -199, 1e-3) << mode;
    EXPECT_NEAR(bounds[1], 199, 1e-3) << mode;
    EXPECT_NEAR(bounds[3], 149, 1e-3) << mode;
    this->Run("remove_terrain { terrain: 'ground' }");
  }
}

} // namespace
} // namespace dspace::testing
