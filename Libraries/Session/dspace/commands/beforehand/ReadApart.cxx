#include <dspace/commands/beforehand/ReadApart.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <system_error>
#include <thread>
#include <utility>

#include <dspace/Error.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {
namespace {

std::atomic<int> Running{0}; // threads of the process

std::chrono::duration<double> Patience(double seconds) {
  constexpr double Longest = 1e6; // [s], which the clock can hold
  return std::chrono::duration<double>(std::clamp(seconds, 0.0, Longest));
}

} // namespace

struct ReadApart::Work {
  std::function<v1::Reply()> read;
  v1::Reply reply;
  std::promise<void> done;
  std::future<void> isDone = done.get_future();
};

ReadApart::ReadApart(std::function<v1::Reply()> read) : Work_(std::make_shared<Work>()) {
  this->Work_->read = std::move(read);
  ++Running;
  try {
    std::thread([work = this->Work_]() mutable {
      work->reply = Catch(work->read);
      work->read = nullptr;
      work->done.set_value();
      work.reset(); // GDAL's objects close before the thread counts as ended
      --Running;
    }).detach();
  } catch (const std::system_error& error) {
    --Running;
    throw Error(Error::Kind::Resource, "a thread that reads files",
                std::string("cannot be started: ") + error.what());
  }
}

bool ReadApart::IsDone(double seconds) const {
  return this->Work_->isDone.wait_for(Patience(seconds)) == std::future_status::ready;
}

const v1::Reply& ReadApart::Reply() const {
  return this->Work_->reply;
}

bool ReadApart::WaitForAll(double seconds) {
  const auto until = std::chrono::steady_clock::now() + Patience(seconds);
  while (Running > 0) {
    if (std::chrono::steady_clock::now() >= until) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

} // namespace dspace::session
