#include <dspace/widgets/telemetry/SvgPaintDevice.h>

#include <cmath>

#include <QBrush>
#include <QBuffer>
#include <QFontInfo>
#include <QImage>
#include <QPaintEngine>
#include <QPainterPath>
#include <QPen>
#include <QPixmap>

namespace dspace::widgets {
namespace {

QByteArray Number(double value) {
  return QByteArray::number(std::abs(value) < 5e-4 ? 0.0 : value, 'g', 7);
}

QByteArray Escaped(const QString& text) {
  QString plain;
  for (const QChar c : text) { // XML has no control characters
    plain += c.unicode() < 0x20 && c != '\t' ? QChar(0xfffd) : c;
  }
  return plain.toHtmlEscaped().toUtf8();
}

QByteArray Color(const char* name, const QColor& color, double opacity) {
  QByteArray text = " " + QByteArray(name) + "=\"" + color.name().toLatin1() + "\"";
  opacity *= color.alphaF();
  if (opacity < 1.0) {
    text += " " + QByteArray(name) + "-opacity=\"" + Number(opacity) + "\"";
  }
  return text;
}

} // namespace

class SvgPaintDevice::Engine : public QPaintEngine {
public:
  Engine()
      : QPaintEngine(QPaintEngine::PrimitiveTransform | QPaintEngine::PainterPaths |
                     QPaintEngine::AlphaBlend | QPaintEngine::Antialiasing |
                     QPaintEngine::ConstantOpacity | QPaintEngine::PixmapTransform |
                     QPaintEngine::PaintOutsidePaintEvent) {}

  QByteArray body;

  bool begin(QPaintDevice*) override {
    this->body.clear();
    return true;
  }
  bool end() override { return true; }
  Type type() const override { return QPaintEngine::User; }

  void updateState(const QPaintEngineState& state) override {
    this->Pen_ = state.pen();
    this->Brush_ = state.brush();
    this->Opacity_ = state.opacity();
    const QTransform& m = state.transform();
    this->Transform_.clear();
    if (!m.isIdentity()) {
      this->Transform_ = " transform=\"matrix(" + Number(m.m11()) + " " + Number(m.m12()) + " " +
                         Number(m.m21()) + " " + Number(m.m22()) + " " + Number(m.dx()) + " " +
                         Number(m.dy()) + ")\"";
    }
  }

  void drawPath(const QPainterPath& path) override {
    QByteArray d;
    for (int i = 0; i < path.elementCount(); ++i) {
      const QPainterPath::Element& each = path.elementAt(i);
      const char* letter = each.type == QPainterPath::MoveToElement    ? "M"
                           : each.type == QPainterPath::LineToElement  ? "L"
                           : each.type == QPainterPath::CurveToElement ? "C"
                                                                       : " ";
      d += letter + Number(each.x) + " " + Number(each.y);
    }
    const char* rule = path.fillRule() == Qt::OddEvenFill ? " fill-rule=\"evenodd\"" : "";
    this->Put("<path d=\"" + d + "\"" + rule + this->Stroke() + this->Fill());
  }

  void drawPolygon(const QPointF* points, int count, PolygonDrawMode mode) override {
    QByteArray text;
    for (int i = 0; i < count; ++i) {
      text += (i ? " " : "") + Number(points[i].x()) + "," + Number(points[i].y());
    }
    const bool line = mode == PolylineMode;
    this->Put(QByteArray(line ? "<polyline" : "<polygon") + " points=\"" + text + "\"" +
              this->Stroke() + (line ? QByteArray(" fill=\"none\"") : this->Fill()));
  }
  void drawPolygon(const QPoint* points, int count, PolygonDrawMode mode) override {
    QPolygonF polygon;
    for (int i = 0; i < count; ++i) {
      polygon += points[i];
    }
    this->drawPolygon(polygon.constData(), count, mode);
  }

  void drawTextItem(const QPointF& place, const QTextItem& item) override {
    const QFont font = item.font();
    const int pixels = font.pixelSize() > 0 ? font.pixelSize() : QFontInfo(font).pixelSize();
    this->Put("<text x=\"" + Number(place.x()) + "\" y=\"" + Number(place.y()) +
                  "\" font-family=\"" + Escaped(font.family()) + ", sans-serif\" font-size=\"" +
                  Number(pixels) + "\"" + (font.bold() ? " font-weight=\"bold\"" : "") +
                  (font.italic() ? " font-style=\"italic\"" : "") + " textLength=\"" +
                  Number(item.width()) +
                  "\" lengthAdjust=\"spacingAndGlyphs\" xml:space=\"preserve\"" +
                  Color("fill", this->Pen_.color(), this->Opacity_),
              Escaped(item.text()) + "</text>\n");
  }

  void drawPixmap(const QRectF& target, const QPixmap& pixmap, const QRectF& source) override {
    this->drawImage(target, pixmap.toImage(), source, Qt::AutoColor);
  }
  void drawImage(const QRectF& target, const QImage& image, const QRectF& source,
                 Qt::ImageConversionFlags) override {
    QByteArray bytes;
    QBuffer buffer(&bytes);
    buffer.open(QIODevice::WriteOnly);
    image.copy(source.toAlignedRect()).save(&buffer, "PNG");
    this->Put("<image x=\"" + Number(target.x()) + "\" y=\"" + Number(target.y()) + "\" width=\"" +
              Number(target.width()) + "\" height=\"" + Number(target.height()) + "\" opacity=\"" +
              Number(this->Opacity_) +
              "\" preserveAspectRatio=\"none\" href=\"data:image/png;base64," + bytes.toBase64() +
              "\"");
  }

private:
  void Put(const QByteArray& element, const QByteArray& content = {}) {
    this->body +=
        element + this->Transform_ + (content.isEmpty() ? QByteArray("/>\n") : ">" + content);
  }

  QByteArray Stroke() const {
    if (this->Pen_.style() == Qt::NoPen) {
      return " stroke=\"none\"";
    }
    QByteArray text = Color("stroke", this->Pen_.color(), this->Opacity_);
    const double width = this->Pen_.widthF() > 0.0 ? this->Pen_.widthF() : 1.0;
    text += " stroke-width=\"" + Number(width) + "\"";
    if (this->Pen_.isCosmetic()) {
      text += " vector-effect=\"non-scaling-stroke\"";
    }
    if (this->Pen_.joinStyle() == Qt::RoundJoin) {
      text += " stroke-linejoin=\"round\"";
    }
    if (this->Pen_.capStyle() != Qt::FlatCap) {
      text += this->Pen_.capStyle() == Qt::RoundCap ? " stroke-linecap=\"round\""
                                                    : " stroke-linecap=\"square\"";
    }
    if (this->Pen_.style() != Qt::SolidLine) {
      QByteArray dashes;
      for (const double each : this->Pen_.dashPattern()) {
        dashes += (dashes.isEmpty() ? "" : " ") + Number(each * width);
      }
      text += " stroke-dasharray=\"" + dashes + "\"";
    }
    return text;
  }
  QByteArray Fill() const {
    return this->Brush_.style() == Qt::NoBrush
               ? QByteArray(" fill=\"none\"")
               : Color("fill", this->Brush_.color(), this->Opacity_);
  }

  QPen Pen_;
  QBrush Brush_;
  double Opacity_ = 1.0;
  QByteArray Transform_;
};

SvgPaintDevice::SvgPaintDevice(const QSize& size, const QString& title)
    : Engine_(std::make_unique<Engine>()), Size_(size), Title_(title) {}

SvgPaintDevice::~SvgPaintDevice() = default;

QPaintEngine* SvgPaintDevice::paintEngine() const {
  return this->Engine_.get();
}

QByteArray SvgPaintDevice::Document() const {
  const QByteArray width = QByteArray::number(this->Size_.width());
  const QByteArray height = QByteArray::number(this->Size_.height());
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
         width + "\" height=\"" + height + "\" viewBox=\"0 0 " + width + " " + height +
         "\">\n<title>" + Escaped(this->Title_) + "</title>\n" + this->Engine_->body + "</svg>\n";
}

int SvgPaintDevice::metric(PaintDeviceMetric metric) const {
  constexpr int Dpi = 96;
  switch (metric) {
  case PdmWidth:
    return this->Size_.width();
  case PdmHeight:
    return this->Size_.height();
  case PdmWidthMM:
    return int(std::lround(this->Size_.width() * 25.4 / Dpi));
  case PdmHeightMM:
    return int(std::lround(this->Size_.height() * 25.4 / Dpi));
  case PdmNumColors:
    return 1 << 24;
  case PdmDepth:
    return 24;
  case PdmDpiX:
  case PdmDpiY:
  case PdmPhysicalDpiX:
  case PdmPhysicalDpiY:
    return Dpi;
  case PdmDevicePixelRatio:
    return 1;
  case PdmDevicePixelRatioScaled:
    return int(devicePixelRatioFScale());
  default:
    return 0;
  }
}

} // namespace dspace::widgets
