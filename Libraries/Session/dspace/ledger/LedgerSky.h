// Kernels, and frames and the Sun that follow the time, of one scene, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_SKY_H
#define DSPACE_SESSION_LEDGER_SKY_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Not a public header.
class LedgerSky {
public:
  using Emit = std::vector<v1::Command>&;

  // Applies a command of these. False for other commands.
  bool Add(const v1::Command& command);
  // The commands with the same effect on poses and on the light "sun" as a command of these, or as
  // what followed a SetTime.
  static std::vector<v1::Command> Effects(const v1::Command& command, const v1::Reply& reply);
  void RemoveOn(const std::unordered_set<std::uint64_t>& frames);

  void Put(const std::string& scene, Emit out) const;     // after all frames
  void PutLast(const std::string& scene, Emit out) const; // after all lights

private:
  std::vector<std::string> Kernels_;
  std::map<std::uint64_t, v1::SetFrameMotion> Frames_;
  std::optional<v1::SetSunMotion> Sun_;
};

} // namespace dspace::session

#endif
