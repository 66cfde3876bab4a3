#include <dspace/commands/beforehand/FilesAhead.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <utility>

#include <dspace/commands/beforehand/ReadApart.h>
#include <dspace/commands/beforehand/ReadFiles.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {

struct FilesAhead::Job {
  v1::Command given;
  v1::Command named; // NameBeforehand()
  std::shared_ptr<ReadBeforehand> read;
  v1::Reply failed;
  std::promise<void> done;
  std::future<void> isDone = done.get_future();
};

std::unique_ptr<FilesAhead> FilesAhead::Begin(State& state, const v1::Command& command,
                                              FilesGuard::Check look) {
  if (!ReadsFiles(command) || HasFiles(state, command)) {
    return nullptr;
  }
  auto job = std::make_shared<Job>();
  job->given = command;
  job->named = command;
  ReadApart([job, before = NameBeforehand(state, job->named), look = std::move(look)] {
    job->failed = Catch([&] {
      const FilesGuard guard(look);
      job->read = ReadFiles(job->named, before);
      return v1::Reply();
    });
    job->done.set_value();
  });
  return std::unique_ptr<FilesAhead>(new FilesAhead(std::move(job)));
}

bool FilesAhead::IsRead(double seconds) const {
  constexpr double Longest = 1e6; // [s], which the clock can hold
  return this->Job_->isDone.wait_for(std::chrono::duration<double>(std::min(seconds, Longest))) ==
         std::future_status::ready;
}

const v1::Reply& FilesAhead::Failed() const {
  return this->Job_->failed;
}

const v1::Command& FilesAhead::ToExecute(const State& state) const {
  const v1::Command& named = this->Job_->named;
  const auto scene = state.scenes.find(named.scene());
  const bool taken = named.has_open_terrain() && scene != state.scenes.end() &&
                     scene->second.terrains.count(named.open_terrain().name()) != 0;
  return taken ? this->Job_->given : named;
}

ReadBeforehand* FilesAhead::Files() const {
  return this->Job_->read.get();
}

} // namespace dspace::session
