// Short ways to fill a scene, with the usual settings. Scene.h has all of them.
#ifndef DSPACE_SCENE_STAGING_H
#define DSPACE_SCENE_STAGING_H

#include <string>

#include <Eigen/Core>

#include <dspace/scene/Scene.h>

namespace dspace {

// Reads a model file and adds it as the object `name` on a new frame of this name, at the origin of
// `parent`. Returns the frame. Throws what ImportModel (ModelImport.h), FrameTree::Create and
// Scene::AddObject throw; the scene then has nothing new.
FrameId StageModel(Scene& scene, const std::string& path, const std::string& name,
                   FrameId parent = RootFrame);

// The light "sun": white, 1361 W/m^2, with the disc that the Sun has at 1 au. `towards`: the
// direction to it in the root, of any length but 0. Replaces the Sun that there is. Throws
// Error(InvalidArgument).
void StageSun(Scene& scene, const Eigen::Vector3d& towards);

// A perspective camera with a vertical field of view of 45 degrees at `eye`, which looks at
// `target`, +Z up (root [m]). Creates the vantage where there is none, and replaces a camera of
// this name. Throws what LookAt (a view straight up or down is rejected), Scene::CreateVantage and
// Scene::SetCamera throw; the scene then is as before.
void StageCamera(Scene& scene, const std::string& name, const Eigen::Vector3d& eye,
                 const Eigen::Vector3d& target, const std::string& vantage = "main");

} // namespace dspace

#endif
