#include <dspace/camera/sampling/LensMap.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace dspace {

LensMap::LensMap(const SourceViews& views, const LensModel& lens, int x, int y, int width,
                 int height)
    : Width_(width), Height_(height), Moves_(lens.MovesPupil() && !views.Parallel()),
      Pixels_(std::size_t(width) * std::size_t(height)) {
  constexpr double Distance = 1e3;     // where the lens' scale is taken [m]
  std::vector<Sample>* last = nullptr; // of the block that the pixel before is in
  SourceViews::Block lastBlock;
  SourceViews::View lastView = {};
  for (std::size_t at = 0; at < this->Pixels_.size(); ++at) {
    Pixel& pixel = this->Pixels_[at];
    const Eigen::Vector2d position(x + int(at % std::size_t(width)),
                                   y + int(at / std::size_t(width)));
    if (lens.Unproject(position, pixel.ray)) {
      pixel.place = views.Find(pixel.ray);
    }
    if (pixel.place.face < 0) {
      ++this->WithoutRay_;
      continue;
    }
    const SourceViews::Block block = views.BlockOf(pixel.place);
    if (!last || block < lastBlock || lastBlock < block) {
      last = &this->Blocks_[block];
      lastBlock = block;
      lastView = views.ViewOf(block);
    }
    const SourceViews::Face& face = views.Faces()[std::size_t(pixel.place.face)];
    Eigen::Vector2d back;
    LensModel::Jacobian jacobian;
    if (lens.Project(pixel.ray.origin + Distance * pixel.ray.direction, back, &jacobian)) {
      const double z = face.R_CF.col(2).dot(pixel.ray.direction);
      // The direction at Z = 1 of the face is 1 / z long: pixels per tangent there, or per metre.
      const Eigen::Matrix2d across =
          jacobian * face.R_CF.leftCols<2>() * (views.Parallel() ? 1.0 : Distance * z);
      const double area = std::abs(across.determinant());
      pixel.footprint =
          float(face.scale / std::sqrt(std::max(area, views.Parallel() ? 1e-300 : 1e-12)));
    }
    last->push_back({std::uint32_t(at), float(pixel.place.x - lastView.x),
                     float(pixel.place.y - lastView.y), pixel.footprint});
  }
}

std::size_t LensMap::Bytes() const {
  return this->Pixels_.size() * (sizeof(Pixel) + sizeof(Sample));
}

} // namespace dspace
