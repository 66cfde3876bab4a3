// The time, fragments, lights, vantages and cameras of one scene, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_NAMES_H
#define DSPACE_SESSION_LEDGER_NAMES_H

#include <map>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Not a public header.
class LedgerNames {
public:
  using Emit = std::vector<v1::Command>&;

  explicit LedgerNames(v1::CreateScene create);
  // Applies a command on these entities. False for other commands.
  bool Add(const v1::Command& command, const v1::Reply& reply);
  void RemoveLightsOn(const std::unordered_set<std::uint64_t>& frames);
  std::vector<std::string> Fragments() const; // the existing ones
  double Time() const { return this->Time_.value_or(0.0); }

  void PutFirst(const std::string& scene, Emit out) const; // the scene, its time, fragments
  void PutLast(const std::string& scene, Emit out) const;  // lights, vantages, cameras, lags

private:
  struct Fragment {
    std::string name;
    v1::Nature nature;
    bool made; // false: one of the two default fragments
    std::optional<bool> visible;
  };
  struct Light {
    std::string name;
    bool first;                      // a default light, in its original position
    std::optional<v1::SetLight> set; // absent: the default light
  };
  struct Vantage {
    std::string name;
    bool first; // the default vantage
    std::vector<v1::SetCamera> cameras;
    std::string active;
  };
  bool AddLight(const v1::Command& command);
  bool AddVantage(const v1::Command& command, const v1::Reply& reply);
  void SetCamera(Vantage& vantage, const v1::SetCamera& command, const v1::Reply& reply);
  Vantage& Find(const std::string& name);

  v1::CreateScene Create_;
  std::optional<double> Time_;
  std::optional<double> Begin_; // the least time that was set
  std::vector<Fragment> Fragments_;
  std::vector<Light> Lights_;
  std::vector<Vantage> Vantages_;
  std::map<std::pair<std::string, std::string>, v1::CameraLag> Lags_;
};

} // namespace dspace::session

#endif
