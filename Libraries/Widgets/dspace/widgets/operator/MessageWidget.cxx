#include <dspace/widgets/operator/MessageWidget.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <QComboBox>
#include <QFrame>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <dspace/state/MessageLog.h>

namespace dspace::widgets {
namespace {

constexpr int Refresh_ms = 200;
constexpr int Patience_ms = 5000; // for the simulation to close an answered question
constexpr int MostButtons = 6;    // more choices are a list

enum Column { Time, Severity, Kind, Frame, Text, Columns };

const char* const Severities[] = {"info", "caution", "warning", "alarm"};

QString SeverityText(int severity) {
  return severity >= 0 && severity < int(std::size(Severities)) ? QString(Severities[severity])
                                                                : QString::number(severity);
}

// Dark letters on it have a contrast above 7.
QColor SeverityColor(int severity) {
  switch (severity) {
  case v1::CAUTION:
    return {0xff, 0xe0, 0x82};
  case v1::WARNING:
    return {0xff, 0xb7, 0x4d};
  case v1::ALARM:
    return {0xff, 0x8a, 0x80};
  default:
    return {};
  }
}

void Paint(QTreeWidgetItem* item, int severity) {
  const QColor color = SeverityColor(severity);
  if (color.isValid()) {
    item->setBackground(Severity, color);
    item->setForeground(Severity, QColor(Qt::black));
  }
}

} // namespace

MessageWidget::MessageWidget(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  auto* questions = new QWidget;
  this->Questions_ = new QVBoxLayout(questions);
  this->Questions_->setContentsMargins(0, 0, 0, 0);
  this->Area_ = new QScrollArea; // several questions may be higher than the dock
  this->Area_->setObjectName(QStringLiteral("questions"));
  this->Area_->setWidget(questions);
  this->Area_->setWidgetResizable(true);
  this->Area_->setFrameShape(QFrame::NoFrame);
  this->Area_->setSizeAdjustPolicy(QAbstractScrollArea::AdjustToContents);
  this->Area_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
  this->Area_->hide();
  column->addWidget(this->Area_);
  auto* row = new QHBoxLayout;
  this->Severity_ = new QComboBox;
  this->Severity_->setObjectName(QStringLiteral("severity"));
  this->Severity_->setAccessibleName(tr("Lowest severity"));
  this->Severity_->setToolTip(tr("The lowest severity that is shown"));
  this->Severity_->addItems(
      {tr("All"), tr("Caution and above"), tr("Warning and above"), tr("Alarm")});
  row->addWidget(this->Severity_);
  this->Filter_ = new QLineEdit;
  this->Filter_->setObjectName(QStringLiteral("filter"));
  this->Filter_->setPlaceholderText(tr("Search kinds, frames and texts"));
  this->Filter_->setClearButtonEnabled(true);
  row->addWidget(this->Filter_, 1);
  column->addLayout(row);
  this->Table_ = new QTreeWidget;
  this->Table_->setObjectName(QStringLiteral("messages"));
  this->Table_->setHeaderLabels(
      {tr("Time [s]"), tr("Severity"), tr("Kind"), tr("Frame"), tr("Text")});
  this->Table_->setRootIsDecorated(false);
  this->Table_->setUniformRowHeights(true);
  this->Table_->setAlternatingRowColors(true);
  this->Table_->header()->setStretchLastSection(true);
  column->addWidget(this->Table_, 1);
  const auto filter = [this] {
    this->Stale_ = true;
    this->Refresh();
  };
  connect(this->Severity_, &QComboBox::currentIndexChanged, this, filter);
  connect(this->Filter_, &QLineEdit::textChanged, this, filter);
  connect(&this->Timer_, &QTimer::timeout, this, [this] {
    if (this->isVisible()) {
      this->Refresh();
    } else { // a question raises the dock
      this->ShowQuestions(this->Look());
    }
  });
  this->Timer_.start(Refresh_ms);
}

MessageWidget::~MessageWidget() = default;

void MessageWidget::SetSource(Source source) {
  this->Source_ = std::move(source);
  this->Refresh();
}

void MessageWidget::TakeAnswerAgain(const QString& question) {
  const auto found = this->Panels_.find(question.toStdString());
  if (found != this->Panels_.end() && this->Last_.canAnswer) {
    auto* controls = found->second->findChild<QWidget*>(QStringLiteral("controls"));
    controls->setEnabled(true);
    controls->setToolTip({});
  }
}

int MessageWidget::Count() const {
  return this->Table_->topLevelItemCount();
}

QString MessageWidget::Row(int row) const {
  const QTreeWidgetItem* item = this->Table_->topLevelItem(row);
  QStringList texts;
  for (int column = 0; item && column < Columns; ++column) {
    texts << item->text(column);
  }
  return texts.join('\t');
}

void MessageWidget::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  this->Refresh();
}

MessageWidget::Shown MessageWidget::Look() {
  const Shown shown = this->Source_ ? this->Source_() : Shown();
  if (shown.scene != this->Last_.scene || shown.canAnswer != this->Last_.canAnswer) {
    this->Stale_ = true;
    for (const auto& [name, panel] : this->Panels_) {
      delete panel;
    }
    this->Panels_.clear();
  }
  this->Last_ = shown;
  return shown;
}

void MessageWidget::Refresh() {
  const Shown shown = this->Look();
  const std::uint64_t number = shown.log ? shown.log->LastNumber() : 0;
  const std::size_t kept = shown.log ? shown.log->Events().size() : 0;
  if (this->Stale_ || number != this->Number_ || kept != this->Kept_) {
    this->ShowEvents(shown.log);
    this->Stale_ = false;
    this->Number_ = number;
    this->Kept_ = kept;
  }
  this->ShowQuestions(shown);
}

void MessageWidget::ShowEvents(const session::MessageLog* log) {
  const QScrollBar* bar = this->Table_->verticalScrollBar();
  const bool atEnd = bar->value() == bar->maximum();
  const int least = this->Severity_->currentIndex();
  const QString words = this->Filter_->text().trimmed();
  QList<QTreeWidgetItem*> items;
  if (log) {
    for (auto it = log->Events().rbegin(); it != log->Events().rend(); ++it) {
      if (items.size() >= MostRows) {
        break;
      }
      const QString kind = QString::fromStdString(it->kind());
      const QString frame = QString::fromStdString(it->frame_path());
      const QString text = QString::fromStdString(it->text());
      if (int(it->severity()) < least ||
          !(words.isEmpty() || kind.contains(words, Qt::CaseInsensitive) ||
            frame.contains(words, Qt::CaseInsensitive) ||
            text.contains(words, Qt::CaseInsensitive))) {
        continue;
      }
      auto* item = new QTreeWidgetItem({QString::number(it->time_s(), 'f', 3),
                                        SeverityText(int(it->severity())), kind, frame,
                                        QString(text).replace('\n', ' ')});
      item->setTextAlignment(Time, Qt::AlignRight | Qt::AlignVCenter);
      item->setToolTip(Text, text);
      Paint(item, int(it->severity()));
      items.prepend(item);
    }
  }
  this->Table_->clear();
  this->Table_->addTopLevelItems(items);
  if (atEnd) {
    this->Table_->scrollToBottom();
  }
}

void MessageWidget::ShowQuestions(const Shown& shown) {
  std::vector<std::string> open;
  if (shown.log) {
    for (const v1::AskOperator& question : shown.log->Questions()) {
      open.push_back(question.name());
      if (this->Panels_.count(question.name()) > 0) {
        continue;
      }
      QStringList choices;
      for (const std::string& choice : question.choice()) {
        choices << QString::fromStdString(choice);
      }
      const QString name = QString::fromStdString(question.name());
      QWidget* panel = this->Panel(name, QString::fromStdString(question.text()), choices,
                                   int(question.severity()), shown.canAnswer);
      this->Questions_->addWidget(panel);
      panel->show();
      this->Area_->show();
      this->Panels_[question.name()] = panel;
      emit this->asked(name);
    }
  }
  for (auto it = this->Panels_.begin(); it != this->Panels_.end();) {
    if (std::find(open.begin(), open.end(), it->first) == open.end()) {
      it->second->hide();
      it->second->deleteLater(); // it may be one of its buttons that closed the question
      it = this->Panels_.erase(it);
    } else {
      ++it;
    }
  }
  this->Area_->setVisible(!this->Panels_.empty());
}

QWidget* MessageWidget::Panel(const QString& name, const QString& text, const QStringList& choices,
                              int severity, bool canAnswer) {
  auto* panel = new QFrame;
  panel->setObjectName(QStringLiteral("question ") + name);
  panel->setFrameShape(QFrame::StyledPanel);
  panel->setAccessibleName(tr("Question %1").arg(name));
  auto* column = new QVBoxLayout(panel);
  auto* title =
      new QLabel(severity == v1::INFO ? name : name + " (" + SeverityText(severity) + ')');
  title->setTextFormat(Qt::PlainText);
  QFont bold = title->font();
  bold.setBold(true);
  title->setFont(bold);
  const QColor color = SeverityColor(severity);
  if (color.isValid()) {
    QPalette palette = title->palette();
    palette.setColor(QPalette::Window, color);
    palette.setColor(QPalette::WindowText, Qt::black);
    title->setPalette(palette);
    title->setAutoFillBackground(true);
  }
  column->addWidget(title);
  auto* words = new QLabel(text);
  words->setTextFormat(Qt::PlainText);
  words->setWordWrap(true);
  words->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(words);
  auto* controls = new QWidget;
  controls->setObjectName(QStringLiteral("controls"));
  auto* row = new QHBoxLayout(controls);
  row->setContentsMargins(0, 0, 0, 0);
  const auto answer = [this, controls, name](const QString& given) {
    controls->setEnabled(false); // one answer; the panel goes when the simulation closes it
    controls->setToolTip(tr("The answer is sent"));
    QTimer::singleShot(Patience_ms, controls, [this, name] { this->TakeAnswerAgain(name); });
    emit this->answered(name, given);
  };
  if (choices.isEmpty()) {
    auto* line = new QLineEdit;
    line->setObjectName(QStringLiteral("answer"));
    line->setMaxLength(4096);
    auto* send = new QPushButton(tr("Send"));
    connect(send, &QPushButton::clicked, line, [answer, line] { answer(line->text()); });
    connect(line, &QLineEdit::returnPressed, send, &QPushButton::click);
    row->addWidget(line, 1);
    row->addWidget(send);
  } else if (choices.size() <= MostButtons) {
    for (const QString& choice : choices) {
      auto* button = new QPushButton(QString(choice).replace('&', QStringLiteral("&&")));
      button->setObjectName(QStringLiteral("answer ") + choice);
      connect(button, &QPushButton::clicked, controls, [answer, choice] { answer(choice); });
      row->addWidget(button);
    }
    row->addStretch(1);
  } else {
    auto* list = new QComboBox;
    list->setObjectName(QStringLiteral("answers"));
    list->addItems(choices);
    auto* send = new QPushButton(tr("Send"));
    connect(send, &QPushButton::clicked, list, [answer, list] { answer(list->currentText()); });
    row->addWidget(list, 1);
    row->addWidget(send);
  }
  if (!canAnswer) {
    controls->setEnabled(false);
    controls->setToolTip(tr("A question of a recording: nobody hears the answer"));
  }
  column->addWidget(controls);
  return panel;
}

} // namespace dspace::widgets
