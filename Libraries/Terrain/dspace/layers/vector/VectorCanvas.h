// Shapes in texels to a block of texels: coverage by cairo, colours in linear light. Not for
// public headers.
#ifndef DSPACE_LAYERS_VECTORCANVAS_H
#define DSPACE_LAYERS_VECTORCANVAS_H

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

struct _cairo;
struct _cairo_surface;

namespace dspace {

using TexelChain = std::vector<Eigen::Vector2d>; // (0, 0) is the outer corner of the first texel

// Lines of one pen: half axes of an ellipse, upright [texels].
struct TexelStroke {
  TexelChain chain;
  Eigen::Vector2d pen = Eigen::Vector2d::Ones();
};

class VectorCanvas {
public:
  using Color = std::array<double, 4>; // sRGB and opacity

  // Throws Error(Resource) where cairo has no memory for it.
  VectorCanvas(int width, int height);
  ~VectorCanvas();

  // One over the other. Coordinates within a million texels.
  void Fill(const std::vector<TexelChain>& rings, const Color& color); // even-odd
  void Draw(const std::vector<TexelStroke>& strokes, const Color& color);
  void Disc(const Eigen::Vector2d& middle, const Eigen::Vector2d& half, const Color& color);

  // As ColorLayer::Read has it. False, and nothing written, where nothing is seen.
  bool Finish(std::uint8_t* rgba) const;

private:
  using Box = Eigen::AlignedBox2d; // [texels] outside of which nothing was covered
  struct Texels {                  // rows and columns from the first up to the second
    int left, right, top, bottom;
  };
  Texels TexelsOf(const Box& box) const;
  void Gather(const Box& box);
  void Paint(const Box& box, const Color& color);

  int Width_;
  int Height_;
  std::unique_ptr<_cairo_surface, void (*)(_cairo_surface*)> Surface_;
  std::unique_ptr<_cairo, void (*)(_cairo*)> Cairo_;
  std::vector<std::uint8_t> Cover_;         // of one shape: the most that any part of it covers
  std::vector<std::array<float, 4>> Light_; // linear, times opacity; opacity
};

} // namespace dspace

#endif
