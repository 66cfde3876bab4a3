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

// Above all that others bind: of colours, then of normals.
constexpr int FirstUnit = 16;

int TilesUnit(LayerContent content) {
  return FirstUnit + 2 * int(content);
}

int PagesUnit(LayerContent content) {
  return TilesUnit(content) + 1;
}

GLenum TypeOf(LayerContent content) {
  return content == LayerContent::Normals ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE;
}

constexpr int Side = ColorTiles::Side;
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

LayerAtlas::LayerAtlas(vtkDspaceHubWindow* window, LayerContent content, int slots)
    : Window_(window), Content_(content), Slots_(Allowed(slots)), Compositions_{0} {
  for (int slot = this->Slots_; slot-- > 0;) {
    this->Free_.push_back(slot);
  }
  glGenTextures(1, &this->Tiles_);
  BindTextureUnit(window, TilesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->Tiles_);
  while (glGetError() != GL_NO_ERROR) {
  }
  const bool normals = content == LayerContent::Normals;
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, normals ? GL_RGBA16 : GL_RGBA8, Side, Side, this->Slots_, 0,
               GL_RGBA, TypeOf(content), nullptr);
  if (glGetError() != GL_NO_ERROR) {
    glDeleteTextures(1, &this->Tiles_);
    throw Error(Error::Kind::Resource, normals ? "layers of normals" : "colour layers",
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
  BindTextureUnit(window, PagesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->PageTable_);
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
  const std::size_t tables = this->Compositions_.size() * Zooms;
  this->Table_.assign(std::size_t(Pages) * Pages * tables, Empty);
  this->Shown_.assign(this->Compositions_.size(), {});
  BindTextureUnit(this->Window_, PagesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->PageTable_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32I, Pages, Pages, int(tables), 0, GL_RGBA_INTEGER,
               GL_INT, this->Table_.data());
}

LayerAtlas::Page& LayerAtlas::PageOf(std::size_t plane, const ColorTile& tile) {
  const auto x = std::size_t(tile.column & (Pages - 1));
  const auto y = std::size_t(tile.row & (Pages - 1));
  return this->Table_[((plane * Zooms + std::size_t(tile.zoom)) * Pages + y) * Pages + x];
}

void LayerAtlas::UploadPage(std::size_t plane, const ColorTile& tile, const Page& page) const {
  BindTextureUnit(this->Window_, PagesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->PageTable_);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, int(tile.column & (Pages - 1)),
                  int(tile.row & (Pages - 1)), int(plane) * Zooms + tile.zoom, 1, 1, 1,
                  GL_RGBA_INTEGER, GL_INT, page.data());
}

int LayerAtlas::SlotOfParent(const Key& key) const {
  const ColorTile& tile = key.second;
  const auto found =
      tile.zoom == 0 ? this->Entries_.end()
                     : this->Entries_.find(
                           {key.first, {tile.chart, tile.zoom - 1, tile.column / 2, tile.row / 2}});
  return found == this->Entries_.end() ? NotThere : found->second.slot;
}

void LayerAtlas::SetPage(std::size_t plane, const ColorTile& tile, int slot) {
  const Page page{std::int32_t(tile.column), std::int32_t(tile.row), slot,
                  this->SlotOfParent({this->Compositions_[plane], tile})};
  Page& there = this->PageOf(plane, tile);
  if (there != page) {
    there = page;
    this->UploadPage(plane, tile, page);
  }
}

void LayerAtlas::ClearPage(const Key& key) {
  const ColorTile& tile = key.second;
  const auto found = std::find(this->Compositions_.begin(), this->Compositions_.end(), key.first);
  if (tile.chart != this->Chart_ || found == this->Compositions_.end()) {
    return;
  }
  const auto plane = std::size_t(found - this->Compositions_.begin());
  const auto holds = [this, plane](const ColorTile& other) {
    const Page& page = this->PageOf(plane, other);
    return page[0] == other.column && page[1] == other.row;
  };
  if (holds(tile)) {
    this->PageOf(plane, tile) = Empty;
    this->UploadPage(plane, tile, Empty);
  }
  for (const int k : {0, 1, 2, 3}) {
    const ColorTile part{tile.chart, tile.zoom + 1, 2 * tile.column + k % 2, 2 * tile.row + k / 2};
    if (part.zoom < Zooms && holds(part)) {
      this->PageOf(plane, part)[3] = NotThere;
      this->UploadPage(plane, part, this->PageOf(plane, part));
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
  BindTextureUnit(this->Window_, TilesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->Tiles_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, slot, Side, Side, 1, GL_RGBA,
                  TypeOf(this->Content_), tile.texels.data());
  statistics.textureBytesUploaded += tile.texels.size();
}

void LayerAtlas::Store(const Key& key, const ColorTiles::TilePointer& shown,
                       RenderStatistics& statistics) {
  Entry& entry = this->Entries_[key];
  entry.used = this->Calls_;
  entry.shown = shown;
  if (shown->texels.empty()) {
    if (entry.slot >= 0) {
      this->ClearPage(key);
      this->Free_.push_back(entry.slot);
      entry.slot = -1;
    }
    return;
  }
  if (entry.slot < 0) {
    entry.slot = this->AllocateSlot();
  }
  if (entry.slot < 0) { // no room
    this->ClearPage(key);
    this->Entries_.erase(key);
    return;
  }
  this->Upload(entry.slot, *shown, statistics);
}

bool LayerAtlas::Show(ColorTiles& tiles, const std::vector<LayerChoice>& planes,
                      const std::vector<ColorTile>& wanted, const std::optional<double>& wait,
                      RenderStatistics& statistics) {
  ++this->Calls_;
  std::vector<int> compositions;
  for (const LayerChoice& choice : planes) {
    compositions.push_back(tiles.CompositionOf(choice));
  }
  const int chart = wanted.empty() ? this->Chart_ : wanted.front().chart;
  if (chart != this->Chart_ || compositions != this->Compositions_) {
    this->Chart_ = chart;
    this->Compositions_ = std::move(compositions);
    this->ClearPages();
  }
  const std::uint64_t revision = tiles.Stack().Revision();
  std::vector<std::vector<ColorTiles::TilePointer>> there;
  for (const int composition : this->Compositions_) {
    there.push_back(wait ? tiles.Get(wanted, *wait, composition)
                         : tiles.TryGet(wanted, composition));
    for (const ColorTile& tile : wanted) { // none of them makes room for another
      const auto found = this->Entries_.find({composition, tile});
      if (found != this->Entries_.end()) {
        found->second.used = this->Calls_;
      }
    }
  }
  bool complete = true;
  int uploads = wait ? std::numeric_limits<int>::max() : UploadsAPicture;
  for (std::size_t plane = 0; plane < there.size(); ++plane) {
    complete &= this->ShowPlane(plane, there[plane], wanted, revision, uploads, statistics);
  }
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

// `uploads`: so many more.
bool LayerAtlas::ShowPlane(std::size_t plane, const std::vector<ColorTiles::TilePointer>& there,
                           const std::vector<ColorTile>& wanted, std::uint64_t revision,
                           int& uploads, RenderStatistics& statistics) {
  const int composition = this->Compositions_[plane];
  bool complete = true;
  std::vector<ColorTile> shown;
  std::set<const Page*> taken; // two tiles may share a page: the first one is nearer
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const ColorTile& tile = wanted[i];
    const Key key(composition, tile);
    complete &= there[i] && there[i]->revision >= revision;
    auto found = this->Entries_.find(key);
    if (there[i] && (found == this->Entries_.end() || !Same(found->second.shown, there[i]))) {
      if (uploads <= 0) {
        complete = false;
      } else {
        uploads -= there[i]->texels.empty() ? 0 : 1;
        this->Store(key, there[i], statistics);
        found = this->Entries_.find(key);
      }
    }
    if (found != this->Entries_.end() && taken.insert(&this->PageOf(plane, tile)).second) {
      this->SetPage(plane, tile, found->second.slot);
      shown.push_back(tile);
    }
  }
  // What was wanted earlier is not shown: a picture hangs on its own view alone.
  for (const ColorTile& tile : this->Shown_[plane]) {
    if (taken.count(&this->PageOf(plane, tile)) == 0) {
      this->ClearPage({composition, tile});
    }
  }
  this->Shown_[plane] = std::move(shown);
  return complete;
}

void LayerAtlas::Bind(vtkShaderProgram* program) const {
  BindTextureUnit(this->Window_, TilesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->Tiles_);
  const bool normals = this->Content_ == LayerContent::Normals;
  program->SetUniformi(normals ? "normalsTiles" : "layerTiles", TilesUnit(this->Content_));
  BindTextureUnit(this->Window_, PagesUnit(this->Content_), GL_TEXTURE_2D_ARRAY, this->PageTable_);
  program->SetUniformi(normals ? "normalsPages" : "layerPages", PagesUnit(this->Content_));
}

} // namespace dspace
