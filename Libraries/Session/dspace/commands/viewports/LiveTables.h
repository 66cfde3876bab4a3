// Text tables that show telemetry: what they say is written anew when it has changed. Needs VTK.
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
  // Puts the table into the viewport, without values as yet. Throws Error(InvalidArgument) and
  // changes nothing.
  void Set(const v1::SetTextTable& command, vtkDspaceViewport& viewport);
  void Remove(const std::string& viewport, const std::string& table);
  void RemoveViewport(const std::string& viewport) { this->Viewports_.erase(viewport); }

  // Before a viewport is drawn: what its tables say now. A text of telemetry that cannot be drawn
  // there is shown with '?' for what the font lacks, and cut where it is long. Throws nothing.
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
