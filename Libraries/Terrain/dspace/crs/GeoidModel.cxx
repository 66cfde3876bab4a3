#include <dspace/crs/GeoidModel.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include <GeographicLib/Geoid.hpp>
#include <cpl_string.h>
#include <ogr_srs_api.h>
#include <proj.h>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/crs/Geodesics.h>

namespace dspace {
namespace {

std::string LabelOf(const std::string& name) {
  return "geoid '" + name + "'";
}

// A name and no path: a server reads no other file for a client.
bool IsPlainName(const std::string& name) {
  return !name.empty() && name.size() < 100 && name[0] != '.' && name[0] != '-' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "0123456789._-") == std::string::npos;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// A grid of PROJ's.
class ProjGrid {
public:
  explicit ProjGrid(const std::string& name) : Context_(proj_context_create()) {
    proj_log_level(this->Context_, PJ_LOG_NONE);
    proj_context_set_enable_network(this->Context_, 0);
    const CPLStringList folders(OSRGetPROJSearchPaths());
    if (folders.size() != 0) {
      proj_context_set_search_paths(this->Context_, folders.size(), folders.List());
    }
    this->Shift_ =
        proj_create(this->Context_, ("+proj=vgridshift +multiplier=1 +grids=" + name).c_str());
  }
  ~ProjGrid() {
    proj_destroy(this->Shift_);
    proj_context_destroy(this->Context_);
  }
  ProjGrid(const ProjGrid&) = delete;
  ProjGrid& operator=(const ProjGrid&) = delete;

  bool Good() const { return this->Shift_ != nullptr; }
  double Height(const Eigen::Vector2d& place) {
    const double degree = M_PI / 180.0;
    const PJ_COORD at =
        proj_coord(std::remainder(place.x(), 360.0) * degree, place.y() * degree, 0.0, 0.0);
    proj_errno_reset(this->Shift_);
    const double height = proj_trans(this->Shift_, PJ_FWD, at).xyz.z;
    return std::isfinite(height) ? height : std::numeric_limits<double>::quiet_NaN();
  }

private:
  PJ_CONTEXT* Context_;
  PJ* Shift_;
};

std::string ProjFoldersText() {
  const CPLStringList folders(OSRGetPROJSearchPaths());
  std::string text;
  for (int i = 0; i < folders.size(); ++i) {
    text += (i ? ":" : "") + std::string(folders[i]);
  }
  const char* standard = proj_info().searchpath;
  return text.empty() && standard ? standard : text;
}

} // namespace

struct GeoidModel::Grid {
  std::string label;
  std::optional<ProjGrid> proj;
  std::optional<GeographicLib::Geoid> geographic;
};

GeoidModel::GeoidModel(const std::string& name) : Grid_(std::make_unique<Grid>()) {
  this->Grid_->label = LabelOf(name);
  if (!IsPlainName(name)) {
    Reject(LabelOf(name), "this is no name of a geoid; accepted: a name of letters, digits, '.', "
                          "'_' and '-', such as 'egm96_15.gtx' or 'egm96-5'");
  }
  if (EndsWith(name, ".gtx") || EndsWith(name, ".tif")) {
    this->Grid_->proj.emplace(name);
    if (!this->Grid_->proj->Good()) {
      throw Error(Error::Kind::NotFound, LabelOf(name),
                  "PROJ has no readable grid '" + name + "' in " + ProjFoldersText() +
                      "; accepted: a grid that is there, such as 'egm96_15.gtx' of the package "
                      "proj-data, or data of GeographicLib such as 'egm96-5'");
    }
    return;
  }
  const std::filesystem::path folder = GeographicLib::Geoid::DefaultGeoidPath();
  const std::filesystem::path file = folder / (name + ".pgm");
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw Error(
        Error::Kind::NotFound, LabelOf(name),
        "file '" + file.string() + "' does not exist; accepted: data that " +
            "'geographiclib-get-geoids " + name + "' of the package geographiclib-tools " +
            "installs there (GEOGRAPHICLIB_GEOID_PATH names another folder), or a grid of " +
            "PROJ's such as 'egm96_15.gtx'");
  }
  try {
    this->Grid_->geographic.emplace(name, folder.string());
  } catch (const std::exception& failure) {
    throw Error(Error::Kind::Corrupt, LabelOf(name),
                "file '" + file.string() + "' cannot be read: " + failure.what());
  }
}

GeoidModel::~GeoidModel() = default;

double GeoidModel::Height(const Eigen::Vector2d& place) {
  RequirePlace(place);
  if (this->Grid_->proj) {
    return this->Grid_->proj->Height(place);
  }
  try {
    return (*this->Grid_->geographic)(place.y(), place.x());
  } catch (const std::exception& failure) {
    throw Error(Error::Kind::Corrupt, this->Grid_->label, failure.what());
  }
}

} // namespace dspace
