// The longest time that a command may take.
#ifndef DSPACE_SESSION_DEADLINE_H
#define DSPACE_SESSION_DEADLINE_H

#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace dspace::session {

// Counts from its construction.
class Deadline {
public:
  // `seconds`: absent: none. `fewer`: what makes the work shorter, for the error: "fewer steps".
  Deadline(std::optional<double> seconds, std::string command, std::string fewer)
      : Seconds_(seconds), Command_(std::move(command)), Fewer_(std::move(fewer)) {}

  // Throws Error(DeadlineExceeded) that names the command and the deadline.
  void Check() const {
    if (this->Seconds_ &&
        std::chrono::duration<double>(Clock::now() - this->Start_).count() > *this->Seconds_) {
      this->Throw();
    }
  }

private:
  using Clock = std::chrono::steady_clock;
  [[noreturn]] void Throw() const;

  std::optional<double> Seconds_;
  std::string Command_;
  std::string Fewer_;
  Clock::time_point Start_ = Clock::now();
};

} // namespace dspace::session

#endif
