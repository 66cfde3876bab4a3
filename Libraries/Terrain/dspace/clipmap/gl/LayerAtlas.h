// Tiles of layers on the GPU, and the table by which a shader finds them.
#ifndef DSPACE_LAYERS_LAYERATLAS_H
#define DSPACE_LAYERS_LAYERATLAS_H

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <dspace/layers/ColorTiles.h>

class vtkDspaceHubWindow;
class vtkShaderProgram;

namespace dspace {

struct RenderStatistics;

// Slots of one array texture hold tiles, whichever they are; a page table of each zoom (a torus of
// Pages x Pages) says which tile is in which slot. A tile that is not there is shown by the one
// that it is a part of. Tiles of several compositions have slots; a plane of page tables shows
// those of one. Every function needs the same context to be current.
class LayerAtlas {
public:
  static constexpr int Pages = 64;
  static constexpr int Zooms = ColorGrid::MaximumZoom + 1; // page tables of a plane

  // `slots`: tiles on the GPU, 16 to 1024; each takes 266 kB, of normals twice as much.
  LayerAtlas(vtkDspaceHubWindow* window, LayerContent content, int slots);
  LayerAtlas(const LayerAtlas&) = delete;
  LayerAtlas& operator=(const LayerAtlas&) = delete;
  ~LayerAtlas();

  int Slots() const { return this->Slots_; }

  // Shows a composition of `wanted` (VisibleTiles, at most Slots() of one chart) in each plane, and
  // uploads what is new. Without `wait` some of what is in memory, else all of it, waiting so many
  // seconds for what is not; throws what ColorTiles::Get throws. False where some of it is not
  // there or not of the stack's revision.
  bool Show(ColorTiles& tiles, const std::vector<LayerChoice>& planes,
            const std::vector<ColorTile>& wanted, const std::optional<double>& wait,
            RenderStatistics& statistics);

  // For a program with ClipmapLayers.frag.glsl.
  void Bind(vtkShaderProgram* program) const;

private:
  struct Entry {
    int slot = -1; // none: all of it is transparent
    std::weak_ptr<const ColorTiles::Tile> shown;
    std::uint64_t used = 0; // by the latest call of Show()
  };
  using Key = std::pair<int, ColorTile>; // a tile of a composition
  bool ShowPlane(std::size_t plane, const std::vector<ColorTiles::TilePointer>& there,
                 const std::vector<ColorTile>& wanted, std::uint64_t revision, int& uploads,
                 RenderStatistics& statistics);
  int AllocateSlot();
  void Store(const Key& key, const ColorTiles::TilePointer& shown, RenderStatistics& statistics);
  void Upload(int slot, const ColorTiles::Tile& tile, RenderStatistics& statistics) const;
  void SetPage(std::size_t plane, const ColorTile& tile, int slot);
  void ClearPage(const Key& key); // also as the parent of other tiles
  int SlotOfParent(const Key& key) const;
  void ClearPages();
  // Column, row, slot (-1: transparent), slot of the tile that it is a part of (-2: not there).
  using Page = std::array<std::int32_t, 4>;
  Page& PageOf(std::size_t plane, const ColorTile& tile);
  void UploadPage(std::size_t plane, const ColorTile& tile, const Page& page) const;

  vtkDspaceHubWindow* Window_;
  LayerContent Content_;
  int Slots_;
  unsigned int Tiles_ = 0; // textures
  unsigned int PageTable_ = 0;
  int Chart_ = -1;                // of the page table
  std::vector<int> Compositions_; // of its planes
  std::uint64_t Calls_ = 0;
  std::map<Key, Entry> Entries_;
  std::vector<int> Free_;
  std::vector<Page> Table_; // as it is on the GPU
  // By plane, whose pages it has: of the latest call of Show().
  std::vector<std::vector<ColorTile>> Shown_;
};

} // namespace dspace

#endif
