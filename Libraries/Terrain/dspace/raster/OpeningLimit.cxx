#include <dspace/raster/OpeningLimit.h>

#include <chrono>
#include <optional>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FilesRead.h>

namespace dspace {
namespace {

using Clock = std::chrono::steady_clock;

thread_local std::optional<Clock::time_point> End;

int GoOn(double /*done*/, const char* /*message*/, void* /*data*/) {
  return !End || Clock::now() < *End ? TRUE : FALSE;
}

} // namespace

OpeningLimit::OpeningLimit() : Mine_(!End && FilesGuard::IsActive()) {
  if (this->Mine_) {
    End = Clock::now() + std::chrono::seconds(BudgetOf(Budget::OpenSeconds));
  }
}

OpeningLimit::~OpeningLimit() {
  if (this->Mine_) {
    End.reset();
  }
}

bool OpeningLimit::IsActive() {
  return End.has_value();
}

GDALRasterIOExtraArg OpeningLimit::Argument() {
  GDALRasterIOExtraArg argument;
  INIT_RASTERIO_EXTRA_ARG(argument);
  argument.pfnProgress = GoOn;
  return argument;
}

void OpeningLimit::Check(const std::string& object) {
  if (End && Clock::now() >= *End) {
    throw Error(Error::Kind::Resource, object,
                "its pixels could not be read in the time that opening may take: build overviews "
                "(gdaladdo), or make one file of a mosaic; " +
                    BudgetText(Budget::OpenSeconds));
  }
}

} // namespace dspace
