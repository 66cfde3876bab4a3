#include <dspace/widgets/window/ViewBar.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <QActionGroup>
#include <QComboBox>
#include <QDockWidget>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QLabel>
#include <QMenu>
#include <QToolButton>

#include "vtkDspaceSession.h"
#include "vtkDspaceViewport.h"

#include <dspace/interpreter/Interpreter.h>
#include <dspace/scene/Scene.h>
#include <dspace/state/State.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

constexpr std::size_t MostFrames = 24; // of the menu of frames
constexpr int MostSamples = 4;         // of the menu; Python takes up to 8
constexpr int ShortBelow = 420;        // [pixels]: narrower bars leave out words

const char* const Navigations[] = {"orbit", "walk", "map"};

} // namespace

struct ViewBar::Internals {
  ViewBar* bar = nullptr;
  ViewportWidget* widget = nullptr;
  ShownSession session;
  std::string viewport;
  Run run;
  QString view; // as Python
  QLabel* title = nullptr;
  QComboBox* moves = nullptr;
  std::map<QString, QMenu*> menus;
  std::vector<QWidget*> optional; // left out of narrow bars

  explicit Internals(const ShownSession& of) : session(of) {}

  session::State& State() const { return this->session.Session()->GetInterpreter().GetState(); }
  const session::ViewportState* Settings() const {
    const auto& all = this->State().viewports;
    const auto found = all.find(this->viewport);
    return found == all.end() ? nullptr : &found->second;
  }
  std::shared_ptr<Scene> GetScene() const {
    const session::ViewportState* settings = this->Settings();
    return settings ? this->session.Session()->GetInterpreter().FindScene(settings->scene)
                    : nullptr;
  }

  QAction* Add(QMenu& menu, const QString& text, const QString& line) const {
    QAction* action = menu.addAction(text);
    QObject::connect(action, &QAction::triggered, this->bar,
                     [run = this->run, line] { run(line); });
    return action;
  }
  QAction* Toggle(QMenu& menu, const QString& text, const QString& tip, bool on,
                  const QString& field) const {
    QAction* action =
        this->Add(menu, text, QStringLiteral("%1.%2 = %3").arg(this->view, field, PythonOf(!on)));
    action->setCheckable(true);
    action->setChecked(on);
    action->setToolTip(tip);
    return action;
  }
  void Choice(QMenu& menu, QActionGroup*& group, const QString& text, bool on,
              const QString& line) const {
    if (!group) {
      group = new QActionGroup(&menu);
    }
    QAction* action = this->Add(menu, text, line);
    action->setCheckable(true);
    action->setChecked(on);
    group->addAction(action);
  }

  void FillCameras(QMenu& menu) const {
    const session::ViewportState* settings = this->Settings();
    const std::shared_ptr<Scene> scene = this->GetScene();
    if (!settings || !scene) {
      menu.addAction(QObject::tr("Not there at this time"))->setEnabled(false);
      return;
    }
    QActionGroup* group = nullptr;
    const std::vector<std::string> vantages = scene->VantageNames();
    const auto vantage = [&](const std::string& name) {
      return QStringLiteral("%1.scene.vantages[%2]")
          .arg(this->view, Quoted(QString::fromStdString(name)));
    };
    for (const std::string& name : vantages) {
      for (const std::string& camera : scene->Vantage(name).CameraNames()) {
        const QString text =
            QString::fromStdString(name == settings->vantage ? camera : name + ": " + camera);
        this->Choice(menu, group, text, name == settings->vantage && camera == settings->camera,
                     QStringLiteral("%1.camera = %2.cameras[%3]")
                         .arg(this->view, vantage(name), Quoted(QString::fromStdString(camera))));
      }
    }
    this->Choice(menu, group, QObject::tr("The vantage's active camera"), settings->camera.empty(),
                 this->view + ".camera = None");
    if (vantages.size() > 1) {
      QMenu* sub = menu.addMenu(QObject::tr("Vantage"));
      QActionGroup* which = nullptr;
      for (const std::string& name : vantages) {
        this->Choice(*sub, which, QString::fromStdString(name), name == settings->vantage,
                     QStringLiteral("%1.vantage = %2")
                         .arg(this->view, Quoted(QString::fromStdString(name))));
      }
    }
    menu.addSeparator();
    this->FillChase(*menu.addMenu(QObject::tr("Chase")), *scene);
    menu.addSeparator();
    this->Add(menu, QObject::tr("Open a map in step"),
              QStringLiteral("app.open_map(%1)").arg(this->view))
        ->setToolTip(QObject::tr("A view from above that follows this one; a pan of the map moves "
                                 "this one"));
    QMenu* links = menu.addMenu(QObject::tr("Make it a map in step with"));
    for (const auto& [name, other] : this->State().viewports) {
      if (name != this->viewport && other.scene == settings->scene) {
        this->Add(*links, QString::fromStdString(name),
                  QStringLiteral("app.link_map(%1, app.views[%2])")
                      .arg(this->view, Quoted(QString::fromStdString(name))));
      }
    }
    links->setEnabled(!links->isEmpty());
  }

  void FillChase(QMenu& menu, const Scene& scene) const {
    const FrameTree& frames = scene.Frames();
    const std::vector<FrameId> below = frames.Children(RootFrame);
    for (std::size_t i = 0; i < std::min(below.size(), MostFrames); ++i) {
      const QString path = QString::fromStdString(frames.Path(below[i]));
      this->Add(menu, path, QStringLiteral("app.chase(%1, %2)").arg(this->view, Quoted(path)));
    }
    QAction* other = menu.addAction(QObject::tr("Another frame..."));
    QObject::connect(other, &QAction::triggered, this->bar, [this] {
      auto* dialog = new QInputDialog(this->bar);
      dialog->setAttribute(Qt::WA_DeleteOnClose);
      dialog->setWindowTitle(QObject::tr("Chase"));
      dialog->setLabelText(QObject::tr("Path of a frame, such as rover/mast"));
      QObject::connect(
          dialog, &QInputDialog::textValueSelected, this->bar, [this](const QString& path) {
            this->run(QStringLiteral("app.chase(%1, %2)").arg(this->view, Quoted(path.trimmed())));
          });
      dialog->open();
    });
    menu.addSeparator();
    this->Add(menu, QObject::tr("Stand still"),
              QStringLiteral("app.chase(%1, None)").arg(this->view));
  }

  void FillShow(QMenu& menu) const {
    const session::ViewportState* settings = this->Settings();
    const std::shared_ptr<Scene> scene = this->GetScene();
    vtkDspaceViewport* viewport = this->session.Viewport(this->viewport);
    if (!settings || !scene || !viewport) {
      menu.addAction(QObject::tr("Not there at this time"))->setEnabled(false);
      return;
    }
    this->Toggle(menu, QObject::tr("Ornaments"), QObject::tr("Labels, trails, axes, marks"),
                 settings->ornaments, "ornaments");
    this->Toggle(menu, QObject::tr("Shadows"), QObject::tr("Shadows of the Sun"),
                 viewport->GetLook().shadows.shown, "shadows");
    this->Toggle(menu, QObject::tr("Corner axes"), QObject::tr("The axes of the root frame"),
                 settings->cornerAxes, "corner_axes");
    menu.addSection(QObject::tr("Fragments"));
    for (const std::string& name : scene->Fragments().Names()) {
      const bool hidden = settings->hiddenFragments.count(name) > 0;
      const bool everywhere = scene->Fragments().Get(name).visible;
      const QString text = QString::fromStdString(name);
      QAction* action = this->Add(
          menu, everywhere ? text : QObject::tr("%1 (hidden)").arg(text),
          QStringLiteral("%1.%2(%3)").arg(this->view, hidden ? "show" : "hide", Quoted(text)));
      action->setCheckable(true);
      action->setChecked(!hidden);
      action->setEnabled(everywhere);
    }
  }

  void FillStyle(QMenu& menu) const {
    vtkDspaceViewport* viewport = this->session.Viewport(this->viewport);
    if (!viewport) {
      menu.addAction(QObject::tr("Not there at this time"))->setEnabled(false);
      return;
    }
    const ViewLook& look = viewport->GetLook();
    QActionGroup* samples = nullptr;
    menu.addSection(QObject::tr("Samples a pixel"));
    for (int n = 1; n <= MostSamples; ++n) {
      this->Choice(menu, samples, QString("%1 x %1").arg(n), this->widget->OwnSamples() == n,
                   QStringLiteral("%1.samples = %2").arg(this->view).arg(n));
    }
    menu.addSection(QObject::tr("Light"));
    this->Toggle(menu, QObject::tr("Automatic exposure"), QString(), look.automaticExposure,
                 "automatic_exposure");
    this->Add(menu, QObject::tr("Brighter"),
              QStringLiteral("%1.exposure = %2").arg(this->view, PythonOf(2.0 * look.exposure)));
    this->Add(menu, QObject::tr("Darker"),
              QStringLiteral("%1.exposure = %2").arg(this->view, PythonOf(0.5 * look.exposure)));
    this->Add(menu, QObject::tr("Exposure 1"), QStringLiteral("%1.exposure = 1").arg(this->view));
    const bool filmic = look.tone == ToneCurve::Filmic;
    QAction* tone =
        this->Add(menu, QObject::tr("Filmic tones"),
                  QStringLiteral("%1.tone = \"%2\"").arg(this->view, filmic ? "linear" : "filmic"));
    tone->setCheckable(true);
    tone->setChecked(filmic);
    QMenu* fill = menu.addMenu(QObject::tr("Fill light"));
    QActionGroup* fills = nullptr;
    for (const double part : {0.0, 0.05, 0.1, 0.2, 0.5}) {
      this->Choice(*fill, fills, QString("%1 %").arg(100.0 * part),
                   std::abs(look.fill - part) < 1e-9,
                   QStringLiteral("%1.fill = %2").arg(this->view, PythonOf(part)));
    }
    menu.addSection(QObject::tr("For engineers"));
    this->Toggle(menu, QObject::tr("Lit part of the Sun's disc"),
                 QObject::tr("In false colours, with shadows"), look.shadows.litColors,
                 "lit_colors");
    this->Toggle(menu, QObject::tr("Ranges of shadow maps"),
                 QObject::tr("In colours, with shadows"), look.shadows.cascadeColors,
                 "cascade_colors");
    menu.addSection(QObject::tr("Background"));
    for (const auto& [text, line] : std::vector<std::pair<QString, QString>>{
             {QObject::tr("Black"), "\"black\""},
             {QObject::tr("Grey"), "\"#30343a\""},
             {QObject::tr("White"), "\"white\""},
             {QObject::tr("Haze"), "\"#c9b8a0\", top=\"#6c7f99\""}}) {
      this->Add(menu, text, QStringLiteral("%1.set_background(%2)").arg(this->view, line));
    }
  }

  void FillWindow(QMenu& menu) const {
    const QString view = this->view;
    this->Add(menu, QObject::tr("Maximise"), QStringLiteral("app.maximize_view(%1)").arg(view));
    this->Add(menu, QObject::tr("Restore"), QStringLiteral("app.restore_views()"));
    this->Add(menu, QObject::tr("Split right"), QStringLiteral("app.split_view(%1)").arg(view));
    this->Add(menu, QObject::tr("Split below"),
              QStringLiteral("app.split_view(%1, \"below\")").arg(view));
    QAction* floating = menu.addAction(QObject::tr("Float"));
    floating->setToolTip(QObject::tr("A window of its own, or back"));
    QObject::connect(floating, &QAction::triggered, this->bar, [this] { this->Float(); });
    menu.addSeparator();
    this->Add(menu, QObject::tr("Copy picture"), QStringLiteral("app.copy_picture(%1)").arg(view));
    QAction* save = menu.addAction(QObject::tr("Save picture..."));
    QObject::connect(save, &QAction::triggered, this->bar, [this] { this->Save(); });
    menu.addSeparator();
    this->Add(menu, QObject::tr("Close view"), QStringLiteral("app.close_view(%1)").arg(view));
  }

  void Float() const {
    for (QWidget* parent = this->bar->parentWidget(); parent; parent = parent->parentWidget()) {
      if (auto* dock = qobject_cast<QDockWidget*>(parent)) {
        dock->setFloating(!dock->isFloating());
        return;
      }
    }
  }
  void Save() const {
    auto* dialog = new QFileDialog(this->bar, QObject::tr("Save picture"), QString(),
                                   QObject::tr("Pictures (*.png *.jpg *.tif *.exr)"));
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setDefaultSuffix(QStringLiteral("png"));
    QObject::connect(dialog, &QFileDialog::fileSelected, this->bar, [this](const QString& path) {
      this->run(QStringLiteral("%1.save(%2)").arg(this->view, Quoted(path)));
    });
    dialog->open();
  }

  QToolButton* Button(QHBoxLayout& row, const QString& text, const QString& tip) {
    auto* button = new QToolButton(this->bar);
    button->setText(text);
    button->setToolTip(tip);
    button->setAutoRaise(true);
    row.addWidget(button);
    return button;
  }
  void MenuButton(QHBoxLayout& row, const QString& name, const QString& text, const QString& tip,
                  void (Internals::*fill)(QMenu&) const) {
    QToolButton* button = this->Button(row, text, tip);
    button->setPopupMode(QToolButton::InstantPopup);
    auto* menu = new QMenu(button);
    menu->setToolTipsVisible(true);
    QObject::connect(menu, &QMenu::aboutToShow, this->bar, [this, menu, fill] {
      for (QMenu* sub : menu->findChildren<QMenu*>(Qt::FindDirectChildrenOnly)) {
        sub->deleteLater();
      }
      for (auto* group : menu->findChildren<QActionGroup*>(Qt::FindDirectChildrenOnly)) {
        group->deleteLater();
      }
      menu->clear();
      (this->*fill)(*menu);
    });
    button->setMenu(menu);
    button->setObjectName(name);
    this->menus[name] = menu;
  }
};

ViewBar::ViewBar(ViewportWidget* widget, const ShownSession& session, const std::string& viewport,
                 const QString& title, Run run, QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>(session)) {
  Internals& self = *this->Impl_;
  self.bar = this;
  self.widget = widget;
  self.viewport = viewport;
  self.run = std::move(run);
  self.view = QStringLiteral("app.views[%1]").arg(Quoted(QString::fromStdString(viewport)));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(4, 1, 4, 1);
  row->setSpacing(1);
  self.title = new QLabel(title, this);
  self.title->setTextFormat(Qt::PlainText);
  self.title->setToolTip(title);
  self.title->setMinimumWidth(24);
  self.title->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  row->addWidget(self.title, 1);
  self.MenuButton(*row, "camera", tr("Camera"),
                  tr("Camera, vantage, what is chased, and a map in step"),
                  &Internals::FillCameras);
  self.MenuButton(*row, "show", tr("Show"), tr("Ornaments, shadows, axes, and fragments"),
                  &Internals::FillShow);
  self.MenuButton(*row, "style", tr("Style"), tr("Samples a pixel, exposure, background"),
                  &Internals::FillStyle);
  self.moves = new QComboBox(this);
  for (const char* kind : Navigations) {
    self.moves->addItem(tr(kind));
  }
  self.moves->setObjectName(QStringLiteral("navigation"));
  self.moves->setToolTip(
      tr("How the mouse and keys move the camera: orbit about a point, walk on the "
         "ground with W A S D, or a map that does not turn"));
  connect(self.moves, &QComboBox::activated, this, [&self](int index) {
    self.run(QStringLiteral("%1.navigation = \"%2\"").arg(self.view, Navigations[index]));
  });
  row->addWidget(self.moves);
  self.optional.push_back(self.moves);
  connect(widget, &ViewportWidget::shown, this, [&self] { // Python may have set it
    const int now = int(self.widget->GetViewport()->GetNavigation().kind);
    if (self.moves->currentIndex() != now) {
      self.moves->setCurrentIndex(now);
    }
  });
  QToolButton* whole =
      self.Button(*row, tr("Fit"), tr("Shows everything, without turning the camera"));
  connect(whole, &QToolButton::clicked, this,
          [&self] { self.run(QStringLiteral("app.fit(%1)").arg(self.view)); });
  self.optional.push_back(whole);
  self.MenuButton(*row, "window", QString(QChar(0x22ee)), // a vertical ellipsis
                  tr("Maximise, split, float, picture, close"), &Internals::FillWindow);
}

ViewBar::~ViewBar() = default;

QMenu* ViewBar::Menu(const QString& name) {
  QMenu* menu = this->Impl_->menus[name];
  emit menu->aboutToShow();
  return menu;
}

void ViewBar::resizeEvent(QResizeEvent*) {
  for (QWidget* each : this->Impl_->optional) {
    each->setVisible(this->width() >= ShortBelow);
  }
}

} // namespace dspace::widgets
