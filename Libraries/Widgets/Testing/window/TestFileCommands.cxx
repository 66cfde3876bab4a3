// Files are read in another thread: the window lives meanwhile, what hangs is cancelled, what is
// damaged changes nothing, and the thread of the windows reads none of it.
#include "WindowFixture.h"

#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QFileInfo>
#include <QLabel>
#include <QTimer>
#include <QToolButton>

#include "OneApplication.h"
#include "OpenedFiles.h"
#include "ShippedFiles.h"
#include "vtkDspaceSession.h"

#include <dspace/FilesRead.h>
#include <dspace/commands/beforehand/ReadFiles.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/widgets/desktop/NoticeBar.h>
#include <dspace/widgets/window/FileCommands.h>
#include <dspace/widgets/window/Shell.h>
#include <dspace/widgets/window/TaskStrip.h>

using namespace dspace;
using namespace dspace::widgets;

namespace {

// A model whose reading takes long: a box of many triangles, as OBJ.
void WriteLargeModel(const QString& path, int side) {
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  QByteArray text;
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      text += "v " + QByteArray::number(x) + ' ' + QByteArray::number(y) + " 0\n";
    }
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int a = y * (side + 1) + x + 1;
      text += "f " + QByteArray::number(a) + ' ' + QByteArray::number(a + 1) + ' ' +
              QByteArray::number(a + side + 2) + ' ' + QByteArray::number(a + side + 1) + '\n';
    }
  }
  file.write(text);
}

} // namespace

class FileCommandsTest : public WindowFixture {
protected:
  // Whether the strip shows a task whose text contains this.
  static bool Strips(const QString& text) {
    for (const QLabel* label : window->findChild<TaskStrip*>()->findChildren<QLabel*>()) {
      if (label->text().contains(text)) {
        return true;
      }
    }
    return false;
  }
  // Records, in a process of its own, a scene to which these files are added by a line of Python
  // each.
  static bool Record(const QString& path, const QStringList& lines) {
    QString text = "import dspace, sys\n"
                   "with dspace.Session() as session, session.record(sys.argv[1]):\n"
                   "    scene = session.scene('place')\n"
                   "    camera = scene.add_camera(eye=(5, -40, 30), target=(5, 0, 0))\n"
                   "    scene.add_viewport((320, 200), camera, name='main')\n";
    for (const QString& line : lines) {
      text += "    " + line + '\n';
    }
    text += "    scene.time = 1.0\n";
    return Run("import os, subprocess, sys\n"
               "assert subprocess.run([sys.executable, '-W', 'ignore', '-c', r\"\"\"" +
               text + "\"\"\", r'" + path +
               "'], env={**os.environ, 'PYTHONPATH': sys.path[0]}).returncode == 0");
  }
};

TEST_F(FileCommandsTest, TheWindowLivesWhileALargeModelIsRead) {
  const QString path = folder->filePath("large.obj");
  WriteLargeModel(path, 500);
  int ticks = 0;
  bool strip = false;
  QTimer ticking;
  QObject::connect(&ticking, &QTimer::timeout, &ticking, [&] {
    ticks += window->Files()->IsReading() ? 1 : 0;
    strip = strip || window->findChild<TaskStrip*>()->Text(-1).contains("large.obj");
  });
  ticking.start(10);
  ASSERT_TRUE(Run("big = scene.load('" + path + "')")) << errors.toStdString();
  EXPECT_GT(ticks, 3);
  EXPECT_TRUE(strip);
  EXPECT_FALSE(window->Files()->IsReading());
  EXPECT_EQ(Value("big.triangles if hasattr(big, 'triangles') else 500000"), "500000");
}

TEST_F(FileCommandsTest, TheSessionsThreadReadsNoModelTwice) {
  // What is read beforehand is used even where the file is gone: so the command read nothing.
  const QString path = folder->filePath("gone.obj");
  WriteLargeModel(path, 4);
  v1::Command command;
  command.set_scene("scene");
  command.mutable_import_object()->add_level()->set_path(path.toStdString());
  const auto read = session::ReadFiles(command);
  ASSERT_EQ(read->kept.size(), 1u);
  vtkNew<vtkDspaceSession> other;
  v1::Command make;
  make.set_scene("scene");
  make.mutable_create_scene();
  ASSERT_FALSE(other->GetInterpreter().Execute(make).has_error());
  // The cache's key has the file's size and time: only the content is exchanged.
  struct stat before {};
  ASSERT_EQ(stat(path.toUtf8().constData(), &before), 0);
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::ReadWrite));
  file.write(QByteArray(int(file.size()), '#'));
  file.close();
  const timespec times[2] = {before.st_atim, before.st_mtim};
  ASSERT_EQ(utimensat(AT_FDCWD, path.toUtf8().constData(), times, 0), 0);
  v1::Command again = command;
  EXPECT_TRUE(other->GetInterpreter().Execute(again).has_error()); // it is no model now
  const session::ReadBeforehand::Scope scope(read.get());
  const v1::Reply reply = other->GetInterpreter().Execute(command);
  EXPECT_FALSE(reply.has_error()) << reply.error().message();
}

TEST_F(FileCommandsTest, ATerrainIsOpenedInTheOtherThread) {
  const std::string before = Value("sorted(scene.terrains)");
  ASSERT_TRUE(window->Open(ShippedData() + "/field/field.tif")) << errors.toStdString();
  ASSERT_TRUE(Settled());
  // The height is that of the same raster in a session that reads by itself.
  ASSERT_TRUE(Run("ground = list(scene.terrains.values())[-1]\n"
                  "import dspace\n"
                  "with dspace.Session() as other:\n"
                  "    plain = other.scene().add_terrain(r'" +
                  ShippedData() +
                  "/field/field.tif', mode='clipmap')\n"
                  "    pair = (float(ground.height(3.0, -2.0)), float(plain.height(3.0, -2.0)))"))
      << errors.toStdString();
  EXPECT_EQ(Value("pair[0] == pair[1]"), "True");
  // A second one has a name of its own.
  ASSERT_TRUE(window->Open(ShippedData() + "/field/field.tif")) << errors.toStdString();
  EXPECT_EQ(Number("len(scene.terrains)"), 2 + QString::fromStdString(before).count("'") / 2);
}

// Triangles with a relief whose light is that of the scene's Sun when the command is given.
TEST_F(FileCommandsTest, ATerrainOfTrianglesIsOpenedInTheOtherThread) {
  vtkNew<vtkDspaceSession> other;
  session::Interpreter& interpreter = other->GetInterpreter();
  v1::Command make;
  make.set_scene("scene");
  make.mutable_create_scene();
  ASSERT_FALSE(interpreter.Execute(make).has_error());
  v1::Command sun;
  sun.set_scene("scene");
  v1::SetLight& light = *sun.mutable_set_light();
  light.set_name("sun");
  light.mutable_direction()->set_x(-0.6);
  light.mutable_direction()->set_z(-0.8);
  ASSERT_FALSE(interpreter.Execute(sun).has_error());
  v1::Command plain;
  plain.set_scene("scene");
  plain.mutable_open_terrain()->set_path(ShippedData().toStdString() + "/field/field.tif");
  plain.mutable_open_terrain()->set_mode(v1::OpenTerrain::TRIANGLES);
  plain.mutable_open_terrain()->mutable_relief();
  v1::Command command = plain;
  ASSERT_FALSE(interpreter.Execute(plain).has_error()); // reads by itself
  EXPECT_NEAR(plain.open_terrain().relief().sun_elevation_deg(), 53.13, 0.1);
  const session::StateBeforehand state = session::NameBeforehand(interpreter.GetState(), command);
  EXPECT_EQ(command.open_terrain().name(), "terrain 2");
  const auto read = session::ReadFiles(command, state);
  ASSERT_TRUE(read->terrain);
  const session::ReadBeforehand::Scope scope(read.get());
  const v1::Reply reply = interpreter.Execute(command);
  ASSERT_FALSE(reply.has_error()) << reply.error().message();
  EXPECT_FALSE(read->terrain); // it was taken
  EXPECT_EQ(command.open_terrain().relief().SerializeAsString(),
            plain.open_terrain().relief().SerializeAsString());
}

// A layer that was opened for another ground of the same name is opened again.
TEST_F(FileCommandsTest, ALayerIsOpenedInTheOtherThread) {
  vtkNew<vtkDspaceSession> other;
  session::Interpreter& interpreter = other->GetInterpreter();
  const auto give = [&](v1::Command command) {
    command.set_scene("scene");
    const v1::Reply reply = interpreter.Execute(command);
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
    return command;
  };
  v1::Command make, terrain, remove, layer;
  make.mutable_create_scene();
  give(make);
  const std::string field = ShippedData().toStdString() + "/field/";
  terrain.mutable_open_terrain()->set_path(field + "field.tif");
  terrain.mutable_open_terrain()->set_mode(v1::OpenTerrain::CLIPMAP);
  terrain.mutable_open_terrain()->set_name("ground");
  give(terrain);
  layer.set_scene("scene");
  layer.mutable_add_terrain_layer()->set_terrain("ground");
  layer.mutable_add_terrain_layer()->mutable_image()->set_path(field + "field_color.tif");
  const auto readLayer = [&] {
    return session::ReadFiles(layer, session::NameBeforehand(interpreter.GetState(), layer));
  };
  const auto read = readLayer();
  ASSERT_TRUE(read->layer);
  {
    const session::ReadBeforehand::Scope scope(read.get());
    give(layer);
  }
  EXPECT_FALSE(read->layer); // it was taken
  const auto old = readLayer();
  remove.mutable_remove_terrain()->set_terrain("ground");
  give(remove);
  give(terrain);
  {
    const session::ReadBeforehand::Scope scope(old.get());
    give(layer);
  }
  EXPECT_TRUE(old->layer);
  // What is wrong is left to the command.
  layer.mutable_add_terrain_layer()->set_terrain("nowhere");
  EXPECT_FALSE(readLayer()->layer);
}

// The rule is written in both languages: Python asks for each command, without parsing it.
TEST_F(FileCommandsTest, BothLanguagesNameTheSameCommands) {
  std::string names;
  const auto* fields = v1::Command::descriptor()->FindOneofByName("command");
  for (int i = 0; i < fields->field_count(); ++i) {
    v1::Command command;
    command.GetReflection()->MutableMessage(&command, fields->field(i));
    if (session::ReadsFiles(command)) {
      names += (names.empty() ? "'" : ", '") + fields->field(i)->name() + "'";
    }
  }
  ASSERT_TRUE(
      Run("from dspace.application.files import READING\nfrom dspace.proto import commands_pb2"));
  EXPECT_EQ(
      Value("[f.name for f in commands_pb2.Command.DESCRIPTOR.oneofs_by_name['command'].fields "
            "if f.name in READING]"),
      "[" + names + "]");
  EXPECT_EQ(Value("len(READING)"), std::to_string(std::count(names.begin(), names.end(), ',') + 1));
}

TEST_F(FileCommandsTest, AFileThatHangsIsCancelled) {
  const QString path = folder->filePath("hangs.glb");
  ASSERT_EQ(mkfifo(path.toUtf8().constData(), 0600), 0);
  const std::string objects = Value("len(scene.objects)");
  QTimer pressing;
  QObject::connect(&pressing, &QTimer::timeout, &pressing, [] {
    auto* strip = window->findChild<TaskStrip*>();
    for (auto* button : strip->findChildren<QToolButton*>()) {
      if (button->isVisible() && button->text() == "Cancel") {
        QTest::mouseClick(button, Qt::LeftButton);
      }
    }
  });
  pressing.start(200);
  QElapsedTimer clock;
  clock.start();
  EXPECT_FALSE(Run("scene.load('" + path + "')"));
  pressing.stop();
  EXPECT_LT(clock.elapsed(), 10000);
  EXPECT_TRUE(errors.contains("cancelled") || errors.contains("regular file"))
      << errors.toStdString();
  EXPECT_EQ(Value("len(scene.objects)"), objects);
  EXPECT_FALSE(window->Files()->IsReading());
  // Others are read while it still hangs.
  EXPECT_TRUE(Run("scene.load(r'" + ShippedData() + "/rover/chassis.gltf', up='z')"))
      << errors.toStdString();
  const int end = open(path.toUtf8().constData(), O_WRONLY | O_NONBLOCK); // lets its thread end
  if (end >= 0) {
    close(end);
  }
  QTest::qWait(100);
}

TEST_F(FileCommandsTest, DamagedFilesSayWhyAndChangeNothing) {
  const QString path = folder->filePath("damaged.glb");
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("glTF\2\0\0\0 and no more");
  file.close();
  ASSERT_TRUE(Run("before = (len(scene.objects), len(scene.terrains), len(app.views))"));
  EXPECT_FALSE(window->Open(path));
  EXPECT_NE(errors.indexOf("damaged.glb"), -1);
  const QString raster = folder->filePath("damaged.tif");
  QFile bad(raster);
  ASSERT_TRUE(bad.open(QIODevice::WriteOnly));
  bad.write("II*\0 nothing");
  bad.close();
  EXPECT_FALSE(window->Open(raster));
  EXPECT_EQ(Value("before == (len(scene.objects), len(scene.terrains), len(app.views))"), "True");
  EXPECT_TRUE(window->Desktop()->Notices()->isVisible());
  EXPECT_NE(window->Desktop()->Notices()->Text().indexOf("damaged.tif"), -1);
}

TEST_F(FileCommandsTest, TheWindowLivesWhileARecordingIsOpened) {
  const QString model = folder->filePath("recorded.obj");
  WriteLargeModel(model, 500);
  const QString path = folder->filePath("large.dspace");
  ASSERT_TRUE(Record(path, {"scene.load(r'" + model + "')"})) << errors.toStdString();
  int ticks = 0;
  QTimer ticking;
  QObject::connect(&ticking, &QTimer::timeout, &ticking,
                   [&] { ticks += Strips("large.dspace") ? 1 : 0; });
  ticking.start(10);
  ASSERT_TRUE(Run("run = app.open(r'" + path + "')")) << errors.toStdString();
  EXPECT_GE(ticks, 1); // more where the views that are shown are drawn faster
  EXPECT_TRUE(Wait([] { return !Strips("large.dspace"); }));
  EXPECT_EQ(Value("list(run.session.scenes['place'].objects.values())[0].bounds is not None"),
            "True");
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(Run("run.close()"));
}

TEST_F(FileCommandsTest, ARecordingThatIsCancelledChangesNothing) {
  const QString model = folder->filePath("cancelled.obj");
  WriteLargeModel(model, 500);
  const QString path = folder->filePath("cancelled.dspace");
  ASSERT_TRUE(Record(path, {"scene.load(r'" + model + "')"})) << errors.toStdString();
  ASSERT_TRUE(Run("before = (len(app.runs), len(app.views))"));
  bool pressed = false;
  QTimer pressing;
  QObject::connect(&pressing, &QTimer::timeout, &pressing, [&] {
    auto* strip = window->findChild<TaskStrip*>();
    if (!pressed && Strips("cancelled.dspace")) {
      pressed = true;
      strip->findChild<QToolButton*>()->click();
    }
  });
  pressing.start(5);
  EXPECT_FALSE(Run("app.open(r'" + path + "')"));
  EXPECT_TRUE(pressed);
  EXPECT_NE(errors.indexOf("cancelled"), -1) << errors.toStdString();
  EXPECT_EQ(Value("before == (len(app.runs), len(app.views))"), "True");
  // One whose file has changed since says so.
  QFile file(model);
  ASSERT_TRUE(file.open(QIODevice::Append));
  file.write("# changed\n");
  file.close();
  errors.clear();
  EXPECT_FALSE(Run("app.open(r'" + path + "')"));
  EXPECT_NE(errors.indexOf("has changed since it was recorded"), -1) << errors.toStdString();
  EXPECT_EQ(Value("before == (len(app.runs), len(app.views))"), "True");
}

TEST_F(FileCommandsTest, TheThreadOfTheWindowsOpensNoFileOfARecording) {
  const QString copies = folder->filePath("recorded");
  ASSERT_TRUE(QDir().mkpath(copies));
  for (const char* name : {"rover/arm_turret.glb", "field/field.tif", "field/field_color.tif"}) {
    ASSERT_EQ(std::system(("cp '" + ShippedData() + "/" + name + "' '" + copies + "'").toUtf8()),
              0);
  }
  const QString path = folder->filePath("files.dspace");
  ASSERT_TRUE(
      Record(path, {"scene.load(r'" + copies + "/arm_turret.glb')",
                    "ground = scene.add_terrain(r'" + copies + "/field.tif', mode='clipmap')",
                    "ground.add_image(r'" + copies + "/field_color.tif')",
                    "scene.add_terrain(r'" + copies + "/field.tif', mode='triangles')"}))
      << errors.toStdString();
  const OpenedFiles opened;
  ASSERT_TRUE(window->Open(path)) << errors.toStdString();
  ASSERT_TRUE(Settled());
  EXPECT_EQ(Value("len(app.runs[-1].session.scenes['place'].terrains)"), "2");
  EXPECT_EQ(opened.Below(copies.toStdString()), std::vector<std::string>{});
  ASSERT_TRUE(Run("app.runs[-1].close()"));
}

TEST_F(FileCommandsTest, TheThreadOfTheWindowsOpensNoModelAndNoRaster) {
  const OpenedFiles opened;
  const QString copies = folder->filePath("watched");
  ASSERT_TRUE(QDir().mkpath(copies));
  const std::string below = copies.toStdString();
  {
    std::ifstream seen(below + "/nothing"); // the watch works
    ASSERT_EQ(opened.Below(below).size(), 1u);
  }
  for (const char* name : {"rover/chassis.gltf", "rover/arm_turret.glb", "field/field.tif"}) {
    const QString copy = copies + '/' + QFileInfo(name).fileName();
    ASSERT_EQ(std::system(("cp '" + ShippedData() + "/" + name + "' '" + copy + "'").toUtf8()), 0);
    const QString buffers = ShippedData() + "/rover"; // of the glTF
    std::system(
        ("cp -n '" + buffers + "'/*.bin '" + buffers + "'/*.png '" + copies + "' 2>/dev/null")
            .toUtf8());
    ASSERT_TRUE(window->Open(copy)) << name << errors.toStdString();
    ASSERT_TRUE(Settled());
  }
  const QString color = copies + "/field_color.tif";
  ASSERT_EQ(
      std::system(("cp '" + ShippedData() + "/field/field_color.tif' '" + color + "'").toUtf8()),
      0);
  ASSERT_TRUE(Run("watched = list(scene.terrains.values())[-1]\n"
                  "layers = len(watched.layers)\n"
                  "watched.add_image(r'" +
                  color + "')\nwatched.add_false_color(r'" + copies + "/field.tif')"))
      << errors.toStdString();
  EXPECT_EQ(Value("len(watched.layers) - layers"), "2");
  ASSERT_TRUE(Run("scene.add_terrain(r'" + copies + "/field.tif', mode='triangles').remove()"))
      << errors.toStdString();
  EXPECT_EQ(opened.Below(below), std::vector<std::string>{below + "/nothing"});
}

TEST_F(FileCommandsTest, TheWindowLivesWhileAScriptSeeks) {
  // Views of terrain would take the time of the turns of the event loop.
  ASSERT_TRUE(Run("for each in list(app.views.values()): app.close_view(each)\n"));
  const QString model = folder->filePath("sought.obj");
  WriteLargeModel(model, 500);
  const QString path = folder->filePath("sought.dspace");
  ASSERT_TRUE(Record(path, {"scene.time = 0.25", "scene.time = 0.5",
                            "scene.load(r'" + model + "', name='large')"}))
      << errors.toStdString();
  ASSERT_TRUE(Run("run = app.open(r'" + path + "')")) << errors.toStdString();
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(Run("place = run.session.scenes['place']"));
  EXPECT_EQ(Value("(run.time, 'large' in place.objects)"), "(0.25, False)");
  bool cancels = true;
  int ticks = 0;
  // In every turn of the event loop, however long it takes.
  QObject context;
  std::function<void()> look = [&] {
    if (Strips("Moving in sought.dspace")) {
      ++ticks;
      if (cancels) {
        window->findChild<TaskStrip*>()->findChild<QToolButton*>()->click();
      }
    }
    QTimer::singleShot(0, &context, look);
  };
  look();
  // What is cancelled leaves the step before.
  EXPECT_FALSE(Run("run.seek(0.6)"));
  EXPECT_GE(ticks, 1);
  EXPECT_NE(errors.indexOf("cancelled"), -1) << errors.toStdString();
  EXPECT_TRUE(Wait([] { return Value("run._player.IsMoving()") == "False"; }));
  EXPECT_EQ(Value("(run.time, 'large' in place.objects)"), "(0.25, False)");
  cancels = false;
  ticks = 0;
  ASSERT_TRUE(Run("reached = run.seek(0.6)")) << errors.toStdString();
  EXPECT_GE(ticks, 1);
  EXPECT_EQ(Value("(reached, run.time, 'large' in place.objects)"), "(0.5, 0.5, True)");
  EXPECT_TRUE(Wait([] { return !Strips("Moving in"); })); // labels go with the next events
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(Run("run.close()"));
}
