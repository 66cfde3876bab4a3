#include <dspace/widgets/desktop/NoticeBar.h>

#include <QClipboard>
#include <QDateTime>
#include <QEvent>
#include <QGuiApplication>
#include <QLabel>
#include <QToolButton>

#include <dspace/widgets/desktop/TextWindow.h>
#include <dspace/widgets/settings/Theme.h>

namespace dspace::widgets {
namespace {

constexpr int LongestShown = 400; // letters

} // namespace

NoticeBar::NoticeBar(QWidget* parent) : QToolBar(tr("Notices"), parent), Label_(new QLabel) {
  this->setObjectName(QStringLiteral("notices"));
  this->setMovable(false);
  this->setFloatable(false);
  this->toggleViewAction()->setVisible(false); // not in the menu of tool bars
  this->Label_->setTextFormat(Qt::PlainText);
  this->Label_->setWordWrap(true);
  this->Label_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  this->Label_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  this->Label_->setAccessibleName(tr("Notice"));
  this->Label_->setContentsMargins(8, 4, 8, 4);
  this->addWidget(this->Label_);
  const auto add = [this](const QString& text, const QString& tip, auto clicked) {
    auto* button = new QToolButton;
    button->setText(text);
    button->setToolTip(tip);
    button->setFocusPolicy(Qt::TabFocus);
    connect(button, &QToolButton::clicked, this, clicked);
    this->addWidget(button);
    return button;
  };
  add(tr("Details"), tr("Shows all that is known"), [this] {
    TextWindow::Open(tr("Details"), this->Details_, this->window());
  })->setObjectName(QStringLiteral("details"));
  add(tr("Copy"), tr("Copies the whole message"), [this] {
    QGuiApplication::clipboard()->setText(this->Details_);
  })->setObjectName(QStringLiteral("copy"));
  add(tr("Close"), tr("Hides this notice; Help > Messages keeps it"), [this] {
    this->hide();
  })->setObjectName(QStringLiteral("close"));
  this->Paint();
  this->hide();
}

void NoticeBar::Fail(const QString& text, const QString& details) {
  this->Details_ = details.isEmpty() ? text : details;
  this->Label_->setText(text.size() > LongestShown ? text.left(LongestShown) + QChar(0x2026)
                                                   : text);
  this->Note(this->Details_);
  this->show();
}

void NoticeBar::Note(const QString& text) {
  this->Kept_ << QDateTime::currentDateTimeUtc().toString(QStringLiteral("HH:mm:ss  ")) +
                     text.trimmed();
  if (this->Kept_.size() > MostKept) {
    this->Kept_.removeFirst();
  }
}

QString NoticeBar::Text() const {
  return this->Label_->text();
}

QString NoticeBar::History() const {
  return this->Kept_.join('\n');
}

void NoticeBar::ShowHistory() {
  TextWindow::Open(tr("Messages"),
                   this->Kept_.isEmpty() ? tr("There were no messages.") : this->History(),
                   this->window());
}

void NoticeBar::changeEvent(QEvent* event) {
  QToolBar::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && this->Label_) {
    this->Paint();
  }
}

void NoticeBar::Paint() {
  QPalette palette = this->Label_->palette();
  const QColor text = AccentOf(Accent::Error, this->palette());
  if (palette.color(QPalette::WindowText) != text) {
    palette.setColor(QPalette::WindowText, text);
    this->Label_->setPalette(palette);
  }
}

} // namespace dspace::widgets
