// A strip that says what failed, until it is closed.
#ifndef DSPACE_WIDGETS_NOTICE_BAR_H
#define DSPACE_WIDGETS_NOTICE_BAR_H

#include <QStringList>
#include <QToolBar>

class QLabel;

namespace dspace::widgets {

// The text can be selected and copied; "Details" shows all of it. What was said before is kept, up
// to MostKept messages.
class NoticeBar : public QToolBar {
  Q_OBJECT

public:
  static constexpr int MostKept = 500;

  explicit NoticeBar(QWidget* parent = nullptr);

  // `details`: what is copied; empty: the text.
  void Fail(const QString& text, const QString& details = QString());
  // A message that needs no attention: it is only kept.
  void Note(const QString& text);
  QString Text() const; // of the strip
  QString Details() const { return this->Details_; }
  // All that was said, each with its time of day (UTC).
  QString History() const;
  // A window with the history, which can be copied.
  void ShowHistory();

protected:
  void changeEvent(QEvent* event) override;

private:
  void Paint();

  QLabel* Label_;
  QString Details_;
  QStringList Kept_;
};

} // namespace dspace::widgets

#endif
