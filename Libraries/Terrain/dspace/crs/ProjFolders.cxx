#include <dspace/crs/ProjFolders.h>

#include <algorithm>
#include <filesystem>
#include <mutex>

#include <cpl_string.h>
#include <ogr_srs_api.h>

namespace dspace {
namespace {

std::mutex Mutex;
std::vector<const std::vector<std::string>*> Alive; // in their order
CPLStringList Base;                                 // without any

void Apply() {
  CPLStringList all;
  for (auto each = Alive.rbegin(); each != Alive.rend(); ++each) {
    for (const std::string& folder : **each) {
      all.AddString(folder.c_str());
    }
  }
  for (int i = 0; i < Base.size(); ++i) {
    all.AddString(Base[i]);
  }
  OSRSetPROJSearchPaths(all.List());
}

} // namespace

bool IsProjGrid(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string ending = file.extension().string();
  return ending == ".gsb" || ending == ".gtx" || ending == ".gvb" || ending == ".ct2" ||
         file.parent_path().filename() == "proj";
}

ProjFolders::ProjFolders(std::vector<std::string> folders) : Folders_(std::move(folders)) {
  const std::lock_guard<std::mutex> lock(Mutex);
  if (Alive.empty()) {
    Base = CPLStringList(OSRGetPROJSearchPaths());
  }
  Alive.push_back(&this->Folders_);
  Apply();
}

ProjFolders::~ProjFolders() {
  const std::lock_guard<std::mutex> lock(Mutex);
  Alive.erase(std::find(Alive.begin(), Alive.end(), &this->Folders_));
  Apply();
}

} // namespace dspace
