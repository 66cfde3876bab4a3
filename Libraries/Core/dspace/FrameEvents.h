// Change events of a frame tree, and their delivery to listeners.
#ifndef DSPACE_FRAME_EVENTS_H
#define DSPACE_FRAME_EVENTS_H

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <dspace/Error.h>

namespace dspace {

// Names a frame for as long as its tree lives; an id is never given to another frame.
using FrameId = std::uint64_t;
constexpr FrameId NoFrame = 0;
constexpr FrameId RootFrame = 1;

// One completed change of a frame tree.
struct FrameEvent {
  enum class Type { Created, Removed, Reparented, Renamed, PosesChanged };
  Type type;
  // Created: one frame, or those of CreateMany, parents before children. Reparented, Renamed: the
  // one frame. Removed: the frame and its subtree, children before parents, none of them in the
  // tree any more. PosesChanged: the frames whose LOCAL pose
  // changed, each once (their descendants move with them and are not listed).
  std::vector<FrameId> ids;
  std::uint64_t revision; // FrameTree::Revision() right after the change
};

// Delivers events to listeners in the order of the changes.
// Listeners may add and remove listeners (including themselves) and change the tree. Such a change
// takes effect at once; its event is delivered after the current one has reached all listeners.
// A listener that throws stops neither the other listeners nor the queued events. The first
// exception is rethrown to the caller that made the change; the change remains.
// Delivery always terminates. A listener is muted until the end of the delivery if its changes
// respond to events for more than MaximumRounds rounds, or if its change is beyond the
// MaximumCaused-th in one delivery. The delivery then ends with Error(Resource). Other listeners
// get every event.
class FrameNotifier {
public:
  using Listener = std::function<void(const FrameEvent&)>;
  using Token = std::uint64_t; // never 0, never reused
  static constexpr int MaximumRounds = 100;
  static constexpr int MaximumCaused = 100000;

  // The listener receives every event that is emitted from now on.
  Token Add(Listener listener) {
    this->Entries_.push_back({++this->LastToken_, std::move(listener), true, false});
    return this->LastToken_;
  }

  // False when the token is unknown or already removed.
  bool Remove(Token token) {
    for (auto it = this->Entries_.begin(); it != this->Entries_.end(); ++it) {
      if (it->token == token && it->alive) {
        it->alive = false;
        if (!this->Delivering_) {
          this->Entries_.erase(it);
        }
        return true;
      }
    }
    return false;
  }

  // False if no event needs to be built.
  bool HasListeners() const { return !this->Entries_.empty(); }

  void Emit(FrameEvent event) {
    if (this->Delivering_) { // the current delivery sends it
      this->Queue_.push_back(
          {std::move(event), this->LastToken_, this->Round_ + 1, this->Calling_});
      ++this->Caused_;
      return;
    }
    this->Queue_.push_back({std::move(event), this->LastToken_, 0, 0});
    this->Caused_ = 0;
    this->Delivering_ = true;
    std::exception_ptr first;
    while (!this->Queue_.empty()) {
      const Pending pending = std::move(this->Queue_.front());
      this->Queue_.pop_front();
      this->Round_ = pending.round;
      const bool endless = pending.round > MaximumRounds || this->Caused_ > MaximumCaused;
      if (endless && pending.cause != 0 && this->Silence(pending.cause) && !first) {
        first = std::make_exception_ptr(
            Error(Error::Kind::Resource, "frame listener " + std::to_string(pending.cause),
                  "its changes cause further ones without end (round " +
                      std::to_string(pending.round) + ", " + std::to_string(this->Caused_) +
                      " changes); accepted: up to " + std::to_string(MaximumRounds) +
                      " rounds and " + std::to_string(MaximumCaused) + " changes"));
      }
      // By index: push_back leaves references into a deque valid, and nothing is erased here.
      for (std::size_t i = 0; i < this->Entries_.size(); ++i) {
        Entry& entry = this->Entries_[i];
        if (!entry.alive || entry.silent || entry.token > pending.lastToken) {
          continue;
        }
        this->Calling_ = entry.token;
        try {
          entry.listener(pending.event);
        } catch (...) {
          if (!first) {
            first = std::current_exception();
          }
        }
      }
    }
    this->Delivering_ = false;
    for (auto it = this->Entries_.begin(); it != this->Entries_.end();) {
      it->silent = false;
      it = it->alive ? it + 1 : this->Entries_.erase(it);
    }
    if (first) {
      std::rethrow_exception(first);
    }
  }

private:
  struct Entry {
    Token token;
    Listener listener;
    bool alive;
    bool silent; // until the current delivery ends
  };
  struct Pending {
    FrameEvent event;
    Token lastToken; // listeners added after the change do not receive it
    int round;       // 0 for a change from outside, else one more than of the event that caused it
    Token cause;     // the listener that made the change, or 0
  };
  // False if it is muted already.
  bool Silence(Token token) {
    for (Entry& entry : this->Entries_) {
      if (entry.token == token && !entry.silent) {
        entry.silent = true;
        return true;
      }
    }
    return false;
  }
  std::deque<Entry> Entries_;
  std::deque<Pending> Queue_;
  Token LastToken_ = 0;
  bool Delivering_ = false;
  int Round_ = 0;     // of the event that is delivered
  Token Calling_ = 0; // the listener that receives it
  int Caused_ = 0;    // events of listeners' changes in this delivery
};

} // namespace dspace

#endif
