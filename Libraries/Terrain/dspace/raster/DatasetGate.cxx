#include <dspace/raster/DatasetGate.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include <cpl_error.h>
#include <cpl_string.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FilesRead.h>

#include <dspace/crs/CrsFiles.h>
#include <dspace/raster/BlockBudget.h>
#include <dspace/raster/InnerNames.h>
#include <dspace/raster/MosaicCount.h>
#include <dspace/raster/MosaicSources.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OpeningProbe.h>
#include <dspace/raster/SelfContainedDrivers.h>
#include <dspace/raster/TiffBlocks.h>
#include <dspace/raster/UnderlyingFile.h>

namespace dspace {
namespace {

namespace fs = std::filesystem;

constexpr int Nesting = 16;

// An opening under way in this thread, within the one that caused it.
class Opening {
public:
  Opening();
  ~Opening();
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  int Depth() const { return this->Outer_ ? this->Outer_->Depth() + 1 : 0; }
  // Also of the openings around it: GDAL itself would go on without an overview or a mask.
  void Fail(const Error& error) {
    this->Failure_ = this->Failure_ ? this->Failure_ : error;
    if (this->Outer_) {
      this->Outer_->Fail(error);
    }
  }
  void Check() const {
    if (this->Failure_) {
      throw Error(*this->Failure_);
    }
  }
  // Of mosaics, by name, whether their sources have been checked; kept by the outermost opening.
  std::map<std::string, bool>& Mosaics() {
    return this->Outer_ ? this->Outer_->Mosaics() : this->Mosaics_;
  }
  // The names of the links in a folder, read once for the outermost opening.
  const std::vector<std::string>& LinksIn(const fs::path& folder);

private:
  Opening* Outer_;
  std::optional<Error> Failure_;
  std::map<std::string, bool> Mosaics_;
  std::map<std::string, std::vector<std::string>> Links_; // by folder
};

thread_local Opening* Innermost = nullptr;

Opening::Opening() : Outer_(Innermost) {
  Innermost = this;
}

const std::vector<std::string>& Opening::LinksIn(const fs::path& folder) {
  if (this->Outer_) {
    return this->Outer_->LinksIn(folder);
  }
  const auto [known, isNew] = this->Links_.try_emplace(folder.string());
  std::error_code error;
  if (isNew) {
    for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
      std::error_code unknown;
      if (at->is_symlink(unknown)) {
        known->second.push_back(at->path().filename().string());
      }
    }
  }
  return known->second;
}

Opening::~Opening() {
  Innermost = this->Outer_;
}

[[noreturn]] void Reject(const std::string& name, const std::string& why) {
  throw Error(Error::Kind::InvalidArgument, "file '" + name.substr(0, 1000) + "'", why);
}

// The absolute name of what may be opened; see OpenDataset.
std::string RequireName(const std::string& name) {
  if (name.empty()) {
    throw Error(Error::Kind::NotFound, "file ''", "there is no such file");
  }
  const auto begins = [&](const char* prefix) { return name.rfind(prefix, 0) == 0; };
  if (name.find_first_of("<>\n") != std::string::npos) {
    Reject(name, "it is a document in the place of a name; accepted here: names of files");
  }
  if (begins("/vsicurl/")) {
    FilesGuard::CheckFile(name);
    return name;
  }
  const bool archive = begins("/vsizip/") || begins("/vsitar/") || begins("/vsigzip/");
  if (begins("/vsi") && !archive) {
    FilesGuard::CheckFile(name);
    Reject(name,
           "it is not a plain file; accepted here: plain files, /vsizip/, /vsitar/, /vsigzip/");
  }
  std::error_code error;
  const fs::path whole = archive ? fs::path(UnderlyingFile(name)) : fs::absolute(name, error);
  FilesGuard::CheckFile(whole.string());
  const fs::file_status status = fs::status(whole, error);
  if (!fs::exists(status)) {
    throw Error(Error::Kind::NotFound, "file '" + name.substr(0, 1000) + "'",
                "there is no such file");
  }
  if (!fs::is_regular_file(status) && (archive || !fs::is_directory(status))) {
    Reject(name, "it is neither a file nor a folder");
  }
  return archive ? name : whole.string();
}

DatasetPointer OpenGuarded(const std::string& name, unsigned flags, const char* const* drivers,
                           const char* const* options);

void CheckSources(const std::string& mosaic, Opening& opening) {
  const auto [known, isNew] = opening.Mosaics().emplace(mosaic, false);
  if (!isNew && !known->second) {
    Reject(mosaic, "it is among its own sources; accepted here: a mosaic (VRT) of plain files");
  }
  if (!isNew) {
    return;
  }
  if (opening.Depth() == 0) {
    CheckMosaicSize(mosaic);
  }
  std::set<std::string> seen;
  for (const std::string& source : MosaicSources(mosaic)) {
    if (seen.insert(source).second && !IsRemote(source) &&
        !OpenGuarded(source, GDAL_OF_RASTER, nullptr, nullptr)) {
      throw Error(Error::Kind::Corrupt, "file '" + source + "'",
                  std::string("as a source of '") + mosaic +
                      "' it cannot be read: " + CPLGetLastErrorMsg());
    }
  }
  opening.Mosaics()[mosaic] = true;
}

// Links that lead out, among the files that GDAL reads by a rule of endings: it opens them before
// it lists them. Of a folder, all.
void CheckLinksBeside(const std::string& path, Opening& opening) {
  std::error_code error;
  const bool isFolder = fs::is_directory(path, error);
  const fs::path folder = isFolder ? fs::path(path) : fs::path(path).parent_path();
  const std::string stem = isFolder ? "" : fs::path(path).stem().string();
  for (const std::string& name : opening.LinksIn(folder)) {
    const bool begins = EQUALN(name.c_str(), stem.c_str(), stem.size());
    const bool goesOn = begins && std::isalnum(static_cast<unsigned char>(name[stem.size()])) != 0;
    if (begins && (isFolder || !goesOn)) { // "a.prj", "a_MTL.txt", "a.tif.ovr" of "a.tif"
      FilesGuard::CheckFile((folder / name).string());
    }
  }
}

// "format 'MRF'" of a file that no accepted driver opens; the drivers only look at its beginning.
std::string FormatOf(const std::string& path, unsigned flags) {
  GDALDriverManager& manager = *GetGDALDriverManager();
  GDALOpenInfo info(path.c_str(), int(flags));
  for (int i = 0; i < manager.GetDriverCount(); ++i) {
    GDALDriver* driver = manager.GetDriver(i);
    if (driver && driver->pfnIdentify && !IsSelfContained(driver->GetDescription()) &&
        driver->pfnIdentify(&info) == TRUE) {
      return std::string("its format is '") + driver->GetDescription() + "'";
    }
  }
  return "its format is none of those that are accepted";
}

std::string AcceptedNames(unsigned flags) {
  std::string text;
  for (const char* const* name = SelfContainedDrivers(); *name; ++name) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(*name);
    if (driver && (((flags & GDAL_OF_RASTER) && driver->GetMetadataItem(GDAL_DCAP_RASTER)) ||
                   ((flags & GDAL_OF_VECTOR) && driver->GetMetadataItem(GDAL_DCAP_VECTOR)))) {
      text += *name + std::string(", ");
    }
  }
  return text + ((flags & GDAL_OF_RASTER) && AreMosaicsAccepted() ? "and mosaics (VRT) of these"
                                                                  : "and no others");
}

// Of a raster whose blocks and levels could not be counted in time.
void CheckPixels(GDALDataset& dataset, const std::string& path) {
  const int columns = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  if (columns > 0 && rows > 0 &&
      std::uint64_t(columns) * std::uint64_t(rows) > BudgetOf(Budget::RasterPixels)) {
    throw Error(Error::Kind::Resource, "file '" + path.substr(0, 1000) + "'",
                "it has " + std::to_string(columns) + " x " + std::to_string(rows) + " pixels; " +
                    BudgetText(Budget::RasterPixels));
  }
}

void CheckCrsOf(GDALDataset& dataset, const std::string& path) {
  std::vector<const OGRSpatialReference*> all = {dataset.GetSpatialRef(),
                                                 dataset.GetGCPSpatialRef()};
  for (int i = 0; i < dataset.GetLayerCount(); ++i) {
    OGRLayer* layer = dataset.GetLayer(i);
    OGRFeatureDefn* fields = layer ? layer->GetLayerDefn() : nullptr;
    for (int k = 0; fields && k < fields->GetGeomFieldCount(); ++k) {
      all.push_back(fields->GetGeomFieldDefn(k)->GetSpatialRef());
    }
  }
  for (const OGRSpatialReference* srs : all) {
    if (srs && CrsNamesFile(*srs)) {
      Reject(path, "its coordinate system names a file; accepted here: coordinate systems without "
                   "grids, parameter files and init");
    }
  }
}

void CheckOpened(GDALDataset& dataset, const std::string& path, const Opening& opening) {
  CheckPixels(dataset, path);
  const char* overviews = dataset.GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS");
  if (overviews) {
    Reject(path,
           "its metadata name '" + std::string(overviews).substr(0, 200) +
               "' as OVERVIEW_FILE; accepted here: overviews within the file, or beside it in "
               "a file of its name and .ovr");
  }
  CheckCrsOf(dataset, path);
  const CPLStringList files(dataset.GetFileList()); // GDAL looks for overviews and masks, too
  opening.Check();
  for (int i = 0; i < files.size(); ++i) {
    FilesGuard::CheckFile(UnderlyingFile(files[i]));
  }
}

DatasetPointer OpenGuarded(const std::string& name, unsigned flags, const char* const* drivers,
                           const char* const* options) {
  Opening opening;
  if (opening.Depth() > Nesting) {
    Reject(name,
           "a chain of " + std::to_string(Nesting) + " files that refer to each other leads to it");
  }
  if (flags & GDAL_OF_UPDATE) {
    Reject(name,
           "another file requests write access to it; accepted here: files that are only read");
  }
  const std::string path = RequireName(name);
  CheckLinksBeside(path, opening);
  if (!IsRemote(path)) {
    CheckInnerNames(path);
  }
  const char* const mosaic[] = {"VRT", nullptr};
  const char* const* allowed = drivers ? drivers : SelfContainedDrivers();
  if (!drivers && (flags & GDAL_OF_RASTER) && AreMosaicsAccepted() && IsMosaic(path)) {
    CheckSources(path, opening);
    allowed = mosaic;
    flags &= ~unsigned(GDAL_OF_VECTOR);
  }
  // As these drivers are named, GDAL does not come back here for this file.
  CPLErrorReset();
  DatasetPointer dataset(GDALDataset::Open(
      path.c_str(), flags & ~unsigned(GDAL_OF_SHARED | GDAL_OF_VERBOSE_ERROR), allowed, options));
  opening.Check();
  if (!dataset && !drivers && CPLGetLastErrorType() < CE_Failure) {
    throw Error(Error::Kind::Unsupported, "file '" + path + "'",
                FormatOf(path, flags) + "; accepted here: " + AcceptedNames(flags));
  }
  if (dataset) {
    CheckOpened(*dataset, path, opening);
    RequireBlockBytes(*dataset, path);
  }
  return dataset;
}

// What GDAL opens by itself. No exception may pass through GDAL.
GDALDataset* OpenForGdal(GDALOpenInfo* info) {
  if (info->pszFilename[0] == '\0') {
    return nullptr; // the other drivers' turn
  }
  try {
    if (!FilesGuard::IsActive()) {
      ProbeOpening(*info);
      return nullptr;
    }
    return OpenGuarded(info->pszFilename, unsigned(info->nOpenFlags), nullptr,
                       info->papszOpenOptions)
        .release();
  } catch (const Error& error) {
    if (Innermost) {
      Innermost->Fail(error);
    }
    CPLError(CE_Failure, CPLE_AppDefined, "%s", error.what()); // no other driver's turn
  }
  return nullptr;
}

void MoveToFront(GDALDriver* gate) {
  GDALDriverManager& manager = *GetGDALDriverManager();
  std::vector<GDALDriver*> others;
  for (int i = 0; i < manager.GetDriverCount(); ++i) {
    if (manager.GetDriver(i) != gate) {
      others.push_back(manager.GetDriver(i));
    }
  }
  for (GDALDriver* driver : others) {
    manager.DeregisterDriver(driver);
  }
  manager.RegisterDriver(gate);
  for (GDALDriver* driver : others) {
    manager.RegisterDriver(driver);
  }
}

void Register() {
  RegisterGdal();
  GDALDriverManager& manager = *GetGDALDriverManager();
  if (manager.GetDriverByName(DatasetGateName)) {
    return;
  }
  auto* gate = new GDALDriver; // the manager's
  gate->SetDescription(DatasetGateName);
  gate->SetMetadataItem(GDAL_DMD_LONGNAME, "Dspace's check of names (opens nothing by itself)");
  gate->SetMetadataItem(GDAL_DCAP_OPEN, "YES");
  gate->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
  gate->SetMetadataItem(GDAL_DCAP_VECTOR, "YES");
  gate->SetMetadataItem(GDAL_DCAP_GNM, "YES");
  gate->SetMetadataItem(GDAL_DCAP_MULTIDIM_RASTER, "YES");
  gate->pfnOpen = OpenForGdal;
  MoveToFront(gate);
}

// Once a process.
void RegisterGate() {
  static std::once_flag once;
  std::call_once(once, Register);
}

unsigned FlagsOf(DatasetKind kind) {
  return GDAL_OF_READONLY | (kind == DatasetKind::Raster   ? GDAL_OF_RASTER
                             : kind == DatasetKind::Shapes ? GDAL_OF_VECTOR
                                                           : GDAL_OF_RASTER | GDAL_OF_VECTOR);
}

} // namespace

DatasetPointer OpenDataset(const std::string& path, DatasetKind kind, const char* const* drivers) {
  RegisterGate();
  const WholeStrips whole;
  if (FilesGuard::IsActive()) {
    return OpenGuarded(path, FlagsOf(kind), drivers, nullptr);
  }
  DatasetPointer dataset(
      GDALDataset::Open(path.c_str(), FlagsOf(kind) | GDAL_OF_VERBOSE_ERROR, drivers));
  if (dataset) {
    CheckPixels(*dataset, path);
    RequireBlockBytes(*dataset, path);
  }
  return dataset;
}

DatasetPointer OpenOwnTiff(const std::string& path) {
  RegisterGate();
  const char* const tiff[] = {"GTiff", nullptr};
  return DatasetPointer(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, tiff));
}

std::string AcceptedFormats(DatasetKind kind) {
  if (FilesGuard::IsActive()) {
    return AcceptedNames(FlagsOf(kind));
  }
  return kind == DatasetKind::Shapes ? "any file of shapes that OGR opens"
                                     : "any raster that GDAL opens";
}

} // namespace dspace
