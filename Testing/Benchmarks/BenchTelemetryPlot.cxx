// A plot of ten million samples is panned: the time of a repaint, against that of two thousand
// samples. It needs no display.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <utility>

#include <QApplication>

#include <dspace/widgets/telemetry/TelemetryPlotWidget.h>

#include "Alternate.h"

using dspace::widgets::SampleSeries;
using dspace::widgets::TelemetryPlotWidget;

namespace {

constexpr int Width = 1280;
constexpr int Height = 720;
constexpr int Repaints = 10;
constexpr double Duration_s = 1e4;

// Swings slowly, with noise: each column of pixels has an extent of its own.
std::shared_ptr<SampleSeries> Make(int count, double noise) {
  auto samples = std::make_shared<SampleSeries>();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < count; ++i) {
    const double time_s = Duration_s * i / count;
    samples->Append(time_s, std::sin(0.002 * time_s) + noise * unit(random));
  }
  return samples;
}

// Moves `part` of the samples' duration through the plot, a repaint a step.
class Panned {
public:
  Panned(std::shared_ptr<SampleSeries> samples, double part) : Part_(part) {
    this->Widget_.AddSeries("signal", "V", std::move(samples));
    this->Widget_.resize(Width, Height);
    this->Widget_.show();
    QApplication::processEvents();
  }
  void operator()() {
    for (int i = 0; i < Repaints; ++i) {
      const double begin = Duration_s * (0.1 + 0.001 * i - (this->Part_ > 0.5 ? 0.1 : 0.0));
      this->Widget_.SetXRange({begin, begin + this->Part_ * Duration_s});
      this->Widget_.repaint();
    }
  }

private:
  double Part_;
  TelemetryPlotWidget Widget_;
};

} // namespace

int main(int argc, char** argv) {
  setenv("QT_QPA_PLATFORM", "offscreen", 1);
  const QApplication application(argc, argv);
  struct Case {
    const char* name;
    double noise;
    double part;
  };
  for (const Case& each :
       {Case{"pan, all in view, noise over a third", 0.5, 0.99},
        Case{"pan, all in view, smooth", 0.002, 0.99}, Case{"pan, a tenth in view", 0.5, 0.1},
        Case{"pan, a ten-thousandth in view", 0.5, 1e-4}}) {
    Panned many(Make(10000000, each.noise), each.part);
    Panned few(Make(2000, each.noise), each.part);
    dspace::bench::Print(each.name, dspace::bench::Alternate(21, std::ref(many), std::ref(few)),
                         Repaints,
                         "a repaint of 1280 x 720 of 10,000,000 samples against 2,000; goal: at "
                         "most 33 ms");
  }
  return 0;
}
