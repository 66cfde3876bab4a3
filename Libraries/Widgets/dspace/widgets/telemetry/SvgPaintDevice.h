// Paints into a text of SVG.
#ifndef DSPACE_WIDGETS_SVG_PAINT_DEVICE_H
#define DSPACE_WIDGETS_SVG_PAINT_DEVICE_H

#include <memory>

#include <QByteArray>
#include <QPaintDevice>
#include <QSize>

namespace dspace::widgets {

// A QPainter on it writes lines, polygons, paths, pictures and texts in plain colours, transformed,
// with opacity. Gradients and patterns become the colour of their brush; clipping is ignored. Texts
// stay texts: as wide as Qt draws them, whatever the font of who shows them.
// (Qt's own QSvgGenerator is in a module of its own.)
class SvgPaintDevice : public QPaintDevice {
public:
  // `size` in units of the drawing, which are pixels of 1/96 inch.
  SvgPaintDevice(const QSize& size, const QString& title);
  ~SvgPaintDevice() override;

  QPaintEngine* paintEngine() const override;
  // The whole document, UTF-8, after the painter has ended.
  QByteArray Document() const;

protected:
  int metric(PaintDeviceMetric metric) const override;

private:
  class Engine;
  std::unique_ptr<Engine> Engine_;
  QSize Size_;
  QString Title_;
};

} // namespace dspace::widgets

#endif
