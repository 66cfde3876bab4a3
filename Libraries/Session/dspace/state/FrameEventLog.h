// Frame events of followed scenes that are not yet in a reply.
#ifndef DSPACE_SESSION_FRAME_EVENT_LOG_H
#define DSPACE_SESSION_FRAME_EVENT_LOG_H

#include <cstddef>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include <dspace/proto/frames.pb.h>
#include <dspace/scene/Scene.h>

namespace dspace::v1 {
class Reply;
}

namespace dspace::session {

// The pending frame events of followed scenes, in order.
//
// C++ code may change a scene for hours before the next command. From event MaximumWaiting on,
// repeated pose changes of one scene are merged into one event, which has each frame once and the
// last revision. Other events are not merged.
class FrameEventLog {
public:
  static constexpr std::size_t MaximumWaiting = 1000;

  void Add(const std::string& scene, const FrameEvent& event);
  // Prevents later events from being merged with the present ones; returns Size().
  std::size_t Close();
  std::size_t Size() const { return this->Events_.size(); }
  // Discards the events from `first` on for frames that were created and removed again, after a
  // command was rejected. Other events stay.
  void DiscardSince(std::size_t first);
  // Moves all events to the reply.
  void MoveTo(v1::Reply& reply);

private:
  bool Joined(const std::string& scene, const FrameEvent& event);
  std::vector<v1::FrameEvent> Events_;
  std::size_t Closed_ = 0;   // events before this index are not merged
  std::size_t JoinedAt_ = 0; // the event that contains JoinedIds_
  std::unordered_set<FrameId> JoinedIds_;
};

// Records the events of a scene's frames in a log. The log must outlive it.
class FrameFollower {
public:
  FrameFollower(std::shared_ptr<Scene> scene, FrameEventLog& log);
  ~FrameFollower();
  FrameFollower(const FrameFollower&) = delete;
  FrameFollower& operator=(const FrameFollower&) = delete;

private:
  std::shared_ptr<Scene> Scene_; // shared: it may outlive the follower
  FrameNotifier::Token Token_;
};

} // namespace dspace::session

#endif
