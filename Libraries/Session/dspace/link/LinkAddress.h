// The address and the TLS settings of a server.
#ifndef DSPACE_SESSION_LINK_ADDRESS_H
#define DSPACE_SESSION_LINK_ADDRESS_H

#include <memory>
#include <string>

namespace grpc {
class ChannelCredentials;
class ServerCredentials;
} // namespace grpc

namespace dspace::session {

// The protocol of both sides of the link.
constexpr const char* LinkProtocol = "dspace.v1";

// PEM files: the own certificate with its key, and the authority that must have signed the other
// side's certificate. All three or none.
struct LinkSecurity {
  std::string certificate;
  std::string key;
  std::string authority;
  bool insecure = false; // allows any address without encryption and authentication

  bool HasCertificates() const { return !this->certificate.empty(); }
};

// Transport settings: bytes per read, bytes per HTTP/2 frame, and unread bytes in flight.
constexpr int LinkReadBytes = 128 << 10;
constexpr int LinkFrameBytes = 256 << 10;
constexpr int LinkAheadBytes = 2 << 20;

struct LinkAddress {
  std::string target;    // in gRPC's form: "unix:/tmp/socket", "127.0.0.1:4000", "[::1]:4000"
  std::string path;      // of a Unix socket; else empty
  bool loopback = false; // reachable from this machine only; true for Unix sockets

  // Parses "host:port" (port 0 to 65535, an IPv6 address in brackets) or "unix:PATH" (made
  // absolute). Throws Error(InvalidArgument). "localhost" is the only name that counts as loopback.
  static LinkAddress Parse(const std::string& text);
};

// Throws Error(InvalidArgument) for incomplete certificates, and for a non-loopback address without
// certificates unless `insecure`; Error(Io) for unreadable files.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const LinkAddress& address,
                                                               const LinkSecurity& security);
std::shared_ptr<grpc::ChannelCredentials> MakeClientCredentials(const LinkAddress& address,
                                                                const LinkSecurity& security);

} // namespace dspace::session

#endif
