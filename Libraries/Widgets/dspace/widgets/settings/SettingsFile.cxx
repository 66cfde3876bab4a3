#include <dspace/widgets/settings/SettingsFile.h>

#include <cerrno>
#include <cstring>

#include <sys/file.h>

#include <QCryptographicHash>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QStandardPaths>
#include <QThread>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>

namespace dspace::widgets {
namespace {

constexpr int Version = 1;
constexpr qint64 MostBytes = 4 << 20;
constexpr int LockPatience_ms = 500;

// The kernel releases it when the program ends, however it ends. A file with the number of its
// process, as QLockFile writes it, blocks others if the program is killed before it has written it.
class FileLock {
public:
  explicit FileLock(const QString& path) : File_(path) {}

  // Empty, or why not.
  QString Take() {
    if (!this->File_.open(QIODevice::ReadWrite)) { // a new one where there is none; it stays empty
      return this->File_.errorString();
    }
    for (int waited = 0; ::flock(this->File_.handle(), LOCK_EX | LOCK_NB) != 0;
         waited += Pause_ms) {
      if (errno != EWOULDBLOCK && errno != EINTR) {
        return QString::fromLocal8Bit(std::strerror(errno));
      }
      if (waited >= LockPatience_ms) {
        return QStringLiteral("another program holds its lock");
      }
      QThread::msleep(static_cast<unsigned long>(Pause_ms));
    }
    return {};
  }

private:
  static constexpr int Pause_ms = 5;
  QFile File_;
};

// Keys of QJsonObject are sorted: equal values have one text.
QString DigestOf(const QJsonObject& values) {
  const QByteArray text = QJsonDocument(values).toJson(QJsonDocument::Compact);
  return QString::fromLatin1(QCryptographicHash::hash(text, QCryptographicHash::Sha256).toHex());
}

} // namespace

QString SettingsFile::DefaultPath() {
  return QStandardPaths::writableLocation(QStandardPaths::AppConfigLocation) +
         QStringLiteral("/settings.json");
}

SettingsFile::SettingsFile(const QString& path) : Path_(path) {
  this->Damaged_ = !this->Read(this->Values_);
}

bool SettingsFile::Read(QJsonObject& values) {
  values = {};
  const QFileInfo info(this->Path_);
  if (!info.exists()) {
    return true;
  }
  const auto fail = [this](const QString& why) {
    this->Problem_ =
        QStringLiteral("settings '%1': %2; the defaults are used").arg(this->Path_, why);
    return false;
  };
  if (!info.isFile()) { // a pipe would never end
    return fail(QStringLiteral("it is not a file"));
  }
  if (info.size() > MostBytes) {
    return fail(QStringLiteral("%1 bytes; accepted: %2 at most").arg(info.size()).arg(MostBytes));
  }
  QFile file(this->Path_);
  if (!file.open(QIODevice::ReadOnly)) {
    return fail(file.errorString());
  }
  QJsonParseError error;
  const QJsonObject all = QJsonDocument::fromJson(file.read(MostBytes), &error).object();
  if (error.error != QJsonParseError::NoError) {
    return fail(QStringLiteral("%1 at byte %2").arg(error.errorString()).arg(error.offset));
  }
  if (all["version"].toInt() != Version) {
    return fail(QStringLiteral("version %1; accepted: %2")
                    .arg(all["version"].toVariant().toString())
                    .arg(Version));
  }
  if (!all["settings"].isObject() ||
      DigestOf(all["settings"].toObject()) != all["sha256"].toString()) {
    return fail(QStringLiteral("its values do not have the digest that stands in it"));
  }
  values = all["settings"].toObject();
  return true;
}

QJsonValue SettingsFile::Get(const QString& name) const {
  return this->Values_.value(name);
}

bool SettingsFile::Set(const QString& name, const QJsonValue& value) {
  const auto put = [&](QJsonObject& values) {
    if (value.isUndefined()) {
      values.remove(name);
    } else {
      values[name] = value;
    }
  };
  put(this->Values_);
  const QFileInfo info(this->Path_);
  const auto fail = [this](const QString& why) {
    this->Problem_ = QStringLiteral("settings '%1' are not saved: %2").arg(this->Path_, why);
    return false;
  };
  if (!QDir().mkpath(info.absolutePath())) {
    return fail(QStringLiteral("its folder cannot be made"));
  }
  FileLock lock(this->Path_ + QStringLiteral(".lock"));
  if (const QString why = lock.Take(); !why.isEmpty()) {
    return fail(why);
  }
  QJsonObject values;
  if (this->Damaged_ || !this->Read(values)) {
    QFile::remove(this->Path_ + QStringLiteral(".damaged"));
    if (info.exists() && !QFile::rename(this->Path_, this->Path_ + QStringLiteral(".damaged"))) {
      return fail(QStringLiteral("what is damaged in its place cannot be renamed"));
    }
    values = this->Values_;
    this->Damaged_ = false;
  }
  put(values);
  this->Values_ = values;
  const QByteArray text =
      QJsonDocument(
          QJsonObject{{"version", Version}, {"sha256", DigestOf(values)}, {"settings", values}})
          .toJson();
  try {
    AtomicFile::Save(this->Path_.toStdString(), text.constData(), std::size_t(text.size()));
  } catch (const Error& error) {
    return fail(QString::fromUtf8(error.what()));
  }
  return true;
}

} // namespace dspace::widgets
