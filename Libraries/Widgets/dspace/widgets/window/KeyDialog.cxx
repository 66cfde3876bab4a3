#include <dspace/widgets/window/KeyDialog.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QJsonArray>
#include <QLabel>

#include <dspace/widgets/script/PythonText.h>

namespace dspace::widgets {
namespace {

constexpr double Longest = 1e6; // [s] of a movie
constexpr double Widest = 179.0;
constexpr double Narrowest = 1e-6;

QDoubleSpinBox* Spin(const char* name, double low, double high, double value, int decimals,
                     const QString& unit, const QString& tip) {
  auto* spin = new QDoubleSpinBox;
  spin->setObjectName(name);
  spin->setDecimals(decimals);
  spin->setRange(low, high);
  spin->setValue(value);
  spin->setSuffix(unit);
  spin->setToolTip(tip);
  return spin;
}

} // namespace

KeyDialog::KeyDialog(int key, const QJsonObject& given, const QJsonObject& next, QWidget* parent)
    : QDialog(parent), Key_(key), Given_(given) {
  this->setWindowTitle(tr("Key %1").arg(key));
  auto* form = new QFormLayout(this);
  const double run = given["run"].toDouble();
  this->Run_ = Spin("run", given["low"].toDouble(-1e15), given["high"].toDouble(1e15), run, 3,
                    tr(" s"), tr("Time of the run, between those of the neighbours"));
  form->addRow(tr("Time of the run"), this->Run_);
  if (!next.isEmpty()) {
    this->SpanBefore_ = next["time"].toDouble() - given["time"].toDouble();
    this->Frozen_ = !next["cut"].toBool() && next["run"].toDouble() == run;
  }
  this->Span_ = Spin("span", 0.001, Longest, this->Frozen_ ? 0.001 : this->SpanBefore_, 3, tr(" s"),
                     tr("Time of the movie to the next key: more is slow motion"));
  this->Span_->setEnabled(!next.isEmpty() && !this->Frozen_ && this->SpanBefore_ > 0.0);
  form->addRow(tr("To the next key"), this->Span_);
  this->Freeze_ = Spin("freeze", 0.0, Longest, this->Frozen_ ? this->SpanBefore_ : 0.0, 3, tr(" s"),
                       tr("Time of the movie for which the run stands still here; 0: not"));
  form->addRow(tr("The run stands still"), this->Freeze_);
  const bool orthographic = given["lens"].toString() == "height";
  this->Lens_ = Spin("lens", orthographic ? 1e-3 : Narrowest, orthographic ? 1e9 : Widest,
                     given["value"].toDouble(), orthographic ? 3 : 4,
                     orthographic ? tr(" m") : QString(QChar(0xb0)),
                     orthographic ? tr("Height of the picture") : tr("Vertical full angle"));
  this->Lens_->setEnabled(given["lens"].toString() != "tangents");
  form->addRow(orthographic ? tr("Height") : tr("Field of view"), this->Lens_);
  this->Easing_ = new QComboBox;
  this->Easing_->setObjectName("easing");
  this->Easing_->addItem(tr("passes through"), QStringLiteral("through"));
  this->Easing_->addItem(tr("comes to rest"), QStringLiteral("rest"));
  this->Easing_->setCurrentIndex(given["rest"].toBool() ? 1 : 0);
  form->addRow(tr("The camera"), this->Easing_);
  this->Cut_ = new QCheckBox(tr("A new shot begins here"));
  this->Cut_->setObjectName("cut");
  this->Cut_->setChecked(given["cut"].toBool());
  form->addRow(QString(), this->Cut_);
  const QJsonArray position = given["position"].toArray();
  auto* place =
      new QLabel(tr("%1, %2, %3 m in %4")
                     .arg(position[0].toDouble(), 0, 'f', 3)
                     .arg(position[1].toDouble(), 0, 'f', 3)
                     .arg(position[2].toDouble(), 0, 'f', 3)
                     .arg(given["frame"].toString().isEmpty() ? QStringLiteral("/")
                                                              : given["frame"].toString()));
  place->setTextFormat(Qt::PlainText);
  form->addRow(tr("Place"), place);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  form->addRow(buttons);
}

QStringList KeyDialog::Lines() const {
  QStringList lines;
  const QString movie = QStringLiteral("app.movie.");
  const auto differs = [](const QDoubleSpinBox* spin, double before) {
    return spin->isEnabled() && spin->cleanText() != spin->textFromValue(before);
  };
  QStringList values;
  if (differs(this->Lens_, this->Given_["value"].toDouble())) {
    values << this->Given_["lens"].toString() + "=" + PythonOf(this->Lens_->value());
  }
  const bool rest = this->Easing_->currentData().toString() == "rest";
  if (rest != this->Given_["rest"].toBool()) {
    values << QStringLiteral("easing=\"%1\"").arg(this->Easing_->currentData().toString());
  }
  if (this->Cut_->isChecked() != this->Given_["cut"].toBool()) {
    values << "cut=" + PythonOf(this->Cut_->isChecked());
  }
  if (!values.isEmpty()) {
    lines << QStringLiteral("%1edit_key(%2, %3)").arg(movie).arg(this->Key_).arg(values.join(", "));
  }
  if (differs(this->Run_, this->Given_["run"].toDouble())) {
    lines << QStringLiteral("%1move_key(%2, %3)")
                 .arg(movie)
                 .arg(this->Key_)
                 .arg(PythonOf(this->Run_->value()));
  }
  // Before a freeze, which adds a key.
  if (differs(this->Span_, this->SpanBefore_)) {
    lines << QStringLiteral("%1set_span(%2, %3)")
                 .arg(movie)
                 .arg(this->Key_)
                 .arg(PythonOf(this->Span_->value()));
  }
  if (differs(this->Freeze_, this->Frozen_ ? this->SpanBefore_ : 0.0)) {
    lines << QStringLiteral("%1freeze(%2, %3)")
                 .arg(movie)
                 .arg(this->Key_)
                 .arg(PythonOf(this->Freeze_->value()));
  }
  return lines;
}

} // namespace dspace::widgets
