// The guide: pages of Markdown with their pictures.
#ifndef DSPACE_WIDGETS_GUIDE_WINDOW_H
#define DSPACE_WIDGETS_GUIDE_WINDOW_H

#include <QDialog>

class QLineEdit;
class QTextBrowser;

namespace dspace::widgets {

class GuideWindow : public QDialog {
  Q_OBJECT

public:
  // `page`: a file of Markdown; links to pages beside it open here, others in the desktop's
  // browser.
  explicit GuideWindow(const QString& page, QWidget* parent = nullptr);
  QTextBrowser* Browser() const { return this->Browser_; }

  // The folder of the guides that belong to this program: of the installed tree, or of the source
  // tree of a build. Empty: neither is there.
  static QString Folder();

private:
  void Find();

  QTextBrowser* Browser_;
  QLineEdit* Words_;
};

} // namespace dspace::widgets

#endif
