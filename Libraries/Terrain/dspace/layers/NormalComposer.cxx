#include <dspace/layers/NormalComposer.h>

#include <dspace/layers/ColorTiles.h>

namespace dspace {
namespace {

constexpr std::size_t TileTexels = std::size_t(ColorTiles::Side) * ColorTiles::Side;

} // namespace

void NormalComposer::Add(const std::vector<std::uint8_t>& texels, double opacity) {
  if (texels.empty()) {
    return;
  }
  this->Sums_.resize(TileTexels);
  for (std::size_t i = 0; i < TileTexels; ++i) {
    this->Sums_[i].Cover(NormalTexel::Read(&texels[i * NormalTexel::Bytes]), float(opacity));
  }
}

std::vector<std::uint8_t> NormalComposer::Encode() const {
  std::vector<std::uint8_t> texels(this->Sums_.size() * NormalTexel::Bytes);
  bool any = false;
  for (std::size_t i = 0; i < this->Sums_.size(); ++i) {
    this->Sums_[i].Write(&texels[i * NormalTexel::Bytes]);
    any = any || this->Sums_[i].opacity > 0.0f;
  }
  return any ? texels : std::vector<std::uint8_t>();
}

} // namespace dspace
