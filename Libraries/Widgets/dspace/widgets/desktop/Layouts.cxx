#include <dspace/widgets/desktop/Layouts.h>

#include <algorithm>

#include <QDockWidget>
#include <QJsonArray>
#include <QMainWindow>
#include <QTimer>

#include <dspace/Error.h>
#include <dspace/widgets/settings/SettingsFile.h>

namespace dspace::widgets {
namespace {

constexpr int Version = 1; // of the docks' state
const QString Named = QStringLiteral("layouts");
const QString Last = QStringLiteral("lastLayout");
const QString ViewPrefix = QStringLiteral("view ");

QString Text(const QByteArray& bytes) {
  return QString::fromLatin1(bytes.toBase64());
}

QByteArray Bytes(const QJsonValue& text) {
  return QByteArray::fromBase64(text.toString().toLatin1());
}

QString LabelOf(const QString& name) {
  return "layout '" + name + "'";
}

} // namespace

Layouts::Layouts(QMainWindow* window, SettingsFile* file, QObject* parent)
    : QObject(parent), Window_(window), File_(file) {}

QStringList Layouts::Names() const {
  return this->File_->Get(Named).toObject().keys();
}

QJsonObject Layouts::Take() const {
  QStringList views;
  for (const QDockWidget* dock : this->Window_->findChildren<QDockWidget*>()) {
    if (dock->objectName().startsWith(ViewPrefix)) {
      views << dock->objectName().mid(ViewPrefix.size());
    }
  }
  views.sort();
  return {{"docks", Text(this->Window_->saveState(Version))},
          {"views", QJsonArray::fromStringList(views)}};
}

bool Layouts::Put(const QJsonObject& layout) {
  const QByteArray before = this->Window_->saveState(Version);
  if (!this->Window_->restoreState(Bytes(layout["docks"]), Version)) {
    this->Window_->restoreState(before, Version);
    return false;
  }
  this->Awaited_.clear();
  this->Put_ = Bytes(layout["docks"]);
  for (const QJsonValue& view : layout["views"].toArray()) {
    const QString dock = ViewPrefix + view.toString();
    if (!this->Window_->findChild<QDockWidget*>(dock)) {
      this->Awaited_.insert(dock);
    }
  }
  return true;
}

void Layouts::Save(const QString& name) {
  const QString plain = name.trimmed();
  if (plain.isEmpty() || plain.size() > LongestName) {
    throw Error(Error::Kind::InvalidArgument, LabelOf(name).toStdString(),
                "its name has " + std::to_string(plain.size()) + " letters; accepted: 1 to " +
                    std::to_string(LongestName));
  }
  QJsonObject all = this->File_->Get(Named).toObject();
  all[plain] = this->Take();
  if (!this->File_->Set(Named, all)) {
    throw Error(Error::Kind::Io, LabelOf(plain).toStdString(),
                this->File_->Problem().toStdString());
  }
  emit this->changed();
}

void Layouts::Restore(const QString& name) {
  const QJsonObject all = this->File_->Get(Named).toObject();
  if (!all.contains(name)) {
    throw Error(Error::Kind::NotFound, LabelOf(name).toStdString(),
                "there is no such layout; there are: " +
                    (all.isEmpty() ? "none" : all.keys().join(", ").toStdString()));
  }
  const QJsonObject layout = all[name].toObject();
  QStringList missing;
  for (const QJsonValue& view : layout["views"].toArray()) {
    if (!this->Window_->findChild<QDockWidget*>(ViewPrefix + view.toString())) {
      missing << view.toString();
    }
  }
  if (!missing.isEmpty()) {
    emit this->viewsWanted(missing);
  }
  if (!this->Put(layout)) {
    throw Error(Error::Kind::Corrupt, LabelOf(name).toStdString(),
                "its docks cannot be restored; save it again");
  }
}

void Layouts::Remove(const QString& name) {
  QJsonObject all = this->File_->Get(Named).toObject();
  if (!all.contains(name)) {
    throw Error(Error::Kind::NotFound, LabelOf(name).toStdString(), "there is no such layout");
  }
  all.remove(name);
  if (!this->File_->Set(Named, all)) {
    throw Error(Error::Kind::Io, LabelOf(name).toStdString(), this->File_->Problem().toStdString());
  }
  emit this->changed();
}

bool Layouts::SaveLast() {
  QJsonObject layout = this->Take();
  layout["window"] = Text(this->Window_->saveGeometry());
  return this->File_->Set(Last, layout);
}

bool Layouts::RestoreLast() {
  const QJsonObject layout = this->File_->Get(Last).toObject();
  return !layout.isEmpty() && this->Window_->restoreGeometry(Bytes(layout["window"])) &&
         this->Put(layout);
}

bool Layouts::Place(QDockWidget* dock) {
  // Qt also remembers where docks were that the user closed: they come back as new ones.
  if (!this->Awaited_.remove(dock->objectName()) || !this->Window_->restoreDockWidget(dock)) {
    return false;
  }
  if (this->Awaited_.isEmpty()) {
    // While docks were missing, the others took their room: now all have the sizes of the layout.
    QTimer::singleShot(0, this, [this, state = this->Put_] {
      if (this->Awaited_.isEmpty() && this->Put_ == state) {
        this->Window_->restoreState(state, Version);
      }
    });
  }
  return true;
}

} // namespace dspace::widgets
