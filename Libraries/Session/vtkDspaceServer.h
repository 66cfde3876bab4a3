/**
 * @class vtkDspaceServer
 * @brief Serves a session of its own: one writer drives it, viewers watch.
 *
 * Commands are carried out, and pictures drawn, in the thread that calls Run. Paths in commands are
 * confined to the allowed roots. Start takes from the whole process, for the rest of its life, the
 * formats of rasters and shapes that refer to other files (<dspace/raster/ConfinedDrivers.h>). No
 * C++ exception leaves a method. See <dspace/link/server/Server.h>.
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

  /// All of these are to be set before Start.
  /// "host:port", port 0 for one that the system chooses, or "unix:PATH". Default "127.0.0.1:0".
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

  /// Listens. Returns what went wrong, or an empty string.
  std::string Start();
  /// Where, with the port that the system chose.
  std::string GetAddress();
  /// Works for so many seconds; false after Stop.
  bool Run(double seconds);
  void Stop();

  /// What is served; changes made on it directly reach no viewer.
  vtkDspaceSession* GetSession();
  /// Commands carried out, snapshots made for viewers, connections, viewers, bytes that wait.
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
