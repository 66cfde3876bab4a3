#include <dspace/widgets/window/TelemetryDocks.h>

#include <algorithm>
#include <exception>

#include <QDockWidget>
#include <QMainWindow>
#include <QTimer>

#include "vtkDspacePlayer.h"

#include <dspace/Error.h>
#include <dspace/widgets/telemetry/TelemetryPlotWidget.h>
#include <dspace/widgets/telemetry/TelemetryTableWidget.h>
#include <dspace/widgets/timeline/TimeSource.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/window/ShownScenes.h>

namespace dspace::widgets {
namespace {

constexpr double PlotHeight = 0.34; // of the window's, at least

} // namespace

TelemetryDocks::TelemetryDocks(QMainWindow* window, ShownScenes* scenes, TimelineWidget* timeline)
    : QObject(window), Window_(window), Scenes_(scenes), Timeline_(timeline) {
  this->Table_ = new TelemetryTableWidget(window);
  this->Table_->SetSource([scenes] {
    const auto [of, scene] = scenes->ActiveScene();
    return scenes->TelemetryOf(of, scene);
  });
  connect(this->Table_, &TelemetryTableWidget::activated, this, &TelemetryDocks::plotWanted);
  this->TableDock_ = new QDockWidget(tr("Telemetry"), window);
  this->TableDock_->setObjectName(QStringLiteral("telemetry"));
  this->TableDock_->setWidget(this->Table_);
  connect(timeline, &TimelineWidget::timeChanged, this, [this](double time_s) {
    const vtkObject* active = this->Scenes_->ActiveScene().first;
    for (auto& [number, plot] : this->Plots_) {
      if (plot.widget && plot.of == active) {
        plot.widget->SetCurrentTime(time_s);
      }
    }
  });
}

TelemetryDocks::~TelemetryDocks() {
  for (auto& [number, plot] : this->Plots_) {
    delete plot.dock.data();
  }
  delete this->TableDock_;
}

TelemetryDocks::Plot_t& TelemetryDocks::Find(long plot) {
  const auto found = this->Plots_.find(plot);
  if (found == this->Plots_.end() || !found->second.widget) {
    throw Error(Error::Kind::NotFound, "plot " + std::to_string(plot), "it is closed");
  }
  return found->second;
}

TelemetryPlotWidget* TelemetryDocks::Plot(long plot) const {
  const auto found = this->Plots_.find(plot);
  return found == this->Plots_.end() ? nullptr : found->second.widget.data();
}

long TelemetryDocks::NewPlot(vtkObject* of, const std::string& scene, const std::string& title) {
  const long number = ++this->Last_;
  auto* dock = new QDockWidget(QString::fromStdString(title), this->Window_);
  dock->setObjectName(QStringLiteral("plot %1").arg(number));
  dock->setAttribute(Qt::WA_DeleteOnClose);
  auto* widget = new TelemetryPlotWidget(dock);
  const bool recorded = vtkDspacePlayer::SafeDownCast(of) != nullptr;
  if (!recorded) { // the samples of a recording are all there from the start
    widget->SetSource(
        [scenes = this->Scenes_, of, scene] { return scenes->TelemetryOf(of, scene); });
  }
  connect(widget, &TelemetryPlotWidget::failed, this, &TelemetryDocks::failed);
  connect(widget, &TelemetryPlotWidget::channelDropped, this,
          [this, number](const QString& name) { emit this->seriesWanted(number, name); });
  connect(widget, &TelemetryPlotWidget::timeChosen, this, [this, of](double time_s) {
    if (this->Scenes_->ActiveScene().first != of) {
      return;
    }
    try {
      if (TimeSource* clock = this->Scenes_->Clock()) {
        clock->Seek(time_s);
      }
    } catch (const std::exception& error) {
      emit this->failed(QString::fromUtf8(error.what()));
    }
  });
  dock->setWidget(widget);
  // Beside the last plot, or beside the table.
  QDockWidget* beside = this->TableDock_;
  for (const auto& [other, plot] : this->Plots_) {
    beside = plot.dock && !plot.dock->isFloating() ? plot.dock.data() : beside;
  }
  this->Plots_[number] = {of, scene, dock, widget};
  if (this->Window_->restoreDockWidget(dock)) { // a layout has it
    dock->show();
    return number;
  }
  this->Window_->addDockWidget(Qt::BottomDockWidgetArea, dock);
  if (beside == this->TableDock_) {
    QTimer::singleShot(0, dock, [this, dock] { this->GiveHeight(dock); }); // when it has its place
    this->Window_->splitDockWidget(beside, dock, Qt::Horizontal);
  } else {
    this->Window_->tabifyDockWidget(beside, dock);
  }
  dock->show();
  dock->raise();
  return number;
}

void TelemetryDocks::GiveHeight(QDockWidget* plot) {
  const int height = int(this->HeightShare() * this->Window_->height());
  if (plot->isFloating() || plot->height() >= height) {
    return;
  }
  QList<QDockWidget*> docks = {plot};
  QList<int> sizes = {height};
  for (QDockWidget* each : this->Window_->findChildren<QDockWidget*>()) { // what is above it
    const Qt::DockWidgetArea area = this->Window_->dockWidgetArea(each);
    if ((area == Qt::LeftDockWidgetArea || area == Qt::RightDockWidgetArea) && each->isVisible() &&
        !each->isFloating()) {
      docks << each;
      sizes << std::max(each->height() - (height - plot->height()), 1);
    }
  }
  this->Window_->resizeDocks(docks, sizes, Qt::Vertical);
}

double TelemetryDocks::HeightShare() const {
  return std::any_of(this->Plots_.begin(), this->Plots_.end(),
                     [](const auto& entry) {
                       return entry.second.dock && !entry.second.dock->isFloating();
                     })
             ? PlotHeight
             : 0.0;
}

void TelemetryDocks::AddChannel(long plot, const std::string& channel) {
  this->Find(plot).widget->AddChannel(QString::fromStdString(channel));
}

void TelemetryDocks::AddSeries(long plot, const std::string& name, const std::string& unit,
                               const std::vector<double>& times,
                               const std::vector<double>& values) {
  const Plot_t& found = this->Find(plot);
  if (times.size() != values.size()) {
    throw Error(Error::Kind::InvalidArgument, "series '" + name + "'",
                "it has " + std::to_string(times.size()) + " times and " +
                    std::to_string(values.size()) + " values; accepted: as many");
  }
  auto samples = std::make_shared<SampleSeries>();
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!samples->IsEmpty() && times[i] < samples->Time(samples->Size() - 1)) {
      samples->RemoveFrom(times[i]); // the simulation went back
    }
    samples->Append(times[i], values[i]);
  }
  found.widget->AddSeries(QString::fromStdString(name), QString::fromStdString(unit),
                          std::move(samples), true);
  found.widget->ShowAll();
}

void TelemetryDocks::Forget(vtkObject* of) {
  for (auto it = this->Plots_.begin(); it != this->Plots_.end();) {
    if (it->second.of == of) {
      delete it->second.dock.data();
      it = this->Plots_.erase(it);
    } else {
      ++it;
    }
  }
}

} // namespace dspace::widgets
