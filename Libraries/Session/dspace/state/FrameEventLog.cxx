#include <dspace/state/FrameEventLog.h>

#include <algorithm>
#include <set>
#include <utility>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {
namespace {

v1::FrameEvent::Type FromType(FrameEvent::Type type) {
  switch (type) {
  case FrameEvent::Type::Created:
    return v1::FrameEvent::CREATED;
  case FrameEvent::Type::Removed:
    return v1::FrameEvent::REMOVED;
  case FrameEvent::Type::Reparented:
    return v1::FrameEvent::REPARENTED;
  case FrameEvent::Type::Renamed:
    return v1::FrameEvent::RENAMED;
  case FrameEvent::Type::PosesChanged:
    break;
  }
  return v1::FrameEvent::POSES_CHANGED;
}

} // namespace

bool FrameEventLog::Joined(const std::string& scene, const FrameEvent& event) {
  if (this->Events_.size() < std::max(MaximumWaiting, this->Closed_ + 1) ||
      event.type != FrameEvent::Type::PosesChanged) {
    return false;
  }
  v1::FrameEvent& last = this->Events_.back();
  if (last.type() != v1::FrameEvent::POSES_CHANGED || last.scene() != scene) {
    return false;
  }
  if (this->JoinedAt_ != this->Events_.size()) {
    this->JoinedAt_ = this->Events_.size();
    this->JoinedIds_ = {last.frame().begin(), last.frame().end()};
  }
  for (const FrameId id : event.ids) {
    if (this->JoinedIds_.insert(id).second) {
      last.add_frame(id);
    }
  }
  last.set_revision(event.revision);
  return true;
}

std::size_t FrameEventLog::Close() {
  this->Closed_ = this->Events_.size();
  return this->Closed_;
}

void FrameEventLog::Add(const std::string& scene, const FrameEvent& event) {
  if (this->Joined(scene, event)) {
    return;
  }
  v1::FrameEvent message;
  message.set_type(FromType(event.type));
  message.mutable_frame()->Add(event.ids.begin(), event.ids.end());
  message.set_revision(event.revision);
  message.set_scene(scene);
  this->Events_.push_back(std::move(message));
}

void FrameEventLog::DiscardSince(std::size_t first) {
  using Key = std::pair<std::string, FrameId>; // ids are a scene's own
  std::set<Key> made;
  std::set<Key> undone;
  for (std::size_t i = first; i < this->Events_.size(); ++i) {
    const v1::FrameEvent& event = this->Events_[i];
    for (const FrameId id : event.frame()) {
      const Key key(event.scene(), id);
      if (event.type() == v1::FrameEvent::CREATED) {
        made.insert(key);
      } else if (event.type() == v1::FrameEvent::REMOVED && made.count(key)) {
        undone.insert(key);
      }
    }
  }
  this->JoinedAt_ = 0;
  if (undone.empty()) {
    return;
  }
  for (std::size_t i = first; i < this->Events_.size(); ++i) {
    v1::FrameEvent& event = this->Events_[i];
    auto* frames = event.mutable_frame();
    frames->erase(std::remove_if(frames->begin(), frames->end(),
                                 [&](FrameId id) {
                                   return undone.count({event.scene(), id}) != 0;
                                 }),
                  frames->end());
  }
  this->Events_.erase(
      std::remove_if(this->Events_.begin() + std::ptrdiff_t(first), this->Events_.end(),
                     [](const v1::FrameEvent& event) { return event.frame().empty(); }),
      this->Events_.end());
}

void FrameEventLog::MoveTo(v1::Reply& reply) {
  for (v1::FrameEvent& event : this->Events_) {
    *reply.add_frame_event() = std::move(event);
  }
  this->Events_.clear();
  this->Closed_ = 0;
  this->JoinedAt_ = 0;
  this->JoinedIds_.clear();
}

FrameFollower::FrameFollower(std::shared_ptr<Scene> scene, FrameEventLog& log)
    : Scene_(std::move(scene)),
      Token_(Scene_->Frames().AddListener(
          [name = Scene_->Name(), &log](const FrameEvent& event) { log.Add(name, event); })) {}

FrameFollower::~FrameFollower() {
  this->Scene_->Frames().RemoveListener(this->Token_);
}

} // namespace dspace::session
