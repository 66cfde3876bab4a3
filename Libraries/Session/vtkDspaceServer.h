/**
 * @class vtkDspaceServer
 * @brief Serves its own session: one writer drives it, viewers watch.
 *
 * The thread that calls Run executes commands and draws pictures. Paths in commands are confined to
 * the allowed roots. Start removes the formats of rasters and shapes that refer to other files from
 * the whole process for the rest of its life (<dspace/raster/ConfinedDrivers.h>). No method throws
 * a C++ exception. See <dspace/link/server/Server.h>.
 */
#ifndef vtkDspaceServer_h
#define vtkDspaceServer_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class vtkDspaceSession;

class VTKDSPACESESSION_EXPORT vtkDspaceServer : public vtkObject {
public:
  static vtkDspaceServer* New();
  vtkTypeMacro(vtkDspaceServer, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Call all of these before Start. "host:port" (port 0: the system chooses) or "unix:PATH".
  /// Default "127.0.0.1:0".
  void SetListen(const std::string& address);
  void SetName(const std::string& name); // for people
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  void AddAllowedRoot(const std::string& folder);
  void SetMaximumMessage(long long bytes);     // 1 KiB to 1 GiB; default 64 MiB
  void SetMaximumConnections(int connections); // 1 to 1000; default 32
  void SetMaximumRate(double commands);        // a second, > 0; default 100,000
  void SetMaximumFrames(long long frames);     // of one scene, >= 1; default 1,000,000

  /// Whether the viewports and scenes of earlier writers are removed before the first command of
  /// another one; default false. A writer that resumes its connection keeps them.
  void SetFreshOnConnect(bool fresh);

  /// Starts to listen. Returns the error, or an empty string.
  std::string Start();
  /// The address, with the port that the system chose.
  std::string GetAddress();
  /// Serves for this time. Returns false after Stop.
  bool Run(double seconds);
  void Stop();

  /// The served session. Viewers do not receive changes that are made on it directly.
  vtkDspaceSession* GetSession();
  /// A counter: "commands" (executed), "snapshots" (made for viewers), "connections", "viewers",
  /// "waiting_bytes"; -1: unknown name.
  long long GetCount(const std::string& what);

protected:
  vtkDspaceServer();
  ~vtkDspaceServer() override;

private:
  vtkDspaceServer(const vtkDspaceServer&) = delete;
  void operator=(const vtkDspaceServer&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
