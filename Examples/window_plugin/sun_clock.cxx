// A plug-in of DspaceQt in C++: a dock with a button, an entry of a menu with a key, a cross-hair
// over all views, and the scene's time in the status bar.
#include <QLabel>
#include <QMainWindow>
#include <QPainter>
#include <QPushButton>
#include <QStatusBar>
#include <QVBoxLayout>

#include <vtkDspaceSession.h>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/WindowPlugIn.h>

namespace {

bool crossShown = true;

void DrawCross(QPainter& painter, const dspace::widgets::ViewportWidget& view) {
  if (!crossShown) {
    return;
  }
  const QPointF middle(0.5 * view.width(), 0.5 * view.height());
  constexpr double Gap = 6.0;
  constexpr double Arm = 22.0;
  painter.setPen(QPen(QColor(255, 214, 102), 1.5));
  for (const QPointF way : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)}) {
    painter.drawLine(middle + Gap * way, middle + Arm * way);
  }
}

void Begin(dspace::widgets::WindowPlugIn& window) {
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  auto* noon = new QPushButton("Noon");
  noon->setToolTip("Puts the Sun 80 degrees high");
  column->addWidget(new QLabel("The Sun of the scene"));
  column->addWidget(noon);
  column->addStretch();
  QObject::connect(noon, &QPushButton::clicked,
                   [&window] { window.Run("scene.sun.set(azimuth_deg=180, elevation_deg=80)"); });
  window.AddDock("Sun clock", content);
  window.AddAction("&Mission", "Show the &cross-hair", "F8", [&window] {
    crossShown = !crossShown;
    for (auto* view : window.Window()->findChildren<QWidget*>("overlay")) {
      view->update();
    }
  });
  window.OnKey("Ctrl+Shift+N", [&window] { window.Run("app.new_view()"); });
  window.AddOverlay(DrawCross);
  window.AddReadOut("scene time", [&window] {
    const auto& scenes = window.Session()->GetInterpreter().GetState().scenes;
    const auto found = scenes.find("scene");
    return found == scenes.end() ? QString("-")
                                 : QString::number(found->second.scene->Time(), 'f', 1) + " s";
  });
}

} // namespace

DSPACE_WINDOW_PLUG_IN(Begin)
