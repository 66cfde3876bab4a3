#include <dspace/clipmap/gl/LayerAtlas.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkShaderProgram.h"

#include <dspace/Error.h>
#include <dspace/render/Capture.h>
#include <dspace/render/SurfaceShaders.h>

namespace dspace {
namespace {

// Above all that others bind.
constexpr int TilesUnit = 16;
constexpr int PagesUnit = 17;

constexpr int Side = ColorTiles::Side;
constexpr int Zooms = ColorGrid::MaximumZoom + 1;
constexpr int UploadsAPicture = 24; // of an interactive one: 6 MB

constexpr std::int32_t Nowhere = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t NotThere = -2;
constexpr std::array<std::int32_t, 4> Empty = {Nowhere, Nowhere, -1, NotThere};

bool Same(const std::weak_ptr<const ColorTiles::Tile>& a, const ColorTiles::TilePointer& b) {
  return !a.owner_before(b) && !b.owner_before(a);
}

// OpenGL guarantees 256 layers, and most drivers have 2048.
int Allowed(int slots) {
  GLint most = 256;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  return std::clamp(slots, 16, std::min(int(most), 1024));
}

} // namespace

LayerAtlas::LayerAtlas(vtkDspaceHubWindow* window, int slots)
    : Window_(window), Slots_(Allowed(slots)), Table_(std::size_t(Pages) * Pages * Zooms) {
  for (int slot = this->Slots_; slot-- > 0;) {
    this->Free_.push_back(slot);
  }
  glGenTextures(1, &this->Tiles_);
  BindTextureUnit(window, TilesUnit, GL_TEXTURE_2D_ARRAY, this->Tiles_);
  while (glGetError() != GL_NO_ERROR) {
  }
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, Side, Side, this->Slots_, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, nullptr);
  if (glGetError() != GL_NO_ERROR) {
    glDeleteTextures(1, &this->Tiles_);
    throw Error(Error::Kind::Resource, "colour layers",
                "the graphics driver has no room for " + std::to_string(this->Slots_) +
                    " tiles; a smaller viewport needs fewer");
  }
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_LINEAR);
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, wrap, GL_CLAMP_TO_EDGE);
  }
  glGenTextures(1, &this->PageTable_);
  BindTextureUnit(window, PagesUnit, GL_TEXTURE_2D_ARRAY, this->PageTable_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  }
  this->ClearPages();
}

LayerAtlas::~LayerAtlas() {
  glDeleteTextures(1, &this->Tiles_);
  glDeleteTextures(1, &this->PageTable_);
}

void LayerAtlas::ClearPages() {
  std::fill(this->Table_.begin(), this->Table_.end(), Empty);
  BindTextureUnit(this->Window_, PagesUnit, GL_TEXTURE_2D_ARRAY, this->PageTable_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32I, Pages, Pages, Zooms, 0, GL_RGBA_INTEGER, GL_INT,
               this->Table_.data());
}

LayerAtlas::Page& LayerAtlas::PageOf(const ColorTile& tile) {
  const auto x = std::size_t(tile.column & (Pages - 1));
  const auto y = std::size_t(tile.row & (Pages - 1));
  return this->Table_[(std::size_t(tile.zoom) * Pages + y) * Pages + x];
}

void LayerAtlas::UploadPage(const ColorTile& tile, const Page& page) const {
  BindTextureUnit(this->Window_, PagesUnit, GL_TEXTURE_2D_ARRAY, this->PageTable_);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, int(tile.column & (Pages - 1)),
                  int(tile.row & (Pages - 1)), tile.zoom, 1, 1, 1, GL_RGBA_INTEGER, GL_INT,
                  page.data());
}

int LayerAtlas::SlotOfParent(const ColorTile& tile) const {
  const auto found =
      tile.zoom == 0
          ? this->Entries_.end()
          : this->Entries_.find({tile.chart, tile.zoom - 1, tile.column / 2, tile.row / 2});
  return found == this->Entries_.end() ? NotThere : found->second.slot;
}

void LayerAtlas::SetPage(const ColorTile& tile, int slot) {
  const Page page{std::int32_t(tile.column), std::int32_t(tile.row), slot,
                  this->SlotOfParent(tile)};
  Page& there = this->PageOf(tile);
  if (there != page) {
    there = page;
    this->UploadPage(tile, page);
  }
}

void LayerAtlas::ClearPage(const ColorTile& tile) {
  if (tile.chart != this->Chart_) {
    return;
  }
  const auto holds = [this](const ColorTile& other) {
    const Page& page = this->PageOf(other);
    return page[0] == other.column && page[1] == other.row;
  };
  if (holds(tile)) {
    this->PageOf(tile) = Empty;
    this->UploadPage(tile, Empty);
  }
  for (const int k : {0, 1, 2, 3}) {
    const ColorTile part{tile.chart, tile.zoom + 1, 2 * tile.column + k % 2, 2 * tile.row + k / 2};
    if (part.zoom < Zooms && holds(part)) {
      this->PageOf(part)[3] = NotThere;
      this->UploadPage(part, this->PageOf(part));
    }
  }
}

// Of the tile whose last use is longest ago, unless that is now.
int LayerAtlas::AllocateSlot() {
  if (this->Free_.empty()) {
    auto oldest = this->Entries_.end();
    for (auto it = this->Entries_.begin(); it != this->Entries_.end(); ++it) {
      if (it->second.slot >= 0 && it->second.used != this->Calls_ &&
          (oldest == this->Entries_.end() || it->second.used < oldest->second.used)) {
        oldest = it;
      }
    }
    if (oldest == this->Entries_.end()) {
      return -1;
    }
    this->ClearPage(oldest->first);
    this->Free_.push_back(oldest->second.slot);
    this->Entries_.erase(oldest);
  }
  const int slot = this->Free_.back();
  this->Free_.pop_back();
  return slot;
}

void LayerAtlas::Upload(int slot, const ColorTiles::Tile& tile,
                        RenderStatistics& statistics) const {
  BindTextureUnit(this->Window_, TilesUnit, GL_TEXTURE_2D_ARRAY, this->Tiles_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, slot, Side, Side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                  tile.texels.data());
  statistics.textureBytesUploaded += tile.texels.size();
}

void LayerAtlas::Store(const ColorTile& tile, const ColorTiles::TilePointer& shown,
                       RenderStatistics& statistics) {
  Entry& entry = this->Entries_[tile];
  entry.used = this->Calls_;
  entry.shown = shown;
  if (shown->texels.empty()) {
    if (entry.slot >= 0) {
      this->ClearPage(tile);
      this->Free_.push_back(entry.slot);
      entry.slot = -1;
    }
    return;
  }
  if (entry.slot < 0) {
    entry.slot = this->AllocateSlot();
  }
  if (entry.slot < 0) { // no room
    this->ClearPage(tile);
    this->Entries_.erase(tile);
    return;
  }
  this->Upload(entry.slot, *shown, statistics);
}

bool LayerAtlas::Show(ColorTiles& tiles, const std::vector<ColorTile>& wanted,
                      const std::optional<double>& wait, RenderStatistics& statistics) {
  ++this->Calls_;
  if (!wanted.empty() && wanted.front().chart != this->Chart_) {
    this->Chart_ = wanted.front().chart;
    this->ClearPages();
  }
  const std::uint64_t revision = tiles.Stack().Revision();
  const std::vector<ColorTiles::TilePointer> there =
      wait ? tiles.Get(wanted, *wait) : tiles.TryGet(wanted);
  for (const ColorTile& tile : wanted) { // none of them makes room for another
    const auto found = this->Entries_.find(tile);
    if (found != this->Entries_.end()) {
      found->second.used = this->Calls_;
    }
  }
  bool complete = true;
  int uploads = 0;
  std::vector<ColorTile> shown;
  std::set<const Page*> taken; // two tiles may share a page: the first one is nearer
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const ColorTile& tile = wanted[i];
    complete &= there[i] && there[i]->revision >= revision;
    auto found = this->Entries_.find(tile);
    if (there[i] && (found == this->Entries_.end() || !Same(found->second.shown, there[i]))) {
      if (!wait && uploads >= UploadsAPicture) {
        complete = false;
      } else {
        uploads += there[i]->texels.empty() ? 0 : 1;
        this->Store(tile, there[i], statistics);
        found = this->Entries_.find(tile);
      }
    }
    if (found != this->Entries_.end() && taken.insert(&this->PageOf(tile)).second) {
      this->SetPage(tile, found->second.slot);
      shown.push_back(tile);
    }
  }
  // What was wanted earlier is not shown: a picture hangs on its own view alone.
  for (const ColorTile& tile : this->Shown_) {
    if (tile.chart == this->Chart_ && taken.count(&this->PageOf(tile)) == 0) {
      this->ClearPage(tile);
    }
  }
  this->Shown_ = std::move(shown);
  // Transparent ones take no slot: they are forgotten when they are many.
  for (auto it = this->Entries_.begin();
       this->Entries_.size() > 4096 && it != this->Entries_.end();) {
    const bool old = it->second.slot < 0 && it->second.used != this->Calls_;
    if (old) {
      this->ClearPage(it->first);
    }
    it = old ? this->Entries_.erase(it) : std::next(it);
  }
  return complete;
}

void LayerAtlas::Bind(vtkShaderProgram* program) const {
  BindTextureUnit(this->Window_, TilesUnit, GL_TEXTURE_2D_ARRAY, this->Tiles_);
  program->SetUniformi("layerTiles", TilesUnit);
  BindTextureUnit(this->Window_, PagesUnit, GL_TEXTURE_2D_ARRAY, this->PageTable_);
  program->SetUniformi("layerPages", PagesUnit);
}

} // namespace dspace
