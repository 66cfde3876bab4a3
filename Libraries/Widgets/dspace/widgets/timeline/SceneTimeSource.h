// The clock of a live scene.
#ifndef DSPACE_WIDGETS_SCENE_TIME_SOURCE_H
#define DSPACE_WIDGETS_SCENE_TIME_SOURCE_H

#include <functional>
#include <memory>

#include <dspace/scene/Scene.h>
#include <dspace/widgets/timeline/TimeSource.h>

class vtkDspaceSession;

namespace dspace::widgets {

// Shows the time that a simulation sets. The range is from the scene's beginning to the greatest
// time since the source was made. It can ask nothing of the simulation: requests throw
// Error(Unsupported).
class SceneTimeSource : public TimeSource {
public:
  // The scene is asked for at every Advance(); null: there is none.
  explicit SceneTimeSource(std::function<std::shared_ptr<Scene>()> scene, bool j2000 = true);

  // Asked for at every Advance(), returns null where nothing changed since the last call.
  using Events_t = std::function<std::unique_ptr<std::vector<TimelineEvent>>()>;
  void SetEvents(Events_t events);
  // The least time that the scene was ever set to, from which all viewers count; none: not yet set.
  // Without this function: the least time since the source was made.
  void SetBegin(std::function<std::optional<double>()> begin);

  State GetState() const override { return this->State_; }
  const std::vector<TimelineEvent>& Events() const override { return this->Events_; }
  std::uint64_t EventsRevision() const override { return this->Revision_; }
  const std::vector<TimeRange>& Gaps() const override { return this->Gaps_; }
  void Advance(double wall_s) override;
  void Play(bool playing) override;
  void Seek(double time_s) override;
  void Step(int steps) override;
  void SetSpeed(double speed) override;
  void SetLoop(const std::optional<TimeRange>& loop) override;
  void Follow(bool following) override;

private:
  std::function<std::shared_ptr<Scene>()> Scene_;
  Events_t NextEvents_;
  std::function<std::optional<double>()> Begin_;
  State State_;
  std::vector<TimelineEvent> Events_;
  std::vector<TimeRange> Gaps_;
  std::uint64_t Revision_ = 0;
};

// A session's scene with its logged events. The source keeps the session.
std::unique_ptr<SceneTimeSource> MakeTimeSource(vtkDspaceSession* session, const std::string& scene,
                                                bool j2000 = true);

} // namespace dspace::widgets

#endif
