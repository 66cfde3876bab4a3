#include <dspace/Budgets.h>

#include <array>
#include <atomic>
#include <limits>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr std::uint64_t Mebi = std::uint64_t(1) << 20;
constexpr std::uint64_t Gibi = std::uint64_t(1) << 30;
constexpr std::size_t BudgetCount = 11;

std::array<std::atomic<std::uint64_t>, BudgetCount>& BudgetValues() {
  static std::array<std::atomic<std::uint64_t>, BudgetCount> values;
  static const bool filled = [] {
    for (const BudgetInfo& info : Budgets()) {
      values[static_cast<std::size_t>(info.budget)] = info.standard;
    }
    return true;
  }();
  static_cast<void>(filled);
  return values;
}

const BudgetInfo& InfoOf(Budget budget) {
  return Budgets()[static_cast<std::size_t>(budget)];
}

} // namespace

const std::vector<BudgetInfo>& Budgets() {
  // 16,384 x 8,192 pixels: the largest texture of most graphics cards for a whole body.
  static const std::vector<BudgetInfo> budgets = {
      {Budget::ImagePixels, "image_pixels", "the pixels of one image", 128 * Mebi, 1, 1024 * Mebi},
      {Budget::BlockBytes, "block_bytes", "the decoded bytes of one block of a raster", 256 * Mebi,
       1, 64 * Gibi},
      {Budget::MessageElements, "message_elements", "the elements of one command", 8 * Mebi, 1,
       1024 * Mebi},
      {Budget::ImportMemory, "import_memory", "the bytes of the process that reads a model",
       4 * Gibi, 64 * Mebi, 1024 * Gibi},
      {Budget::ImportSeconds, "import_seconds", "the seconds in which a model is read", 300, 1,
       1000000},
      // The whole Earth by pixels of 1 m has 8e14.
      {Budget::RasterPixels, "raster_pixels", "the pixels of one raster", 1024 * 1024 * Gibi, 1,
       std::uint64_t(1) << 62},
      {Budget::MosaicFiles, "mosaic_files", "the files that a mosaic makes be opened", 20000, 1,
       1000000000},
      {Budget::MosaicBytes, "mosaic_bytes", "the bytes of the document of a mosaic", 64 * Mebi, 1,
       64 * Gibi},
      {Budget::OpenMemory, "open_memory", "the bytes that opening a netCDF or HDF5 file takes",
       512 * Mebi, Mebi, 1024 * Gibi},
      {Budget::TextureBytes, "texture_bytes", "the decoded bytes of the textures of one model",
       512 * Mebi, 1, 1024 * Gibi},
      {Budget::OpenSeconds, "open_seconds", "the seconds that a raster is read while it is opened",
       15, 1, 1000000}};
  return budgets;
}

std::uint64_t BudgetOf(Budget budget) {
  return BudgetValues()[static_cast<std::size_t>(budget)];
}

void SetBudget(const std::string& name, std::uint64_t value) {
  std::string names;
  for (const BudgetInfo& info : Budgets()) {
    if (name == info.name) {
      if (value < info.least || value > info.most) {
        throw Error(Error::Kind::InvalidArgument, "limit '" + name + "'",
                    "is " + std::to_string(value) + "; accepted: " + std::to_string(info.least) +
                        " to " + std::to_string(info.most));
      }
      BudgetValues()[static_cast<std::size_t>(info.budget)] = value;
      return;
    }
    names += (names.empty() ? "" : ", ") + std::string(info.name);
  }
  throw Error(Error::Kind::InvalidArgument, "limit '" + name + "'",
              "there is no such limit; accepted: " + names);
}

std::string BudgetText(Budget budget) {
  return "the limit " + std::string(InfoOf(budget).name) + " is " +
         std::to_string(BudgetOf(budget)) + ", which dspace.limits.set raises";
}

} // namespace dspace
