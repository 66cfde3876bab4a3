// Tiles of colour layers on the GPU, and the table by which a shader finds them.
#ifndef DSPACE_LAYERS_LAYERATLAS_H
#define DSPACE_LAYERS_LAYERATLAS_H

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <dspace/layers/ColorTiles.h>

class vtkDspaceHubWindow;
class vtkShaderProgram;

namespace dspace {

struct RenderStatistics;

// Slots of one array texture hold tiles, whichever they are; a page table of each zoom (a torus of
// Pages x Pages) says which tile is in which slot. A tile that is not there is shown by the one
// that it is a part of. Every function needs the same context to be current.
class LayerAtlas {
public:
  static constexpr int Pages = 64;

  // `slots`: tiles on the GPU, 16 to 1024; each takes 266 kB.
  LayerAtlas(vtkDspaceHubWindow* window, int slots);
  LayerAtlas(const LayerAtlas&) = delete;
  LayerAtlas& operator=(const LayerAtlas&) = delete;
  ~LayerAtlas();

  int Slots() const { return this->Slots_; }

  // Uploads what is new of `wanted` (VisibleTiles, at most Slots() of one chart). Without `wait`
  // some of what is in memory, else all of it, waiting so many seconds for what is not; throws what
  // ColorTiles::Get throws. False where some of it is not there or not of the stack's revision.
  bool Show(ColorTiles& tiles, const std::vector<ColorTile>& wanted,
            const std::optional<double>& wait, RenderStatistics& statistics);

  // For a program with ClipmapLayers.frag.glsl.
  void Bind(vtkShaderProgram* program) const;

private:
  struct Entry {
    int slot = -1; // none: all of it is transparent
    std::weak_ptr<const ColorTiles::Tile> shown;
    std::uint64_t used = 0; // by the latest call of Show()
  };
  int AllocateSlot();
  void Store(const ColorTile& tile, const ColorTiles::TilePointer& shown,
             RenderStatistics& statistics);
  void Upload(int slot, const ColorTiles::Tile& tile, RenderStatistics& statistics) const;
  void SetPage(const ColorTile& tile, int slot);
  void ClearPage(const ColorTile& tile); // also as the parent of other tiles
  int SlotOfParent(const ColorTile& tile) const;
  void ClearPages();
  // Column, row, slot (-1: transparent), slot of the tile that it is a part of (-2: not there).
  using Page = std::array<std::int32_t, 4>;
  Page& PageOf(const ColorTile& tile);
  void UploadPage(const ColorTile& tile, const Page& page) const;

  vtkDspaceHubWindow* Window_;
  int Slots_;
  unsigned int Tiles_ = 0; // textures
  unsigned int PageTable_ = 0;
  int Chart_ = -1; // of the page table
  std::uint64_t Calls_ = 0;
  std::map<ColorTile, Entry> Entries_;
  std::vector<int> Free_;
  std::vector<Page> Table_;      // as it is on the GPU
  std::vector<ColorTile> Shown_; // whose pages it has: of the latest call of Show()
};

} // namespace dspace

#endif
