// The calls of the gRPC service, each in a thread of gRPC. Inside the library only.
#ifndef DSPACE_SESSION_SERVER_SERVICE_H
#define DSPACE_SESSION_SERVER_SERVICE_H

#include <cstdint>
#include <memory>

#include <grpcpp/grpcpp.h>

#include <dspace/link/server/ServerHub.h>
#include <dspace/proto/service.grpc.pb.h>

namespace dspace::session {

class Server::Service : public v1::Dspace::Service {
public:
  explicit Service(Hub& hub) : Hub_(hub) {}
  grpc::Status Hello(grpc::ServerContext*, const v1::HelloRequest*, v1::HelloReply*) override;
  grpc::Status Drive(grpc::ServerContext*,
                     grpc::ServerReaderWriter<v1::DriveReply, v1::DriveRequest>* stream) override;
  grpc::Status Watch(grpc::ServerContext*, const v1::WatchRequest*,
                     grpc::ServerWriter<v1::WatchReply>* stream) override;
  grpc::Status Tell(grpc::ServerContext*, const v1::TellRequest*, v1::TellReply*) override;

private:
  using Stream = grpc::ServerReaderWriter<v1::DriveReply, v1::DriveRequest>;
  grpc::Status Open(const v1::OpenDrive& open, const std::shared_ptr<DriveStream>& me);
  grpc::Status Read(Stream& stream, DriveStream& me, std::uint64_t generation);
  void SendTo(Stream& stream, DriveStream& me);
  struct Driving;
  Hub& Hub_;
};

} // namespace dspace::session

#endif
