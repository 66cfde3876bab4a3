#include <dspace/link/LinkChannel.h>

#include <algorithm>
#include <utility>

#include <dspace/Error.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {
namespace {

Error::Kind ToKind(v1::Error::Kind kind) {
  switch (kind) {
  case v1::Error::INVALID_ARGUMENT:
    return Error::Kind::InvalidArgument;
  case v1::Error::NOT_FOUND:
    return Error::Kind::NotFound;
  case v1::Error::ALREADY_EXISTS:
    return Error::Kind::AlreadyExists;
  case v1::Error::UNSUPPORTED:
    return Error::Kind::Unsupported;
  case v1::Error::CORRUPT:
    return Error::Kind::Corrupt;
  case v1::Error::IO:
    return Error::Kind::Io;
  case v1::Error::RESOURCE:
    return Error::Kind::Resource;
  case v1::Error::DEADLINE_EXCEEDED:
    return Error::Kind::DeadlineExceeded;
  default:
    return Error::Kind::Internal;
  }
}

} // namespace

void Raise(const v1::Error& error) {
  const std::string& text = error.message();
  const std::string prefix = error.object() + ": ";
  throw Error(ToKind(error.kind()), error.object(),
              text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text);
}

std::shared_ptr<grpc::Channel> MakeChannel(const std::string& address, const LinkSecurity& security,
                                           double keepalive_s) {
  const LinkAddress parsed = LinkAddress::Parse(address);
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);                  // pictures
  arguments.SetMaxSendMessageSize(-1);                     // the server has its limit
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1); // a separate connection for each client
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 50);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  // Pings detect a dead connection, also while nothing is sent.
  const int keepalive_ms = int(std::clamp(1e3 * keepalive_s, 1.0, 1e9));
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, keepalive_ms);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, std::min(keepalive_ms, 10000));
  arguments.SetInt(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 0);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  // Steps are large: fewer and larger reads and frames.
  arguments.SetInt(GRPC_ARG_TCP_READ_CHUNK_SIZE, LinkReadBytes);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, LinkFrameBytes);
  return grpc::CreateCustomChannel(parsed.target, MakeClientCredentials(parsed, security),
                                   arguments);
}

v1::Error ToError(const std::string& address, const grpc::Status& status, bool& final) {
  v1::Error error;
  const std::string object = "server '" + address + "'";
  const auto say = [&](v1::Error::Kind kind, const std::string& message, bool last) {
    PutError(&error, kind, object, object + ": " + message);
    final = last;
    return error;
  };
  using Code = grpc::StatusCode;
  switch (status.error_code()) {
  case Code::ALREADY_EXISTS:
    return say(v1::Error::ALREADY_EXISTS, status.error_message(), true);
  case Code::FAILED_PRECONDITION:
    return say(v1::Error::UNSUPPORTED, status.error_message(), true);
  case Code::UNIMPLEMENTED:
    return say(v1::Error::UNSUPPORTED, "it does not speak protocol 'dspace.v1'", true);
  case Code::INVALID_ARGUMENT:
    return say(v1::Error::INVALID_ARGUMENT, status.error_message(), true);
  case Code::RESOURCE_EXHAUSTED:
    return say(v1::Error::RESOURCE, status.error_message(), true);
  case Code::ABORTED:
    return say(v1::Error::IO, status.error_message(), true);
  case Code::OK:
  case Code::CANCELLED:
  case Code::UNAVAILABLE:
    return say(v1::Error::IO,
               status.error_message().empty() ? "it has closed the connection"
                                              : status.error_message(),
               false);
  default:
    return say(v1::Error::IO, "the connection failed: " + status.error_message(), true);
  }
}

} // namespace dspace::session
