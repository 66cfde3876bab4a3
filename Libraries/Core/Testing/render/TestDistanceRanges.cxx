// Parts that are drawn at some distances only: the same in every plane, and in picks.
#include "RenderingTestSupport.h"

using namespace dspace;

namespace {

struct DistanceRangeTest : RenderingFixture {
  // Red below 8 m from the point 1 m to the left of its middle, green from there on to 20 m.
  ObjectId AddWall(double scale) {
    auto model = std::make_shared<Model>();
    model->path = "made by hand";
    for (int i = 0; i < 2; ++i) {
      model->meshes.push_back(PlaneTowardsCamera(40, 40));
      model->meshes.back().material = i;
      Material material;
      material.lit = false;
      material.color = {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, 0.0};
      model->materials.push_back(material);
    }
    ModelNode top;
    top.range = DistanceRange{{0, 0, 0}, 0.0, 20.0};
    model->nodes.push_back(top);
    for (int i = 0; i < 2; ++i) {
      ModelNode node;
      node.parent = 0;
      node.meshes = {i};
      node.range = DistanceRange{{0, 1, 0}, i == 0 ? 0.0 : 8.0, i == 0 ? 8.0 : 1e9};
      model->nodes.push_back(node);
    }
    this->frame = scene->Frames().Create(RootFrame, "wall");
    GraphicsObject object;
    object.name = "wall";
    object.frame = this->frame;
    object.levels = {{PartsOf(model, scale), 0.0}};
    return scene->AddObject(std::move(object));
  }
  FrameId frame = NoFrame;
};

} // namespace

TEST_F(DistanceRangeTest, DecidesWhichPartsAreSeen) {
  for (const double scale : {1.0, 2.5}) {
    Look({});
    const ObjectId wall = AddWall(scale);
    auto view = View(9, 9);
    // The camera is at the origin; the centre of the range is off by 1 m sideways, times the scale.
    const auto at = [&](double x) { // [m] along the line of sight, for a distance of sqrt(x² + 1)
      scene->Frames().SetLocalPose(this->frame, At(scale * x, 0, 0));
      return view->GetCapture({true, true, true, false, {}});
    };
    const double turn = std::sqrt(8.0 * 8.0 - 1.0);
    for (const double x : {2.0, turn - 0.01, turn + 0.01, 15.0, 20.5}) {
      const Capture capture = at(x);
      const std::size_t middle = 4 * 9 + 4;
      const bool seen = x < 20.0;
      EXPECT_EQ(capture.color[4 * middle], x < turn ? 255 : 0) << x;
      EXPECT_EQ(capture.color[4 * middle + 1], seen && x > turn ? 255 : 0) << x;
      EXPECT_EQ(capture.label[middle], seen ? wall : 0u) << x;
      EXPECT_EQ(std::isinf(capture.depth[middle]), !seen) << x;
    }
    scene->RemoveObject(wall);
    scene->RemoveFrame(this->frame);
  }
}
