#include <dspace/commands/beforehand/FilesAhead.h>

#include <utility>

#include <dspace/commands/beforehand/ReadApart.h>
#include <dspace/commands/beforehand/ReadFiles.h>

namespace dspace::session {

// What the thread reads outlives it in `read`, which it fills before it is done.
struct FilesAhead::Job {
  v1::Command given;
  v1::Command named; // NameBeforehand()
  std::shared_ptr<std::shared_ptr<ReadBeforehand>> read =
      std::make_shared<std::shared_ptr<ReadBeforehand>>();
  std::unique_ptr<ReadApart> thread;
};

std::unique_ptr<FilesAhead> FilesAhead::Begin(State& state, const v1::Command& command,
                                              FilesGuard::Check look) {
  if (!ReadsFiles(command) || HasFiles(state, command)) {
    return nullptr;
  }
  auto job = std::make_unique<Job>();
  job->given = command;
  job->named = command;
  const StateBeforehand before = NameBeforehand(state, job->named);
  job->thread = std::make_unique<ReadApart>(
      [named = job->named, before, look = std::move(look), into = job->read] {
        const FilesGuard guard(look);
        *into = ReadFiles(named, before);
        return v1::Reply();
      });
  return std::unique_ptr<FilesAhead>(new FilesAhead(std::move(job)));
}

FilesAhead::FilesAhead(std::unique_ptr<Job> job) : Job_(std::move(job)) {}
FilesAhead::~FilesAhead() = default;

bool FilesAhead::IsRead(double seconds) const {
  return this->Job_->thread->IsDone(seconds);
}

const v1::Reply& FilesAhead::Failed() const {
  return this->Job_->thread->Reply();
}

const v1::Command& FilesAhead::ToExecute(const State& state) const {
  const v1::Command& named = this->Job_->named;
  const auto scene = state.scenes.find(named.scene());
  const bool taken = named.has_open_terrain() && scene != state.scenes.end() &&
                     scene->second.terrains.count(named.open_terrain().name()) != 0;
  return taken ? this->Job_->given : named;
}

ReadBeforehand* FilesAhead::Files() const {
  return this->Job_->read->get();
}

} // namespace dspace::session
