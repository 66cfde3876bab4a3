#include <dspace/widgets/overlay/PlugInOverlays.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include <QColor>
#include <QFontMetricsF>
#include <QJsonArray>
#include <QPainter>
#include <QPainterPath>

#include <dspace/Error.h>
#include <dspace/widgets/overlay/OverlayPane.h>
#include <dspace/widgets/overlay/ProjectedPoints.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

constexpr double HaloWidth = 2.5; // [pixels] beside a line or letters

// The edge beside a colour: dark, or light beside a dark one.
QColor HaloOf(const QColor& color) {
  return color.lightness() < 96 ? QColor(255, 255, 255, 170) : QColor(0, 0, 0, 150);
}

void Check(const QJsonObject& item) {
  const QString kind = item["kind"].toString();
  if (kind != "text" && kind != "line" && kind != "circle") {
    throw Error(Error::Kind::InvalidArgument, "overlay",
                "an item is a \"" + kind.toStdString() + "\"; accepted: text, line, circle");
  }
  if (!QColor::isValidColor(item["color"].toString())) {
    throw Error(Error::Kind::InvalidArgument, "overlay",
                "a colour is \"" + item["color"].toString().toStdString() +
                    "\"; accepted: one such as \"#ffd23f\" or \"white\"");
  }
}

std::vector<QPointF> PixelsOf(const QJsonArray& at, const QSize& size) {
  std::vector<QPointF> places;
  for (const QJsonValue& each : at) {
    const double x = each.toArray()[0].toDouble();
    const double y = each.toArray()[1].toDouble();
    places.emplace_back(x < 0.0 ? size.width() + x : x, y < 0.0 ? size.height() + y : y);
  }
  return places;
}

std::vector<std::array<double, 3>> PointsOf(const QJsonArray& points) {
  std::vector<std::array<double, 3>> found;
  for (const QJsonValue& each : points) {
    const QJsonArray p = each.toArray();
    found.push_back({p[0].toDouble(), p[1].toDouble(), p[2].toDouble()});
  }
  return found;
}

void PaintText(QPainter& painter, const QJsonObject& item, const QPointF& place) {
  QFont font = painter.font();
  font.setPixelSize(int(std::lround(std::clamp(item["size"].toDouble(13.0), 4.0, 400.0))));
  const QFontMetricsF metrics(font);
  QPainterPath letters;
  const QStringList lines = item["text"].toString().split('\n');
  for (int i = 0; i < lines.size(); ++i) {
    const double width = metrics.horizontalAdvance(lines[i]);
    const QString align = item["align"].toString();
    const double left = align == "center" ? -0.5 * width : align == "right" ? -width : 0.0;
    letters.addText(place + QPointF(left, i * metrics.lineSpacing()), font, lines[i]);
  }
  const QColor color(item["color"].toString());
  painter.strokePath(letters,
                     QPen(HaloOf(color), HaloWidth, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.fillPath(letters, color);
}

void PaintLine(QPainter& painter, const QJsonObject& item, std::vector<QPointF> places) {
  const double width = std::clamp(item["width"].toDouble(2.0), 0.5, 100.0);
  if (item["closed"].toBool() && !places.empty()) {
    places.push_back(places.front());
  }
  const QColor own(item["color"].toString());
  for (const auto& [color, w] :
       {std::pair(HaloOf(own), width + HaloWidth), std::pair(own, width)}) {
    painter.setPen(QPen(color, w, Qt::SolidLine, Qt::RoundCap));
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (IsPaintable(places[i - 1]) && IsPaintable(places[i])) {
        painter.drawLine(places[i - 1], places[i]);
      }
    }
  }
}

void PaintCircle(QPainter& painter, const QJsonObject& item, const QPointF& place) {
  const double radius = std::clamp(item["radius"].toDouble(5.0), 0.5, 1e4);
  const double width = std::clamp(item["width"].toDouble(2.0), 0.5, 100.0);
  const QColor color(item["color"].toString());
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(HaloOf(color), width + HaloWidth));
  painter.drawEllipse(place, radius, radius);
  painter.setBrush(item["filled"].toBool() ? QBrush(color) : Qt::NoBrush);
  painter.setPen(QPen(color, width));
  painter.drawEllipse(place, radius, radius);
}

void PaintItem(QPainter& painter, const QJsonObject& item, const std::vector<QPointF>& places) {
  const QString kind = item["kind"].toString();
  if (kind == "line") {
    PaintLine(painter, item, places);
    return;
  }
  for (const QPointF& place : places) {
    if (!IsPaintable(place)) {
      continue;
    }
    if (kind == "text") {
      PaintText(painter, item, place);
    } else {
      PaintCircle(painter, item, place);
    }
  }
}

} // namespace

PlugInOverlays::PlugInOverlays(QObject* parent) : QObject(parent) {}

void PlugInOverlays::Add(ViewportWidget* view, vtkObject* of, const std::string& viewport) {
  auto* pane =
      new OverlayPane(view, [this, view](QPainter& painter) { this->Paint(painter, view); });
  pane->setObjectName(QStringLiteral("plug-in overlay"));
  this->Views_[view] = {of, viewport, pane};
  connect(view, &QObject::destroyed, this, [this](QObject* gone) { this->Views_.erase(gone); });
  this->Update();
}

bool PlugInOverlays::Handles(const QJsonObject& request) {
  return request["do"].toString() == "overlay";
}

PlugInOverlays::Overlay& PlugInOverlays::Find(const QJsonObject& request) {
  const auto found = this->Overlays_.find(request["overlay"].toInt());
  if (found == this->Overlays_.end()) {
    throw Error(Error::Kind::NotFound, "overlay " + std::to_string(request["overlay"].toInt()),
                "it is closed");
  }
  return found->second;
}

QJsonObject PlugInOverlays::Handle(const QJsonObject& request) {
  const QString what = request["what"].toString();
  QJsonObject answer;
  if (what == "add") {
    this->Overlays_[++this->Last_].viewport = request["view"].toString().toStdString();
    return {{"overlay", this->Last_}};
  }
  Overlay& overlay = this->Find(request);
  if (what == "item") {
    const QJsonObject item = request["item"].toObject();
    Check(item);
    overlay.items[++overlay.last] = item;
    answer = {{"item", overlay.last}};
  } else if (what == "set" || what == "remove") {
    const auto found = overlay.items.find(request["item"].toInt());
    if (found == overlay.items.end()) {
      throw Error(Error::Kind::NotFound, "item of an overlay", "it is removed");
    }
    if (what == "remove") {
      overlay.items.erase(found);
    } else {
      QJsonObject changed = found->second;
      const QJsonObject changes = request["changes"].toObject();
      for (auto it = changes.begin(); it != changes.end(); ++it) {
        changed[it.key()] = it.value();
        if (it.key() == "at" || it.key() == "points") { // one of them counts
          changed.remove(it.key() == "at" ? "points" : "at");
        }
      }
      Check(changed);
      found->second = changed;
    }
  } else if (what == "close") {
    this->Overlays_.erase(request["overlay"].toInt());
  } else {
    throw Error(Error::Kind::InvalidArgument, "overlay",
                "there is no \"" + what.toStdString() +
                    "\"; accepted: add, item, set, remove, close");
  }
  this->Update();
  return answer;
}

bool PlugInOverlays::Any(const std::string& viewport) const {
  return std::any_of(this->Overlays_.begin(), this->Overlays_.end(), [&](const auto& entry) {
    const Overlay& overlay = entry.second;
    return !overlay.items.empty() && (overlay.viewport.empty() || overlay.viewport == viewport);
  });
}

void PlugInOverlays::Update() {
  for (const auto& [view, shown] : this->Views_) {
    if (shown.pane) {
      shown.pane->setVisible(this->Any(shown.viewport)); // a pane costs a repaint a picture
      shown.pane->update();
    }
  }
}

void PlugInOverlays::Paint(QPainter& painter, ViewportWidget* view) {
  const auto found = this->Views_.find(view);
  if (found == this->Views_.end()) {
    return;
  }
  const std::string& viewport = found->second.viewport;
  try {
    const ShownSession session(found->second.of);
    if (!session.Viewport(viewport)) {
      return;
    }
    // All points of the view are projected by one command.
    std::vector<std::array<double, 3>> points;
    std::vector<const QJsonObject*> items;
    for (const auto& [number, overlay] : this->Overlays_) {
      if (!overlay.viewport.empty() && overlay.viewport != viewport) {
        continue;
      }
      for (const auto& [key, item] : overlay.items) {
        items.push_back(&item);
        const auto more = PointsOf(item["points"].toArray());
        points.insert(points.end(), more.begin(), more.end());
      }
    }
    const std::vector<QPointF> projected =
        points.empty() ? std::vector<QPointF>()
                       : ProjectedPoints(session, *view, session.SceneOf(viewport), points);
    auto next = projected.begin();
    for (const QJsonObject* item : items) {
      const auto count = (*item)["points"].toArray().size();
      if (count == 0) {
        PaintItem(painter, *item, PixelsOf((*item)["at"].toArray(), view->size()));
      } else if (!projected.empty()) {
        PaintItem(painter, *item, std::vector<QPointF>(next, next + count));
        next += count;
      }
    }
  } catch (const std::exception&) {
    return; // the view itself reports what fails
  }
}

} // namespace dspace::widgets
