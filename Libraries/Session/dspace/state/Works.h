// Requests that are computed in threads of their own while the session does other things.
#ifndef DSPACE_SESSION_WORKS_H
#define DSPACE_SESSION_WORKS_H

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <dspace/messages/Deadline.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/sky/KernelSet.h>

namespace dspace::session {

// Used by one thread. The destructor cancels all work and waits for it.
class Works {
public:
  // At most so many are computed or wait for their AwaitWork; a further one is rejected.
  static constexpr std::size_t Most = 64;
  // [s] Work that no request waited for in this time is cancelled, and its result dropped.
  static constexpr double Abandoned = 60.0;

  // The work calls it often with how much of it is done (0 to 1). It throws where the work is to
  // end: at the deadline, and when nobody waits any more.
  using Proceed = std::function<void(double fraction)>;
  // Fills in a reply from its own copies: the scene may change while it runs.
  using Compute = std::function<void(v1::Reply&, const Proceed&)>;
  struct Terms {
    std::optional<double> wait; // [s]; absent: the calling thread computes
    Deadline deadline;
    std::shared_ptr<const KernelSet> kernels; // whose time scales warnings have
  };

  explicit Works(double abandoned = Abandoned);
  Works(const Works&) = delete;
  Works& operator=(const Works&) = delete;
  ~Works();

  // The reply has the result, or a WorkReply where that takes longer than the wait. Throws what
  // computing throws, and Error(Resource) for too many.
  void Run(v1::Reply& reply, const Terms& terms, Compute compute);
  // The same for work that goes on. Throws Error(NotFound) for work that does not, and what it
  // threw.
  void Await(v1::Reply& reply, const v1::AwaitWork& command);

private:
  struct Running;
  void DropAbandoned();
  // Tells work to end, without waiting for that.
  void End(std::uint64_t id);
  // Takes the result, if it is there.
  void Answer(v1::Reply& reply, std::uint64_t id, const std::optional<double>& wait);

  std::map<std::uint64_t, std::unique_ptr<Running>> Running_;
  std::vector<std::unique_ptr<Running>> Ending_;
  std::uint64_t Last_ = 0;
  const double Abandoned_; // [s]
};

} // namespace dspace::session

#endif
