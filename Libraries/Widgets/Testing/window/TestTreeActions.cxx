// Lines of Python for what the scene tree asks for, and the requests of such lines, by hand.
#include <gtest/gtest.h>

#include <memory>

#include <dspace/Error.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/window/TreeActions.h>

using dspace::widgets::IsTreeRequest;
using dspace::widgets::LineOf;
using dspace::widgets::RequestOf;
using dspace::widgets::SceneAction;

namespace {

// A rover with two objects.
struct TreeActions : ::testing::Test {
  std::shared_ptr<dspace::Scene> scene = std::make_shared<dspace::Scene>("scene");
  dspace::FrameId rover = scene->Frames().Create(dspace::RootFrame, "rover");
  dspace::FrameId mast = scene->Frames().Create(rover, "mast");
  dspace::ObjectId hull = AddThing("hull"), wheel = AddThing("wheel");

  dspace::ObjectId AddThing(const char* name) {
    dspace::GraphicsObject object;
    object.name = name;
    object.frame = rover;
    return scene->AddObject(std::move(object));
  }
};

} // namespace

TEST_F(TreeActions, LinesNameFramesAndObjects) {
  EXPECT_EQ(LineOf({SceneAction::Trail, {mast, 0}}, *scene).toStdString(),
            "app.act(\"trail\", \"rover/mast\")");
  EXPECT_EQ(LineOf({SceneAction::Focus, {dspace::RootFrame, 0}}, *scene).toStdString(),
            "app.act(\"focus\", \"/\")");
  EXPECT_EQ(LineOf({SceneAction::Hide, {rover, hull}}, *scene).toStdString(),
            "app.act(\"hide\", \"rover\", \"hull\")");
  EXPECT_EQ(LineOf({SceneAction::CopyPath, {rover, 0}}, *scene).toStdString(), "");
  EXPECT_EQ(LineOf({SceneAction::Hide, {rover, 999}}, *scene).toStdString(), "");
  EXPECT_EQ(LineOf({SceneAction::Hide, {dspace::FrameId(999), 0}}, *scene).toStdString(), "");
}

TEST_F(TreeActions, RequestsAreThoseOfTheLines) {
  const QJsonObject frame = {{"do", "tree"}, {"action", "axes"}, {"frame", "rover/mast"}};
  EXPECT_TRUE(IsTreeRequest(frame));
  EXPECT_FALSE(IsTreeRequest({{"do", "views"}}));
  EXPECT_EQ(RequestOf(frame, *scene).action, SceneAction::Axes);
  EXPECT_EQ(RequestOf(frame, *scene).item.frame, mast);
  EXPECT_EQ(RequestOf(frame, *scene).item.object, 0U);
  EXPECT_EQ(RequestOf({{"action", "chase"}, {"frame", "/"}}, *scene).item.frame, dspace::RootFrame);
  QJsonObject object = {{"action", "hide"}, {"frame", "rover"}, {"object", "hull"}};
  EXPECT_EQ(RequestOf(object, *scene).item.object, hull);
  object["object"] = int(wheel);
  EXPECT_EQ(RequestOf(object, *scene).item.object, wheel);
  object["frame"] = "rover/mast"; // it is on another frame
  EXPECT_THROW(RequestOf(object, *scene), dspace::Error);
  EXPECT_THROW(RequestOf({{"action", "hide"}, {"frame", "nowhere"}}, *scene), dspace::Error);
  EXPECT_THROW(RequestOf({{"action", "melt"}, {"frame", "rover"}}, *scene), dspace::Error);
}
