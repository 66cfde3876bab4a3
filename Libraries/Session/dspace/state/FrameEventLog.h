// Change events of followed scenes, on their way into replies.
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

// What happened to the frames of followed scenes and no reply has told yet, in order.
//
// C++ code may drive a scene for hours before the next command asks: from the MaximumWaiting-th
// event on, poses of one scene that change again and again are one event, which has each frame once
// and the last revision. What else waits is not joined: it grows with frames made, removed, moved
// and renamed.
class FrameEventLog {
public:
  static constexpr std::size_t MaximumWaiting = 1000;

  void Add(const std::string& scene, const FrameEvent& event);
  // Keeps what waits as it is, whatever is added; returns Size().
  std::size_t Close();
  std::size_t Size() const { return this->Events_.size(); }
  // A refused command may have made frames and taken them away again: nobody hears of them. Looks
  // at the events from `first` on; what else happened is still told.
  void DiscardSince(std::size_t first);
  // Appends all to the reply's and is empty then.
  void MoveTo(v1::Reply& reply);

private:
  bool Joined(const std::string& scene, const FrameEvent& event);
  std::vector<v1::FrameEvent> Events_;
  std::size_t Closed_ = 0;   // events before this one are not joined with others
  std::size_t JoinedAt_ = 0; // the event whose frames are:
  std::unordered_set<FrameId> JoinedIds_;
};

// Writes what happens to a scene's frames into a log, which must outlive it.
class FrameFollower {
public:
  FrameFollower(std::shared_ptr<Scene> scene, FrameEventLog& log);
  ~FrameFollower();
  FrameFollower(const FrameFollower&) = delete;
  FrameFollower& operator=(const FrameFollower&) = delete;

private:
  std::shared_ptr<Scene> Scene_; // others may keep it longer than its follower
  FrameNotifier::Token Token_;
};

} // namespace dspace::session

#endif
