#include <dspace/widgets/window/FileCommands.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include <QCoreApplication>
#include <QEventLoop>
#include <QFileInfo>

#include "vtkDspaceSession.h"

#include <dspace/Error.h>
#include <dspace/commands/beforehand/ReadFiles.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/widgets/window/TaskStrip.h>

namespace dspace::widgets {
namespace {

constexpr auto Patience = std::chrono::milliseconds(20);
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
  v1::Command command; // with the names that what is read has
  std::shared_ptr<session::ReadBeforehand> read;
  v1::Reply failed; // where it has an error
  std::promise<void> done;
  std::future<void> isDone = done.get_future();
  std::atomic<bool> cancelled{false};
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
  auto job = std::make_shared<Job>();
  if (!job->command.ParseFromString(command) || !session::ReadsFiles(job->command)) {
    return;
  }
  const session::StateBeforehand state =
      session::NameBeforehand(this->Session_->GetInterpreter().GetState(), job->command);
  std::thread([job, state] { // it keeps what it uses, also when nobody waits any more
    job->failed = session::Catch([&] {
      job->read = session::ReadFiles(job->command, state);
      return v1::Reply();
    });
    job->done.set_value();
  })
      .detach();
  if (job->isDone.wait_for(Patience) != std::future_status::ready) {
    const long id = --this->Last_; // Python's tasks have positive numbers
    this->Jobs_[id] = job;
    const QString file = FileOf(job->command);
    this->Strip_->Show(id, tr("Reading %1").arg(file), -1.0, tr("Cancel"));
    while (!job->cancelled &&
           job->isDone.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready) {
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
  if (job->failed.has_error()) {
    return job->failed.SerializeAsString();
  }
  const session::ReadBeforehand::Scope scope(job->read.get());
  // Another terrain may have taken the name meanwhile: then the command chooses one, and reads.
  const auto& state = this->Session_->GetInterpreter().GetState();
  const auto scene = state.scenes.find(job->command.scene());
  const bool taken = job->command.has_open_terrain() && scene != state.scenes.end() &&
                     scene->second.terrains.count(job->command.open_terrain().name()) != 0;
  return this->Session_->Execute(taken ? command : job->command.SerializeAsString());
}

} // namespace dspace::widgets
