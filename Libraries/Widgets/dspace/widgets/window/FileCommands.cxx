#include <dspace/widgets/window/FileCommands.h>

#include <QCoreApplication>
#include <QEventLoop>
#include <QFileInfo>

#include "vtkDspaceSession.h"

#include <dspace/Error.h>
#include <dspace/commands/beforehand/FilesAhead.h>
#include <dspace/widgets/window/TaskStrip.h>

namespace dspace::widgets {
namespace {

constexpr double Patience = 0.02; // [s]
constexpr int Slice_ms = 10;

QString FileOf(const v1::Command& command) {
  std::string path;
  if (command.has_import_object() && command.import_object().level_size() > 0) {
    path = command.import_object().level(0).path();
  } else if (command.has_import_nodes() && command.import_nodes().import().level_size() > 0) {
    path = command.import_nodes().import().level(0).path();
  } else if (command.has_load_robot()) {
    path = command.load_robot().path();
  } else if (command.has_open_terrain()) {
    path = command.open_terrain().path();
  } else if (command.has_add_terrain_layer()) {
    const v1::AddTerrainLayer& layer = command.add_terrain_layer();
    path = layer.has_image()         ? layer.image().path()
           : layer.has_false_color() ? layer.false_color().path()
           : layer.has_shapes()      ? layer.shapes().path()
                                     : layer.normals().path();
  }
  return QFileInfo(QString::fromStdString(path)).fileName();
}

} // namespace

struct FileCommands::Job {
  std::unique_ptr<session::FilesAhead> files;
  bool cancelled = false;
};

FileCommands::FileCommands(vtkDspaceSession* session, TaskStrip* strip, QObject* parent)
    : QObject(parent), Session_(session), Strip_(strip) {
  connect(strip, &TaskStrip::cancelled, this, [this](long id) {
    const auto found = this->Jobs_.find(id);
    if (found != this->Jobs_.end()) {
      found->second->cancelled = true;
    }
  });
}

FileCommands::~FileCommands() {
  this->CancelAll();
}

void FileCommands::CancelAll() {
  for (auto& [id, job] : this->Jobs_) {
    job->cancelled = true;
  }
}

void FileCommands::Read(const std::string& command) {
  v1::Command parsed;
  if (!parsed.ParseFromString(command)) {
    return;
  }
  auto job = std::make_shared<Job>();
  job->files = session::FilesAhead::Begin(this->Session_->GetInterpreter().GetState(), parsed);
  if (!job->files) {
    return;
  }
  if (!job->files->IsRead(Patience)) {
    const long id = --this->Last_; // Python's tasks have positive numbers
    this->Jobs_[id] = job;
    const QString file = FileOf(parsed);
    this->Strip_->Show(id, tr("Reading %1").arg(file), -1.0, tr("Cancel"));
    while (!job->cancelled && !job->files->IsRead(0.002)) {
      QCoreApplication::processEvents(QEventLoop::AllEvents, Slice_ms);
    }
    this->Jobs_.erase(id);
    this->Strip_->Show(id, QString(), 0.0, QString());
    if (job->cancelled) {
      throw Error(Error::Kind::Resource, "file '" + file.toStdString() + "'",
                  "reading it was cancelled");
    }
  }
  this->Ready_[command] = job;
}

std::string FileCommands::Execute(const std::string& command) {
  const auto found = this->Ready_.find(command);
  if (found == this->Ready_.end()) {
    return this->Session_->Execute(command);
  }
  const std::shared_ptr<Job> job = found->second;
  this->Ready_.erase(found);
  if (job->files->Failed().has_error()) {
    return job->files->Failed().SerializeAsString();
  }
  const session::ReadBeforehand::Scope scope(job->files->Files());
  return this->Session_->Execute(
      job->files->ToExecute(this->Session_->GetInterpreter().GetState()).SerializeAsString());
}

} // namespace dspace::widgets
