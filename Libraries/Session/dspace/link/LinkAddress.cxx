#include <dspace/link/LinkAddress.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <sys/un.h>

#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

[[noreturn]] void RejectAddress(const std::string& text, const std::string& why) {
  throw Error(Error::Kind::InvalidArgument, "address '" + text + "'",
              why + "; accepted: host:port with a port from 0 to 65535, or unix:PATH");
}

bool IsLoopback(const std::string& host) {
  if (host == "localhost" || host == "[::1]") {
    return true;
  }
  // 127.0.0.0/8: four numbers, so that no name that only begins like one passes.
  int part = 0;
  int dots = 0;
  for (const char c : host) {
    if (c == '.' && part > 0) {
      ++dots;
      part = 0;
    } else if (!std::isdigit(static_cast<unsigned char>(c)) || ++part > 3) {
      return false;
    }
  }
  return dots == 3 && part > 0 && host.rfind("127.", 0) == 0;
}

std::string ReadAll(const std::string& path, const char* what) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || text.str().find("-----BEGIN") == std::string::npos) {
    throw Error(Error::Kind::Io, "file '" + path + "'",
                std::string("it cannot be read as the ") + what + "; accepted: a PEM file");
  }
  return text.str();
}

void CheckSecurity(const LinkAddress& address, const LinkSecurity& security) {
  const bool all =
      !security.certificate.empty() && !security.key.empty() && !security.authority.empty();
  const bool none =
      security.certificate.empty() && security.key.empty() && security.authority.empty();
  if (!all && !none) {
    throw Error(Error::Kind::InvalidArgument, "certificates",
                "certificate '" + security.certificate + "', key '" + security.key +
                    "', authority '" + security.authority + "'; accepted: all three, or none");
  }
  if (none && !address.loopback && !security.insecure) {
    throw Error(Error::Kind::InvalidArgument, "address '" + address.target + "'",
                "it is not limited to this machine, and there are no certificates; accepted: a "
                "certificate, its key and an authority, a loopback address, a Unix socket, or "
                "an explicit 'insecure'");
  }
}

} // namespace

LinkAddress LinkAddress::Parse(const std::string& text) {
  LinkAddress address;
  if (text.rfind("unix:", 0) == 0) {
    if (text.size() == 5 || text.find('\0') != std::string::npos) {
      RejectAddress(text, "there is no path");
    }
    address.path = std::filesystem::absolute(text.substr(5)).lexically_normal();
    if (address.path.size() >= sizeof(sockaddr_un::sun_path)) {
      RejectAddress(text, "a socket's path is shorter than " +
                              std::to_string(sizeof(sockaddr_un::sun_path)) + " bytes");
    }
    address.target = "unix:" + address.path;
    address.loopback = true;
    return address;
  }
  const std::size_t colon = text.rfind(':');
  const std::string host = text.substr(0, colon == std::string::npos ? 0 : colon);
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (host.empty() || port.empty() || port.size() > 5 ||
      port.find_first_not_of("0123456789") != std::string::npos || std::stoi(port) > 65535) {
    RejectAddress(text, "it has no host or no port");
  }
  const bool bracketed = host.front() == '[' && host.back() == ']';
  if (!bracketed && host.find_first_of(":/[] ,%") != std::string::npos) {
    RejectAddress(text, "its host is invalid (an IPv6 address needs brackets)");
  }
  address.target = text;
  address.loopback = IsLoopback(host);
  return address;
}

std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const LinkAddress& address,
                                                               const LinkSecurity& security) {
  CheckSecurity(address, security);
  if (!security.HasCertificates()) {
    return grpc::InsecureServerCredentials();
  }
  grpc::SslServerCredentialsOptions options(
      GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  options.pem_root_certs = ReadAll(security.authority, "authority's certificate");
  options.pem_key_cert_pairs.push_back(
      {ReadAll(security.key, "key"), ReadAll(security.certificate, "certificate")});
  return grpc::SslServerCredentials(options);
}

std::shared_ptr<grpc::ChannelCredentials> MakeClientCredentials(const LinkAddress& address,
                                                                const LinkSecurity& security) {
  CheckSecurity(address, security);
  if (!security.HasCertificates()) {
    return grpc::InsecureChannelCredentials();
  }
  grpc::SslCredentialsOptions options;
  options.pem_root_certs = ReadAll(security.authority, "authority's certificate");
  options.pem_private_key = ReadAll(security.key, "key");
  options.pem_cert_chain = ReadAll(security.certificate, "certificate");
  return grpc::SslCredentials(options);
}

} // namespace dspace::session
