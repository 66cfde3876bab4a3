#include <dspace/HomeProcess.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>

#include <pthread.h>

namespace dspace {
namespace {

void EndAtOnce(int status, void* /*unused*/) {
  std::fflush(nullptr);
  ::_exit(status);
}

// Exit handlers are called from the last to the first: this one comes before those of the parent.
void InChild() {
  ::on_exit(EndAtOnce, nullptr);
}

} // namespace

std::string HomeProcess::Message() const {
  return "belongs to process " + std::to_string(this->Process_) +
         ", from which this one was forked; accepted: one that this process makes itself";
}

void EndForkedChildrenAtOnce() {
  static std::once_flag once;
  std::call_once(once, [] { pthread_atfork(nullptr, nullptr, InChild); });
}

} // namespace dspace
