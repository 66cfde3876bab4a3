// The telemetry of a window: a table of the scene in the docks, and any number of plots.
#ifndef DSPACE_WIDGETS_TELEMETRY_DOCKS_H
#define DSPACE_WIDGETS_TELEMETRY_DOCKS_H

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <QObject>
#include <QPointer>

class QDockWidget;
class QMainWindow;
class vtkObject;

namespace dspace::widgets {

class ShownScenes;
class TelemetryPlotWidget;
class TelemetryTableWidget;
class TimelineWidget;

// A plot belongs to the scene that it was made for, whatever is in the other docks later. Its line
// at the present time is that of the timeline while its scene is there; a click in it moves a
// recording there.
class TelemetryDocks : public QObject {
  Q_OBJECT

public:
  // All must outlive it. The table's dock is not placed.
  TelemetryDocks(QMainWindow* window, ShownScenes* scenes, TimelineWidget* timeline);

  ~TelemetryDocks() override; // with all of its docks

  QDockWidget* TableDock() const { return this->TableDock_; }
  // An empty plot of a scene in a dock of its own; returns its number.
  long NewPlot(vtkObject* of, const std::string& scene, const std::string& title);
  // Adds a channel of the plot's scene: its values from now on. Throws Error: NotFound without such
  // a plot or channel, InvalidArgument for a channel of texts.
  void AddChannel(long plot, const std::string& channel);
  // Adds samples, in the order of time, each of which holds until the next one. Throws as
  // SampleSeries::Append() does.
  void AddSeries(long plot, const std::string& name, const std::string& unit,
                 const std::vector<double>& times, const std::vector<double>& values);
  TelemetryPlotWidget* Plot(long plot) const; // null: it is closed
  // The part of the window's height that the docks of plots want, at least; 0: none is docked.
  double HeightShare() const;
  // The plots of a scene's session close.
  void Forget(vtkObject* of);

signals:
  // The user asks for a plot of a channel of the scene in the docks.
  void plotWanted(const QString& channel);
  // The user dropped a channel on the plot of a recording, whose samples it has not.
  void seriesWanted(long plot, const QString& channel);
  void failed(const QString& message);

private:
  struct Plot_t {
    vtkObject* of = nullptr;
    std::string scene;
    QPointer<QDockWidget> dock;
    QPointer<TelemetryPlotWidget> widget;
  };
  Plot_t& Find(long plot);
  void GiveHeight(QDockWidget* plot);

  QMainWindow* Window_;
  ShownScenes* Scenes_;
  TimelineWidget* Timeline_;
  QDockWidget* TableDock_ = nullptr;
  TelemetryTableWidget* Table_ = nullptr;
  std::map<long, Plot_t> Plots_;
  long Last_ = 0;
};

} // namespace dspace::widgets

#endif
