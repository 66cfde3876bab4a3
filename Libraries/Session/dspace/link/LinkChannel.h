// The gRPC channel of a client or a viewer, and its errors. Inside the library only.
#ifndef DSPACE_SESSION_LINK_CHANNEL_H
#define DSPACE_SESSION_LINK_CHANNEL_H

#include <memory>
#include <string>

#include <grpcpp/grpcpp.h>

#include <dspace/link/LinkAddress.h>
#include <dspace/proto/common.pb.h>

namespace dspace::session {

// Makes a channel to the address. A connection that is silent for `keepalive_s` is pinged. Throws
// Error(InvalidArgument) for the address or the certificates, and Error(Io) for unreadable files.
std::shared_ptr<grpc::Channel> MakeChannel(const std::string& address, const LinkSecurity& security,
                                           double keepalive_s = 20);
// Converts the status of a call to an error. Sets `final` if a retry is useless.
v1::Error ToError(const std::string& address, const grpc::Status& status, bool& final);
// Throws the message as an Error.
[[noreturn]] void Raise(const v1::Error& error);

} // namespace dspace::session

#endif
