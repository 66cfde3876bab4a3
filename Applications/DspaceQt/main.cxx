// DspaceQt: scenes, recordings and terrain at a desktop. Wiring only: the windows are in
// Libraries/Widgets, and what menus do is in the Python package, dspace/application.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>

#include <QApplication>
#include <QCommandLineParser>
#include <QDialog>
#include <QDir>
#include <QElapsedTimer>
#include <QIcon>
#include <QMessageBox>
#include <QPainter>
#include <QStatusBar>
#include <QTimer>

#include <dspace/commands/beforehand/ReadApart.h>
#include <dspace/widgets/console/PythonInterpreter.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/window/MainWindow.h>
#include <dspace/widgets/window/Shell.h>
#include <dspace/widgets/window/SmallWindow.h>

namespace {

// The folder with the Python package, beside this program in a build tree and in an installed one.
QString Packages() {
  const QString given = qEnvironmentVariable("DSPACE_PACKAGES");
  return given.isEmpty() ? QDir(QCoreApplication::applicationDirPath())
                               .absoluteFilePath(QStringLiteral(DSPACE_PACKAGES_BESIDE))
                         : given;
}

// Saves a picture of the window when everything in it is drawn, and quits.
void TakeScreenshot(dspace::widgets::MainWindow& window, const QString& path, double after_s) {
  auto* timer = new QTimer(&window);
  auto clock = std::make_shared<QElapsedTimer>();
  clock->start();
  auto calm = std::make_shared<QElapsedTimer>(); // since the window is settled
  calm->start();
  QObject::connect(timer, &QTimer::timeout, &window, [&window, path, after_s, clock, calm] {
    const double elapsed = 1e-3 * double(clock->elapsed());
    constexpr double Patience = 2.0; // [s] for scenes that never stand still
    constexpr qint64 Calm_ms = 300;  // docks find their places, and show what they look at
    if (!window.IsSettled()) {
      calm->start();
    }
    if (elapsed < after_s || (calm->elapsed() < Calm_ms && elapsed < after_s + Patience)) {
      return;
    }
    QPixmap picture = window.grab();
    QPainter painter(&picture);
    for (QWidget* each : QApplication::topLevelWidgets()) { // dialogs over it
      if (each != &window && each->isVisible() && qobject_cast<QDialog*>(each)) {
        const QPoint corner(std::max(0, (window.width() - each->width()) / 2),
                            std::max(0, (window.height() - each->height()) / 2));
        painter.fillRect(QRect(corner - QPoint(1, 1), each->size() + QSize(2, 2)),
                         each->palette().color(QPalette::Mid));
        painter.drawPixmap(corner, each->grab());
      }
    }
    painter.end();
    const bool saved = picture.save(path, "PNG");
    if (!saved) {
      std::cerr << "DspaceQt: " << path.toStdString() << " cannot be written\n";
    }
    QCoreApplication::exit(saved ? 0 : 1);
  });
  timer->start(50);
}

// `--listen` without an address listens on any free port of this machine.
QStringList Arguments() {
  QStringList arguments = QCoreApplication::arguments();
  for (qsizetype i = 1; i < arguments.size(); ++i) {
    if (arguments[i] == QStringLiteral("--listen") &&
        (i + 1 == arguments.size() || arguments[i + 1].startsWith('-') ||
         !arguments[i + 1].contains(':'))) {
      arguments[i] = QStringLiteral("--listen=127.0.0.1:0");
    }
  }
  return arguments;
}

int Start(QApplication&) {
  QCommandLineParser parser;
  parser.setApplicationDescription("3D visualization and measurement for spacecraft and rovers.");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument("files",
                               "models, rasters of heights, robots, recordings, Python "
                               "scripts; none: the demo scene",
                               "[FILE ...]");
  const QCommandLineOption screenshot("screenshot", "Saves a picture of the window and quits.",
                                      "PNG");
  const QCommandLineOption after("after", "Seconds before the screenshot (default 0).", "S", "0");
  const QCommandLineOption size("size", "Size of the window (default 1280x800).", "WxH",
                                "1280x800");
  const QCommandLineOption empty("empty", "Opens no demo scene.");
  const QCommandLineOption connect("connect", "Shows the scene of a server.", "ADDRESS");
  const QCommandLineOption listen(
      "listen", "Serves: a simulation that connects drives this window (127.0.0.1:0).", "ADDRESS");
  const QCommandLineOption root(
      "root",
      "Of --listen: a folder whose files the simulation may name (default: the working folder); "
      "may be repeated.",
      "DIR");
  const QCommandLineOption plugin(
      "load-plugin", "Loads a plug-in: a Python file or module; may be repeated.", "NAME");
  const QCommandLineOption layout("layout", "Arranges the docks as they were saved by that name.",
                                  "NAME");
  parser.addOptions({screenshot, after, size, empty, connect, listen, root, plugin, layout});
  parser.process(Arguments());
  const QStringList sides = parser.value(size).split('x');
  bool good[3] = {false, false, false};
  const int width = sides.value(0).toInt(&good[0]);
  const int height = sides.value(1).toInt(&good[1]);
  const double wait = parser.value(after).toDouble(&good[2]);
  if (sides.size() != 2 || !good[0] || !good[1] || width < 320 || height < 240 || width > 16384 ||
      height > 16384) {
    std::cerr << "DspaceQt: --size " << parser.value(size).toStdString()
              << ": accepted are 320x240 to 16384x16384\n";
    return 2;
  }
  if (!good[2] || !(wait >= 0.0 && wait <= 3600.0)) {
    std::cerr << "DspaceQt: --after " << parser.value(after).toStdString()
              << ": accepted are 0 to 3600 seconds\n";
    return 2;
  }
  if (parser.isSet(root) && !parser.isSet(listen)) {
    std::cerr << "DspaceQt: --root: accepted with --listen\n";
    return 2;
  }
  QIcon icon;
  for (const int side : {16, 32, 48, 128}) {
    icon.addFile(QStringLiteral(":/dspace/icons/dspace-%1.png").arg(side));
  }
  QApplication::setWindowIcon(icon);
  dspace::widgets::MainWindow window(Packages());
  // What goes wrong is on the terminal, too.
  QObject::connect(window.Interpreter(), &dspace::widgets::PythonInterpreter::written, &window,
                   [](const QString& text, bool error) {
                     if (error) {
                       std::cerr << text.toStdString() << std::flush;
                     }
                   });
  window.resize(width, height);
  if (!parser.isSet(screenshot) && !parser.isSet(size)) {
    window.Desktop()->Start(); // where it was the last time
  }
  window.show();
  bool done = window.LoadPlugIns(parser.values(plugin));
  for (const QString& path : parser.positionalArguments()) {
    done = window.Open(path) && done;
  }
  for (const QString& address : parser.values(connect)) {
    done = window.Connect(address) && done;
  }
  for (const QString& address : parser.values(listen)) {
    done = window.Listen(address, parser.values(root)) && done;
  }
  if (parser.positionalArguments().isEmpty() && !parser.isSet(empty) && !parser.isSet(connect) &&
      !parser.isSet(listen)) {
    window.Run(QStringLiteral("app.demo()"));
  }
  if (parser.isSet(layout)) {
    done = window.RestoreLayout(parser.value(layout)) && done;
  }
  if (parser.isSet(size)) {
    QTimer::singleShot(0, &window, [&window, wanted = QSize(width, height)] {
      const QString told =
          dspace::widgets::KeepSmall(window, wanted); // with the views of the files
      if (!told.isEmpty()) {
        window.statusBar()->showMessage(told);
        std::cerr << "DspaceQt: --size " << told.toStdString() << "\n";
      }
    });
  }
  if (!done && parser.isSet(screenshot)) {
    return 1; // the messages are on the terminal
  }
  if (parser.isSet(screenshot)) {
    TakeScreenshot(window, parser.value(screenshot), wait);
  }
  // Without a window, because it was closed while files were opened, nothing would end the loop.
  const int code = window.isVisible() ? QApplication::exec() : 0;
  constexpr double Patience = 2.0; // [s]
  if (!dspace::session::ReadApart::WaitForAll(Patience)) {
    std::cout << std::flush;
    std::_Exit(code); // what such a thread uses must not be cleaned up
  }
  return code;
}

} // namespace

int main(int count, char** arguments) {
  dspace::widgets::PrepareApplication();
  QApplication application(count, arguments);
  QCoreApplication::setOrganizationName(QStringLiteral("Dspace"));
  QCoreApplication::setApplicationName(QStringLiteral("DspaceQt"));
  QGuiApplication::setDesktopFileName(QStringLiteral("dspace"));
  QCoreApplication::setApplicationVersion(QStringLiteral(DSPACE_VERSION));
  try {
    return Start(application);
  } catch (const std::exception& error) {
    std::cerr << "DspaceQt: " << error.what() << "\n";
    const bool unattended = std::any_of(arguments, arguments + count, [](const char* argument) {
      return std::string(argument).rfind("--screenshot", 0) == 0;
    });
    if (unattended) {
      return 1; // nobody would close a dialog
    }
    QMessageBox box(QMessageBox::Critical, QStringLiteral("DspaceQt"),
                    QString::fromUtf8(error.what()), QMessageBox::Close);
    box.setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
    box.exec();
    return 1;
  }
}
