// Where a server listens, and who may come there.
#ifndef DSPACE_SESSION_LINK_ADDRESS_H
#define DSPACE_SESSION_LINK_ADDRESS_H

#include <memory>
#include <string>

namespace grpc {
class ChannelCredentials;
class ServerCredentials;
} // namespace grpc

namespace dspace::session {

// What both sides of the link must speak.
constexpr const char* LinkProtocol = "dspace.v1";

// PEM files: one's own certificate with its key, and the authority that the other side's
// certificate must come from. All three or none.
struct LinkSecurity {
  std::string certificate;
  std::string key;
  std::string authority;
  bool insecure = false; // neither encrypted nor authenticated, wherever it goes

  bool HasCertificates() const { return !this->certificate.empty(); }
};

// Of the transport: what is read at once, a frame, and what may be on its way unread.
constexpr int LinkReadBytes = 128 << 10;
constexpr int LinkFrameBytes = 256 << 10;
constexpr int LinkAheadBytes = 2 << 20;

struct LinkAddress {
  std::string target;    // as gRPC has it: "unix:/tmp/socket", "127.0.0.1:4000", "[::1]:4000"
  std::string path;      // of a Unix socket, else empty
  bool loopback = false; // on this machine only; Unix sockets are

  // "host:port" (port 0 to 65535, an IPv6 address in brackets) or "unix:PATH", made absolute.
  // Throws Error(InvalidArgument). Of names only "localhost" counts as loopback.
  static LinkAddress Parse(const std::string& text);
};

// Throws Error(InvalidArgument) for an address beyond this machine without certificates unless
// `insecure`, and for certificates that are not all there; Error(Io) for files that cannot be read.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const LinkAddress& address,
                                                               const LinkSecurity& security);
std::shared_ptr<grpc::ChannelCredentials> MakeClientCredentials(const LinkAddress& address,
                                                                const LinkSecurity& security);

} // namespace dspace::session

#endif
