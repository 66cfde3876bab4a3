// Change events of followed scenes, on their way into replies.
#ifndef DSPACE_SESSION_FRAME_EVENT_LOG_H
#define DSPACE_SESSION_FRAME_EVENT_LOG_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <dspace/scene/Scene.h>
#include <dspace/session/frames.pb.h>

namespace dspace::v1 {
class Reply;
}

namespace dspace::session {

// What happened to the frames of followed scenes and no reply has told yet, in order.
class FrameEventLog {
public:
  void Add(const std::string& scene, const FrameEvent& event);
  std::size_t Size() const { return this->Events_.size(); }
  // A refused command may have made frames and taken them away again: nobody hears of them. Looks
  // at the events from `first` on; what else happened is still told.
  void ForgetUndone(std::size_t first);
  // Appends all to the reply's and is empty then.
  void MoveTo(v1::Reply& reply);

private:
  std::vector<v1::FrameEvent> Events_;
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
