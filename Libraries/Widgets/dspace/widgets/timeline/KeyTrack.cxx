#include <dspace/widgets/timeline/KeyTrack.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <QContextMenuEvent>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <dspace/widgets/timeline/ScrubBar.h>

namespace dspace::widgets {
namespace {

constexpr int Height = 22;
constexpr double Half = 5.5;     // of a key [pixels]
constexpr double KeyReach = 7.0; // [pixels] from what is meant
constexpr double DragFrom = 3.0; // [pixels] before a press becomes a drag
const QColor KeyColor(0xff, 0xb0, 0x20);

} // namespace

struct KeyTrack::Internals {
  KeyTrack* widget = nullptr;
  ScrubBar* bar = nullptr;
  std::vector<TimelineKey> keys;
  QString hint;
  QString note;
  int selected = -1;
  std::optional<int> pressed;    // key
  double pressedAt = 0.0;        // x
  std::optional<double> dragged; // the run time to which the pressed key moves

  double X(double time_s) const { return this->bar->PlaceOf(time_s); }
  bool Frozen(std::size_t key) const { // with the key before it
    return key > 0 && key < this->keys.size() && !this->keys[key].cut &&
           this->keys[key].run_s == this->keys[key - 1].run_s;
  }
  double ShownTime(std::size_t key) const {
    if (this->dragged && this->pressed &&
        this->keys[key].run_s == this->keys[std::size_t(*this->pressed)].run_s) {
      return *this->dragged;
    }
    return this->keys[key].run_s;
  }
  // Of keys at one place, the selected one, else the first.
  int KeyNear(double x) const {
    int nearest = -1;
    double distance = KeyReach;
    for (std::size_t i = 0; i < this->keys.size(); ++i) {
      const double away = std::abs(this->X(this->keys[i].run_s) - x);
      const bool again = int(i) == this->selected && away <= distance;
      if (away < distance || again) {
        distance = away;
        nearest = int(i);
      }
    }
    return nearest;
  }
  // Between the neighbours, and a pixel away from them.
  double Limited(int key, double time_s) const {
    const TimelineKey& moved = this->keys[std::size_t(key)];
    const double pixel = std::abs(this->bar->TimeAt(101.0) - this->bar->TimeAt(100.0));
    const double gap = std::max(1e-6, pixel);
    const double low = moved.low_s + std::min(gap, 0.25 * (moved.high_s - moved.low_s));
    const double high = moved.high_s - std::min(gap, 0.25 * (moved.high_s - moved.low_s));
    return std::min(std::max(time_s, low), std::max(low, high));
  }

  void DrawSpans(QPainter& painter, double y) const {
    for (std::size_t i = 0; i + 1 < this->keys.size(); ++i) {
      if (this->keys[i + 1].cut || this->Frozen(i + 1)) {
        continue;
      }
      const double from = this->X(this->ShownTime(i));
      const double to = this->X(this->ShownTime(i + 1));
      const double run = std::abs(this->keys[i + 1].run_s - this->keys[i].run_s);
      const double movie = this->keys[i + 1].movie_s - this->keys[i].movie_s;
      QColor color = KeyColor;
      color.setAlphaF(0.75f);
      painter.setPen(QPen(color, 2.0));
      painter.drawLine(QPointF(from, y), QPointF(to, y));
      const double rate = movie > 0.0 ? run / movie : 1.0;
      if (std::abs(rate - 1.0) > 1e-6) { // slow or fast motion
        const QString text = QString(QChar(0xd7)) + QString::number(rate, 'g', 3);
        const QRectF box(std::min(from, to), 0.0, std::abs(to - from), this->widget->height());
        const double width = painter.fontMetrics().horizontalAdvance(text) + 6.0;
        if (box.width() > width + 4.0 * Half) {
          const QRectF plate(box.center().x() - 0.5 * width, 3.0, width, box.height() - 6.0);
          painter.fillRect(plate, this->widget->palette().color(QPalette::Window));
          painter.setPen(this->widget->palette().color(QPalette::WindowText));
          painter.drawText(plate, Qt::AlignCenter, text);
        }
      }
    }
  }
  void DrawKey(QPainter& painter, std::size_t i, double y) const {
    const TimelineKey& key = this->keys[i];
    const double x = this->X(this->ShownTime(i));
    const QColor text = this->widget->palette().color(QPalette::WindowText);
    if (key.cut) {
      painter.setPen(QPen(text, 1.6));
      painter.drawLine(QPointF(x - Half - 3.0, 3.0),
                       QPointF(x - Half - 3.0, this->widget->height() - 3.0));
    }
    painter.setPen(QPen(int(i) == this->selected ? text : KeyColor.darker(160),
                        int(i) == this->selected ? 2.2 : 1.0));
    painter.setBrush(KeyColor);
    if (key.rest) {
      painter.drawRect(QRectF(x - 0.8 * Half, y - 0.8 * Half, 1.6 * Half, 1.6 * Half));
    } else {
      painter.drawPolygon(QPolygonF({{x, y - Half}, {x + Half, y}, {x, y + Half}, {x - Half, y}}));
    }
  }
  // The seconds for which the run stands still at keys from the first to the last one.
  void DrawFreeze(QPainter& painter, std::size_t first, std::size_t last, double y) const {
    const double x = this->X(this->ShownTime(first));
    const QString text =
        QString::number(this->keys[last].movie_s - this->keys[first].movie_s, 'g', 4) + " s";
    const double width = painter.fontMetrics().horizontalAdvance(text) + 20.0;
    const QRectF plate(x + Half + 2.0, y - 8.0, width, 16.0);
    QColor color = this->widget->palette().color(QPalette::Base);
    painter.setPen(QPen(KeyColor, 1.0));
    painter.setBrush(color);
    painter.drawRoundedRect(plate, 3, 3);
    painter.setPen(Qt::NoPen);
    painter.setBrush(this->widget->palette().color(QPalette::Text)); // a pause sign
    painter.drawRect(QRectF(plate.left() + 5.0, y - 4.0, 2.5, 8.0));
    painter.drawRect(QRectF(plate.left() + 9.5, y - 4.0, 2.5, 8.0));
    painter.setPen(this->widget->palette().color(QPalette::Text));
    painter.drawText(plate.adjusted(15.0, 0.0, 0.0, 0.0), Qt::AlignVCenter | Qt::AlignLeft, text);
  }
};

KeyTrack::KeyTrack(ScrubBar* bar, QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>()) {
  this->Impl_->widget = this;
  this->Impl_->bar = bar;
  this->setFocusPolicy(Qt::ClickFocus);
  this->setMouseTracking(true);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  this->setAccessibleName("Camera keys");
  this->setObjectName("keys");
  connect(bar, &ScrubBar::viewChanged, this, [this] { this->update(); });
}

KeyTrack::~KeyTrack() = default;

void KeyTrack::SetKeys(std::vector<TimelineKey> keys) {
  Internals& self = *this->Impl_;
  if (self.keys == keys) {
    return;
  }
  self.keys = std::move(keys);
  self.selected = std::min(self.selected, int(self.keys.size()) - 1);
  self.pressed.reset();
  self.dragged.reset();
  this->update();
}

const std::vector<TimelineKey>& KeyTrack::Keys() const {
  return this->Impl_->keys;
}

int KeyTrack::Selected() const {
  return this->Impl_->selected;
}

void KeyTrack::Select(int key) {
  this->Impl_->selected = key >= 0 && std::size_t(key) < this->Impl_->keys.size() ? key : -1;
  this->update();
}

void KeyTrack::SetHint(const QString& hint) {
  this->Impl_->hint = hint;
  this->update();
}

void KeyTrack::SetNote(const QString& note) {
  this->Impl_->note = note;
  this->update();
}

QSize KeyTrack::sizeHint() const {
  return {480, Height};
}

QSize KeyTrack::minimumSizeHint() const {
  return {120, Height};
}

void KeyTrack::paintEvent(QPaintEvent*) {
  Internals& self = *this->Impl_;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double y = 0.5 * this->height();
  if (self.keys.empty()) {
    painter.setPen(this->palette().color(QPalette::PlaceholderText));
    painter.drawText(this->rect(), Qt::AlignCenter, self.hint);
    return;
  }
  self.DrawSpans(painter, y);
  for (std::size_t i = 0; i < self.keys.size(); ++i) {
    std::size_t last = i;
    while (self.Frozen(last + 1)) {
      ++last;
    }
    if (last > i) {
      self.DrawFreeze(painter, i, last, y);
    }
    for (std::size_t key = last + 1; key-- > i;) { // the first one over the others
      self.DrawKey(painter, key, y);
    }
    i = last;
  }
  if (self.selected >= 0) {
    self.DrawKey(painter, std::size_t(self.selected), y);
  }
  if (!self.note.isEmpty()) {
    const double width = painter.fontMetrics().horizontalAdvance(self.note) + 12.0;
    const QRectF plate(this->width() - width - 2.0, 3.0, width, this->height() - 6.0);
    painter.fillRect(plate, this->palette().color(QPalette::Highlight));
    painter.setPen(this->palette().color(QPalette::HighlightedText));
    painter.drawText(plate, Qt::AlignCenter, self.note);
  }
}

void KeyTrack::mousePressEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  if (event->button() != Qt::LeftButton) {
    return;
  }
  const int key = self.KeyNear(event->position().x());
  this->Select(key);
  self.pressed.reset();
  self.dragged.reset();
  if (key >= 0) {
    self.pressed = key;
    self.pressedAt = event->position().x();
    emit this->goAsked(self.keys[std::size_t(key)].run_s);
  }
}

void KeyTrack::mouseMoveEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  const double x = event->position().x();
  if (!self.pressed) {
    this->setCursor(self.KeyNear(x) >= 0 ? Qt::SizeHorCursor : Qt::ArrowCursor);
    return;
  }
  if (self.dragged || std::abs(x - self.pressedAt) >= DragFrom) {
    self.dragged = self.Limited(*self.pressed, self.bar->TimeAt(x));
    this->update();
    QToolTip::showText(event->globalPosition().toPoint(),
                       self.bar->TextAt(QPoint(int(self.X(*self.dragged)), 1000)), this);
  }
}

void KeyTrack::mouseReleaseEvent(QMouseEvent*) {
  Internals& self = *this->Impl_;
  const std::optional<int> key = std::exchange(self.pressed, {});
  const std::optional<double> to = std::exchange(self.dragged, {});
  this->update();
  if (key && to) {
    emit this->moveAsked(*key, *to);
  }
}

void KeyTrack::mouseDoubleClickEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  if (event->button() != Qt::LeftButton) {
    return;
  }
  const int key = self.KeyNear(event->position().x());
  if (key >= 0) {
    emit this->editAsked(key);
  } else {
    emit this->addAsked(self.bar->TimeAt(event->position().x()));
  }
}

void KeyTrack::keyPressEvent(QKeyEvent* event) {
  Internals& self = *this->Impl_;
  switch (event->key()) {
  case Qt::Key_Delete:
  case Qt::Key_Backspace:
    if (self.selected >= 0) {
      emit this->eraseAsked(self.selected);
    }
    return;
  case Qt::Key_Return:
  case Qt::Key_Enter:
    if (self.selected >= 0) {
      emit this->editAsked(self.selected);
    }
    return;
  case Qt::Key_Escape:
    if (self.pressed) { // the drag ends where it began
      self.pressed.reset();
      self.dragged.reset();
      this->update();
      return;
    }
    break;
  default:
    break;
  }
  QWidget::keyPressEvent(event);
}

void KeyTrack::contextMenuEvent(QContextMenuEvent* event) {
  Internals& self = *this->Impl_;
  auto* menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  const bool byKey = event->reason() == QContextMenuEvent::Keyboard;
  const int key = byKey ? self.selected : self.KeyNear(event->pos().x());
  const double time_s =
      key >= 0 ? self.keys[std::size_t(key)].run_s : self.bar->TimeAt(event->pos().x());
  this->Select(key);
  emit this->menuWanted(menu, key, time_s);
  menu->popup(this->mapToGlobal(byKey ? QPoint(int(self.X(time_s)), Height) : event->pos()));
}

bool KeyTrack::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    Internals& self = *this->Impl_;
    const auto* help = static_cast<QHelpEvent*>(event);
    const int key = self.KeyNear(help->pos().x());
    if (key >= 0) {
      QToolTip::showText(help->globalPos(),
                         self.keys[std::size_t(key)].text.toHtmlEscaped().replace("\n", "<br>"),
                         this);
    } else {
      QToolTip::hideText();
    }
    return true;
  }
  return QWidget::event(event);
}

} // namespace dspace::widgets
