#include <dspace/widgets/terrain/TerrainWidget.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <QComboBox>
#include <QFileDialog>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QSlider>
#include <QStackedWidget>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/terrain/LayerList.h>
#include <dspace/widgets/terrain/RampLegend.h>
#include <dspace/widgets/terrain/StyleEditor.h>

namespace dspace::widgets {
namespace {

constexpr int Look_ms = 330;

QToolButton* MakeButton(const QString& text, const QString& tip, const QString& name) {
  auto* button = new QToolButton;
  button->setText(text);
  button->setToolTip(tip);
  button->setAccessibleName(tip);
  button->setObjectName(name);
  return button;
}

std::vector<QColor> Colors(const google::protobuf::RepeatedPtrField<v1::Color>& from) {
  std::vector<QColor> colors;
  for (const v1::Color& color : from) {
    colors.push_back(QColor::fromRgbF(float(color.r()), float(color.g()), float(color.b())));
  }
  return colors;
}

} // namespace

TerrainWidget::TerrainWidget(QWidget* parent) : QWidget(parent) {
  this->Timer_ = new QTimer(this);
  connect(this->Timer_, &QTimer::timeout, this, &TerrainWidget::Refresh);
  this->Terrains_ = new QComboBox;
  this->Terrains_->setObjectName(QStringLiteral("terrains"));
  this->Terrains_->setToolTip(tr("The terrain whose layers and style are below"));
  this->About_ = new QLabel;
  this->About_->setWordWrap(true);
  this->About_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  this->Layers_ = new LayerList;
  this->Layers_->setMinimumHeight(90);
  this->Opacity_ = new QSlider(Qt::Horizontal);
  this->Opacity_->setObjectName(QStringLiteral("opacity"));
  this->Opacity_->setRange(0, 100);
  this->Opacity_->setPageStep(10);
  this->Opacity_->setTracking(false); // one command a drag
  this->Opacity_->setToolTip(tr("The opacity of the selected layer"));
  this->OpacityText_ = new QLabel;
  this->OpacityText_->setMinimumWidth(this->fontMetrics().horizontalAdvance(tr("100 %")));
  this->OpacityText_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  this->Add_ = MakeButton(tr("Add"), tr("Adds a layer"), QStringLiteral("add"));
  this->Add_->setPopupMode(QToolButton::InstantPopup);
  this->Add_->setMenu(new QMenu(this->Add_));
  connect(this->Add_->menu(), &QMenu::aboutToShow, this, &TerrainWidget::FillAddMenu);
  this->Remove_ =
      MakeButton(tr("Remove"), tr("Removes the selected layer (Delete)"), QStringLiteral("remove"));
  this->Up_ = MakeButton(tr("Up"), tr("Moves the selected layer up (Alt+Up, or drag it)"),
                         QStringLiteral("up"));
  this->Down_ = MakeButton(tr("Down"), tr("Moves the selected layer down (Alt+Down, or drag it)"),
                           QStringLiteral("down"));
  this->Legend_ = new RampLegend;
  this->Style_ = new StyleEditor;

  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(6, 6, 6, 6);
  column->addWidget(this->Terrains_);
  column->addWidget(this->About_);
  column->addWidget(this->Layers_, 1);
  auto* opacity = new QHBoxLayout;
  opacity->addWidget(new QLabel(tr("Opacity")));
  opacity->addWidget(this->Opacity_, 1);
  opacity->addWidget(this->OpacityText_);
  column->addLayout(opacity);
  auto* buttons = new QHBoxLayout;
  for (QToolButton* button : {this->Add_, this->Remove_, this->Up_, this->Down_}) {
    buttons->addWidget(button);
  }
  buttons->addStretch();
  column->addLayout(buttons);
  column->addWidget(this->Legend_);
  auto* style = new QGroupBox(tr("Style"));
  auto* within = new QVBoxLayout(style);
  within->setContentsMargins(2, 2, 2, 2);
  within->addWidget(this->Style_);
  column->addWidget(style);
  auto* scroll = new QScrollArea;
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff); // nothing is cut at the side:
  scroll->setMinimumWidth(content->minimumSizeHint().width() +
                          scroll->verticalScrollBar()->sizeHint().width());
  auto* none =
      new QLabel(tr("This scene has no terrain.\n\nOpen a raster of heights (File > Open), or call "
                    "scene.add_terrain() in the Python dock."));
  none->setAlignment(Qt::AlignCenter);
  none->setWordWrap(true);
  none->setMargin(12);
  this->Pages_ = new QStackedWidget;
  this->Pages_->addWidget(none);
  this->Pages_->addWidget(scroll);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(this->Pages_);

  connect(this->Terrains_, &QComboBox::currentTextChanged, this, [this] {
    this->Seen_.clear();
    this->Refresh();
  });
  connect(this->Layers_, &LayerList::visibleWanted, this, [this](const QString& name, bool on) {
    this->Change(this->LayerPath(name) + QStringLiteral(".visible = ") + PythonOf(on));
  });
  connect(this->Layers_, &LayerList::positionWanted, this, [this](const QString& name, int to) {
    this->Change(this->LayerPath(name) + QStringLiteral(".position = %1").arg(to));
  });
  const auto remove = [this](const QString& name) {
    if (!name.isEmpty()) {
      this->Change(this->LayerPath(name) + QStringLiteral(".remove()"));
    }
  };
  connect(this->Layers_, &LayerList::removeWanted, this, remove);
  connect(this->Layers_, &QTreeWidget::currentItemChanged, this, [this] { this->ShowSelected(); });
  connect(this->Opacity_, &QSlider::valueChanged, this, [this](int percent) {
    const QString name = this->Layers_->Selected();
    if (!name.isEmpty()) {
      this->Change(this->LayerPath(name) + QStringLiteral(".opacity = ") +
                   PythonOf(percent / 100.0));
    }
  });
  connect(this->Opacity_, &QSlider::sliderMoved, this,
          [this](int percent) { this->OpacityText_->setText(tr("%1 %").arg(percent)); });
  connect(this->Remove_, &QToolButton::clicked, this,
          [this, remove] { remove(this->Layers_->Selected()); });
  const auto move = [this](int by) {
    for (const v1::TerrainLayerReply& layer : this->State_.layers.layer()) {
      const int to = int(layer.position()) + by;
      if (QString::fromStdString(layer.name()) == this->Layers_->Selected() && to >= 0 &&
          to < this->State_.layers.layer_size()) {
        emit this->Layers_->positionWanted(this->Layers_->Selected(), to);
        return;
      }
    }
  };
  connect(this->Up_, &QToolButton::clicked, this, [move] { move(1); });
  connect(this->Down_, &QToolButton::clicked, this, [move] { move(-1); });
  connect(this->Style_, &StyleEditor::styleWanted, this, [this](const QString& arguments) {
    this->Change(this->Path() + QStringLiteral(".change_style(%1)").arg(arguments));
  });
  connect(this->Style_, &StyleEditor::sunWanted, this, [this](double azimuth, double elevation) {
    this->Change(QStringLiteral("sun.set(azimuth_deg=%1, elevation_deg=%2, terrain=%3)")
                     .arg(PythonOf(azimuth), PythonOf(elevation), Quoted(this->Terrain())));
  });
  this->ShowSelected();
}

void TerrainWidget::SetSource(Source source) {
  this->Source_ = std::move(source);
  this->Seen_.clear();
  this->Refresh();
}

v1::Reply TerrainWidget::Ask(const Shown& shown, v1::Command& command) {
  command.set_scene(shown.scene);
  v1::Reply reply;
  reply.ParseFromString(shown.execute(command.SerializeAsString()));
  return reply;
}

void TerrainWidget::Change(const QString& python) {
  emit this->changeWanted(python);
  this->Seen_.clear(); // what was refused is shown as it is
  QMetaObject::invokeMethod(this, &TerrainWidget::Refresh, Qt::QueuedConnection);
}

void TerrainWidget::Refresh() {
  const Shown shown = this->Source_ ? this->Source_() : Shown();
  if (shown.busy) {
    return;
  }
  if (!shown.execute) {
    this->Pages_->setCurrentIndex(0);
    return;
  }
  this->ShowTerrains(shown);
  if (this->Terrains_->count() == 0) {
    return;
  }
  const TerrainState state = this->StateOf(shown, this->Terrain().toStdString());
  // Counters of tiles change all the time, and are not shown.
  v1::TerrainLayerList layers;
  *layers.mutable_layer() = state.layers.layer();
  const std::string seen = this->Terrain().toStdString() + (state.canChange ? "\n" : "\r") +
                           layers.SerializeAsString() + '\n' + state.style.SerializeAsString() +
                           '\n' + state.fields.SerializeAsString();
  if (seen != this->Seen_) {
    this->Seen_ = seen;
    this->ShowTerrain(state);
  }
}

void TerrainWidget::ShowTerrains(const Shown& shown) {
  v1::Command command;
  command.mutable_list_terrains();
  QStringList names;
  const v1::Reply listed = Ask(shown, command); // with an error where the scene is gone
  for (const std::string& name : listed.terrains().name()) {
    names << QString::fromStdString(name);
  }
  QStringList old;
  for (int i = 0; i < this->Terrains_->count(); ++i) {
    old << this->Terrains_->itemText(i);
  }
  if (names != old) {
    const QString chosen = this->Terrains_->currentText();
    const QSignalBlocker silent(this->Terrains_);
    this->Terrains_->clear();
    this->Terrains_->addItems(names);
    this->Terrains_->setCurrentIndex(std::max(0, int(names.indexOf(chosen))));
    this->Seen_.clear();
  }
  this->Pages_->setCurrentIndex(names.isEmpty() ? 0 : 1);
}

TerrainState TerrainWidget::StateOf(const Shown& shown, const std::string& terrain) const {
  TerrainState state;
  state.canChange = shown.canChange;
  v1::Command command;
  command.mutable_describe_terrain()->set_terrain(terrain);
  state.terrain = Ask(shown, command).terrain();
  state.layered = state.terrain.mode() == v1::OpenTerrain::CLIPMAP;
  command.Clear();
  command.mutable_list_terrain_layers()->set_terrain(terrain);
  state.layers = Ask(shown, command).terrain_layers();
  command.Clear();
  command.mutable_list_terrain_fields()->set_terrain(terrain);
  state.fields = Ask(shown, command).terrain_fields();
  if (state.layered) {
    command.Clear();
    command.mutable_describe_terrain_style()->set_terrain(terrain);
    const v1::Reply reply = Ask(shown, command);
    state.style = reply.terrain_style().given();
    state.style.clear_ramp();
    if (reply.terrain_style().has_ramp()) {
      *state.style.mutable_ramp() = reply.terrain_style().ramp();
    }
  }
  return state;
}

QString TerrainWidget::Terrain() const {
  return this->Terrains_->currentText();
}
QString TerrainWidget::Path() const {
  return QStringLiteral("terrains[%1]").arg(Quoted(this->Terrain()));
}
QString TerrainWidget::LayerPath(const QString& layer) const {
  return this->Path() + QStringLiteral(".layer(%1)").arg(Quoted(layer));
}

void TerrainWidget::ShowTerrain(const TerrainState& state) {
  this->State_ = state;
  const v1::TerrainReply& terrain = state.terrain;
  QString about = tr("%1 %6 %2 pixels, %3, heights %4 to %5 m")
                      .arg(terrain.columns())
                      .arg(terrain.rows())
                      .arg(state.layered ? tr("clipmap") : tr("triangles"))
                      .arg(terrain.minimum_height(), 0, 'f', 1)
                      .arg(terrain.maximum_height(), 0, 'f', 1)
                      .arg(QChar(0xd7));
  if (!state.layered) {
    about += QLatin1Char('\n') +
             tr("It takes layers of normals only, and no style. Open it with mode=\"clipmap\" for "
                "the others.");
  }
  if (!state.canChange) {
    about += QLatin1Char('\n') + tr("Only its simulation changes this terrain.");
  }
  this->About_->setText(about);
  this->About_->setToolTip(QString::fromStdString(terrain.vertical_datum()));
  this->Layers_->Show(state.layers, state.canChange);
  this->Add_->setEnabled(state.canChange);
  this->Style_->Show(state);
  this->ShowLegend(state);
  this->ShowSelected();
}

void TerrainWidget::ShowLegend(const TerrainState& state) {
  std::vector<RampEntry> entries;
  if (state.style.has_ramp() && state.style.ramp().by() != v1::StyleTerrain::Ramp::NORMAL) {
    const v1::StyleTerrain::Ramp& ramp = state.style.ramp();
    const QString title = ramp.by() == v1::StyleTerrain::Ramp::HEIGHT  ? tr("Height [m]")
                          : ramp.by() == v1::StyleTerrain::Ramp::SLOPE ? tr("Slope [deg]")
                                                                       : tr("Aspect [deg]");
    entries.push_back({title, ramp.low(), ramp.high(), Colors(ramp.color())});
  }
  for (int i = state.layers.layer_size() - 1; i >= 0; --i) {
    const v1::TerrainLayerReply& layer = state.layers.layer(i);
    if (layer.kind() == v1::TerrainLayerReply::FALSE_COLOR && layer.visible()) {
      QString title = QString::fromStdString(layer.name());
      if (!layer.unit().empty()) {
        title += QStringLiteral(" [%1]").arg(QString::fromStdString(layer.unit()));
      }
      if (layer.opacity() < 1.0) {
        title += tr(", %1 % opaque").arg(std::lround(100.0 * layer.opacity()));
      }
      entries.push_back({title, layer.low(), layer.high(), Colors(layer.color())});
    }
  }
  this->Legend_->SetEntries(std::move(entries));
}

void TerrainWidget::ShowSelected() {
  const QString name = this->Layers_->Selected();
  const v1::TerrainLayerReply* found = nullptr;
  for (const v1::TerrainLayerReply& layer : this->State_.layers.layer()) {
    found = QString::fromStdString(layer.name()) == name ? &layer : found;
  }
  const QSignalBlocker silent(this->Opacity_);
  for (QWidget* widget :
       {static_cast<QWidget*>(this->Opacity_), static_cast<QWidget*>(this->Remove_)}) {
    widget->setEnabled(found && this->State_.canChange);
  }
  const int last = this->State_.layers.layer_size() - 1;
  this->Up_->setEnabled(this->State_.canChange && found && int(found->position()) < last);
  this->Down_->setEnabled(this->State_.canChange && found && found->position() > 0);
  const int percent = found ? int(std::lround(100.0 * found->opacity())) : 0;
  if (!this->Opacity_->isSliderDown()) {
    this->Opacity_->setValue(percent);
    this->OpacityText_->setText(found ? tr("%1 %").arg(percent) : QString());
  }
}

void TerrainWidget::FillAddMenu() {
  QMenu* menu = this->Add_->menu();
  menu->clear();
  const QString rasters =
      tr("Rasters (*.tif *.tiff *.img *.lbl *.cub *.vrt *.png *.jpg *.jp2 *.asc "
         "*.nc *.xml);;All files (*)");
  if (this->State_.layered) {
    menu->addAction(tr("Image..."), this,
                    [this, rasters] { this->ChooseFile(QStringLiteral("image"), rasters); });
    menu->addAction(tr("False colour of a raster..."), this,
                    [this, rasters] { this->ChooseFile(QStringLiteral("false_color"), rasters); });
    for (const auto& field : this->State_.fields.field()) {
      const QString name = QString::fromStdString(field.name());
      menu->addAction(tr("False colour of field %1").arg(name), this,
                      [this, name] { this->AddLayer(QStringLiteral("field"), name); });
    }
    menu->addAction(tr("Shapes..."), this, [this] {
      this->ChooseFile(QStringLiteral("shapes"),
                       tr("Shapes (*.geojson *.json *.gpkg *.shp *.kml);;All files (*)"));
    });
    menu->addAction(tr("Noise (decoration)"), this,
                    [this] { this->AddLayer(QStringLiteral("noise"), QString()); });
  }
  menu->addAction(tr("Normals..."), this,
                  [this, rasters] { this->ChooseFile(QStringLiteral("normals"), rasters); });
}

void TerrainWidget::ChooseFile(const QString& kind, const QString& filter) {
  auto* dialog = new QFileDialog(this, tr("Add a layer"), QString(), filter);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, kind](const QString& path) { this->AddLayer(kind, path); });
  dialog->open();
}

void TerrainWidget::AddLayer(const QString& kind, const QString& what) {
  const QString call = kind == QStringLiteral("field")
                           ? QStringLiteral("add_false_color(field=%1)").arg(Quoted(what))
                       : what.isEmpty() ? QStringLiteral("add_%1()").arg(kind)
                                        : QStringLiteral("add_%1(%2)").arg(kind, Quoted(what));
  this->Change(this->Path() + QLatin1Char('.') + call);
}

void TerrainWidget::showEvent(QShowEvent*) {
  this->Refresh();
  this->Timer_->start(Look_ms);
}

void TerrainWidget::hideEvent(QHideEvent*) {
  this->Timer_->stop();
}

} // namespace dspace::widgets
