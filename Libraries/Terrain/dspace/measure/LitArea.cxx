#include <dspace/measure/LitArea.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace dspace {
namespace {

constexpr int DiscPoints = 16;
constexpr double Grazing = 1e-9;              // cosine; the rays are along the face
constexpr double Golden = 0.6180339887498949; // the golden section

double Fraction(double x) {
  return x - std::floor(x);
}

// What a place sees of the sky.
class Outlook {
public:
  Outlook(const Obstacles& obstacles, const Eigen::Vector3d& p_R)
      : Obstacles_(obstacles), Place_(p_R),
        Touch_(Obstacles::Touch +
               64.0 * std::numeric_limits<double>::epsilon() * p_R.cwiseAbs().maxCoeff()) {
    for (const Obstacles::Ground& ground : obstacles.Grounds()) {
      Eigen::Vector3d p_S = ground.X_RS.Inverse().Apply(p_R);
      const double height = Obstacles::HeightOver(ground, p_S);
      this->Buried_ |= height < -this->Touch_;
      if (height < this->Touch_) { // not where there is no data
        p_S += (this->Touch_ - height) / ground.X_RS.scale * ground.surface->Up(p_S);
      }
      this->Starts_.push_back(p_S);
    }
  }

  bool IsBuried() const { return this->Buried_; }
  bool IsFree(const Eigen::Vector3d& direction_R) const {
    if (this->Buried_) {
      return false;
    }
    for (const Obstacles::Solid& solid : this->Obstacles_.Solids()) {
      const double t =
          solid.rays->Intersect(solid.X_MR * this->Place_, solid.X_MR.linear() * direction_R,
                                this->Touch_, std::numeric_limits<double>::max());
      if (std::isfinite(t)) {
        return false;
      }
    }
    for (std::size_t i = 0; i < this->Starts_.size(); ++i) {
      const Obstacles::Ground& ground = this->Obstacles_.Grounds()[i];
      const Eigen::Vector3d direction_S = ground.X_RS.rotation.conjugate() * direction_R;
      if (ground.surface->Intersect(this->Starts_[i], direction_S).hit) {
        return false;
      }
    }
    return true;
  }

private:
  const Obstacles& Obstacles_;
  Eigen::Vector3d Place_;
  double Touch_;                        // [m]
  std::vector<Eigen::Vector3d> Starts_; // in each ground's frame
  bool Buried_ = false;
};

// Points of equal parts of the disc.
class DiscRays {
public:
  explicit DiscRays(const SunDisc& sun)
      : Sun_(sun), Across_(sun.towards_R.unitOrthogonal()), Up_(sun.towards_R.cross(this->Across_)),
        Count_(sun.radius > 0.0 ? DiscPoints : 1) {}

  int Count() const { return this->Count_; }
  Eigen::Vector3d At(int i, double turn) const {
    if (this->Count_ == 1) {
      return this->Sun_.towards_R;
    }
    const double half = std::sin(this->Sun_.radius / 2.0);
    const double versine = 2.0 * half * half * (i + 0.5) / this->Count_; // 1 - cos, of equal parts
    const double sine = std::sqrt(versine * (2.0 - versine));
    const double angle = 2.0 * M_PI * Fraction(i * Golden + turn);
    return (1.0 - versine) * this->Sun_.towards_R +
           sine * (std::cos(angle) * this->Across_ + std::sin(angle) * this->Up_);
  }
  // Of the cosines between the rays and the centre: their mean over the disc.
  double MeanCosine() const { return (1.0 + std::cos(this->Sun_.radius)) / 2.0; }

private:
  SunDisc Sun_;
  Eigen::Vector3d Across_;
  Eigen::Vector3d Up_;
  int Count_;
};

// Adds one piece of a face, seen from the side of `normal`.
void AddPiece(const Obstacles& obstacles, const DiscRays& rays, const SunDisc& sun,
              const Eigen::Vector3d& p_R, const Eigen::Vector3d& normal, double area, double turn,
              LitArea& sum) {
  sum.area += area;
  if (normal.dot(sun.towards_R) <= -std::sin(sun.radius)) {
    return;
  }
  const Outlook outlook(obstacles, p_R);
  sum.buried += outlook.IsBuried() ? area : 0.0;
  double lit = 0.0;
  double projected = 0.0;
  for (int i = 0; i < rays.Count(); ++i) {
    const Eigen::Vector3d direction = rays.At(i, turn);
    const double cosine = normal.dot(direction);
    if (cosine > Grazing && outlook.IsFree(direction)) {
      lit += 1.0;
      projected += cosine;
    }
  }
  sum.lit += area * lit / rays.Count();
  sum.projected += area * projected / rays.Count() / rays.MeanCosine();
}

} // namespace

LitArea MeasureLitArea(const Obstacles& obstacles, const SunDisc& sun,
                       const std::vector<Face>& faces_R, bool bothSides, std::size_t samples,
                       const std::function<void(double)>& progress) {
  const auto areaOf = [](const Face& face) {
    return (face[1] - face[0]).cross(face[2] - face[0]).norm() / 2.0;
  };
  double whole = 0.0;
  for (const Face& face : faces_R) {
    whole += areaOf(face);
  }
  const DiscRays rays(sun);
  LitArea sum;
  std::size_t number = 0;
  for (const Face& face : faces_R) {
    const double area = areaOf(face);
    if (area == 0.0) {
      continue;
    }
    const Eigen::Vector3d a = face[1] - face[0];
    const Eigen::Vector3d b = face[2] - face[0];
    const Eigen::Vector3d normal = a.cross(b).normalized();
    const int side = std::max(1, int(std::ceil(std::sqrt(double(samples) * area / whole))));
    const double piece = area / side / side;
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < 2 * (side - row) - 1; ++column) {
        obstacles.Check();
        if (progress) {
          progress(sum.area / (bothSides ? 2.0 * whole : whole));
        }
        ++number;
        // Pieces stand on their bases and on their tips by turns. The points of the pieces are
        // those of Roberts' sequence R2, folded into the triangle.
        double u = Fraction(0.5 + 0.7548776662466927 * double(number));
        double v = Fraction(0.5 + 0.5698402909980532 * double(number));
        if (u + v > 1.0) {
          u = 1.0 - u;
          v = 1.0 - v;
        }
        const bool onTip = column % 2 == 1;
        const int cell = column / 2;
        const double s = (cell + (onTip ? 1.0 - u : u)) / side;
        const double t = (row + (onTip ? 1.0 - v : v)) / side;
        const Eigen::Vector3d p_R = face[0] + s * a + t * b;
        const double turn = Fraction(Golden * double(number));
        AddPiece(obstacles, rays, sun, p_R, normal, piece, turn, sum);
        if (bothSides) {
          AddPiece(obstacles, rays, sun, p_R, -normal, piece, turn, sum);
        }
      }
    }
  }
  return sum;
}

} // namespace dspace
