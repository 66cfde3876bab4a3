// A window with a text that can be copied.
#ifndef DSPACE_WIDGETS_TEXT_WINDOW_H
#define DSPACE_WIDGETS_TEXT_WINDOW_H

#include <QDialog>

class QPlainTextEdit;

namespace dspace::widgets {

class TextWindow : public QDialog {
  Q_OBJECT

public:
  TextWindow(const QString& title, const QString& text, QWidget* parent = nullptr);
  // Opens one that is deleted when it is closed; nothing stops meanwhile.
  static TextWindow* Open(const QString& title, const QString& text, QWidget* parent);

private:
  QPlainTextEdit* Text_;
};

} // namespace dspace::widgets

#endif
