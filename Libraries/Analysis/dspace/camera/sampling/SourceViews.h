// The plain views that a picture through a lens is sampled from.
#ifndef DSPACE_CAMERA_SAMPLING_SOURCE_VIEWS_H
#define DSPACE_CAMERA_SAMPLING_SOURCE_VIEWS_H

#include <tuple>
#include <vector>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// Views of a pinhole, or one of parallel rays for a lens whose rays are parallel.
// Up to 50 degrees from the axis one view covers the image; beyond, up to six views of a cube's
// faces do. Every face is a grid of square pixels as fine as the lens' image at its finest place
// (but see ScaleOf), cut into blocks. Blocks are the same for every part of the picture, so that a
// picture in tiles equals one that is drawn whole.
class SourceViews {
public:
  // A view along Z of the axes F: X right, Y down. The centre of its pixel (i, j) is at the
  // tangents left + (i + 0.5) / scale, top + (j + 0.5) / scale; of parallel rays at these metres.
  struct Face {
    Eigen::Matrix3d R_CF = Eigen::Matrix3d::Identity();
    double scale = 1.0; // pixels per tangent, or per metre
    double left = -1.0;
    double top = -1.0;
    int width = 0; // pixels
    int height = 0;
  };
  // A position on a face's grid; integers are centres. face < 0: no face has it.
  struct Place {
    int face = -1;
    double x = 0.0;
    double y = 0.0;
  };
  struct Block {
    int face = 0;
    int column = 0;
    int row = 0;
    bool operator<(const Block& other) const {
      return std::tie(this->face, this->row, this->column) <
             std::tie(other.face, other.row, other.column);
    }
  };
  // What a block shows: with a margin on all sides for filters.
  struct View {
    int x = 0; // of its first pixel on the face's grid
    int y = 0;
    int width = 0;
    int height = 0;
    double left, right, top, bottom; // tangents, or metres, of the edges
  };

  static constexpr double WidestSingle_deg = 50.0;
  static constexpr int Margin = 4; // pixels around a block; with a moving pupil MovingMargin
  static constexpr int MovingMargin = 24;

  // For a model with a size. `block`: pixels a side, without margin. Throws Error(Unsupported) for
  // a line scan, Error(InvalidArgument) where no pixel has a ray.
  SourceViews(const CameraModel& model, int block);

  // Whether the only face is seen along parallel rays, from Z = 0.
  bool Parallel() const { return this->Parallel_; }
  const std::vector<Face>& Faces() const { return this->Faces_; }
  // Where all views are taken from, in the camera's axes: the middle of the entrance pupils.
  const Eigen::Vector3d& Eye() const { return this->Eye_; }
  // The greatest distance of a pixel's entrance pupil from Eye() [m].
  double PupilShift() const { return this->PupilShift_; }
  double HalfAngle_deg() const { return this->HalfAngle_deg_; } // of the image's rays

  // Of a ray in the camera's axes: of its direction from Eye(), or of its place where rays are
  // parallel.
  Place Find(const LensRay& ray) const;
  Block BlockOf(const Place& place) const;
  View ViewOf(const Block& block) const;

private:
  void SetParallel(const CameraModel& model);
  void AddFace(Face face, const Eigen::Vector2d& far, const CameraModel& model);
  int FaceOf(const Eigen::Vector3d& direction) const;

  std::vector<Face> Faces_;
  std::vector<int> Index_; // of the six directions of a cube, in Faces_; one: the only face
  Eigen::Vector3d Eye_ = Eigen::Vector3d::Zero();
  double PupilShift_ = 0.0;
  double HalfAngle_deg_ = 0.0;
  bool Parallel_ = false;
  int Block_;
  int Margin_ = Margin;
};

} // namespace dspace

#endif
