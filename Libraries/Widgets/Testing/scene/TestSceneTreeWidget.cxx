// The tree shows a scene's frames and objects, follows their changes row by row, and turns the
// user's events into requests and commands.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <QAbstractItemModelTester>
#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QScrollBar>
#include <QtTest>

#include "vtkDspaceSession.h"
#include "vtkNew.h"

#include <dspace/Error.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/scene/Primitives.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/scene/SceneCommands.h>
#include <dspace/widgets/scene/ScenePropertyPanel.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeView.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/settings/DisplayUnits.h>

using dspace::FrameId;
using dspace::NoFrame;
using dspace::ObjectId;
using dspace::RootFrame;
using dspace::widgets::SceneAction;
using dspace::widgets::SceneItem;
using dspace::widgets::ScenePropertyPanel;
using dspace::widgets::SceneRequest;
using dspace::widgets::SceneTreeModel;
using dspace::widgets::SceneTreeView;
using dspace::widgets::SceneTreeWidget;

namespace {

using Eye = SceneTreeModel::Eye;

// Aborts where the model breaks a rule of Qt's views. It makes no rows by itself: it would do so in
// the middle of a reset.
struct ModelTester : QAbstractItemModelTester {
  explicit ModelTester(QAbstractItemModel* model)
      : QAbstractItemModelTester(model, FailureReportingMode::Fatal) {
    this->setUseFetchMore(false);
  }
};

struct SceneTreeTest : ::testing::Test {
  std::shared_ptr<dspace::Scene> scene = std::make_shared<dspace::Scene>("scene");
  FrameId rover = 0, mast = 0, wheel = 0;
  ObjectId body = 0, camera = 0, label = 0;

  ObjectId Add(const std::string& name, FrameId frame,
               dspace::Nature nature = dspace::Nature::Physical) {
    dspace::GraphicsObject object;
    object.name = name;
    object.frame = frame;
    object.nature = nature;
    object.levels = {dspace::DetailLevel{{dspace::Part{
        std::make_shared<const dspace::Mesh>(dspace::MakeBox({2.0, 1.0, 0.5})), nullptr}}}};
    return scene->AddObject(std::move(object));
  }
  void SetUp() override {
    dspace::FrameTree& frames = scene->Frames();
    const double half = std::sqrt(0.5);
    rover = frames.Create(RootFrame, "rover", {{10, 20, 30}, {half, 0, 0, half}, 1.0});
    mast = frames.Create(rover, "mast", {{1, 0, 2}, Eigen::Quaterniond::Identity(), 1.0});
    wheel = frames.Create(rover, "wheel");
    body = Add("chassis", rover);
    camera = Add("camera", mast);
    label = Add("name plate", mast, dspace::Nature::Ornamental);
  }
  // Each row and those below, as "name(child, ...)"; makes all rows.
  static std::string Rows(SceneTreeModel& model, const QModelIndex& parent = {}) {
    model.fetchMore(parent);
    std::string text;
    for (int row = 0; row < model.rowCount(parent); ++row) {
      const QModelIndex index = model.index(row, 0, parent);
      const std::string below = Rows(model, index);
      text += (row ? ", " : "") + index.data().toString().toStdString() +
              (below.empty() ? "" : "(" + below + ")");
    }
    return text;
  }
  static QString Text(const SceneTreeWidget& widget, const QString& row) {
    const auto* found = widget.findChild<QLabel*>(row);
    return found ? found->text().replace(QChar(QChar::Nbsp), ' ') : QString("no such row");
  }
  static QPoint Middle(const SceneTreeWidget& widget, const SceneItem& item, int column) {
    const QModelIndex index = widget.Model()->IndexOf(item);
    return widget.View()->visualRect(index.sibling(index.row(), column)).center();
  }
  static void Show(SceneTreeWidget& widget) {
    widget.resize(420, 700);
    widget.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&widget));
    QTest::qWait(50);
  }
};

} // namespace

TEST_F(SceneTreeTest, RowsAreTheFramesWithTheirObjects) {
  SceneTreeModel model;
  ModelTester tester(&model);
  EXPECT_EQ(model.rowCount(), 0);
  model.SetScene(scene);
  EXPECT_EQ(Rows(model), "root(rover(chassis, mast(camera, name plate), wheel))");
  const QModelIndex plate = model.IndexOf({mast, label});
  ASSERT_TRUE(plate.isValid());
  EXPECT_EQ(plate.siblingAtColumn(SceneTreeModel::NatureColumn).data().toString(), "ornamental");
  EXPECT_EQ(plate.siblingAtColumn(SceneTreeModel::KindColumn).data().toString(), "mesh");
  EXPECT_EQ(model.IndexOf({mast, 0}).data(Qt::ToolTipRole).toString(), "rover/mast");
  EXPECT_EQ(model.ItemOf(plate), (SceneItem{mast, label}));
  EXPECT_FALSE(model.IndexOf({999, 0}).isValid());
  model.SetScene(nullptr);
  EXPECT_EQ(model.rowCount(), 0);
}

TEST_F(SceneTreeTest, RowsAreMadeWhenAFrameIsOpened) {
  for (int i = 0; i < 100; ++i) {
    scene->Frames().Create(wheel, "bolt " + std::to_string(i));
  }
  SceneTreeModel model;
  model.SetScene(scene);
  const QModelIndex root = model.index(0, 0);
  EXPECT_EQ(model.rowCount(root), 0);
  EXPECT_TRUE(model.hasChildren(root));
  model.fetchMore(root);
  EXPECT_EQ(model.rowCount(root), 1);
  const QModelIndex wheels = model.IndexOf({wheel, 0});
  EXPECT_EQ(model.rowCount(wheels), 0);
  EXPECT_TRUE(model.canFetchMore(wheels));
  EXPECT_FALSE(model.hasChildren(model.IndexOf({mast, camera})));
}

TEST_F(SceneTreeTest, FollowsChangesAndTouchesOnlyTheirRows) {
  SceneTreeModel model;
  ModelTester tester(&model);
  model.SetScene(scene);
  Rows(model);
  QSignalSpy inserted(&model, &QAbstractItemModel::rowsInserted);
  QSignalSpy removed(&model, &QAbstractItemModel::rowsRemoved);
  QSignalSpy changed(&model, &QAbstractItemModel::dataChanged);
  QSignalSpy resets(&model, &QAbstractItemModel::modelReset);
  QSignalSpy layouts(&model, &QAbstractItemModel::layoutChanged);
  dspace::FrameTree& frames = scene->Frames();

  frames.SetLocalPose(mast, {{1, 2, 3}, Eigen::Quaterniond::Identity(), 1.0});
  scene->SetTime(5.0);
  EXPECT_FALSE(model.Refresh()); // poses are no rows

  const FrameId arm = frames.Create(rover, "arm");
  EXPECT_TRUE(model.Refresh());
  EXPECT_EQ(inserted.count(), 1);
  EXPECT_EQ(inserted.at(0).at(1).toInt(), 3);
  EXPECT_EQ(removed.count() + changed.count(), 0);
  EXPECT_EQ(Rows(model), "root(rover(chassis, mast(camera, name plate), wheel, arm))");

  frames.Rename(wheel, "left wheel");
  EXPECT_TRUE(model.Refresh());
  ASSERT_EQ(changed.count(), 1);
  EXPECT_EQ(model.ItemOf(changed.at(0).at(0).toModelIndex()), (SceneItem{wheel, 0}));
  EXPECT_FALSE(model.Refresh());

  changed.clear();
  scene->SetObjectVisible(camera, false);
  EXPECT_TRUE(model.Refresh()); // the object and the three frames above it
  EXPECT_EQ(changed.count(), 4);
  EXPECT_EQ(model.EyeOf({mast, camera}), Eye::Hidden);
  EXPECT_EQ(model.EyeOf({mast, 0}), Eye::Mixed);
  EXPECT_EQ(model.EyeOf({wheel, 0}), Eye::None);

  frames.Reparent(mast, arm, false);
  EXPECT_TRUE(model.Refresh());
  EXPECT_EQ(Rows(model), "root(rover(chassis, left wheel, arm(mast(camera, name plate))))");
  EXPECT_EQ(model.EyeOf({arm, 0}), Eye::Mixed);

  scene->AttachObject(body, wheel);
  scene->RemoveObject(label);
  EXPECT_TRUE(model.Refresh());
  EXPECT_EQ(Rows(model), "root(rover(left wheel(chassis), arm(mast(camera))))");
  EXPECT_EQ(model.EyeOf({arm, 0}), Eye::Hidden);

  scene->RemoveFrame(arm);
  EXPECT_TRUE(model.Refresh());
  EXPECT_EQ(Rows(model), "root(rover(left wheel(chassis)))");
  EXPECT_EQ(model.EyeOf({RootFrame, 0}), Eye::Visible);
  EXPECT_EQ(resets.count(), 0);
  EXPECT_EQ(layouts.count(), 0);
}

TEST_F(SceneTreeTest, AClosedFrameThatBecomesEmptyLosesItsArrow) {
  SceneTreeModel model;
  model.SetScene(scene);
  model.IndexOf({mast, 0}); // the rows of the rover, not those of the mast
  EXPECT_TRUE(model.hasChildren(model.IndexOf({mast, 0})));
  QSignalSpy layouts(&model, &QAbstractItemModel::layoutChanged);
  scene->RemoveObject(camera);
  scene->RemoveObject(label);
  EXPECT_TRUE(model.Refresh());
  EXPECT_EQ(layouts.count(), 1);
  EXPECT_FALSE(model.hasChildren(model.IndexOf({mast, 0})));
  scene->Frames().Create(mast, "lamp");
  EXPECT_TRUE(model.Refresh());
  EXPECT_TRUE(model.hasChildren(model.IndexOf({mast, 0})));
}

TEST_F(SceneTreeTest, ChangesInAnyOrderGiveTheRowsOfANewModel) {
  for (const QString& filter : {QString(), QString("1")}) {
    SceneTreeModel model;
    ModelTester tester(&model);
    model.SetScene(scene);
    model.SetFilter(filter);
    Rows(model);
    std::uint32_t seed = 7;
    const auto random = [&](std::uint32_t below) {
      seed = seed * 1664525u + 1013904223u;
      return (seed >> 8) % below;
    };
    dspace::FrameTree& frames = scene->Frames();
    for (int i = 0; i < 2000; ++i) {
      const FrameId any = frames.IdAt(random(std::uint32_t(frames.Size())));
      const FrameId other = frames.IdAt(random(std::uint32_t(frames.Size())));
      const std::string name = filter.toStdString() + "n" + std::to_string(i);
      try {
        switch (random(8)) {
        case 0:
        case 1:
          frames.Create(any, name);
          break;
        case 2:
          if (random(4) == 0) {
            scene->RemoveFrame(any);
          }
          break;
        case 3:
          frames.Reparent(any, other, false);
          break;
        case 4:
          frames.Rename(any, name);
          break;
        case 5:
          Add("o" + name, any);
          break;
        default:
          if (!scene->Objects().empty()) {
            auto object = scene->Objects().begin();
            std::advance(object, random(std::uint32_t(scene->Objects().size())));
            if (random(2)) {
              scene->AttachObject(object->first, any);
            } else if (random(2)) {
              scene->SetObjectVisible(object->first, !object->second.visible);
            } else {
              scene->RemoveObject(object->first);
            }
          }
        }
      } catch (const dspace::Error&) { // a frame below itself, ...
      }
      if (random(5) == 0) {
        model.Refresh();
        SceneTreeModel anew;
        anew.SetScene(scene);
        anew.SetFilter(filter);
        ASSERT_EQ(Rows(model), Rows(anew)) << i;
        for (std::size_t slot = 0; slot < frames.Size(); ++slot) {
          const SceneItem item{frames.IdAt(slot), 0};
          ASSERT_EQ(model.EyeOf(item), anew.EyeOf(item)) << i;
        }
      }
    }
  }
}

TEST_F(SceneTreeTest, SearchKeepsMatchesAndTheFramesAboveThem) {
  SceneTreeWidget widget;
  widget.SetScene(scene);
  Show(widget);
  widget.Select({mast, 0});
  auto* search = widget.findChild<QLineEdit*>();
  ASSERT_NE(search, nullptr);
  QTest::keyClicks(search, "PLATE");
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Model()->Matches() == 1; }, 3000));
  EXPECT_EQ(Rows(*widget.Model()), "root(rover(mast(name plate)))");
  EXPECT_TRUE(widget.View()->isExpanded(widget.Model()->IndexOf({mast, 0})));
  EXPECT_EQ(widget.Selected(), (SceneItem{mast, 0}));
  const FrameId lamp = scene->Frames().Create(wheel, "plate 2"); // what comes later matches, too
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Model()->IndexOf({lamp, 0}).isValid(); }, 3000));
  EXPECT_EQ(Rows(*widget.Model()), "root(rover(mast(name plate), wheel(plate 2)))");
  search->clear();
  QTest::keyClicks(search, "xyz");
  QTest::keyClick(search, Qt::Key_Return);
  EXPECT_EQ(widget.Model()->rowCount(), 0);
  search->clear();
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Model()->rowCount() == 1; }, 3000));
  EXPECT_FALSE(widget.View()->isExpanded(widget.Model()->IndexOf({wheel, 0})));
}

TEST_F(SceneTreeTest, ClicksOnEyesAskAndSelectNothing) {
  SceneTreeWidget widget;
  widget.SetScene(scene);
  std::vector<SceneRequest> requests;
  widget.SetHandler([&](const SceneRequest& request) {
    requests.push_back(request);
    scene->SetObjectVisible(request.item.object, request.action == SceneAction::Show);
  });
  Show(widget);
  widget.View()->expandAll();
  QSignalSpy selected(&widget, &SceneTreeWidget::selected);
  const auto click = [&] {
    QTest::mouseClick(widget.View()->viewport(), Qt::LeftButton, {},
                      Middle(widget, {mast, camera}, SceneTreeModel::VisibleColumn));
  };
  click();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].action, SceneAction::Hide);
  EXPECT_EQ(requests[0].item, (SceneItem{mast, camera}));
  EXPECT_EQ(widget.Model()->EyeOf({mast, camera}), Eye::Hidden);
  click();
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[1].action, SceneAction::Show);
  EXPECT_EQ(selected.count(), 0);
  QTest::mouseClick(widget.View()->viewport(), Qt::LeftButton, {},
                    Middle(widget, {rover, body}, SceneTreeModel::NameColumn));
  ASSERT_EQ(selected.count(), 1);
  EXPECT_EQ(widget.Selected(), (SceneItem{rover, body}));
  QTest::keyClick(widget.View(), Qt::Key_Space);
  ASSERT_EQ(requests.size(), 3u);
  EXPECT_EQ(requests[2].item.object, body);
  QTest::keyClick(widget.View(), Qt::Key_Down);
  EXPECT_EQ(widget.Selected(), (SceneItem{mast, 0}));
}

TEST_F(SceneTreeTest, ThePanelShowsPosesRelativeToAnyFrame) {
  SceneTreeWidget widget;
  widget.SetScene(scene);
  Show(widget);
  widget.Select({mast, 0});
  // By hand: 90 degrees about Z turn (1, 0, 2) to (0, 1, 2).
  EXPECT_EQ(Text(widget, "position"), "x 10.0000   y 21.0000   z 32.0000");
  EXPECT_EQ(Text(widget, "quaternion"), "w 0.707107   x 0.000000   y 0.000000   z 0.707107");
  EXPECT_EQ(Text(widget, "angles"), "roll 0.0000   pitch 0.0000   yaw 90.0000");
  EXPECT_EQ(Text(widget, "frame"), "rover/mast");
  // In the units that the user chose.
  using dspace::widgets::DisplayUnits;
  using dspace::widgets::UnitChoice;
  DisplayUnits::The().Set({UnitChoice::Length::Kilometre, UnitChoice::Angle::Radian});
  widget.Refresh();
  EXPECT_EQ(Text(widget, "position"), "x 0.0100000   y 0.0210000   z 0.0320000");
  EXPECT_EQ(Text(widget, "angles"), "roll 0.000000   pitch 0.000000   yaw 1.570796");
  QStringList labels;
  for (const QLabel* label : widget.findChildren<QLabel*>()) {
    labels << label->text();
  }
  EXPECT_TRUE(labels.contains("Position [km]") && labels.contains("Angles [rad]"));
  DisplayUnits::The().Set({});
  widget.Refresh();
  auto* reference = widget.findChild<QComboBox*>();
  reference->lineEdit()->selectAll();
  QTest::keyClicks(reference->lineEdit(), "rover");
  QTest::keyClick(reference->lineEdit(), Qt::Key_Return);
  EXPECT_EQ(widget.Reference(), rover);
  EXPECT_EQ(Text(widget, "position"), "x 1.0000   y 0.0000   z 2.0000");
  // Live.
  scene->Frames().SetLocalPose(mast, {{1.5, 0, 2}, Eigen::Quaterniond::Identity(), 1.0});
  ASSERT_TRUE(QTest::qWaitFor(
      [&] { return Text(widget, "position") == "x 1.5000   y 0.0000   z 2.0000"; }, 2000));
  // A path that does not exist changes nothing.
  QSignalSpy failed(&widget, &SceneTreeWidget::failed);
  reference->lineEdit()->selectAll();
  QTest::keyClicks(reference->lineEdit(), "rover/antenna");
  QTest::keyClick(reference->lineEdit(), Qt::Key_Return);
  EXPECT_EQ(failed.count(), 1);
  EXPECT_EQ(widget.Reference(), rover);
  EXPECT_EQ(reference->currentText(), "rover");
  // An object's axes, with its offset; relative to its parent.
  scene->SetObjectOffset(camera, Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.25)));
  dspace::MaterialOverride red;
  red.color = {1.0, 0.0, 0.0};
  scene->SetObjectMaterial(camera, red);
  widget.SetReference(NoFrame);
  widget.Select({mast, camera});
  EXPECT_EQ(Text(widget, "position"), "x 0.0000   y 0.0000   z 0.2500");
  EXPECT_EQ(Text(widget, "fragment"), "physical");
  EXPECT_TRUE(Text(widget, "material").startsWith("#ff0000"))
      << Text(widget, "material").toStdString();
  EXPECT_EQ(Text(widget, "levels"), "12 triangles");
  scene->RemoveObject(camera);
  widget.Refresh();
  EXPECT_EQ(widget.Selected().frame, NoFrame);
}

TEST_F(SceneTreeTest, RollPitchAndYawTurnAboutFixedAxes) {
  constexpr double degree = 3.14159265358979323846 / 180.0;
  const Eigen::Quaterniond q = Eigen::AngleAxisd(30 * degree, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(-20 * degree, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(10 * degree, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(ScenePropertyPanel::RollPitchYaw(q).isApprox(Eigen::Vector3d(10, -20, 30), 1e-12));
}

TEST_F(SceneTreeTest, TheContextMenuAsksAndCopies) {
  SceneTreeWidget widget;
  widget.SetScene(scene);
  std::vector<SceneRequest> requests;
  widget.SetHandler([&](const SceneRequest& request) { requests.push_back(request); });
  QSignalSpy actions(&widget, &SceneTreeWidget::contextAction);
  Show(widget);
  widget.View()->expandAll();
  const auto choose = [&](const SceneItem& item, const QString& text) {
    emit widget.View()->customContextMenuRequested(
        Middle(widget, item, SceneTreeModel::NameColumn));
    auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
    ASSERT_NE(menu, nullptr);
    for (QAction* action : menu->actions()) {
      if (action->text() == text) {
        QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
        return;
      }
    }
    menu->close();
    FAIL() << text.toStdString();
  };
  choose({mast, 0}, "Chase");
  choose({mast, camera}, "Hide");
  choose({wheel, 0}, "Trail");
  choose({wheel, 0}, "Axes");
  choose({rover, body}, "Focus");
  choose({mast, 0}, "Copy path");
  ASSERT_EQ(requests.size(), 5u);
  EXPECT_EQ(requests[0].action, SceneAction::Chase);
  EXPECT_EQ(requests[0].item, (SceneItem{mast, 0}));
  EXPECT_EQ(requests[1].action, SceneAction::Hide);
  EXPECT_EQ(requests[1].item, (SceneItem{mast, camera}));
  EXPECT_EQ(requests[4].action, SceneAction::Focus);
  EXPECT_EQ(actions.count(), 6);
  EXPECT_EQ(QApplication::clipboard()->text(), "rover/mast");
  choose({rover, 0}, "Show poses relative to this frame");
  EXPECT_EQ(widget.Reference(), rover);
}

TEST_F(SceneTreeTest, DeepRowsHaveRoomForTheirNames) {
  SceneTreeWidget widget;
  widget.SetScene(scene);
  Show(widget);
  widget.resize(320, 700);
  QTest::qWait(50);
  auto* view = widget.View();
  dspace::FrameId deep = rover;
  for (int i = 0; i < 12; ++i) {
    deep = scene->Frames().Create(deep, "link_" + std::to_string(i));
  }
  widget.Refresh();
  const int narrow = view->columnWidth(SceneTreeModel::NameColumn);
  EXPECT_LE(narrow, 320);
  widget.Select({deep, 0}); // opens what is above it
  ASSERT_TRUE(QTest::qWaitFor([&] {
    const QRect row = view->visualRect(view->currentIndex());
    return view->currentIndex().data().toString() == "link_11" &&
           row.width() >= 16 + view->fontMetrics().horizontalAdvance("link_11");
  }));
  EXPECT_GT(view->columnWidth(SceneTreeModel::NameColumn), narrow);
  view->collapseAll(); // the other columns come back into view
  EXPECT_TRUE(
      QTest::qWaitFor([&] { return view->columnWidth(SceneTreeModel::NameColumn) == narrow; }));
}

TEST_F(SceneTreeTest, AHandlersErrorIsShown) {
  SceneTreeWidget widget;
  widget.SetScene(scene);
  widget.SetHandler([](const SceneRequest&) {
    throw dspace::Error(dspace::Error::Kind::NotFound, "frame 'x'", "it is gone");
  });
  QSignalSpy failed(&widget, &SceneTreeWidget::failed);
  widget.Request(SceneAction::Focus, {rover, 0});
  ASSERT_EQ(failed.count(), 1);
  EXPECT_EQ(failed.at(0).at(0).toString(), "frame 'x': it is gone");
}

TEST_F(SceneTreeTest, AnotherSceneKeepsWhatIsOpenAndSelected) {
  SceneTreeWidget widget;
  std::shared_ptr<dspace::Scene> shown = scene;
  widget.SetSource([&] { return shown; });
  Show(widget);
  widget.Select({mast, camera});
  QSignalSpy selected(&widget, &SceneTreeWidget::selected);
  // As a playback makes it: the same names, other ids.
  auto next = std::make_shared<dspace::Scene>("scene");
  next->Frames().Create(RootFrame, "first");
  const FrameId rover2 = next->Frames().Create(RootFrame, "rover");
  const FrameId mast2 = next->Frames().Create(rover2, "mast");
  dspace::GraphicsObject object = scene->Object(camera);
  object.id = 0;
  object.frame = mast2;
  const ObjectId camera2 = next->AddObject(object);
  shown = next;
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Model()->GetScene() == next; }, 2000));
  EXPECT_EQ(widget.Selected(), (SceneItem{mast2, camera2}));
  EXPECT_TRUE(widget.View()->isExpanded(widget.Model()->IndexOf({rover2, 0})));
  EXPECT_TRUE(widget.View()->isExpanded(widget.Model()->IndexOf({mast2, 0})));
  shown = nullptr;
  widget.Refresh();
  EXPECT_EQ(widget.Model()->rowCount(), 0);
  EXPECT_EQ(widget.Selected().frame, NoFrame);
}

TEST_F(SceneTreeTest, RequestsBecomeCommandsOfASession) {
  vtkNew<vtkDspaceSession> session;
  const auto execute = [&](dspace::v1::Command command) {
    command.set_scene("run");
    dspace::v1::Reply reply;
    reply.ParseFromString(session->Execute(command.SerializeAsString()));
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
    return reply;
  };
  dspace::v1::Command command;
  command.mutable_create_scene();
  execute(command);
  command.mutable_create_frame()->set_name("lander");
  const FrameId lander = execute(command).frame().frame();
  command.Clear();
  auto* box = command.mutable_create_primitive();
  box->mutable_object()->set_frame(lander);
  box->mutable_object()->set_name("hull");
  box->mutable_box()->mutable_size()->set_x(2.0);
  box->mutable_box()->mutable_size()->set_y(2.0);
  box->mutable_box()->mutable_size()->set_z(1.0); // half a diagonal: 1.5 m
  const ObjectId hull = execute(command).object().object();

  SceneTreeWidget widget;
  dspace::widgets::ConnectToSession(widget, session, "run");
  QSignalSpy failed(&widget, &SceneTreeWidget::failed);
  QStringList kinds;
  const auto token = session->GetInterpreter().AddListener(
      [&](const dspace::v1::Command& accepted, const dspace::v1::Reply&) {
        kinds << QString::fromStdString(dspace::session::CommandName(accepted));
      });
  const auto shown = session->GetInterpreter().FindScene("run");
  ASSERT_EQ(widget.Model()->GetScene(), shown);
  EXPECT_EQ(widget.Model()->KindOf({lander, hull}), "primitive");

  widget.Request(SceneAction::Hide, {RootFrame, 0});
  EXPECT_FALSE(shown->Object(hull).visible);
  widget.Request(SceneAction::Show, {lander, hull});
  EXPECT_TRUE(shown->Object(hull).visible);

  widget.Request(SceneAction::Chase, {lander, 0});
  const dspace::CameraMount chase = shown->Vantage("main").ActiveCamera().mount;
  EXPECT_EQ(chase.kind, dspace::CameraMount::Kind::Chase);
  EXPECT_EQ(chase.frame, lander);
  EXPECT_NEAR(chase.offset.norm(), 3.5 * 1.5, 1e-6);
  widget.Request(SceneAction::Focus, {lander, 0});
  EXPECT_NE(shown->Vantage("main").ActiveCamera().mount.kind, dspace::CameraMount::Kind::Chase);

  widget.Request(SceneAction::Axes, {lander, 0});
  const ObjectId axes = shown->FindObject("axes of lander");
  ASSERT_NE(axes, 0u);
  EXPECT_EQ(shown->Object(axes).nature, dspace::Nature::Ornamental);
  widget.Request(SceneAction::Axes, {lander, 0});
  EXPECT_EQ(shown->FindObject("axes of lander"), 0u);

  widget.Request(SceneAction::Trail, {lander, 0});
  const ObjectId trail = shown->FindObject("trail of lander");
  ASSERT_NE(trail, 0u);
  EXPECT_EQ(widget.Model()->KindOf({RootFrame, trail}), "trail");
  for (int i = 1; i <= 3; ++i) {
    command.Clear();
    command.mutable_set_poses()->add_frame(lander);
    for (const double value : {double(i), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      command.mutable_set_poses()->add_pose(value);
    }
    execute(command);
    execute(command); // without a movement there is no point
  }
  const auto& points = session->GetInterpreter().GetState().scenes.at("run").trails.at(trail);
  ASSERT_EQ(points.Size(), 4u);
  EXPECT_EQ(points.End(), Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(kinds.count("append_trail"), 4); // recorded like others
  widget.Request(SceneAction::Trail, {lander, 0});
  EXPECT_EQ(shown->FindObject("trail of lander"), 0u);
  EXPECT_EQ(failed.count(), 0);

  widget.Request(SceneAction::Hide, {lander, hull});
  widget.Request(SceneAction::Focus, {lander, 0}); // nothing visible
  EXPECT_EQ(failed.count(), 1);
  session->GetInterpreter().RemoveListener(token);
  command.Clear();
  command.mutable_remove_scene();
  execute(command);
  widget.Refresh();
  EXPECT_EQ(widget.Model()->rowCount(), 0);
}

TEST_F(SceneTreeTest, ManyRowsArePaintedOnlyInView) {
  dspace::FrameTree& frames = scene->Frames();
  std::vector<ObjectId> ids;
  for (int i = 0; i < 2000; ++i) {
    ids.push_back(
        Add("stone " + std::to_string(i), frames.Create(RootFrame, "f" + std::to_string(i))));
  }
  SceneTreeWidget widget;
  widget.SetScene(scene);
  Show(widget);
  widget.View()->expandAll();
  QTest::qWait(100);
  const int before = widget.View()->Paintings();
  scene->SetObjectVisible(ids.back(), false); // far below; the root's eye is in view
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.View()->Paintings() > before; }, 2000));
  const int mixed = widget.View()->Paintings();
  scene->SetObjectVisible(ids[1500], false); // the root's eye stays
  EXPECT_TRUE(QTest::qWaitFor(
      [&] {
        return widget.Model()->EyeOf({scene->Object(ids[1500]).frame, 0}) == Eye::Hidden;
      },
      2000));
  QTest::qWait(50);
  EXPECT_EQ(widget.View()->Paintings(), mixed);
}
