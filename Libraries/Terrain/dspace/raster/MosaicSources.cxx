#include <dspace/raster/MosaicSources.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FilesRead.h>

#include <dspace/raster/NetworkScope.h>

namespace dspace {
namespace {

namespace fs = std::filesystem;

// Elements that describe pixels and where they lie, and name no data; and those that only hold such
// elements and SourceFilename. Unknown ones are rejected.
constexpr const char* HarmlessElements =
    "?xml VRTDataset SRS GeoTransform GCPList GCP BlockXSize BlockYSize OverviewList "
    "VRTRasterBand Description UnitType Offset Scale NoDataValue NoDataValueInt64 "
    "NoDataValueUInt64 HideNoDataValue ColorInterp ColorTable Entry CategoryNames Category "
    "Histograms HistItem HistMin HistMax BucketCount IncludeOutOfRange Approximate HistCounts "
    "GDALRasterAttributeTable FieldDefn Name Type Usage Row F Overview MaskBand SimpleSource "
    "ComplexSource AveragedSource NoDataFromMaskSource KernelFilteredSource SourceBand "
    "SourceProperties SrcRect DstRect NODATA UseMaskBand MaskValueThreshold RemappedValue "
    "ScaleOffset ScaleRatio LUT ColorTableComponent Exponent SrcMin SrcMax DstMin DstMax "
    "Clamp Resampling Kernel Size Coefs";

// GDAL takes names in upper and lower case for the same.
bool IsHarmless(const std::string& element) {
  static const CPLStringList names(CSLTokenizeString2(HarmlessElements, " ", 0));
  return names.FindString(element.c_str()) >= 0;
}

void RequireShortDocument(const std::string& path) {
  VSIStatBufL info = {};
  if (VSIStatL(path.c_str(), &info) == 0 &&
      std::uint64_t(info.st_size) > BudgetOf(Budget::MosaicBytes)) {
    throw Error(Error::Kind::Resource, "file '" + path + "'",
                "this mosaic (VRT) has " + std::to_string(info.st_size) + " bytes; " +
                    BudgetText(Budget::MosaicBytes));
  }
}

class Document {
public:
  explicit Document(const std::string& path) : Path_(path), Folder_(FolderOf(path)) {
    RequireShortDocument(path);
    const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> root(
        CPLParseXMLFile(path.c_str()), CPLDestroyXMLNode);
    this->Read(root.get());
  }

  std::vector<std::string> Sources;

private:
  static std::string FolderOf(const std::string& path) {
    if (IsRemote(path)) {
      return path.substr(0, path.rfind('/'));
    }
    std::error_code error; // GDAL follows a link to the document, too
    return fs::weakly_canonical(path, error).parent_path().string();
  }

  [[noreturn]] void Reject(const std::string& what) const {
    throw Error(Error::Kind::InvalidArgument, "file '" + this->Path_ + "'",
                "it " + what +
                    "; accepted here: a mosaic (VRT) of plain files that are allowed too");
  }

  // GDAL takes tags in upper and lower case for the same.
  void Read(const CPLXMLNode* node) {
    for (; node; node = node->psNext) {
      const std::string name = node->pszValue ? node->pszValue : "";
      if (node->eType == CXT_Element && EQUAL(name.c_str(), "SourceFilename")) {
        this->AddSource(*node);
        continue;
      }
      if (node->eType == CXT_Element && EQUAL(name.c_str(), "Metadata")) {
        continue; // may hold any XML, which GDAL gives as text
      }
      if (node->eType == CXT_Element && !IsHarmless(name)) {
        this->Reject("has the element '" + name.substr(0, 100) + "'");
      }
      if (node->eType == CXT_Attribute && EQUAL(name.c_str(), "subClass") && node->psChild &&
          !EQUAL(node->psChild->pszValue, "VRTSourcedRasterBand")) {
        this->Reject("is of the sort '" + std::string(node->psChild->pszValue) + "'");
      }
      this->Read(node->psChild);
    }
  }

  void AddSource(const CPLXMLNode& node) {
    const std::string name = CPLGetXMLValue(&node, "", "");
    const bool relative = std::atoi(CPLGetXMLValue(&node, "relativetoVRT", "0")) != 0;
    const bool whole = name.empty() || name[0] == '/' || !relative;
    const std::string source = whole ? name : this->Folder_ + "/" + name;
    FilesGuard::CheckFile(source);
    std::error_code error;
    if (name.find('<') != std::string::npos ||
        (!IsRemote(source) && !fs::is_regular_file(source, error))) {
      this->Reject("names '" + name.substr(0, 200) + "', which is not a plain file");
    }
    this->Sources.push_back(source);
  }

  const std::string& Path_;
  const std::string Folder_;
};

} // namespace

std::vector<std::string> MosaicSources(const std::string& path) {
  return Document(path).Sources;
}

} // namespace dspace
