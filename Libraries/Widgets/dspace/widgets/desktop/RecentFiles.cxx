#include <dspace/widgets/desktop/RecentFiles.h>

#include <QJsonArray>
#include <QMenu>

#include <dspace/widgets/settings/SettingsFile.h>

namespace dspace::widgets {
namespace {

const QString Key = QStringLiteral("recentFiles");

} // namespace

RecentFiles::RecentFiles(QMenu* menu, SettingsFile* file, int most, QObject* parent)
    : QObject(parent), Menu_(menu), File_(file), Most_(most) {
  this->Fill();
}

QStringList RecentFiles::Paths() const {
  QStringList paths;
  for (const QJsonValue& path : this->File_->Get(Key).toArray()) {
    if (path.isString() && paths.size() < this->Most_) {
      paths << path.toString();
    }
  }
  return paths;
}

void RecentFiles::Keep(const QStringList& paths) {
  this->File_->Set(Key, QJsonArray::fromStringList(paths.mid(0, this->Most_)));
  this->Fill();
}

void RecentFiles::Add(const QString& path) {
  QStringList paths = this->Paths();
  paths.removeAll(path);
  paths.prepend(path);
  this->Keep(paths);
}

void RecentFiles::SetMost(int most) {
  this->Most_ = most;
  if (this->File_->Get(Key).toArray().size() > most) {
    this->Keep(this->Paths());
  }
}

void RecentFiles::Fill() {
  this->Menu_->clear();
  int number = 0;
  for (const QString& path : this->Paths()) {
    QString shown = path;
    shown.replace('&', QStringLiteral("&&"));
    ++number; // 1 to 9 are keys
    this->Menu_->addAction((number < 10 ? QStringLiteral("&%1 ").arg(number) : QString()) + shown,
                           this, [this, path] { emit this->chosen(path); });
  }
  if (number > 0) {
    this->Menu_->addSeparator();
    this->Menu_->addAction(tr("&Clear this list"), this, [this] { this->Keep({}); });
  }
  this->Menu_->setEnabled(number > 0);
}

} // namespace dspace::widgets
