#include <dspace/widgets/window/ViewPanes.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <QClipboard>
#include <QDockWidget>
#include <QEvent>
#include <QGuiApplication>
#include <QImage>
#include <QMainWindow>
#include <QTimer>

#include "vtkDspaceViewport.h"

#include <dspace/Error.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {

ViewPanes::ViewPanes(QMainWindow* window) : QObject(window), Window_(window) {}

void ViewPanes::Add(QDockWidget* dock, ViewportWidget* widget, vtkObject* of,
                    const std::string& viewport) {
  this->Restore();
  this->Panes_.erase(std::remove_if(this->Panes_.begin(), this->Panes_.end(),
                                    [](const Pane& pane) { return !pane.dock || !pane.widget; }),
                     this->Panes_.end());
  this->Panes_.push_back({dock, widget, of, viewport});
  this->Used_ = dock;
  widget->installEventFilter(this);
  connect(widget, &ViewportWidget::shown, this, [this, viewport] {
    if (this->Watched_.count(viewport) > 0) { // after the painting
      QTimer::singleShot(0, this,
                         [this, viewport] { emit this->drawn(QString::fromStdString(viewport)); });
    }
  });
}

std::vector<ViewPanes::Pane> ViewPanes::Panes() const {
  std::vector<Pane> open;
  std::copy_if(this->Panes_.begin(), this->Panes_.end(), std::back_inserter(open),
               [](const Pane& pane) { return pane.dock && pane.widget; });
  return open;
}

ViewPanes::Pane ViewPanes::Current(vtkObject* of) const {
  Pane found;
  for (const Pane& pane : this->Panes()) {
    if (!of || pane.of == of) {
      found = pane;
      if (pane.dock == this->Used_) {
        break;
      }
    }
  }
  return found;
}

const ViewPanes::Pane& ViewPanes::Find(const QString& viewport) const {
  for (const Pane& pane : this->Panes_) {
    if (pane.dock && pane.widget && pane.viewport == viewport.toStdString()) {
      return pane;
    }
  }
  throw Error(Error::Kind::NotFound, "view '" + viewport.toStdString() + "'",
              "it is not shown; accepted: one of app.views");
}

bool ViewPanes::Handles(const QJsonObject& request) {
  return request["do"].toString() == "views";
}

QJsonObject ViewPanes::Handle(const QJsonObject& request) {
  const QString what = request["what"].toString();
  const QString view = request["view"].toString();
  if (what == "current") {
    return {{"view", QString::fromStdString(this->Current(nullptr).viewport)}};
  }
  if (what == "maximize") {
    this->Maximize(this->Find(view).dock);
  } else if (what == "restore") {
    this->Restore();
  } else if (what == "tile") {
    this->Tile();
  } else if (what == "copy") {
    Copy(this->Find(view));
  } else if (what == "split") {
    this->Split(this->Find(view), this->Find(request["beside"].toString()),
                request["side"].toString());
  } else if (what == "watch") {
    if (request["on"].toBool()) {
      this->Watched_.insert(view.toStdString());
    } else {
      this->Watched_.erase(view.toStdString());
    }
  } else {
    throw Error(Error::Kind::InvalidArgument, "views",
                "there is no \"" + what.toStdString() +
                    "\"; accepted: current, maximize, restore, tile, copy, split, watch");
  }
  return {};
}

void ViewPanes::Maximize(QDockWidget* dock) {
  if (dock->isFloating()) {
    dock->setWindowState(dock->windowState() ^ Qt::WindowMaximized);
    return;
  }
  this->Restore();
  this->Before_ = this->Window_->saveState();
  for (auto* other : this->Window_->findChildren<QDockWidget*>()) {
    if (other != dock && !other->isFloating()) {
      other->hide();
    }
  }
  dock->show();
  emit this->arranged();
}

void ViewPanes::Restore() {
  if (this->Before_.isEmpty()) {
    return;
  }
  this->Window_->restoreState(this->Before_);
  this->Before_.clear();
  emit this->arranged();
}

void ViewPanes::Tile() {
  this->Restore();
  std::vector<QDockWidget*> docks;
  for (const Pane& pane : this->Panes()) {
    if (pane.dock->isVisibleTo(this->Window_) && !pane.dock->isFloating()) {
      docks.push_back(pane.dock);
    }
  }
  if (docks.empty()) {
    return;
  }
  const auto columns = std::size_t(std::ceil(std::sqrt(double(docks.size()))));
  for (std::size_t i = 0; i < docks.size(); ++i) {
    if (i == 0) {
      this->Window_->addDockWidget(Qt::RightDockWidgetArea, docks[i]);
    } else if (i < columns) { // the first row, and then below it
      this->Window_->splitDockWidget(docks[i - 1], docks[i], Qt::Horizontal);
    } else {
      this->Window_->splitDockWidget(docks[i - columns], docks[i], Qt::Vertical);
    }
  }
  // Splitting halves the last one again and again.
  const auto equal = [this](const QList<QDockWidget*>& among, Qt::Orientation along) {
    this->Window_->resizeDocks(among, QList<int>(among.size(), 1000), along);
  };
  QList<QDockWidget*> first;
  for (std::size_t i = 0; i < std::min(columns, docks.size()); ++i) {
    first << docks[i];
    QList<QDockWidget*> column;
    for (std::size_t j = i; j < docks.size(); j += columns) {
      column << docks[j];
    }
    equal(column, Qt::Vertical);
  }
  equal(first, Qt::Horizontal);
}

void ViewPanes::Split(const Pane& pane, const Pane& beside, const QString& side) {
  if (side != "right" && side != "below") {
    throw Error(Error::Kind::InvalidArgument, "view '" + pane.viewport + "'",
                "its side is \"" + side.toStdString() + "\"; accepted: right, below");
  }
  if (beside.dock->isFloating() || pane.dock == beside.dock) {
    return; // a window of its own has one view
  }
  const Qt::Orientation along = side == "right" ? Qt::Horizontal : Qt::Vertical;
  this->Window_->splitDockWidget(beside.dock, pane.dock, along);
  const int room = along == Qt::Horizontal ? beside.dock->width() : beside.dock->height();
  this->Window_->resizeDocks({beside.dock, pane.dock}, {room / 2, room / 2}, along);
}

void ViewPanes::Copy(const Pane& pane) {
  vtkDspaceViewport* viewport = pane.widget->GetViewport();
  const Capture capture = viewport->GetCapture({});
  const QImage picture(capture.color.data(), capture.width, capture.height, 4 * capture.width,
                       QImage::Format_RGBX8888);
  QGuiApplication::clipboard()->setImage(picture.convertToFormat(QImage::Format_RGB32));
}

bool ViewPanes::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::FocusIn || event->type() == QEvent::MouseButtonPress) {
    for (const Pane& pane : this->Panes()) {
      if (pane.widget == watched) {
        if (std::exchange(this->Used_, pane.dock) != pane.dock) {
          emit this->currentChanged();
        }
      }
    }
  }
  return QObject::eventFilter(watched, event);
}

} // namespace dspace::widgets
