// What a frame tree tells those who follow it, and how it is delivered.
#ifndef DSPACE_FRAME_EVENTS_H
#define DSPACE_FRAME_EVENTS_H

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <utility>
#include <vector>

namespace dspace {

// Names a frame for as long as its tree lives; an id is never given to another frame.
using FrameId = std::uint64_t;
constexpr FrameId NoFrame = 0;
constexpr FrameId RootFrame = 1;

// One completed change of a frame tree.
struct FrameEvent {
  enum class Type { Created, Removed, Reparented, Renamed, PosesChanged };
  Type type;
  // Created, Reparented, Renamed: the one frame. Removed: the frame and its subtree, children
  // before parents, none of them in the tree any more. PosesChanged: the frames whose LOCAL pose
  // changed, each once (their descendants move with them and are not listed).
  std::vector<FrameId> ids;
  std::uint64_t revision; // FrameTree::Revision() right after the change
};

// Delivers events to listeners in the order in which the changes were made.
// Listeners may add and remove listeners (themselves too) and change the tree: such a change takes
// effect at once, and its event follows when the present one has reached everybody.
// A listener that throws stops neither the others nor the events that wait; the first exception is
// rethrown to whoever made the change, which stays made.
class FrameNotifier {
public:
  using Listener = std::function<void(const FrameEvent&)>;
  using Token = std::uint64_t; // never 0, never reused

  // The listener hears every event that is emitted from now on.
  Token Add(Listener listener) {
    this->Entries_.push_back({++this->LastToken_, std::move(listener), true});
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

  // Whether an event would be heard, so that none need be built when not.
  bool HasListeners() const { return !this->Entries_.empty(); }

  void Emit(FrameEvent event) {
    this->Queue_.push_back({std::move(event), this->LastToken_});
    if (this->Delivering_) {
      return; // the delivery that is under way comes to it
    }
    this->Delivering_ = true;
    std::exception_ptr first;
    while (!this->Queue_.empty()) {
      const Pending pending = std::move(this->Queue_.front());
      this->Queue_.pop_front();
      // By index: push_back leaves references into a deque valid, and nothing is erased meanwhile.
      for (std::size_t i = 0; i < this->Entries_.size(); ++i) {
        Entry& entry = this->Entries_[i];
        if (!entry.alive || entry.token > pending.lastToken) {
          continue;
        }
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
  };
  struct Pending {
    FrameEvent event;
    Token lastToken; // listeners that were added after the change do not hear of it
  };
  std::deque<Entry> Entries_;
  std::deque<Pending> Queue_;
  Token LastToken_ = 0;
  bool Delivering_ = false;
};

} // namespace dspace

#endif
