// Values as Python writes them, for the lines that actions run.
#ifndef DSPACE_WIDGETS_PYTHON_TEXT_H
#define DSPACE_WIDGETS_PYTHON_TEXT_H

#include <QString>

namespace dspace::widgets {

QString Quoted(const QString& text);
QString PythonOf(double value); // the shortest text of this double
QString PythonOf(bool value);

} // namespace dspace::widgets

#endif
