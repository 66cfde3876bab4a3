#include <dspace/raster/MosaicSources.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>

#include <cpl_conv.h>
#include <cpl_minixml.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>

#include <dspace/raster/NetworkScope.h>

namespace dspace {
namespace {

namespace fs = std::filesystem;

class Document {
public:
  explicit Document(const std::string& path) : Path_(path), Folder_(FolderOf(path)) {
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
      for (const char* other :
           {"SourceDataset", "SrcDataSource", "GDALWarpOptions", "OpenOptions",
            "PansharpeningOptions", "PixelFunctionCode", "Group", "ArraySource"}) {
        if (node->eType == CXT_Element && EQUAL(name.c_str(), other)) {
          this->Reject("has the element '" + name + "'");
        }
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
    if (this->Known_.insert(source).second) {
      this->Sources.push_back(source);
    }
  }

  const std::string& Path_;
  const std::string Folder_;
  std::set<std::string> Known_;
};

} // namespace

std::vector<std::string> MosaicSources(const std::string& path) {
  return Document(path).Sources;
}

} // namespace dspace
