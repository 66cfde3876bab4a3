#include <dspace/widgets/console/ConsoleWidget.h>

#include <algorithm>

#include <QFontDatabase>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QTextBlock>
#include <QToolButton>
#include <QVBoxLayout>

#include <dspace/widgets/console/PythonInterpreter.h>
#include <dspace/widgets/settings/Theme.h>

namespace dspace::widgets {
namespace {

constexpr int MostLines = 20000; // kept of the output
constexpr int ToneProperty = QTextFormat::UserProperty + 1;

// The start that all of the words share.
QString CommonStart(const QStringList& words) {
  QString start = words.isEmpty() ? QString() : words.front();
  for (const QString& word : words) {
    while (!word.startsWith(start)) {
      start.chop(1);
    }
  }
  return start;
}

// A line that raised, as a script keeps it.
QString Commented(const QString& source) {
  return QStringLiteral("# failed: ") +
         QString(source).replace(QStringLiteral("\n"), QStringLiteral("\n# "));
}

} // namespace

ConsoleWidget::ConsoleWidget(PythonInterpreter* interpreter, QWidget* parent)
    : QWidget(parent), Interpreter_(interpreter), Output_(new QPlainTextEdit(this)),
      Line_(new QLineEdit(this)), Prompt_(new QToolButton(this)),
      Interrupt_(new QToolButton(this)) {
  const QFont font = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  this->Output_->setFont(font);
  this->Output_->setReadOnly(true);
  this->Output_->setMinimumHeight(40);
  this->Output_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
  this->Output_->setMaximumBlockCount(MostLines);
  this->Output_->setLineWrapMode(QPlainTextEdit::WidgetWidth);
  this->Line_->setFont(font);
  this->Line_->setPlaceholderText(tr("Python: session, scene, view, app, dspace"));
  this->Line_->setToolTip(tr("Return runs the line, Up and Down recall, Tab completes"));
  this->Line_->installEventFilter(this);
  this->Prompt_->setFont(font);
  this->Prompt_->setText(QStringLiteral(">>>"));
  this->Prompt_->setAutoRaise(true);
  this->Prompt_->setFocusPolicy(Qt::NoFocus);
  this->Prompt_->setToolTip(tr("Run the line"));
  this->Interrupt_->setObjectName(QStringLiteral("interrupt"));
  this->Interrupt_->setText(tr("Interrupt"));
  this->Interrupt_->setToolTip(tr("Ends the script that runs (Ctrl+C)"));
  this->Interrupt_->setEnabled(false);
  connect(this->Interrupt_, &QToolButton::clicked, interpreter,
          [] { PythonInterpreter::Interrupt(); });
  connect(interpreter, &PythonInterpreter::busyChanged, this->Interrupt_, &QToolButton::setEnabled);
  auto* row = new QHBoxLayout;
  row->addWidget(this->Prompt_);
  row->addWidget(this->Line_);
  row->addWidget(this->Interrupt_);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(4, 4, 4, 4);
  all->addWidget(this->Output_);
  all->addLayout(row);
  this->setFocusProxy(this->Line_);
  connect(this->Prompt_, &QToolButton::clicked, this, &ConsoleWidget::Enter);
  connect(this->Line_, &QLineEdit::returnPressed, this, &ConsoleWidget::Enter);
  connect(interpreter, &PythonInterpreter::written, this, [this](const QString& text, bool error) {
    this->Raised_ =
        this->Raised_ || (error && (text.contains(QStringLiteral("Traceback (most recent")) ||
                                    text.contains(QStringLiteral("SyntaxError: "))));
    this->Append(text, error ? Tone::Error : Tone::Output);
  });
}

QTextCharFormat ConsoleWidget::FormatOf(Tone tone) const {
  QTextCharFormat format;
  format.setProperty(ToneProperty, int(tone));
  if (tone != Tone::Output) {
    format.setForeground(
        AccentOf(tone == Tone::Error ? Accent::Error : Accent::Input, this->palette()));
  }
  return format;
}

// Gives what was written the colours of another theme.
void ConsoleWidget::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) {
    return;
  }
  for (QTextBlock block = this->Output_->document()->begin(); block.isValid();
       block = block.next()) {
    for (auto it = block.begin(); !it.atEnd(); ++it) {
      const QTextFragment part = it.fragment();
      QTextCursor cursor(this->Output_->document());
      cursor.setPosition(part.position());
      cursor.setPosition(part.position() + part.length(), QTextCursor::KeepAnchor);
      cursor.setCharFormat(this->FormatOf(Tone(part.charFormat().intProperty(ToneProperty))));
    }
  }
}

void ConsoleWidget::Append(const QString& text, Tone tone) {
  QTextCursor cursor = this->Output_->textCursor();
  cursor.movePosition(QTextCursor::End);
  cursor.setCharFormat(this->FormatOf(tone));
  cursor.insertText(text);
  this->Output_->setTextCursor(cursor);
  this->Output_->ensureCursorVisible();
}

bool ConsoleWidget::Run(const QString& source) {
  const QStringList lines = source.split('\n');
  for (int i = 0; i < lines.size(); ++i) {
    this->Append((i == 0 ? ">>> " : "... ") + lines[i] + "\n", Tone::Input);
  }
  const int at = this->Script_.size();
  this->Script_ << source;
  const bool done = this->Interpreter_->Run(source);
  if (!done) {
    this->Script_[at] = Commented(source);
  }
  return done;
}

bool ConsoleWidget::IsInUse() const {
  return !this->Line_->text().isEmpty() || !this->Pending_.isEmpty() || !this->History_.isEmpty();
}

QString ConsoleWidget::Script() const {
  return this->Script_.isEmpty() ? QString() : this->Script_.join('\n') + '\n';
}

void ConsoleWidget::Enter() {
  const QString line = this->Line_->text();
  this->Line_->clear();
  this->Append((this->Pending_.isEmpty() ? ">>> " : "... ") + line + "\n", Tone::Input);
  if (!line.trimmed().isEmpty() && (this->History_.isEmpty() || this->History_.back() != line)) {
    this->History_ << line;
  }
  this->Recalled_ = 0;
  const QString source = this->Pending_.isEmpty() ? line : this->Pending_ + '\n' + line;
  const int at = this->Script_.size();
  this->Raised_ = false;
  const bool more = this->Interpreter_->Push(source);
  this->Pending_ = more ? source : QString();
  if (!more && !source.trimmed().isEmpty()) {
    this->Script_.insert(at, this->Raised_ ? Commented(source) : source);
  }
  this->Prompt_->setText(more ? QStringLiteral("...") : QStringLiteral(">>>"));
}

void ConsoleWidget::Recall(int step) {
  const int recalled = std::clamp(this->Recalled_ + step, 0, int(this->History_.size()));
  if (recalled != this->Recalled_) {
    this->Recalled_ = recalled;
    this->Line_->setText(recalled == 0 ? QString()
                                       : this->History_[this->History_.size() - recalled]);
  }
}

void ConsoleWidget::Complete() {
  const QString line = this->Line_->text().left(this->Line_->cursorPosition());
  const QStringList found = this->Interpreter_->Complete(line);
  if (found.isEmpty()) {
    return;
  }
  const QString common = CommonStart(found);
  // The word at the end of the line that the names begin with.
  int length = std::min(line.size(), common.size());
  while (length > 0 && !common.startsWith(line.right(length))) {
    --length;
  }
  this->Line_->insert(common.mid(length));
  if (found.size() > 1) {
    QStringList shown = found.mid(0, 60);
    if (found.size() > shown.size()) {
      shown << tr("... %1 more").arg(found.size() - shown.size());
    }
    this->Append(shown.join(QStringLiteral("   ")) + "\n", Tone::Output);
  }
}

bool ConsoleWidget::eventFilter(QObject* object, QEvent* event) {
  if (object == this->Line_ && event->type() == QEvent::KeyPress) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->matches(QKeySequence::Copy) && !this->Line_->hasSelectedText() &&
        this->Interpreter_->IsBusy()) {
      PythonInterpreter::Interrupt();
      return true;
    }
    switch (key->key()) {
    case Qt::Key_Up:
      this->Recall(1);
      return true;
    case Qt::Key_Down:
      this->Recall(-1);
      return true;
    case Qt::Key_Tab:
      if (this->Line_->text().trimmed().isEmpty()) {
        return false; // to the next widget
      }
      this->Complete();
      return true;
    default:
      break;
    }
  }
  return QWidget::eventFilter(object, event);
}

} // namespace dspace::widgets
