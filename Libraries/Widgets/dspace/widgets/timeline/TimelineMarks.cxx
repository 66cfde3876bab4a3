#include <dspace/widgets/timeline/TimelineMarks.h>

#include <algorithm>
#include <cmath>

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QUuid>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>

namespace dspace::widgets {
namespace {

const char* const FormatName = "dspace marks";
constexpr int FormatVersion = 1;
constexpr qint64 LargestFile = 64 << 20; // [bytes]

[[noreturn]] void Fail(const std::string& path, Error::Kind kind, const std::string& why) {
  throw Error(kind, "file '" + path + "'", why);
}

QJsonObject ReadFile(const std::string& path) {
  QFile file(QString::fromStdString(path));
  if (!file.exists()) {
    return {{"format", FormatName}, {"version", FormatVersion}, {"marks", QJsonArray()}};
  }
  if (!file.open(QIODevice::ReadOnly)) {
    Fail(path, Error::Kind::Io, "cannot be read: " + file.errorString().toStdString());
  }
  const QByteArray bytes = file.read(LargestFile + 1);
  if (bytes.size() > LargestFile) {
    Fail(path, Error::Kind::Corrupt, "is larger than 64 MiB; accepted: a file of marks");
  }
  QJsonParseError error;
  const QJsonDocument document = QJsonDocument::fromJson(bytes, &error);
  if (error.error != QJsonParseError::NoError) {
    Fail(path, Error::Kind::Corrupt,
         "is no JSON: " + error.errorString().toStdString() + " at byte " +
             std::to_string(error.offset));
  }
  const QJsonObject all = document.object();
  if (all["format"].toString() != FormatName || !all["version"].isDouble() ||
      !all["marks"].isArray()) {
    Fail(path, Error::Kind::Corrupt, "is no file of marks; accepted: format \"dspace marks\"");
  }
  if (all["version"].toDouble() > FormatVersion) {
    Fail(path, Error::Kind::Unsupported,
         "is of version " + std::to_string(all["version"].toInt()) + "; accepted: 1");
  }
  return all;
}

std::vector<TimelineMark> MarksOf(const std::string& path, const QJsonObject& all) {
  std::vector<TimelineMark> marks;
  for (const QJsonValue& value : all["marks"].toArray()) {
    const QJsonObject object = value.toObject();
    if (object["id"].toString().isEmpty() || !object["time_s"].isDouble()) {
      Fail(path, Error::Kind::Corrupt,
           "mark " + std::to_string(marks.size() + 1) + " has no id or no time");
    }
    marks.push_back({object["id"].toString().toStdString(), object["time_s"].toDouble(),
                     object["note"].toString().toStdString()});
  }
  std::stable_sort(marks.begin(), marks.end(), [](const TimelineMark& a, const TimelineMark& b) {
    return a.time_s < b.time_s;
  });
  return marks;
}

std::vector<TimelineMark> Save(const std::string& path, const QJsonObject& all) {
  const QByteArray bytes = QJsonDocument(all).toJson();
  AtomicFile::Save(path, bytes.data(), std::size_t(bytes.size()));
  return MarksOf(path, all);
}

} // namespace

std::string MarksPath(const std::string& recording) {
  return recording + ".marks.json";
}

std::string NewMarkId() {
  return QUuid::createUuid().toString(QUuid::WithoutBraces).toStdString();
}

std::vector<TimelineMark> LoadMarks(const std::string& path) {
  return MarksOf(path, ReadFile(path));
}

std::vector<TimelineMark> PutMark(const std::string& path, const TimelineMark& mark) {
  if (mark.id.empty() || !std::isfinite(mark.time_s)) {
    throw Error(Error::Kind::InvalidArgument, "mark '" + mark.id + "'",
                "its time is " + std::to_string(mark.time_s) +
                    "; accepted: a finite time, and an id that is not empty");
  }
  QJsonObject all = ReadFile(path);
  MarksOf(path, all); // nothing is added to a damaged file
  QJsonArray marks = all["marks"].toArray();
  const QString id = QString::fromStdString(mark.id);
  qsizetype at = 0;
  while (at < marks.size() && marks[at].toObject()["id"].toString() != id) {
    ++at;
  }
  QJsonObject changed = at < marks.size() ? marks[at].toObject() : QJsonObject();
  changed["id"] = id;
  changed["time_s"] = mark.time_s;
  changed["note"] = QString::fromStdString(mark.note);
  if (at < marks.size()) {
    marks[at] = changed;
  } else {
    marks.append(changed);
  }
  all["marks"] = marks;
  return Save(path, all);
}

std::vector<TimelineMark> EraseMark(const std::string& path, const std::string& id) {
  QJsonObject all = ReadFile(path);
  MarksOf(path, all);
  QJsonArray marks = all["marks"].toArray();
  for (qsizetype i = marks.size(); i-- > 0;) {
    if (marks[i].toObject()["id"].toString().toStdString() == id) {
      marks.removeAt(i);
    }
  }
  all["marks"] = marks;
  return Save(path, all);
}

} // namespace dspace::widgets
