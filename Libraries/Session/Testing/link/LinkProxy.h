// Stands between the two sides of a link and breaks its connections.
#ifndef DSPACE_LINK_PROXY_H
#define DSPACE_LINK_PROXY_H

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace dspace::testing {

// Passes bytes on between a socket of its own and a server's. Each connection is cut after a random
// number of bytes, counted over both directions: closed on both sides; after half of a piece was
// passed on; closed on one side first; or it goes dumb: nothing is passed on any more, and neither
// side is told.
class LinkProxy {
public:
  LinkProxy(const std::string& path, const std::string& server, unsigned seed, double meanBytes)
      : Server_(server), Random_(seed), MeanBytes_(meanBytes) {
    unlink(path.c_str());
    this->Listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const sockaddr_un place = Place(path);
    EXPECT_EQ(bind(this->Listener_, reinterpret_cast<const sockaddr*>(&place), sizeof(place)), 0);
    EXPECT_EQ(listen(this->Listener_, 16), 0);
    this->Threads_.emplace_back([this] { this->Accept(); });
  }
  ~LinkProxy() {
    this->Ending_ = true;
    while (true) { // the first of them adds others
      std::vector<std::thread> threads;
      {
        const std::lock_guard lock(this->Mutex_);
        threads.swap(this->Threads_);
      }
      if (threads.empty()) {
        break;
      }
      for (std::thread& thread : threads) {
        thread.join();
      }
    }
    close(this->Listener_);
  }
  LinkProxy(const LinkProxy&) = delete;
  LinkProxy& operator=(const LinkProxy&) = delete;

  void Heal() { this->Healed_ = true; } // breaks none any more
  int Cuts() const { return this->Cuts_; }
  int Dumb() const { return this->Dumb_; }

private:
  enum class End { Close, Torn, OneSide, Dumb };

  static sockaddr_un Place(const std::string& path) {
    sockaddr_un place = {};
    place.sun_family = AF_UNIX;
    std::copy(path.begin(), path.end(), place.sun_path);
    return place;
  }

  void Accept() {
    while (!this->Ending_) {
      pollfd wait = {this->Listener_, POLLIN, 0};
      if (poll(&wait, 1, 20) <= 0) {
        continue;
      }
      const int client = accept4(this->Listener_, nullptr, nullptr, SOCK_CLOEXEC);
      const int server = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
      const sockaddr_un place = Place(this->Server_);
      if (connect(server, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) != 0) {
        close(client);
        close(server);
        continue;
      }
      const std::lock_guard lock(this->Mutex_);
      std::exponential_distribution<double> bytes(1 / this->MeanBytes_);
      const auto budget = std::size_t(200 + bytes(this->Random_));
      const unsigned kind = this->Random_() % 8;
      const End end = kind == 0  ? End::Dumb
                      : kind < 3 ? End::OneSide
                      : kind < 5 ? End::Torn
                                 : End::Close;
      this->Threads_.emplace_back([=] { this->Pass(client, server, budget, end); });
    }
  }

  // Until it is to be cut or one side has closed.
  void Pass(int client, int server, std::size_t budget, End end) {
    std::vector<char> piece(16384);
    bool open = true;
    while (open && !this->Ending_) {
      pollfd waits[] = {{client, POLLIN, 0}, {server, POLLIN, 0}};
      if (poll(waits, 2, 20) <= 0) {
        continue;
      }
      for (int i = 0; i < 2 && open; ++i) {
        if (waits[i].revents == 0) {
          continue;
        }
        const int from = i == 0 ? client : server;
        const int to = i == 0 ? server : client;
        const ssize_t read = recv(from, piece.data(), piece.size(), 0);
        if (read <= 0) {
          open = false;
        } else if (this->Healed_ || std::size_t(read) < budget) {
          budget -= std::min(budget, std::size_t(read));
          open = Send(to, piece.data(), std::size_t(read));
        } else {
          ++this->Cuts_;
          this->Cut(client, server, to, piece.data(), std::size_t(read), end);
          open = false;
        }
      }
    }
    close(client);
    close(server);
  }

  void Cut(int client, int server, int to, const char* piece, std::size_t size, End end) {
    if (end == End::Torn) {
      Send(to, piece, size / 2);
    } else if (end == End::OneSide) {
      shutdown(to, SHUT_RDWR);
      this->Sleep(30);
    } else if (end == End::Dumb) {
      ++this->Dumb_;
      // Either side may give it up; POLLHUP comes without being asked for.
      pollfd waits[] = {{client, 0, 0}, {server, 0, 0}};
      while (!this->Ending_ && poll(waits, 2, 20) == 0) {
      }
    }
  }

  static bool Send(int to, const char* data, std::size_t size) {
    while (size > 0) {
      const ssize_t sent = send(to, data, size, MSG_NOSIGNAL);
      if (sent <= 0) {
        return false;
      }
      data += sent;
      size -= std::size_t(sent);
    }
    return true;
  }

  void Sleep(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

  std::string Server_;
  int Listener_ = -1;
  std::mutex Mutex_;
  std::mt19937 Random_;
  double MeanBytes_;
  std::vector<std::thread> Threads_;
  std::atomic<bool> Ending_ = false;
  std::atomic<bool> Healed_ = false;
  std::atomic<int> Cuts_ = 0;
  std::atomic<int> Dumb_ = 0;
};

} // namespace dspace::testing

#endif
