// A Python prompt.
#ifndef DSPACE_WIDGETS_CONSOLE_WIDGET_H
#define DSPACE_WIDGETS_CONSOLE_WIDGET_H

#include <QStringList>
#include <QWidget>

class QLineEdit;
class QPlainTextEdit;
class QTextCharFormat;
class QToolButton;

namespace dspace::widgets {

class PythonInterpreter;

// What was typed and printed, and a line to type in: Return runs it, Up and Down bring back earlier
// lines, Tab completes a name. Lines that menus run are shown as if they were typed.
// A button, and Ctrl+C where no text is selected, interrupt what takes long.
class ConsoleWidget : public QWidget {
  Q_OBJECT

public:
  explicit ConsoleWidget(PythonInterpreter* interpreter, QWidget* parent = nullptr);

  // Shows the lines and runs them; false: they raised.
  bool Run(const QString& source);
  // Something was typed, now or before.
  bool IsInUse() const;
  // All lines that were run, as a script; those that raised are comments.
  QString Script() const;

protected:
  bool eventFilter(QObject* object, QEvent* event) override;
  void changeEvent(QEvent* event) override;

private:
  enum class Tone { Output, Input, Error };
  void Enter();
  void Recall(int step);
  void Complete();
  void Append(const QString& text, Tone tone);
  QTextCharFormat FormatOf(Tone tone) const;

  PythonInterpreter* Interpreter_;
  QPlainTextEdit* Output_;
  QLineEdit* Line_;
  QToolButton* Prompt_;
  QToolButton* Interrupt_;
  QStringList History_;
  QStringList Script_;
  QString Pending_;     // lines of a compound statement
  bool Raised_ = false; // the line that runs
  int Recalled_ = 0;    // lines back in the history
};

} // namespace dspace::widgets

#endif
