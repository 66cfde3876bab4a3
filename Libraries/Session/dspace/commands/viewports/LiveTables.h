// Text tables that show telemetry and are updated when it changes. Needs VTK.
#ifndef DSPACE_SESSION_LIVE_TABLES_H
#define DSPACE_SESSION_LIVE_TABLES_H

#include <cstdint>
#include <map>
#include <string>

#include <dspace/proto/viewports.pb.h>
#include <dspace/state/Telemetry.h>

class vtkDspaceViewport;

namespace dspace::session {

// The tables of all viewports that name channels of telemetry.
class LiveTables {
public:
  // Adds the table to the viewport, without values at first. Throws Error(InvalidArgument) and
  // changes nothing.
  void Set(const v1::SetTextTable& command, vtkDspaceViewport& viewport);
  void Remove(const std::string& viewport, const std::string& table);
  void RemoveViewport(const std::string& viewport) { this->Viewports_.erase(viewport); }

  // Updates the tables of a viewport before it is drawn. Characters that the font lacks are shown
  // as '?', and long text is truncated. Does not throw.
  void Update(const std::string& name, const Telemetry& telemetry, vtkDspaceViewport& viewport);

private:
  struct Viewport {
    std::map<std::string, v1::SetTextTable> tables;
    std::uint64_t revision = 0; // of the telemetry that is shown
    bool fresh = false;
  };
  std::map<std::string, Viewport> Viewports_;
};

} // namespace dspace::session

#endif
