// The telemetry of one scene: named values.
#ifndef DSPACE_SESSION_TELEMETRY_H
#define DSPACE_SESSION_TELEMETRY_H

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Channels by id and by name. Invalid input throws Error and changes nothing. The interpreter and
// the ledger have one for each scene; the ledger converts it to commands.
class Telemetry {
public:
  struct Channel {
    v1::CreateTelemetry about; // its definition, with the present limits
    double value = std::numeric_limits<double>::quiet_NaN();
    std::string text;
    std::optional<double> time_s; // of the last change; none: never set
    std::uint64_t step = 0;       // the last step that set it
    std::size_t defined = 0;      // bytes of its definition
  };

  // If the command's id is 0, uses `free`, which must be above all ids of this scene. Returns the
  // id.
  std::uint64_t Create(const v1::CreateTelemetry& command, std::uint64_t free);
  void SetLimits(const v1::SetTelemetryLimits& command);
  void Set(const v1::SetTelemetry& command, double now);
  void SetTexts(const v1::SetTelemetryTexts& command, double now);
  void Remove(const v1::RemoveTelemetry& command);

  std::uint64_t LastId() const { return this->LastId_; }
  // Increases with every change.
  std::uint64_t Revision() const { return this->Revision_; }
  const Channel& Get(std::uint64_t id) const;         // throws Error(NotFound)
  const Channel& Get(const std::string& name) const;  // likewise
  const Channel* Find(const std::string& name) const; // null: there is none
  const std::map<std::string, std::uint64_t>& Names() const { return this->Names_; }

  // Appends the commands that recreate it in the scene of this name.
  void Put(const std::string& scene, std::vector<v1::Command>& out) const;

private:
  Channel& At(std::uint64_t id);
  template<class Command, class Values>
  std::vector<Channel*> Check(const Command& command, const Values& values, const char* name);
  std::unordered_map<std::uint64_t, Channel> Channels_;
  std::map<std::string, std::uint64_t> Names_;
  std::uint64_t LastId_ = 0;
  std::size_t Bytes_ = 0; // of all definitions
  std::uint64_t Revision_ = 0;
  std::uint64_t Step_ = 0;
};

v1::TelemetryInfo::State StateOf(const Telemetry::Channel& channel);
void PutInfo(const Telemetry::Channel& channel, v1::TelemetryInfo* info);

// The text of a table row that shows telemetry. Never empty.
std::string ShownTelemetry(const Telemetry& telemetry, const v1::SetTextTable::Row& row);

} // namespace dspace::session

#endif
