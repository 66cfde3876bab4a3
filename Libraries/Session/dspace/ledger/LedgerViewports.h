// The viewports of a session, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_VIEWPORTS_H
#define DSPACE_SESSION_LEDGER_VIEWPORTS_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include <dspace/ledger/LatestCommands.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Not a public header.
class LedgerViewports {
public:
  using Emit = std::vector<v1::Command>&;
  bool Add(const v1::Command& command);
  // `fragments` returns the fragments of a scene.
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
