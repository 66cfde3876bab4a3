// Collects GDAL's error messages: none reaches stderr, none is lost.
#ifndef DSPACE_TERRAIN_GDALERRORS_H
#define DSPACE_TERRAIN_GDALERRORS_H

#include <string>
#include <vector>

#include <dspace/Error.h>

namespace dspace {

// During its lifetime it collects this thread's GDAL and PROJ messages and converts them to UTF-8,
// because they quote files. Not for public headers.
class GdalErrors {
public:
  GdalErrors();
  ~GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  bool Failed() const { return !this->Failures_.empty(); }
  const std::vector<std::string>& Warnings() const { return this->Warnings_; }

  // All failures in one line, or `otherwise` when GDAL said nothing.
  std::string Message(const std::string& otherwise) const;

  // Throws Error(kind, object, message) when GDAL reported a failure.
  void Check(Error::Kind kind, const std::string& object) const;

  // Turns failures into warnings, for a call that succeeded in spite of them.
  void DemoteFailures();

  // Called by GDAL's handler.
  void Add(bool failure, const char* message);

private:
  std::vector<std::string> Failures_;
  std::vector<std::string> Warnings_;
};

// Registers GDAL's drivers once a process.
void RegisterGdal();

} // namespace dspace

#endif
