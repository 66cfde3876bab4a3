// Pictures through lenses: draws source views and keeps those that the next tile may need.
#ifndef DSPACE_SESSION_LENS_PICTURES_H
#define DSPACE_SESSION_LENS_PICTURES_H

#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include <vtkSmartPointer.h>

#include <dspace/camera/sampling/LensTile.h>
#include <dspace/commands/cameras/PlacedLens.h>
#include <dspace/scene/Scene.h>

class vtkDspaceRenderContext;
class vtkDspaceViewport;

namespace dspace::session {

class LensPictures {
public:
  struct Request {
    PlacedLens lens;
    LensWishes wishes;
    bool ornaments = false;
    std::set<std::string> hiddenFragments;
    int samples = 2;
    int x = 0, y = 0, width = 0, height = 0; // the tile
    // Requests with the same keys have the same lens, and see the same picture of an unchanged
    // scene.
    std::string lensKey;
    std::string key;
  };
  struct Result {
    LensPlanes planes;
    std::uint64_t sourceViews = 0; // drawn now
    std::uint64_t sourcePixels = 0;
    std::uint64_t withoutRay = 0;
    double halfAngle_deg = 0.0;
    double pupilShift = 0.0;
    double pupilPixels = 0.0;
    std::uint64_t pupilBeyond = 0;
  };

  LensPictures();
  ~LensPictures();
  // Throws Error as SourceViews and vtkDspaceViewport::GetCapture do.
  Result Draw(vtkDspaceRenderContext* context, const std::shared_ptr<Scene>& scene,
              const Request& request);
  void Clear(); // the viewport and what is kept

private:
  using Key = SourceViews::Block;
  std::shared_ptr<const LensPlanes> Get(vtkDspaceRenderContext* context,
                                        const std::shared_ptr<Scene>& scene, const Request& request,
                                        const Key& block, bool depth, Result& result);

  std::shared_ptr<const LensMap> MapOf(const Request& request);
  void ClearBlocks();

  vtkSmartPointer<vtkDspaceViewport> Viewport_;
  std::weak_ptr<Scene> Scene_;
  std::string Lens_; // what the views and maps are of
  std::unique_ptr<SourceViews> Views_;
  std::map<std::tuple<int, int, int, int>, std::shared_ptr<const LensMap>> Maps_; // by their tile
  std::size_t MapBytes_ = 0;
  std::string Request_; // what the blocks below are of
  std::uint64_t Revision_ = 0;
  std::map<Key, std::shared_ptr<const LensPlanes>> Blocks_;
  std::list<Key> Order_; // the oldest first
  std::size_t Bytes_ = 0;
};

} // namespace dspace::session

#endif
