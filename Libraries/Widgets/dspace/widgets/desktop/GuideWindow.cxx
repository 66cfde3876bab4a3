#include <dspace/widgets/desktop/GuideWindow.h>

#include <QCoreApplication>
#include <QDesktopServices>
#include <QDir>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QShortcut>
#include <QTextBrowser>
#include <QToolButton>
#include <QVBoxLayout>

namespace dspace::widgets {
namespace {

// Shows pages of Markdown with pictures no wider than the window.
class Pages : public QTextBrowser {
public:
  QVariant loadResource(int type, const QUrl& name) override {
    const QVariant loaded = QTextBrowser::loadResource(type, name);
    if (type != QTextDocument::ImageResource) {
      return loaded;
    }
    QImage image = loaded.value<QImage>();
    if (image.isNull()) {
      image.loadFromData(loaded.toByteArray());
    }
    constexpr int Widest = 780; // pixels
    return image.width() > Widest ? image.scaledToWidth(Widest, Qt::SmoothTransformation) : image;
  }

protected:
  void doSetSource(const QUrl& name, QTextDocument::ResourceType type) override {
    if (name.scheme() == "http" || name.scheme() == "https") {
      QDesktopServices::openUrl(name);
      return;
    }
    const bool page = name.path().endsWith(".md") || name.path().isEmpty();
    if (!page) { // programs of Examples/ and the like
      return;
    }
    QTextBrowser::doSetSource(
        name, type == QTextDocument::UnknownResource ? QTextDocument::MarkdownResource : type);
  }
};

} // namespace

QString GuideWindow::Folder() {
  const QDir beside(QCoreApplication::applicationDirPath());
  const QString shipped = qEnvironmentVariable("DSPACE_SHIPPED_DATA");
  for (const QString& folder :
       {beside.absoluteFilePath(QStringLiteral("../share/doc/dspace")),
        shipped.isEmpty() ? QString() : QDir(shipped).absoluteFilePath("../Documentation"),
        beside.absoluteFilePath(QStringLiteral("../../../Documentation"))}) {
    if (!folder.isEmpty() && QFileInfo::exists(folder + QStringLiteral("/Application.md"))) {
      return QDir::cleanPath(folder);
    }
  }
  return {};
}

GuideWindow::GuideWindow(const QString& page, QWidget* parent)
    : QDialog(parent), Browser_(new Pages), Words_(new QLineEdit) {
  this->setWindowTitle(tr("Guide"));
  this->resize(860, 720);
  this->Browser_->setOpenExternalLinks(false);
  const auto button = [this](Qt::ArrowType arrow, const QString& tip, auto clicked) {
    auto* made = new QToolButton;
    made->setArrowType(arrow);
    made->setToolTip(tip);
    made->setAccessibleName(tip);
    connect(made, &QToolButton::clicked, this->Browser_, clicked);
    return made;
  };
  auto* back = button(Qt::LeftArrow, tr("Back (Alt+Left)"), &QTextBrowser::backward);
  auto* on = button(Qt::RightArrow, tr("Forward (Alt+Right)"), &QTextBrowser::forward);
  back->setEnabled(false);
  on->setEnabled(false);
  connect(this->Browser_, &QTextBrowser::backwardAvailable, back, &QWidget::setEnabled);
  connect(this->Browser_, &QTextBrowser::forwardAvailable, on, &QWidget::setEnabled);
  this->Words_->setPlaceholderText(tr("Find in this page (Ctrl+F)"));
  this->Words_->setClearButtonEnabled(true);
  connect(this->Words_, &QLineEdit::returnPressed, this, &GuideWindow::Find);
  connect(new QShortcut(QKeySequence::Find, this), &QShortcut::activated, this->Words_,
          [this] { this->Words_->setFocus(); });
  auto* row = new QHBoxLayout;
  row->addWidget(back);
  row->addWidget(on);
  row->addStretch();
  row->addWidget(this->Words_);
  auto* all = new QVBoxLayout(this);
  all->addLayout(row);
  all->addWidget(this->Browser_);
  this->Browser_->setSource(QUrl::fromLocalFile(page), QTextDocument::MarkdownResource);
}

void GuideWindow::Find() {
  if (!this->Browser_->find(this->Words_->text())) { // from the top
    this->Browser_->moveCursor(QTextCursor::Start);
    this->Browser_->find(this->Words_->text());
  }
}

} // namespace dspace::widgets
