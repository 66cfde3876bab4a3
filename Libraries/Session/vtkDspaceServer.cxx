#include "vtkDspaceServer.h"

#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/HomeProcess.h>
#include <dspace/import/worker/ImportWorker.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/link/server/Server.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/Confinement.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/raster/ConfinedDrivers.h>

#include "vtkDspaceSession.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceServer);

namespace {

// A drawer is code, and a prop an object, of the process that has the session.
void RejectDrawn(const dspace::v1::Command& command) {
  if (command.has_create_drawn()) {
    const std::string& name = command.create_drawn().object().name();
    throw dspace::Error(dspace::Error::Kind::Unsupported,
                        name.empty() ? "command create_drawn" : "object '" + name + "'",
                        "'" + command.create_drawn().drawer() +
                            "' is drawn by code of one process, which a server does not take from "
                            "its clients; accepted: a session in process (dspace.Session), or "
                            "meshes");
  }
}

} // namespace

struct vtkDspaceServer::Internals {
  dspace::HomeProcess home;
  dspace::session::ServerOptions options;
  std::vector<std::string> roots;
  long long maximumFrames = 1000000;
  vtkNew<vtkDspaceSession> session;
  dspace::session::Interpreter::Token listener = 0;                // there
  std::shared_ptr<const dspace::session::Confinement> confinement; // guards may outlive this
  std::unique_ptr<dspace::ConfinedDrivers> drivers;
  std::unique_ptr<dspace::session::Server> server; // goes first: it calls what is above
  std::uint64_t published = 0;                     // commands: the server counts them alike

  dspace::session::Server::SessionWork Work() {
    return {[this](dspace::v1::Command& command) {
              dspace::v1::Reply reply = this->Execute(command);
              reply.set_sequence(this->published);
              return reply;
            },
            [this] { return this->session->GetLedger().Commands(); }, [this] { this->Reset(); }};
  }

  // Removes all viewports and scenes, by commands that viewers and recordings get.
  void Reset() {
    dspace::v1::Command command;
    command.mutable_list_viewports();
    dspace::v1::Reply listed = this->Execute(command);
    for (const std::string& name : listed.viewports().name()) {
      dspace::v1::Command remove;
      remove.mutable_remove_viewport()->set_viewport(name);
      this->Execute(remove);
    }
    command.mutable_list_scenes();
    listed = this->Execute(command);
    for (const std::string& name : listed.scenes().name()) {
      dspace::v1::Command remove;
      remove.set_scene(name);
      remove.mutable_remove_scene();
      this->Execute(remove);
    }
  }

  dspace::v1::Reply Execute(dspace::v1::Command& command) {
    return dspace::session::Catch([&] {
      this->confinement->Apply(command);
      RejectDrawn(command);
      this->CheckFrames(command);
      if (command.has_capture()) {
        command.mutable_capture()->set_inline_data(true); // the planes are wanted elsewhere
      } else if (command.has_simulate_image()) {
        command.mutable_simulate_image()->set_inline_data(true);
      }
      const dspace::FilesGuard guard([confinement = this->confinement](const std::string& path) {
        confinement->RequireWithin(path);
      });
      return this->session->GetInterpreter().Execute(command);
    });
  }

  void CheckFrames(const dspace::v1::Command& command) const {
    const long long more = command.has_create_frames() ? command.create_frames().name_size()
                           : command.has_create_frame() || command.has_load_robot() ? 1
                                                                                    : 0;
    if (more == 0) {
      return;
    }
    const std::string& name = dspace::session::SceneName(command);
    const auto scene = this->session->GetInterpreter().FindScene(name);
    const long long frames = scene ? static_cast<long long>(scene->Frames().Size()) : 0;
    if (frames + more > this->maximumFrames) {
      throw dspace::Error(
          dspace::Error::Kind::Resource, "scene '" + name + "'",
          "it has " + std::to_string(frames) + " frames" +
              (more > 1 ? " and would have " + std::to_string(more) + " more" : "") +
              "; accepted by this server: up to " + std::to_string(this->maximumFrames));
    }
  }

  void OnCommand(const dspace::v1::Command& command, const dspace::v1::Reply& reply) {
    dspace::v1::Command recorded;
    if (this->server && dspace::session::ToRecorded(command, reply, recorded)) {
      ++this->published;
      this->server->Publish(recorded);
    }
  }
};

vtkDspaceServer::vtkDspaceServer() : Impl(new Internals) {
  this->Impl->listener = this->Impl->session->GetInterpreter().AddListener(
      [impl = this->Impl.get()](const dspace::v1::Command& command,
                                const dspace::v1::Reply& reply) {
        impl->OnCommand(command, reply);
      });
}

vtkDspaceServer::~vtkDspaceServer() { // others may keep the session
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
    return;
  }
  this->Impl->session->GetInterpreter().RemoveListener(this->Impl->listener);
}

void vtkDspaceServer::SetListen(const std::string& address) {
  this->Impl->options.listen = address;
}

void vtkDspaceServer::SetName(const std::string& name) {
  this->Impl->options.name = name;
}

void vtkDspaceServer::SetCertificates(const std::string& certificate, const std::string& key,
                                      const std::string& authority) {
  this->Impl->options.security.certificate = certificate;
  this->Impl->options.security.key = key;
  this->Impl->options.security.authority = authority;
}

void vtkDspaceServer::SetInsecure(bool insecure) {
  this->Impl->options.security.insecure = insecure;
}

void vtkDspaceServer::AddAllowedRoot(const std::string& folder) {
  this->Impl->roots.push_back(folder);
}

void vtkDspaceServer::SetMaximumMessage(long long bytes) {
  this->Impl->options.maximumMessage = bytes < 0 ? 0 : std::size_t(bytes);
}

void vtkDspaceServer::SetMaximumConnections(int connections) {
  this->Impl->options.maximumConnections = connections < 0 ? 0 : unsigned(connections);
}

void vtkDspaceServer::SetMaximumRate(double commands) {
  this->Impl->options.maximumRate = commands;
}

void vtkDspaceServer::SetMaximumFrames(long long frames) {
  this->Impl->maximumFrames = frames;
}

void vtkDspaceServer::SetFreshOnConnect(bool fresh) {
  this->Impl->options.freshOnConnect = fresh;
}

std::string vtkDspaceServer::Start() {
  if (this->Impl->server) {
    return "server: it has been started";
  }
  const dspace::v1::Reply reply = dspace::session::Catch([this] {
    this->Impl->confinement = std::make_shared<dspace::session::Confinement>(this->Impl->roots);
    this->Impl->drivers = std::make_unique<dspace::ConfinedDrivers>();
    dspace::ImportWorker::OfProcess().Start(); // before the threads of gRPC
    this->Impl->server = std::make_unique<dspace::session::Server>(this->Impl->options);
    return dspace::v1::Reply();
  });
  return reply.error().message();
}

std::string vtkDspaceServer::GetAddress() {
  return this->Impl->server ? this->Impl->server->Address() : std::string();
}

bool vtkDspaceServer::Run(double seconds) {
  return this->Impl->server && this->Impl->server->Run(this->Impl->Work(), seconds);
}

void vtkDspaceServer::Stop() {
  if (this->Impl->server) {
    this->Impl->server->Stop();
  }
}

vtkDspaceSession* vtkDspaceServer::GetSession() {
  return this->Impl->session;
}

long long vtkDspaceServer::GetCount(const std::string& what) {
  if (!this->Impl->server) {
    return 0;
  }
  const dspace::session::Server::Counts counts = this->Impl->server->GetCounts();
  const std::pair<const char*, unsigned long long> known[] = {
      {"commands", counts.commands},
      {"snapshots", counts.snapshots},
      {"connections", counts.connections},
      {"viewers", counts.viewers},
      {"waiting_bytes", counts.waitingBytes}};
  for (const auto& [name, value] : known) {
    if (what == name) {
      return static_cast<long long>(value);
    }
  }
  return -1;
}

void vtkDspaceServer::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Address: " << this->GetAddress() << "\n"
     << indent << "Connections: " << this->GetCount("connections") << "\n";
}
