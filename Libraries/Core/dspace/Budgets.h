// Limits on what one file or one message may cost in memory and time.
#ifndef DSPACE_BUDGETS_H
#define DSPACE_BUDGETS_H

#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

// A small file may ask for much: these bound it. They hold for the whole process; their names are
// those of SetBudget.
enum class Budget {
  ImagePixels,     // image_pixels: width times height of one image that is decoded
  BlockBytes,      // block_bytes: of one block (tile, strip) of a raster, decoded
  MessageElements, // message_elements: fields and numbers in one command of another process
  ImportMemory,    // import_memory: bytes of the process that reads a model (ModelImport.h)
  ImportSeconds,   // import_seconds: its processor time, and its time by the clock
  RasterPixels,    // raster_pixels: columns times rows of one raster
  MosaicFiles,     // mosaic_files: files that a mosaic (VRT) of another process makes be opened in
                   // all, each as often as it is named: sources, their sources, and so on
  MosaicBytes,     // mosaic_bytes: of its document
  OpenMemory,      // open_memory: bytes that opening a netCDF or HDF5 file takes (OpeningProbe.h)
  TextureBytes,    // texture_bytes: of all textures of one model, decoded
  OpenSeconds      // open_seconds: that a raster of another process is read while it is opened
};

struct BudgetInfo {
  Budget budget;
  const char* name;
  const char* meaning; // "the pixels of one image"
  std::uint64_t standard;
  std::uint64_t least;
  std::uint64_t most;
};

// All of them, in the order of the enumeration.
const std::vector<BudgetInfo>& Budgets();

// The present value. Any thread may ask.
std::uint64_t BudgetOf(Budget budget);

// Throws Error(InvalidArgument) for a name that is none and a value outside [least, most].
void SetBudget(const std::string& name, std::uint64_t value);

// "the limit image_pixels is 134217728, which dspace.limits.set raises": the end of a message that
// rejects something for a budget.
std::string BudgetText(Budget budget);

} // namespace dspace

#endif
