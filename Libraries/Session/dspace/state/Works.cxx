#include <dspace/state/Works.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <string>
#include <utility>

#include <dspace/Error.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/state/WorkThread.h>

namespace dspace::session {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

} // namespace

struct Works::Running {
  explicit Running(double abandoned) : abandoned(abandoned) {}
  bool IsAbandoned() const { return !this->waited && SecondsSince(this->asked) > this->abandoned; }

  const double abandoned; // [s]

  std::atomic<bool> waited{false};                    // a client waits now
  std::atomic<Clock::time_point> asked{Clock::now()}; // when a client waited last
  v1::Reply reply;                                    // of the thread until its end
  std::unique_ptr<WorkThread> thread;                 // last: it uses the others
};

Works::Works(double abandoned) : Abandoned_(abandoned) {}
Works::~Works() {
  for (const auto& [id, running] : this->Running_) {
    running->thread->Stop(); // all of them, before one is waited for
  }
}

void Works::Run(v1::Reply& reply, const Terms& terms, Compute compute) {
  if (!terms.wait) {
    compute(reply, [&](double) { terms.deadline.Check(); });
    return;
  }
  this->DropAbandoned();
  if (this->Running_.size() >= Most || this->Ending_.size() >= Most) {
    throw Error(Error::Kind::Resource, "work",
                std::to_string(Most) + " requests are being computed; accepted: another one when "
                                       "one of them has ended, or was cancelled");
  }
  const std::uint64_t id = ++this->Last_;
  auto running = std::make_unique<Running>(this->Abandoned_);
  running->thread = std::make_unique<WorkThread>(
      [&own = *running, terms, compute = std::move(compute)](WorkThread& thread) {
        const Clock::time_point start = Clock::now();
        double most = 0.0;
        const Proceed proceed = [&](double fraction) {
          terms.deadline.Check();
          if (thread.IsCancelled() || own.IsAbandoned()) {
            throw Error(Error::Kind::DeadlineExceeded, "work", "nobody waits for it");
          }
          if (fraction > most) {
            most = std::min(fraction, 1.0);
            thread.Tell({most, SecondsSince(start) * (1.0 - most) / most});
          }
        };
        const FallbackScope fallbacks;
        compute(own.reply, proceed);
        for (std::string& warning : fallbacks.Warnings(terms.kernels->Scales())) {
          own.reply.add_warning(std::move(warning));
        }
      });
  this->Running_.emplace(id, std::move(running));
  if (*terms.wait > 0.0) {
    this->Answer(reply, id, terms.wait);
  } else {
    reply.mutable_work()->set_work(id);
    reply.mutable_work()->set_left_s(std::numeric_limits<double>::infinity());
  }
}

void Works::Await(v1::Reply& reply, const v1::AwaitWork& command) {
  const auto found = this->Running_.find(command.work());
  if (found == this->Running_.end()) {
    throw Error(Error::Kind::NotFound, "work " + std::to_string(command.work()),
                "there is no such work; accepted: the number of a WorkReply whose work was neither "
                "cancelled nor answered");
  }
  if (command.cancel()) {
    v1::WorkReply& work = *reply.mutable_work();
    work.set_work(command.work());
    work.set_fraction(found->second->thread->Told().fraction);
    this->End(command.work());
    return;
  }
  found->second->asked = Clock::now();
  this->DropAbandoned();
  this->Answer(reply, command.work(),
               command.has_wait_s() ? std::optional<double>(command.wait_s()) : std::nullopt);
}

void Works::Answer(v1::Reply& reply, std::uint64_t id, const std::optional<double>& wait) {
  const auto found = this->Running_.find(id);
  Running& running = *found->second;
  running.waited = true;
  const bool ended = running.thread->Wait(wait);
  running.asked = Clock::now();
  running.waited = false;
  if (!ended) {
    const WorkThread::Progress told = running.thread->Told();
    v1::WorkReply& work = *reply.mutable_work();
    work.set_work(id);
    work.set_fraction(told.fraction);
    work.set_left_s(told.left);
    return;
  }
  const std::unique_ptr<Running> done = std::move(found->second);
  this->Running_.erase(found);
  done->thread->Check();
  v1::Reply& result = done->reply; // may be large: it is swapped
  reply.mutable_warning()->MergeFrom(result.warning());
  result.mutable_warning()->Swap(reply.mutable_warning());
  reply.Swap(&result);
}

void Works::End(std::uint64_t id) {
  const auto found = this->Running_.find(id);
  found->second->thread->Stop();
  this->Ending_.push_back(std::move(found->second));
  this->Running_.erase(found);
}

void Works::DropAbandoned() {
  std::vector<std::uint64_t> abandoned;
  for (const auto& [id, running] : this->Running_) {
    if (running->IsAbandoned()) {
      abandoned.push_back(id);
    }
  }
  for (const std::uint64_t id : abandoned) {
    this->End(id);
  }
  this->Ending_.erase(std::remove_if(this->Ending_.begin(), this->Ending_.end(),
                                     [](const auto& each) { return each->thread->Wait(0.0); }),
                      this->Ending_.end());
}

} // namespace dspace::session
