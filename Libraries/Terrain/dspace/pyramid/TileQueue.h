// A queue of requested tiles: their order, failures, and times of retries. Not for public headers.
#ifndef DSPACE_TERRAIN_TILEQUEUE_H
#define DSPACE_TERRAIN_TILEQUEUE_H

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace dspace {

// Its owner's lock is held in every call. `Extra` is what else the owner keeps of a request.
template<class Key, class Extra> class TileQueue {
public:
  using Clock = std::chrono::steady_clock;
  static constexpr double LongestDelay = 30.0; // [s] between attempts

  struct Request : Extra {
    std::uint64_t call = 0; // the latest that asked for it
    std::int64_t rank = 0;  // within that call: the least comes first
    bool reading = false;
    int failures = 0;
    Clock::time_point notBefore = {}; // of the next attempt
    std::exception_ptr error;         // of the last one
  };
  using Requests = std::map<Key, Request>;

  static Clock::duration Seconds(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  // Requests that `staleAfter` later calls did not repeat are dropped as obsolete.
  TileQueue(std::uint64_t staleAfter, double retryDelay)
      : StaleAfter_(staleAfter), RetryDelay_(retryDelay) {}

  void BeginCall() { ++this->Call_; }
  // The call requested nothing: earlier requests do not age.
  void CancelCall() { --this->Call_; }

  void Add(const Key& key, std::int64_t rank) {
    Request& request = this->Requests_[key];
    request.call = this->Call_;
    request.rank = rank;
  }

  Request* Find(const Key& key) {
    const auto found = this->Requests_.find(key);
    return found == this->Requests_.end() ? nullptr : &found->second;
  }
  Requests& All() { return this->Requests_; }
  std::size_t Count() const { return this->Requests_.size(); }

  // The request to serve next, of the latest call first; or none, and `soonest` is then when one
  // becomes due.
  typename Requests::iterator Next(std::optional<Clock::time_point>& soonest) {
    const Clock::time_point now = Clock::now();
    auto best = this->Requests_.end();
    for (auto it = this->Requests_.begin(); it != this->Requests_.end();) {
      const Request& request = it->second;
      if (!request.reading && this->Call_ - request.call > this->StaleAfter_ &&
          this->Waited_.count(it->first) == 0) {
        it = this->Requests_.erase(it);
        continue;
      }
      if (!request.reading && request.notBefore > now) {
        soonest = std::min(soonest.value_or(request.notBefore), request.notBefore);
      } else if (!request.reading &&
                 (best == this->Requests_.end() || request.call > best->second.call ||
                  (request.call == best->second.call && request.rank < best->second.rank))) {
        best = it;
      }
      ++it;
    }
    return best;
  }
  bool IsNone(typename Requests::iterator it) { return it == this->Requests_.end(); }

  // Waits for a request that is due; none once `stopping` is set. `wanted` is notified of new ones.
  typename Requests::iterator Wait(std::unique_lock<std::mutex>& lock,
                                   std::condition_variable& wanted, const bool& stopping) {
    while (!stopping) {
      std::optional<Clock::time_point> soonest;
      const auto next = this->Next(soonest);
      if (!this->IsNone(next)) {
        return next;
      }
      if (soonest) {
        wanted.wait_until(lock, *soonest);
      } else {
        wanted.wait(lock);
      }
    }
    return this->Requests_.end();
  }

  void Done(const Key& key) { this->Requests_.erase(key); }

  // The delay doubles with each failure. Returns the error's message.
  std::string Fail(const Key& key, const std::exception_ptr& error) {
    Request& request = this->Requests_[key];
    request.reading = false;
    request.error = error;
    const double delay =
        std::min(LongestDelay, std::ldexp(this->RetryDelay_, std::min(request.failures, 20)));
    ++request.failures;
    request.notBefore = Clock::now() + Seconds(delay);
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& e) {
      return e.what();
    } catch (...) {
      return "unknown error";
    }
  }

  // During its lifetime a call waits for tiles, which are then not dropped. Failures for earlier
  // callers do not count: retries start at once. Create it after all tiles are requested.
  class Waiting {
  public:
    Waiting(TileQueue& queue, std::vector<Key> keys) : Queue_(queue), Keys_(std::move(keys)) {
      for (const Key& key : this->Keys_) {
        ++this->Queue_.Waited_[key];
        if (Request* request = this->Queue_.Find(key)) {
          this->Before_[key] = request->failures;
          request->notBefore = {};
        }
      }
    }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;
    ~Waiting() {
      for (const Key& key : this->Keys_) {
        const auto found = this->Queue_.Waited_.find(key);
        if (--found->second == 0) {
          this->Queue_.Waited_.erase(found);
        }
      }
    }
    // Throws what the last attempt threw once so many have failed since.
    void Check(const Key& key, int attempts) {
      const Request* request = this->Queue_.Find(key);
      if (request && !request->reading && request->failures - this->Before_[key] >= attempts) {
        std::rethrow_exception(request->error);
      }
    }

  private:
    TileQueue& Queue_;
    std::vector<Key> Keys_;
    std::map<Key, int> Before_;
  };

private:
  std::uint64_t StaleAfter_;
  double RetryDelay_; // [s]
  std::uint64_t Call_ = 0;
  Requests Requests_;
  std::map<Key, int> Waited_; // by how many calls
};

} // namespace dspace

#endif
