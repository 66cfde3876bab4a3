// What gRPC does with the bytes of a request before the server sees it: inside the library only.
// The generated service includes this header, too, so that no other way of parsing exists.
#ifndef DSPACE_SESSION_REQUEST_BYTES_H
#define DSPACE_SESSION_REQUEST_BYTES_H

#include <string>

#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include <dspace/proto/service.pb.h>

namespace dspace::session {

// Parses a request, unless it has too many elements (MessageElements.h). Such a SendCommand comes
// with its number and without its command, and TakeRejection() says why.
grpc::Status ParseRequest(grpc::ByteBuffer* bytes, v1::DriveRequest& request);
// The same for requests without a command: they are rejected as a whole.
grpc::Status ParseRequest(grpc::ByteBuffer* bytes, google::protobuf::Message& request);

// Why the last DriveRequest that this thread has read came without its command; empty: it did not.
std::string TakeRejection();

// gRPC's serialization of a message of type `Request`, parsed as `As`.
template<class Request, class As> struct CheckedRequest {
  static grpc::Status Serialize(const google::protobuf::MessageLite& message,
                                grpc::ByteBuffer* bytes, bool* own) {
    return grpc::GenericSerialize<grpc::ProtoBufferWriter, Request>(message, bytes, own);
  }
  static grpc::Status Deserialize(grpc::ByteBuffer* bytes, google::protobuf::MessageLite* message) {
    return ParseRequest(bytes, static_cast<As&>(*static_cast<Request*>(message)));
  }
};

} // namespace dspace::session

namespace grpc {

template<>
class SerializationTraits<dspace::v1::DriveRequest, void>
    : public dspace::session::CheckedRequest<dspace::v1::DriveRequest, dspace::v1::DriveRequest> {};
template<>
class SerializationTraits<dspace::v1::HelloRequest, void>
    : public dspace::session::CheckedRequest<dspace::v1::HelloRequest, google::protobuf::Message> {
};
template<>
class SerializationTraits<dspace::v1::TellRequest, void>
    : public dspace::session::CheckedRequest<dspace::v1::TellRequest, google::protobuf::Message> {};
template<>
class SerializationTraits<dspace::v1::WatchRequest, void>
    : public dspace::session::CheckedRequest<dspace::v1::WatchRequest, google::protobuf::Message> {
};

} // namespace grpc

#endif
