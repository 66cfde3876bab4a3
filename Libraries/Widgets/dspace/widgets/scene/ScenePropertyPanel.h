// The properties of a frame or an object.
#ifndef DSPACE_WIDGETS_SCENE_PROPERTY_PANEL_H
#define DSPACE_WIDGETS_SCENE_PROPERTY_PANEL_H

#include <memory>

#include <QWidget>

#include <dspace/scene/Scene.h>
#include <dspace/widgets/scene/SceneRequest.h>

namespace dspace::widgets {

// Shows the pose X_WG of a frame or of an object's axes, relative to a frame W that the user
// chooses (the root by default): position [m], unit quaternion (w x y z), and roll, pitch and yaw
// [degrees] about W's fixed X, then Y, then Z axis. Of objects also fragment, material and levels
// of detail.
class ScenePropertyPanel : public QWidget {
  Q_OBJECT

public:
  explicit ScenePropertyPanel(QWidget* parent = nullptr);
  ~ScenePropertyPanel() override;

  // Shows the present values; `kind` is the item's kind in words. A null scene, or an item that
  // does not exist, shows nothing.
  void Show(const Scene* scene, const SceneItem& item, const QString& kind);
  // NoFrame: the parent of what is shown. A frame that no longer exists counts as the root.
  void SetReference(const Scene* scene, FrameId frame);
  FrameId Reference() const;

  // Roll, pitch and yaw [degrees] of a rotation R = Rz(yaw) Ry(pitch) Rx(roll).
  static Eigen::Vector3d RollPitchYaw(const Eigen::Quaterniond& rotation);

signals:
  // The user chose the path of a frame, "/" for the root, or "parent".
  void referenceChosen(const QString& path);

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
