#include <dspace/widgets/desktop/TextWindow.h>

#include <QClipboard>
#include <QDialogButtonBox>
#include <QGuiApplication>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QVBoxLayout>

namespace dspace::widgets {

TextWindow::TextWindow(const QString& title, const QString& text, QWidget* parent)
    : QDialog(parent), Text_(new QPlainTextEdit(text)) {
  this->setWindowTitle(title);
  this->resize(640, 360);
  this->Text_->setReadOnly(true);
  this->Text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  auto* copy = buttons->addButton(tr("&Copy"), QDialogButtonBox::ActionRole);
  copy->setToolTip(tr("Copies the whole text"));
  connect(copy, &QPushButton::clicked, this,
          [this] { QGuiApplication::clipboard()->setText(this->Text_->toPlainText()); });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
  auto* all = new QVBoxLayout(this);
  all->addWidget(this->Text_);
  all->addWidget(buttons);
}

TextWindow* TextWindow::Open(const QString& title, const QString& text, QWidget* parent) {
  auto* window = new TextWindow(title, text, parent);
  window->setAttribute(Qt::WA_DeleteOnClose);
  window->show();
  return window;
}

} // namespace dspace::widgets
