// GDAL's own error messages, caught: none reaches stderr, none is lost.
#ifndef DSPACE_TERRAIN_GDALERRORS_H
#define DSPACE_TERRAIN_GDALERRORS_H

#include <string>
#include <vector>

#include <dspace/Error.h>

namespace dspace {

// While it lives, this thread's GDAL and PROJ messages are collected here, made UTF-8: they quote
// files. Not for public headers.
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

  // For a call that succeeded although something failed on the way: failures become warnings.
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
