#include <dspace/widgets/panel/PanelWidget.h>

#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QJsonArray>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QSlider>
#include <QTableWidget>

#include <dspace/Error.h>

namespace dspace::widgets {
namespace {

constexpr int SliderSteps = 1000;
constexpr int MostTableRows = 10000;
constexpr int LowestColumns[] = {40, 60}; // [pixels] of the names and of the controls

[[noreturn]] void Reject(const QString& kind) {
  throw Error(
      Error::Kind::InvalidArgument, "panel",
      "a row of kind \"" + kind.toStdString() +
          "\"; accepted: heading, text, value, button, slider, choice, check, entry, table");
}

QStringList Texts(const QJsonValue& list) {
  QStringList texts;
  for (const QJsonValue& text : list.toArray()) {
    texts << text.toString();
  }
  return texts;
}

void SetState(QLabel* label, const QString& text, const QString& state) {
  // Dark letters on a light ground: readable in both themes.
  QString style = QStringLiteral("QLabel { padding: 1px 6px; ");
  if (state == "red") {
    style += "background: #b3261e; color: #ffffff; font-weight: bold; }";
  } else if (state == "amber") {
    style += "background: #ffc247; color: #201400; font-weight: bold; }";
  } else {
    style += "}";
  }
  const QString mark = state == "red"     ? QStringLiteral("\u203c ")
                       : state == "amber" ? QStringLiteral("! ")
                                          : QString();
  if (label->text() != mark + text) {
    label->setText(mark + text);
  }
  if (label->styleSheet() != style) {
    label->setStyleSheet(style);
  }
  label->setAccessibleDescription(state);
}

void AppendTo(QTableWidget* table, const QStringList& cells) {
  if (table->rowCount() >= MostTableRows) {
    table->removeRow(0);
  }
  const int row = table->rowCount();
  table->insertRow(row);
  for (int column = 0; column < table->columnCount(); ++column) {
    auto* item = new QTableWidgetItem(cells.value(column));
    item->setToolTip(cells.value(column));
    table->setItem(row, column, item);
  }
}

void Fill(QTableWidget* table, const QJsonArray& rows) {
  table->setRowCount(0);
  for (const QJsonValue& row : rows) {
    AppendTo(table, Texts(row));
  }
}

} // namespace

PanelWidget::PanelWidget(QWidget* parent) : QScrollArea(parent) {
  auto* content = new QWidget;
  this->Grid_ = new QGridLayout(content);
  this->Grid_->setColumnStretch(1, 1);
  this->Grid_->setColumnMinimumWidth(0, LowestColumns[0]);
  this->Grid_->setColumnMinimumWidth(1, LowestColumns[1]);
  this->Grid_->setContentsMargins(8, 8, 8, 8);
  this->setWidget(content);
  this->setWidgetResizable(true);
  this->setFrameShape(QFrame::NoFrame);
}

QSize PanelWidget::sizeHint() const {
  const QSize wanted = this->widget()->sizeHint();
  return wanted.boundedTo(QSize(460, 420)) +
         QSize(this->verticalScrollBar()->sizeHint().width(), 0);
}

const PanelWidget::Row& PanelWidget::At(int row) const {
  if (row < 0 || row >= this->RowCount()) {
    throw Error(Error::Kind::InvalidArgument, "panel",
                "row " + std::to_string(row) + "; it has " + std::to_string(this->RowCount()));
  }
  return this->Rows_[std::size_t(row)];
}

QWidget* PanelWidget::Control(int row) const {
  return this->At(row).control;
}

int PanelWidget::AddRow(const QJsonObject& given) {
  Row row;
  row.kind = given["kind"].toString();
  const int number = this->RowCount();
  const int line = this->Grid_->rowCount();
  const QString name = given["name"].toString();
  const QString unit = given["unit"].toString();
  QWidget* whole = nullptr; // what the grid gets, if not the control
  bool wide = false;        // without a name beside it
  if (row.kind == "heading" || row.kind == "text") {
    auto* label = new QLabel;
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(row.kind == "text");
    if (row.kind == "heading") {
      QFont font = label->font();
      font.setBold(true);
      label->setFont(font);
    } else {
      label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    }
    row.control = label;
    wide = true;
  } else if (row.kind == "value") {
    auto* label = new QLabel;
    label->setTextFormat(Qt::PlainText);
    label->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    row.control = label;
  } else if (row.kind == "button") {
    auto* button = new QPushButton;
    button->setAutoDefault(false);
    connect(button, &QPushButton::clicked, this,
            [this, number] { emit this->changed(number, QJsonValue()); });
    row.control = button;
    wide = name.isEmpty();
  } else if (row.kind == "slider") {
    auto* slider = new QSlider(Qt::Horizontal);
    auto* box = new QDoubleSpinBox;
    const double low = given["low"].toDouble();
    const double high = given["high"].toDouble(1.0);
    box->setDecimals(std::clamp(given["decimals"].toInt(2), 0, 6));
    box->setRange(low, high);
    box->setSingleStep((high - low) / 100.0);
    box->setSuffix(unit.isEmpty() ? QString() : " " + unit);
    box->setKeyboardTracking(false); // a number that is being typed is no value yet
    slider->setRange(0, SliderSteps);
    slider->setPageStep(SliderSteps / 10);
    slider->setMinimumWidth(60);
    row.low = low;
    row.step = (high - low) / SliderSteps;
    connect(slider, &QSlider::valueChanged, box,
            [box, low, step = row.step](int at) { box->setValue(low + step * at); });
    connect(box, &QDoubleSpinBox::valueChanged, this,
            [this, number, slider, low, step = row.step](double value) {
              const QSignalBlocker silent(slider);
              slider->setValue(int(std::lround((value - low) / step)));
              emit this->changed(number, value);
            });
    whole = new QWidget;
    auto* both = new QHBoxLayout(whole);
    both->setContentsMargins(0, 0, 0, 0);
    both->addWidget(slider, 1);
    both->addWidget(box);
    row.control = box;
    row.second = slider;
  } else if (row.kind == "choice") {
    auto* choice = new QComboBox;
    connect(choice, &QComboBox::currentTextChanged, this,
            [this, number](const QString& text) { emit this->changed(number, text); });
    row.control = choice;
  } else if (row.kind == "check") {
    auto* check = new QCheckBox(name);
    connect(check, &QCheckBox::toggled, this,
            [this, number](bool on) { emit this->changed(number, on); });
    row.control = check;
    wide = true;
  } else if (row.kind == "entry") {
    auto* entry = new QLineEdit;
    connect(entry, &QLineEdit::editingFinished, this, [this, number, entry] {
      if (entry->isModified()) { // not when the focus only passes
        entry->setModified(false);
        emit this->changed(number, entry->text());
      }
    });
    row.control = entry;
  } else if (row.kind == "table") {
    auto* table = new QTableWidget;
    const QStringList columns = Texts(given["columns"]);
    table->setColumnCount(int(columns.size()));
    table->setHorizontalHeaderLabels(columns);
    table->horizontalHeader()->setStretchLastSection(true);
    table->horizontalHeader()->setHighlightSections(false);
    table->verticalHeader()->hide();
    table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table->setSelectionBehavior(QAbstractItemView::SelectRows);
    table->setAlternatingRowColors(true);
    table->setTabKeyNavigation(false); // Tab leaves it
    const int shown = std::clamp(given["height"].toInt(6), 1, 50);
    table->verticalHeader()->setDefaultSectionSize(table->fontMetrics().height() + 6);
    table->setMinimumHeight(shown * (table->fontMetrics().height() + 6) +
                            table->horizontalHeader()->sizeHint().height() + 4);
    row.control = table;
    wide = true;
  } else {
    Reject(row.kind);
  }
  row.control->setObjectName(name);
  row.control->setAccessibleName(name.isEmpty() ? given["text"].toString() : name);
  if (!whole) {
    whole = row.control;
  }
  if (wide) {
    this->Grid_->addWidget(whole, line, 0, 1, 2);
  } else {
    auto* label = new QLabel(name);
    label->setTextFormat(Qt::PlainText);
    label->setBuddy(row.control);
    this->Grid_->addWidget(label, line, 0);
    this->Grid_->addWidget(whole, line, 1);
  }
  // The room below the last row, unless a table takes it.
  this->Grid_->setRowStretch(line, row.kind == "table" ? 1000 : 0);
  this->Grid_->setRowStretch(line + 1, 1);
  this->Rows_.push_back(row);
  this->Set(number, given);
  return number;
}

void PanelWidget::Set(int number, const QJsonObject& changes) {
  const Row& row = this->At(number);
  const QSignalBlocker silent(row.control);
  if (changes.contains("tip")) {
    row.control->setToolTip(changes["tip"].toString());
    if (row.second) {
      row.second->setToolTip(changes["tip"].toString());
    }
  }
  if (changes.contains("enabled")) {
    row.control->setEnabled(changes["enabled"].toBool());
    if (row.second) {
      row.second->setEnabled(changes["enabled"].toBool());
    }
  }
  const QJsonValue value = changes["value"];
  if (auto* label = qobject_cast<QLabel*>(row.control)) {
    if (row.kind == "value") {
      const QString text = changes.contains("text") ? changes["text"].toString() : label->text();
      SetState(label, text, changes["state"].toString());
    } else if (changes.contains("text")) {
      label->setText(changes["text"].toString());
    }
  } else if (auto* button = qobject_cast<QPushButton*>(row.control)) {
    if (changes.contains("text")) {
      button->setText(changes["text"].toString());
    }
  } else if (auto* box = qobject_cast<QDoubleSpinBox*>(row.control)) {
    if (value.isDouble()) {
      box->setValue(value.toDouble());
      const QSignalBlocker quiet(row.second);
      static_cast<QSlider*>(row.second)
          ->setValue(int(std::lround((box->value() - row.low) / row.step)));
    }
  } else if (auto* choice = qobject_cast<QComboBox*>(row.control)) {
    if (changes.contains("options")) {
      choice->clear();
      choice->addItems(Texts(changes["options"]));
    }
    if (value.isString()) {
      choice->setCurrentText(value.toString());
    }
  } else if (auto* check = qobject_cast<QCheckBox*>(row.control)) {
    if (value.isBool()) {
      check->setChecked(value.toBool());
    }
  } else if (auto* entry = qobject_cast<QLineEdit*>(row.control)) {
    if (value.isString()) {
      entry->setText(value.toString());
    }
  } else if (auto* table = qobject_cast<QTableWidget*>(row.control)) {
    if (changes.contains("rows")) {
      Fill(table, changes["rows"].toArray());
    }
    if (changes.contains("append")) {
      AppendTo(table, Texts(changes["append"]));
      table->scrollToBottom();
    }
  }
}

} // namespace dspace::widgets
