#include <dspace/gdal/GdalErrors.h>

#include <mutex>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>

#include <dspace/Utf8.h>

namespace dspace {

namespace {

void CPL_STDCALL Collect(CPLErr level, CPLErrorNum, const char* message) {
  auto* self = static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
  if (level == CE_Failure || level == CE_Fatal)
    self->Add(true, message);
  else if (level == CE_Warning)
    self->Add(false, message);
}

} // namespace

GdalErrors::GdalErrors() {
  CPLPushErrorHandlerEx(Collect, this);
}

GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

void GdalErrors::Add(bool failure, const char* message) {
  auto& list = failure ? this->Failures_ : this->Warnings_;
  // A damaged file can repeat one message for every row.
  constexpr std::size_t most = 20;
  if (list.size() < most && (list.empty() || list.back() != ToUtf8(message)))
    list.push_back(ToUtf8(message));
}

std::string GdalErrors::Message(const std::string& otherwise) const {
  std::string text;
  for (const std::string& failure : this->Failures_)
    text += (text.empty() ? "" : "; ") + failure;
  return text.empty() ? otherwise : text;
}

void GdalErrors::Check(Error::Kind kind, const std::string& object) const {
  if (this->Failed())
    throw Error(kind, object, this->Message(""));
}

void GdalErrors::DemoteFailures() {
  this->Warnings_.insert(this->Warnings_.end(), this->Failures_.begin(), this->Failures_.end());
  this->Failures_.clear();
}

void RegisterGdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    // Tiles are kept by the pyramid, under its own budget: GDAL's share of all memory (5 %) would
    // stand beside it. Users may set another size.
    if (!CPLGetConfigOption("GDAL_CACHEMAX", nullptr)) {
      GDALSetCacheMax64(GIntBig(64) << 20);
    }
  });
}

} // namespace dspace
