#include <dspace/widgets/scene/ScenePropertyPanel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <QAction>
#include <QClipboard>
#include <QComboBox>
#include <QGridLayout>
#include <QGuiApplication>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QScrollArea>
#include <QStackedLayout>
#include <QVBoxLayout>

#include <dspace/widgets/settings/DisplayUnits.h>

namespace dspace::widgets {
namespace {

const char* const ParentWord = "parent";

QString Number(double value, int decimals) {
  if (std::abs(value) >= 1e12) {
    return QString::number(value, 'g', 15);
  }
  const QString text = QString::number(value, 'f', decimals);
  const bool zero = text.count('0') + text.count('.') + text.count('-') == text.size();
  return zero && text.startsWith('-') ? text.mid(1) : text; // no -0
}

// "x 1.0000   y 2.0000": breaks only between the numbers.
QString Numbers(const std::vector<std::pair<const char*, double>>& values, int decimals) {
  QString text;
  for (const auto& [name, value] : values) {
    text += (text.isEmpty() ? "" : "   ") + QString(name) + QChar(QChar::Nbsp) +
            Number(value, decimals);
  }
  return text;
}

QString ColorText(const std::array<double, 3>& color) {
  return QColor::fromRgbF(float(color[0]), float(color[1]), float(color[2])).name();
}

// What is drawn: the finest level's first part with the object's overrides.
QString MaterialText(const GraphicsObject& object) {
  const MaterialOverride& over = object.material;
  const dspace::Material* own = nullptr;
  std::size_t materials = 0;
  if (!object.levels.empty()) {
    std::vector<const dspace::Material*> all;
    for (const Part& part : object.levels.front().parts) {
      if (std::find(all.begin(), all.end(), part.material.get()) == all.end()) {
        all.push_back(part.material.get());
      }
    }
    materials = all.size();
    own = all.empty() ? nullptr : all.front();
  }
  const dspace::Material standard;
  const dspace::Material& base = own ? *own : standard;
  QStringList words;
  if (object.custom) {
    return "of its own";
  }
  words << ColorText(over.color.value_or(base.color));
  const double opacity = over.opacity.value_or(base.opacity);
  if (opacity < 1.0) {
    words << "opacity " + QString::number(opacity, 'g', 3);
  }
  words << "metallic " + QString::number(over.metallic.value_or(base.metallic), 'g', 3)
        << "roughness " + QString::number(over.roughness.value_or(base.roughness), 'g', 3);
  const auto texture = over.texture.value_or(base.texture);
  if (texture) {
    words << QString("texture %1 × %2").arg(texture->width).arg(texture->height);
  }
  if (!over.lit.value_or(base.lit)) {
    words << "unlit";
  }
  if (over.wireframe.value_or(false)) {
    words << "wireframe";
  }
  if (materials > 1) {
    words << QString("first of %1 materials").arg(materials);
  }
  if (over != MaterialOverride()) {
    words << "overridden";
  }
  return words.join(", ");
}

QString LevelsText(const GraphicsObject& object) {
  QStringList lines;
  for (const DetailLevel& level : object.levels) {
    std::size_t count[3] = {0, 0, 0};
    for (const Part& part : level.parts) {
      count[int(part.mesh->primitive)] += part.mesh->PrimitiveCount();
    }
    QStringList what;
    const char* const words[3] = {"triangles", "lines", "points"};
    for (int i = 0; i < 3; ++i) {
      if (count[i] > 0) {
        what << QLocale(QLocale::English).toString(qulonglong(count[i])) + " " + words[i];
      }
    }
    const QString text = what.isEmpty() ? QString("empty") : what.join(", ");
    lines << (object.levels.size() == 1 && level.minimumPixels <= 0.0
                  ? text
                  : QString("from %1 px: %2").arg(level.minimumPixels).arg(text));
  }
  return object.custom ? "of its own" : lines.isEmpty() ? "none" : lines.join("\n");
}

} // namespace

struct ScenePropertyPanel::Internals {
  QStackedLayout* pages = nullptr;
  QGridLayout* form = nullptr; // QFormLayout of Qt 6.4 writes out of bounds with hidden rows
  QLabel* title = nullptr;
  QLabel* path = nullptr;
  QComboBox* reference = nullptr;
  QLabel* position = nullptr;
  QLabel* quaternion = nullptr;
  QLabel* angles = nullptr;
  QLabel* scale = nullptr;
  std::vector<QLabel*> ofObjects; // nature, fragment, material, levels
  FrameId frame = RootFrame;      // of the reference
  std::map<QWidget*, QLabel*> names;

  void AddRow(const QString& name, QWidget* field) {
    auto* label = new QLabel(name);
    label->setBuddy(field);
    const int row = this->form->rowCount();
    this->form->addWidget(label, row, 0, Qt::AlignTop);
    this->form->addWidget(field, row, 1);
    this->names[field] = label;
  }
  QLabel* Add(const QString& name, const QString& tip) {
    auto* label = new QLabel;
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    // No selectable text: it would be laid out as a document 30 times a second.
    auto* copy = new QAction("Copy", label);
    QObject::connect(copy, &QAction::triggered, label, [label] {
      QGuiApplication::clipboard()->setText(label->text().replace(QChar(QChar::Nbsp), ' '));
    });
    label->addAction(copy);
    label->setContextMenuPolicy(Qt::ActionsContextMenu);
    label->setToolTip(tip);
    label->setAccessibleName(name);
    label->setObjectName(name.toLower());
    this->AddRow(name, label);
    return label;
  }
  static void Set(QLabel* label, const QString& text) {
    if (label->text() != text) {
      label->setText(text);
    }
  }
  void ShowUnits() {
    const UnitChoice& units = DisplayUnits::The().Get();
    Set(this->names[this->position], "Position [" + units.LengthUnit() + "]");
    Set(this->names[this->angles], "Angles [" + units.AngleUnit() + "]");
  }
  void ShowRow(QLabel* label, bool visible) {
    label->setVisible(visible);
    this->names[label]->setVisible(visible);
  }
};

ScenePropertyPanel::ScenePropertyPanel(QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>()) {
  Internals& self = *this->Impl_;
  self.pages = new QStackedLayout(this);
  auto* empty = new QLabel("Select a frame or an object\nto see its properties");
  empty->setAlignment(Qt::AlignCenter);
  empty->setForegroundRole(QPalette::PlaceholderText);
  self.pages->addWidget(empty);

  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  auto* content = new QWidget;
  area->setWidget(content);
  self.pages->addWidget(area);
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(8, 8, 8, 8);
  self.title = new QLabel;
  self.title->setTextFormat(Qt::PlainText);
  self.title->setWordWrap(true);
  QFont bold = self.title->font();
  bold.setBold(true);
  self.title->setFont(bold);
  column->addWidget(self.title);
  self.form = new QGridLayout;
  self.form->setColumnStretch(1, 1);
  self.form->setHorizontalSpacing(12);
  self.form->setVerticalSpacing(4);
  column->addLayout(self.form);
  column->addStretch(1);

  self.path = self.Add("Frame", "Names of the frames from below the root");
  self.reference = new QComboBox;
  self.reference->setEditable(true);
  self.reference->setInsertPolicy(QComboBox::NoInsert);
  self.reference->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  self.reference->setMinimumContentsLength(8);
  self.reference->addItems({"/", ParentWord});
  self.reference->setToolTip(
      "The frame that the pose is relative to: \"/\" for the root, \"parent\", or a path");
  self.reference->setAccessibleName("Relative to");
  self.AddRow("Relative to", self.reference);
  self.form->setAlignment(self.names[self.reference], Qt::AlignVCenter);
  self.position = self.Add("Position", "In the unit of lengths of View > Preferences");
  self.quaternion = self.Add("Quaternion", "Unit quaternion, scalar first");
  self.angles =
      self.Add("Angles", "Roll, pitch and yaw about the fixed X, then Y, then Z axis, in the unit "
                         "of angles of View > Preferences");
  self.ShowUnits();
  self.scale = self.Add("Scale", "Of the frame's axes");
  self.ofObjects = {
      self.Add("Nature", "Physical objects are visible to a real camera"),
      self.Add("Fragment", "The group with which the object is shown and hidden"),
      self.Add("Material", "Of the finest level's first part, with the object's overrides"),
      self.Add("Levels", "Levels of detail, and the least diameter on the screen [pixels] at which "
                         "each is drawn")};
  const auto choose = [this] { emit this->referenceChosen(this->Impl_->reference->currentText()); };
  connect(self.reference, &QComboBox::activated, this, choose);
  connect(self.reference->lineEdit(), &QLineEdit::returnPressed, this, choose);
}

ScenePropertyPanel::~ScenePropertyPanel() = default;

Eigen::Vector3d ScenePropertyPanel::RollPitchYaw(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d m = rotation.toRotationMatrix();
  constexpr double degrees = 180.0 / 3.14159265358979323846;
  return degrees * Eigen::Vector3d(std::atan2(m(2, 1), m(2, 2)),
                                   std::atan2(-m(2, 0), std::hypot(m(0, 0), m(1, 0))),
                                   std::atan2(m(1, 0), m(0, 0)));
}

FrameId ScenePropertyPanel::Reference() const {
  return this->Impl_->frame;
}

void ScenePropertyPanel::SetReference(const Scene* scene, FrameId frame) {
  Internals& self = *this->Impl_;
  const bool known = scene && scene->Frames().Contains(frame);
  self.frame = frame == NoFrame || known ? frame : RootFrame;
  const QString text = self.frame == NoFrame ? QString(ParentWord)
                       : self.frame == RootFrame
                           ? QString("/")
                           : QString::fromStdString(scene->Frames().Path(self.frame));
  if (self.reference->findText(text) < 0) {
    self.reference->addItem(text);
    if (self.reference->count() > 12) {
      self.reference->removeItem(2);
    }
  }
  self.reference->setCurrentText(text);
}

void ScenePropertyPanel::Show(const Scene* scene, const SceneItem& item, const QString& kind) {
  Internals& self = *this->Impl_;
  const GraphicsObject* object = nullptr;
  if (scene && item.object != 0) {
    const auto found = scene->Objects().find(item.object);
    object = found == scene->Objects().end() ? nullptr : &found->second;
  }
  const FrameId frame = object ? object->frame : item.frame;
  if (!scene || !scene->Frames().Contains(frame) || (item.object != 0 && !object)) {
    self.pages->setCurrentIndex(0);
    return;
  }
  self.pages->setCurrentIndex(1);
  const FrameTree& frames = scene->Frames();
  const QString name = QString::fromStdString(object ? object->name : frames.Name(frame));
  Internals::Set(self.title, kind.isEmpty() ? name : QString("%1 (%2)").arg(name, kind));
  Internals::Set(self.path, QString::fromStdString(frames.Path(frame)));
  if (self.frame != NoFrame && !frames.Contains(self.frame)) {
    this->SetReference(scene, RootFrame);
  }
  const FrameId parent = frame == RootFrame ? RootFrame : frames.Parent(frame);
  const FrameId reference = self.frame != NoFrame ? self.frame : object ? frame : parent;
  Pose pose = frames.RelativePose(reference, frame);
  QString scale;
  if (object) { // X_FO may be stretched along each axis
    const Eigen::Matrix3d rotation = object->X_FO.rotation();
    const Eigen::Matrix3d stretch = rotation.transpose() * object->X_FO.linear();
    pose.position = pose.Apply(object->X_FO.translation());
    pose.rotation = (pose.rotation * Eigen::Quaterniond(rotation)).normalized();
    const Eigen::Vector3d s = pose.scale * stretch.diagonal();
    scale = s.isApprox(Eigen::Vector3d::Ones(), 1e-9) ? QString()
            : s.isApprox(Eigen::Vector3d::Constant(s.x()), 1e-9)
                ? QString::number(s.x(), 'g', 9)
                : QString("x %1   y %2   z %3").arg(s.x()).arg(s.y()).arg(s.z());
  } else if (std::abs(pose.scale - 1.0) > 1e-12) {
    scale = QString::number(pose.scale, 'g', 9);
  }
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.rotation;
  const Eigen::Vector3d angles = RollPitchYaw(q);
  const UnitChoice& units = DisplayUnits::The().Get();
  const double metre = units.LengthFactor();
  const double degree = units.AngleFactor();
  self.ShowUnits();
  Internals::Set(self.position,
                 Numbers({{"x", metre * p.x()}, {"y", metre * p.y()}, {"z", metre * p.z()}},
                         units.LengthDecimals(4)));
  Internals::Set(self.quaternion,
                 Numbers({{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}, 6));
  Internals::Set(self.angles, Numbers({{"roll", degree * angles.x()},
                                       {"pitch", degree * angles.y()},
                                       {"yaw", degree * angles.z()}},
                                      units.AngleDecimals(4)));
  Internals::Set(self.scale, scale);
  self.ShowRow(self.scale, !scale.isEmpty());
  for (QLabel* label : self.ofObjects) {
    self.ShowRow(label, object != nullptr);
  }
  if (object) {
    const SceneFragmentManager& fragments = scene->Fragments();
    const bool shown =
        fragments.Contains(object->fragment) && fragments.Get(object->fragment).visible;
    Internals::Set(self.ofObjects[0],
                   object->nature == Nature::Physical ? "physical" : "ornamental");
    Internals::Set(self.ofObjects[1],
                   QString::fromStdString(object->fragment) + (shown ? "" : " (hidden)"));
    Internals::Set(self.ofObjects[2], MaterialText(*object));
    Internals::Set(self.ofObjects[3], LevelsText(*object));
  }
}

} // namespace dspace::widgets
