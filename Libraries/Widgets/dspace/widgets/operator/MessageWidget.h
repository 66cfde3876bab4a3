// The messages of a simulation and its open questions.
#ifndef DSPACE_WIDGETS_MESSAGE_WIDGET_H
#define DSPACE_WIDGETS_MESSAGE_WIDGET_H

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include <QTimer>
#include <QWidget>

class QComboBox;
class QLineEdit;
class QScrollArea;
class QTreeWidget;
class QVBoxLayout;

namespace dspace::session {
class MessageLog;
}

namespace dspace::widgets {

// A table of the logged events of a scene, the newest last: time [s], severity, kind, frame, text.
// It shows the newest 1,000 that match the filters. Above it each open question has a panel with
// its choices, or with a line for any text. Changes are shown within 0.2 s while the widget is
// visible.
class MessageWidget : public QWidget {
  Q_OBJECT

public:
  static constexpr int MostRows = 1000;

  // `log` is null where there is no scene. It is used before control returns.
  struct Shown {
    const session::MessageLog* log = nullptr;
    std::uint64_t scene = 0; // another number: another scene
    bool canAnswer = true;   // false: a recording, where nobody hears the answer
  };
  using Source = std::function<Shown()>;

  explicit MessageWidget(QWidget* parent = nullptr);
  ~MessageWidget() override;

  void SetSource(Source source);
  // An answer was not sent: the question takes another one. So it does by itself 5 s after an
  // answer, where it is still open.
  void TakeAnswerAgain(const QString& question);
  // Looks for changes now, also while it is hidden.
  void Refresh();
  // The rows of the table.
  int Count() const;
  // Of a row: the columns' texts, separated by tabs.
  QString Row(int row) const;

signals:
  // The operator answered an open question of the scene that is shown.
  void answered(const QString& question, const QString& answer);
  // A question was asked that was not there before.
  void asked(const QString& question);

protected:
  void showEvent(QShowEvent* event) override;

private:
  // The source's log and whether its questions can be answered; panels of another scene go.
  Shown Look();
  void ShowEvents(const session::MessageLog* log);
  void ShowQuestions(const Shown& shown);
  QWidget* Panel(const QString& name, const QString& text, const QStringList& choices, int severity,
                 bool canAnswer);

  Source Source_;
  QTimer Timer_;
  QComboBox* Severity_ = nullptr;
  QLineEdit* Filter_ = nullptr;
  QTreeWidget* Table_ = nullptr;
  QScrollArea* Area_ = nullptr; // of the questions
  QVBoxLayout* Questions_ = nullptr;
  std::map<std::string, QWidget*> Panels_; // by question
  Shown Last_;                             // of the last look; its log is not used
  std::uint64_t Number_ = 0;               // the last event in the table
  std::size_t Kept_ = 0;                   // the number of events in the log at that time
  bool Stale_ = true;                      // the table has another scene, or other filters
};

} // namespace dspace::widgets

#endif
