#include <dspace/widgets/overlay/PointerReadout.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <QElapsedTimer>
#include <QEvent>
#include <QGuiApplication>
#include <QMouseEvent>
#include <QPainter>
#include <QStringList>
#include <QStyle>

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/settings/DisplayUnits.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

constexpr int PickRest_ms = 100; // between two picks, at least
constexpr int PickShare = 10;    // one part of so many goes into picks
constexpr int MostLetters = 60;  // of a name
constexpr int MostFields = 4;    // of a terrain
const QChar Degree(0xb0);

QString Shortened(const std::string& name) {
  const QString text = QString::fromStdString(name);
  return text.size() <= MostLetters ? text : text.left(MostLetters - 1) + QChar(0x2026);
}

// In the chosen unit, without it. With a millimetre's digits, which a float of a picture does not
// exceed.
QString Length(double metres, const UnitChoice& units) {
  return std::isfinite(metres)
             ? QString::number(metres * units.LengthFactor(), 'f', units.LengthDecimals(3))
             : QObject::tr("no data");
}

// Whether the map's x and y are the longitude and latitude, which are shown anyway. Latitudes of a
// map may be planetocentric.
bool IsDegrees(const v1::PickReply& pick) {
  const v1::Coordinates& at = pick.coordinates();
  return pick.has_coordinates() && std::isfinite(at.longitude_deg()) &&
         std::abs(std::remainder(pick.map().x() - at.longitude_deg(), 360.0)) < 1e-6 &&
         std::abs(pick.map().y() - at.latitude_deg()) < 0.5;
}

// "x 1.000  y 2.000  z 3.000 m"
QString Place(const v1::Vector3& at, const UnitChoice& units) {
  return QObject::tr("x %1  y %2  z %3 %4")
      .arg(Length(at.x(), units), Length(at.y(), units), Length(at.z(), units), units.LengthUnit());
}

// "137.441635°", "2.398809 rad"
QString Angle(double degrees, int decimals, const UnitChoice& units) {
  const QString unit = units.AngleUnit();
  return QString::number(degrees * units.AngleFactor(), 'f', units.AngleDecimals(decimals)) +
         (unit == Degree ? unit : ' ' + unit);
}

// "137.441635° E"
QString Side(double degrees, const QString& positive, const QString& negative,
             const UnitChoice& units) {
  return Angle(std::abs(degrees), 6, units) + ' ' + (degrees < 0.0 ? negative : positive);
}

} // namespace

PointerReadout::PointerReadout(QWidget* parent) : QLabel(parent), Pause_ms_(PickRest_ms) {
  this->setObjectName(QStringLiteral("pointer"));
  this->setTextFormat(Qt::PlainText);
  this->setTextInteractionFlags(Qt::TextSelectableByMouse);
  this->setAccessibleName(tr("What is under the pointer"));
  this->setToolTip(
      tr("The point under the pointer: in the root; on terrain also in its map, and its height "
         "above the vertical datum"));
  connect(&DisplayUnits::The(), &DisplayUnits::changed, this, [this] { this->Later(); });
  this->Rest_.setSingleShot(true);
  connect(&this->Rest_, &QTimer::timeout, this, [this] { this->Look(); });
}

void PointerReadout::Add(ViewportWidget* widget, vtkObject* of, const std::string& viewport) {
  this->Views_[widget] = {of, viewport};
  widget->setMouseTracking(true);
  widget->installEventFilter(this);
  connect(widget, &QObject::destroyed, this, [this](QObject* gone) { this->Views_.erase(gone); });
  connect(widget, &ViewportWidget::shown, this, [this, widget] {
    if (this->Over_ != widget) {
      return;
    }
    if (std::exchange(this->Waiting_, false)) {
      this->Fresh_ = true;
      this->Rest_.start(0); // after the painting
    } else {                // something else may be under the pointer now
      this->Later();
    }
  });
}

bool PointerReadout::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::MouseMove && this->Views_.count(watched) > 0) {
    const auto* moved = static_cast<QMouseEvent*>(event);
    if (moved->buttons() == Qt::NoButton) {
      this->Over_ = static_cast<ViewportWidget*>(watched);
      this->Place_ = moved->position();
      this->Later();
    }
  } else if (event->type() == QEvent::Leave && watched == this->Over_) {
    this->Over_ = nullptr;
    this->Waiting_ = false;
    this->clear();
  }
  return QLabel::eventFilter(watched, event);
}

void PointerReadout::paintEvent(QPaintEvent* event) {
  const QFontMetrics metrics = this->fontMetrics();
  if (metrics.horizontalAdvance(this->text()) <= this->contentsRect().width()) {
    QLabel::paintEvent(event);
    return;
  }
  QPainter painter(this);
  this->style()->drawItemText(
      &painter, this->contentsRect(), Qt::AlignLeft | Qt::AlignVCenter, this->palette(),
      this->isEnabled(),
      metrics.elidedText(this->text(), Qt::ElideRight, this->contentsRect().width()),
      QPalette::WindowText);
}

void PointerReadout::Later() {
  if (!this->Rest_.isActive() && !this->Waiting_) {
    this->Rest_.start(this->Pause_ms_);
  }
}

void PointerReadout::Look() {
  const auto found = this->Views_.find(this->Over_);
  if (!this->Over_ || found == this->Views_.end()) {
    return;
  }
  if (QGuiApplication::mouseButtons() != Qt::NoButton) {
    this->Rest_.start(PickRest_ms);
    return;
  }
  if (!std::exchange(this->Fresh_, false) &&
      !this->Over_->IsUpToDate()) { // the pick would draw the view's next picture
    this->Waiting_ = true;
    return;
  }
  QElapsedTimer clock;
  clock.start();
  try {
    const ShownSession session(found->second.of);
    if (!session.Viewport(found->second.viewport)) {
      return; // a playback is between two steps
    }
    const double ratio = this->Over_->devicePixelRatioF();
    v1::Command command;
    v1::Pick* pick = command.mutable_pick();
    pick->set_viewport(found->second.viewport);
    pick->set_x(this->Place_.x() * ratio - 0.5);
    pick->set_y(this->Place_.y() * ratio - 0.5);
    const std::string picked = session.Execute(command.SerializeAsString());
    v1::Reply reply;
    std::string slope;
    if (reply.ParseFromString(picked) && !reply.pick().terrain().empty()) {
      v1::Command ask;
      ask.set_scene(session.SceneOf(found->second.viewport));
      v1::QueryTerrain* query = ask.mutable_query_terrain();
      query->set_terrain(reply.pick().terrain());
      const v1::Vector3& at = reply.pick().in_object_frame();
      for (const double value : {at.x(), at.y(), at.z()}) {
        query->add_point(value);
      }
      query->set_spatial(true);
      query->set_slope(true);
      slope = session.Execute(ask.SerializeAsString());
    }
    this->setText(PointerReadout::TextOf(picked, slope));
  } catch (const std::exception&) {
    this->clear(); // the view itself reports what fails
  }
  this->Pause_ms_ = std::max(PickRest_ms, (PickShare - 1) * int(clock.elapsed()));
}

QString PointerReadout::TextOf(const std::string& picked, const std::string& slope, bool all) {
  v1::Reply reply;
  if (!reply.ParseFromString(picked) || reply.pick().object() == 0) {
    return {};
  }
  const v1::PickReply& pick = reply.pick();
  const UnitChoice& units = DisplayUnits::The().Get();
  QStringList parts;
  const QString part = Shortened(pick.part());
  parts << Shortened(pick.object_name()) + (part.isEmpty() ? QString() : " / " + part);
  if (pick.terrain().empty()) {
    parts << Place(pick.in_root(), units);
  } else {
    if (!IsDegrees(pick)) {
      parts << tr("map %1, %2 %3")
                   .arg(Length(pick.map().x(), units), Length(pick.map().y(), units),
                        units.LengthUnit());
    }
    if (pick.has_coordinates()) {
      parts << Side(pick.coordinates().longitude_deg(), tr("E"), tr("W"), units) + "  " +
                   Side(pick.coordinates().latitude_deg(), tr("N"), tr("S"), units);
    }
    parts << tr("height %1 %2").arg(Length(pick.map().z(), units), units.LengthUnit());
    v1::Reply told;
    if (told.ParseFromString(slope) && told.terrain_values().slope_deg_size() == 1 &&
        std::isfinite(told.terrain_values().slope_deg(0))) {
      parts << tr("slope %1").arg(Angle(told.terrain_values().slope_deg(0), 1, units));
    }
    for (int i = 0; i < std::min(MostFields, pick.field_size()); ++i) {
      parts << Shortened(pick.field(i).name()) + ' ' + QString::number(pick.field(i).value());
    }
    if (pick.has_coordinates() && (all || units.bodyFixed)) {
      parts << tr("body-fixed %1").arg(Place(pick.coordinates().body_fixed(), units));
    }
    if (pick.coordinates().has_inertial() && (all || units.inertial)) {
      parts << tr("J2000 %1").arg(Place(pick.coordinates().inertial(), units));
    }
  }
  return parts.join(QStringLiteral("   "));
}

} // namespace dspace::widgets
