// Fragments, lights, time and vantages of one scene, and viewports, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_VIEWS_H
#define DSPACE_SESSION_LEDGER_VIEWS_H

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <dspace/ledger/LatestCommands.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// What is named by name in a scene.
class LedgerNames {
public:
  using Emit = std::vector<v1::Command>&;

  explicit LedgerNames(v1::CreateScene create);
  // False for a command that is about none of them.
  bool Add(const v1::Command& command, const v1::Reply& reply);
  void RemoveLightsOn(const std::unordered_set<std::uint64_t>& frames);
  std::vector<std::string> Fragments() const; // that there are
  double Time() const { return this->Time_.value_or(0.0); }

  void PutFirst(const std::string& scene, Emit out) const; // the scene, its time, fragments
  void PutLast(const std::string& scene, Emit out) const;  // lights, vantages, cameras, lags

private:
  struct Fragment {
    std::string name;
    v1::Nature nature;
    bool made; // else one of the two that always exist
    std::optional<bool> visible;
  };
  struct Light {
    std::string name;
    bool first;                      // one that the scene begins with, in its place
    std::optional<v1::SetLight> set; // absent: as it began
  };
  struct Vantage {
    std::string name;
    bool first; // the one that the scene begins with
    std::vector<v1::SetCamera> cameras;
    std::string active;
  };
  bool AddLight(const v1::Command& command);
  bool AddVantage(const v1::Command& command, const v1::Reply& reply);
  void SetCamera(Vantage& vantage, const v1::SetCamera& command, const v1::Reply& reply);
  Vantage& Find(const std::string& name);

  v1::CreateScene Create_;
  std::optional<double> Time_;
  std::vector<Fragment> Fragments_;
  std::vector<Light> Lights_;
  std::vector<Vantage> Vantages_;
  std::map<std::pair<std::string, std::string>, v1::CameraLag> Lags_;
};

// The session's viewports.
class LedgerViewports {
public:
  using Emit = std::vector<v1::Command>&;
  bool Add(const v1::Command& command);
  // `fragments` gives those that a scene has.
  template<class Fragments> void Put(const Fragments& fragments, Emit out) const {
    for (const auto& [name, viewport] : this->Viewports_) {
      PutOne(name, viewport, fragments(viewport.create.scene()), out);
    }
  }

private:
  struct Viewport {
    v1::Command create;
    v1::SetViewport set; // background, ornaments, corner axes; all else goes into `create`
    LatestCommands latest;
    std::set<std::string> hidden;
    std::vector<v1::SetTextTable> tables;
    std::vector<v1::SetColorBar> bars;
  };
  static void Set(Viewport& viewport, const v1::SetViewport& command);
  static void PutOne(const std::string& name, const Viewport& viewport,
                     const std::vector<std::string>& fragments, Emit out);
  Viewport& Find(const std::string& name) { return this->Viewports_[name]; }

  std::map<std::string, Viewport> Viewports_;
};

} // namespace dspace::session

#endif
