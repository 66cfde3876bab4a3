// The makers of geometry that code of this process draws, by the name of their drawer.
#ifndef DSPACE_SESSION_DRAWN_GEOMETRIES_H
#define DSPACE_SESSION_DRAWN_GEOMETRIES_H

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <dspace/scene/CustomGeometry.h>

namespace dspace::session {

// What a maker gets of the command CreateDrawn.
struct DrawnRequest {
  const std::string& object; // "object 'cloud'", for messages
  const std::string& drawer;
  const std::string& parameters; // bytes, as given
};

class DrawnGeometries {
public:
  // Returns a geometry of its own each time. Throws dspace::Error for parameters that it rejects.
  using Maker = std::function<std::shared_ptr<const CustomGeometry>(const DrawnRequest&)>;

  // `name`: 1 to 256 characters without a colon. Throws Error(InvalidArgument) for another one, and
  // Error(AlreadyExists) if there is one of this name.
  void Register(const std::string& name, Maker maker);
  // The maker of a drawer, or of all drawers "NAME:..."; null if none is registered.
  const Maker* Find(const std::string& drawer) const;
  std::vector<std::string> Names() const;

private:
  std::map<std::string, Maker> Makers_;
};

} // namespace dspace::session

#endif
