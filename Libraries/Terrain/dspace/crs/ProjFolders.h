// Where PROJ looks for its grids.
#ifndef DSPACE_TERRAIN_PROJFOLDERS_H
#define DSPACE_TERRAIN_PROJFOLDERS_H

#include <string>
#include <vector>

namespace dspace {

// Whether a noted file is a grid of PROJ's: by its ending (.gsb, .gtx, .gvb, .ct2), or since it is
// in a folder named "proj".
bool IsProjGrid(const std::string& path);

// While it lives, conversions that are made from then on find grids in these folders first, in all
// of the process. Of several that live the last one comes first.
class ProjFolders {
public:
  explicit ProjFolders(std::vector<std::string> folders);
  ~ProjFolders();
  ProjFolders(const ProjFolders&) = delete;
  ProjFolders& operator=(const ProjFolders&) = delete;

private:
  std::vector<std::string> Folders_;
};

} // namespace dspace

#endif
