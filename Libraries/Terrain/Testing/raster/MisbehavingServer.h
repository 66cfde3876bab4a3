// A small HTTP server of the tests' own that serves one file with ranges and misbehaves on demand.
#ifndef DSPACE_TEST_MISBEHAVINGSERVER_H
#define DSPACE_TEST_MISBEHAVINGSERVER_H

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <list>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace dspace::testing {

class MisbehavingServer {
public:
  enum class Mode {
    Good,
    Silent,    // takes the request and never answers
    Stall,     // half of the body, then nothing
    NotFound,  // 404
    Broken,    // 500
    Busy,      // 503, Retry-After: 1
    Cut,       // half of the body, then the connection is reset
    Truncated, // half of the body, then the connection is closed in good order
    Short,     // half of the body, and the header says so
    Garbage,   // the right number of wrong bytes
    Nonsense,  // no HTTP at all
    Page       // 200 with a page of text, whatever was asked for
  };

  // Serves the file's content under any name; 404 for names that hold "absent" or that end in
  // neither .tif nor .vrt.
  explicit MisbehavingServer(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    this->Body_.assign(std::istreambuf_iterator<char>(file), {});
    this->Socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof(address);
    auto* any = reinterpret_cast<sockaddr*>(&address);
    if (this->Body_.empty() || this->Socket_ < 0 || ::bind(this->Socket_, any, length) != 0 ||
        ::listen(this->Socket_, 64) != 0 || ::getsockname(this->Socket_, any, &length) != 0) {
      throw std::runtime_error("the test's server does not start");
    }
    this->Port_ = ntohs(address.sin_port);
    this->Thread_ = std::thread([this] { this->Accept(); });
  }
  ~MisbehavingServer() {
    this->Stopping_ = true;
    ::shutdown(this->Socket_, SHUT_RDWR);
    this->Thread_.join();
    ::close(this->Socket_);
    for (std::thread& thread : this->Threads_) {
      thread.join();
    }
  }
  MisbehavingServer(const MisbehavingServer&) = delete;
  MisbehavingServer& operator=(const MisbehavingServer&) = delete;

  std::string Url(const std::string& name) const {
    return "http://127.0.0.1:" + std::to_string(this->Port_) + "/" + name;
  }

  std::atomic<Mode> mode{Mode::Good};
  std::atomic<int> requests{0};
  std::atomic<int> misbehaviours{0};
  std::atomic<int> until{1 << 30}; // misbehaves so many times more, then is good

private:
  void Accept() {
    for (;;) {
      const int connection = ::accept(this->Socket_, nullptr, nullptr);
      if (connection < 0) {
        return;
      }
      this->Threads_.emplace_back([this, connection] {
        this->Answer(connection);
        ::close(connection);
      });
    }
  }

  static void Send(int connection, const char* data, std::size_t bytes) {
    while (bytes > 0) {
      const ssize_t sent = ::send(connection, data, bytes, MSG_NOSIGNAL);
      if (sent <= 0) {
        return;
      }
      data += sent;
      bytes -= std::size_t(sent);
    }
  }
  static void Send(int connection, const std::string& text) {
    Send(connection, text.data(), text.size());
  }

  // Until the client gives up or the test ends.
  void Hang(int connection) const {
    timeval tenth{0, 100000};
    ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &tenth, sizeof(tenth));
    char byte;
    while (!this->Stopping_ && ::recv(connection, &byte, 1, 0) != 0) {
    }
  }

  void Answer(int connection) {
    std::string request;
    char buffer[4096];
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t got = ::recv(connection, buffer, sizeof(buffer), 0);
      if (got <= 0) {
        return;
      }
      request.append(buffer, std::size_t(got));
    }
    ++this->requests;
    Mode mode = this->mode;
    if (mode != Mode::Good && this->until-- <= 0) {
      mode = Mode::Good;
    }
    if (mode != Mode::Good) {
      ++this->misbehaviours;
    }
    const auto reject = [&](const std::string& status) {
      Send(connection, "HTTP/1.1 " + status + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    };
    const bool head = request.compare(0, 5, "HEAD ") == 0;
    const std::size_t start = request.find(' ') + 1;
    const std::string name = request.substr(start, request.find(' ', start) - start);
    const std::string ending = name.size() < 4 ? "" : name.substr(name.size() - 4);
    const bool absent =
        name.find("absent") != std::string::npos || (ending != ".tif" && ending != ".vrt");
    switch (absent && mode == Mode::Good ? Mode::NotFound : mode) {
    case Mode::Silent:
      return this->Hang(connection);
    case Mode::NotFound:
      return reject("404 Not Found");
    case Mode::Broken:
      return reject("500 Internal Server Error");
    case Mode::Busy:
      return reject("503 Service Unavailable\r\nRetry-After: 1");
    case Mode::Nonsense:
      return Send(connection, std::string(500, '\x7f'));
    case Mode::Page:
      return Send(connection, "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nContent-Length: 17\r\n"
                              "Connection: close\r\n\r\n<p>Sign in, do</p>");
    default:
      break;
    }
    unsigned long long first = 0;
    unsigned long long last = this->Body_.size() - 1;
    const std::size_t range = request.find("Range: bytes=");
    bool part = range != std::string::npos;
    if (part) {
      std::sscanf(request.c_str() + range, "Range: bytes=%llu-%llu", &first, &last);
      last = std::min<unsigned long long>(last, this->Body_.size() - 1);
      if (first > last) {
        return reject("416 Range Not Satisfiable");
      }
    }
    std::string body = this->Body_.substr(first, last - first + 1);
    std::size_t sent = body.size();
    std::size_t stated = body.size();
    if (mode == Mode::Garbage) {
      std::fill(body.begin(), body.end(), '\x5a');
    } else if (mode != Mode::Good) {
      sent /= 2;
      stated = mode == Mode::Short ? sent : stated;
    }
    std::string header = part ? "HTTP/1.1 206 Partial Content\r\n" : "HTTP/1.1 200 OK\r\n";
    if (part) {
      header += "Content-Range: bytes " + std::to_string(first) + "-" + std::to_string(last) + "/" +
                std::to_string(this->Body_.size()) + "\r\n";
    }
    header += "Content-Length: " + std::to_string(stated) +
              "\r\nAccept-Ranges: bytes\r\nConnection: close\r\n\r\n";
    Send(connection, header);
    if (head) {
      return;
    }
    Send(connection, body.data(), sent);
    if (mode == Mode::Stall) {
      this->Hang(connection);
    } else if (mode == Mode::Cut) {
      const linger reset{1, 0};
      ::setsockopt(connection, SOL_SOCKET, SO_LINGER, &reset, sizeof(reset));
    }
  }

  std::string Body_;
  int Socket_ = -1;
  int Port_ = 0;
  std::atomic<bool> Stopping_{false};
  std::thread Thread_;
  std::list<std::thread> Threads_; // of Accept alone, then of the destructor
};

} // namespace dspace::testing

#endif
