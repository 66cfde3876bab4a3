#include <dspace/widgets/window/TaskStrip.h>

#include <algorithm>
#include <cmath>

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>

namespace dspace::widgets {

TaskStrip::TaskStrip(QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(12);
}

void TaskStrip::Show(long id, const QString& text, double done, const QString& cancel) {
  const auto found = this->Rows_.find(id);
  if (text.isEmpty()) {
    if (found != this->Rows_.end()) {
      found->second.widget->deleteLater(); // its button may be what calls
      found->second.widget->hide();
      this->Rows_.erase(found);
    }
    return;
  }
  if (found == this->Rows_.end()) {
    Row made{new QWidget(this), nullptr, nullptr, nullptr};
    auto* line = new QHBoxLayout(made.widget);
    line->setContentsMargins(0, 0, 0, 0);
    line->setSpacing(6);
    made.text = new QLabel(made.widget);
    made.text->setTextFormat(Qt::PlainText);
    made.bar = new QProgressBar(made.widget);
    made.bar->setFixedWidth(120);
    made.bar->setTextVisible(false);
    made.bar->setMaximumHeight(14);
    made.button = new QToolButton(made.widget);
    made.button->setObjectName(QStringLiteral("cancel"));
    connect(made.button, &QToolButton::clicked, this, [this, id] { emit this->cancelled(id); });
    line->addWidget(made.text);
    line->addWidget(made.bar);
    line->addWidget(made.button);
    this->layout()->addWidget(made.widget);
    made.widget->show();
    this->Rows_[id] = made;
  }
  const Row& row = this->Rows_[id];
  row.text->setText(text);
  row.bar->setVisible(done >= 0.0);
  row.bar->setRange(0, 1000);
  row.bar->setValue(int(std::lround(1000.0 * std::clamp(done, 0.0, 1.0))));
  row.button->setVisible(!cancel.isEmpty());
  row.button->setText(cancel);
}

QString TaskStrip::Text(long id) const {
  const auto found = this->Rows_.find(id);
  return found == this->Rows_.end() ? QString() : found->second.text->text();
}

} // namespace dspace::widgets
