#include <dspace/widgets/script/PythonText.h>

#include <cmath>

#include <QLocale>

namespace dspace::widgets {

QString Quoted(const QString& text) {
  QString quoted = text;
  quoted.replace('\\', QStringLiteral("\\\\")).replace('"', QStringLiteral("\\\""));
  quoted.replace('\n', QStringLiteral("\\n"));
  return '"' + quoted + '"';
}

QString PythonOf(double value) {
  if (!std::isfinite(value)) {
    return QStringLiteral("float(\"%1\")")
        .arg(std::isnan(value) ? "nan"
             : value > 0.0     ? "inf"
                               : "-inf");
  }
  return QString::number(value, 'g', QLocale::FloatingPointShortest);
}

QString PythonOf(bool value) {
  return value ? QStringLiteral("True") : QStringLiteral("False");
}

} // namespace dspace::widgets
