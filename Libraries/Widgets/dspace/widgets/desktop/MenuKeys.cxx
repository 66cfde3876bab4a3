#include <dspace/widgets/desktop/MenuKeys.h>

#include <functional>
#include <map>
#include <utility>

#include <QAction>
#include <QDialog>
#include <QDialogButtonBox>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QTextBrowser>
#include <QVBoxLayout>

#include <dspace/Error.h>

namespace dspace::widgets {
namespace {

QString Plain(QString text) {
  return WithoutMnemonics(std::move(text)).remove(QStringLiteral("..."));
}

// Each action of the menus with the titles of its menus.
void ForEach(const QList<QAction*>& actions, const QString& path,
             const std::function<void(QAction*, const QString&)>& tell) {
  for (QAction* action : actions) {
    if (action->isSeparator() || !action->isVisible()) {
      continue;
    }
    tell(action, path);
    if (action->menu()) {
      ForEach(action->menu()->actions(), path + Plain(action->text()) + " > ", tell);
    }
  }
}

QChar LetterOf(const QString& text) {
  for (int i = 0; i + 1 < text.size(); ++i) {
    if (text[i] == '&') {
      if (text[i + 1] == '&') {
        ++i;
        continue;
      }
      return text[i + 1].toLower();
    }
  }
  return {};
}

void Complete(const QList<QAction*>& actions) {
  QString taken;
  for (const QAction* action : actions) {
    const QChar letter = LetterOf(action->text());
    if (!letter.isNull()) {
      taken += letter;
    }
  }
  for (QAction* action : actions) {
    if (action->isSeparator()) {
      continue;
    }
    if (LetterOf(action->text()).isNull()) {
      const QString text = action->text();
      for (int i = 0; i < text.size(); ++i) {
        if (text[i].isLetterOrNumber() && !taken.contains(text[i].toLower())) {
          taken += text[i].toLower();
          action->setText(text.left(i) + '&' + text.mid(i));
          break;
        }
      }
    }
    if (action->menu()) {
      Complete(action->menu()->actions());
    }
  }
}

} // namespace

QString WithoutMnemonics(QString text) {
  return text.remove('&');
}

QString KeysOfMenus(const QMenuBar* menus) {
  QString rows;
  ForEach(menus->actions(), QString(), [&](const QAction* action, const QString& path) {
    if (!action->shortcut().isEmpty()) {
      rows += QStringLiteral("<tr><td><b>%1</b></td><td>%2</td></tr>")
                  .arg(action->shortcut().toString(QKeySequence::NativeText).toHtmlEscaped(),
                       (path + Plain(action->text())).toHtmlEscaped());
    }
  });
  return "<table cellspacing=6>" + rows + "</table>";
}

QKeySequence FreeKey(const QMainWindow* window, const QString& text, const QString& key) {
  const QKeySequence sequence(key);
  const std::string label = "action '" + text.toStdString() + "'";
  // Qt takes the first letter of a word that is no key.
  const QString read = sequence.toString(QKeySequence::PortableText);
  const auto last = [](const QString& keys) { return keys.section('+', -1).trimmed().toLower(); };
  if (!key.isEmpty() && (sequence.count() != 1 || last(read) != last(key))) {
    throw Error(Error::Kind::InvalidArgument, label,
                "its key is \"" + key.toStdString() +
                    "\"; accepted: one such as F6 or Ctrl+Shift+D");
  }
  for (const QAction* other : window->findChildren<QAction*>()) {
    if (!sequence.isEmpty() && other->shortcut() == sequence) {
      throw Error(Error::Kind::InvalidArgument, label,
                  "its key " + key.toStdString() + " is that of '" +
                      WithoutMnemonics(other->text()).toStdString() + "'; accepted: a free one");
    }
  }
  return sequence;
}

QMenu* MenuNamed(const QMainWindow* window, const QString& title) {
  QMenu* found = nullptr;
  for (QAction* each : window->menuBar()->actions()) {
    if (each->menu() && WithoutMnemonics(each->text()) == WithoutMnemonics(title)) {
      found = each->menu();
    }
  }
  return found;
}

void ShowKeys(QMainWindow* window, const QString& fixed) {
  auto* dialog = new QDialog(window);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setObjectName(QStringLiteral("keys"));
  dialog->setWindowTitle(QObject::tr("Keys"));
  dialog->resize(620, 560);
  auto* text = new QTextBrowser;
  text->setHtml(QObject::tr("<h3>In a view</h3>") + fixed + QObject::tr("<h3>In the menus</h3>") +
                KeysOfMenus(window->menuBar()));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
  auto* all = new QVBoxLayout(dialog);
  all->addWidget(text);
  all->addWidget(buttons);
  dialog->show();
}

QStringList MnemonicFaults(const QMenuBar* menus) {
  QStringList faults;
  std::map<QString, QString> taken; // by the path of the menu: letters
  ForEach(menus->actions(), QString(), [&](const QAction* action, const QString& path) {
    if (path.contains(QStringLiteral("recent"))) { // files
      return;
    }
    const QChar letter = LetterOf(action->text());
    if (letter.isNull()) {
      faults << path + Plain(action->text()) + ": no letter";
    } else if (taken[path].contains(letter)) {
      faults << path + Plain(action->text()) + ": its letter " + letter + " is another's, too";
    } else {
      taken[path] += letter;
    }
  });
  return faults;
}

void CompleteMnemonics(QMenuBar* menus) {
  Complete(menus->actions());
}

} // namespace dspace::widgets
