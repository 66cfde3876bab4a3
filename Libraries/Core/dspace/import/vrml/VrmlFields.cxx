#include <dspace/import/vrml/VrmlFields.h>

#include <algorithm>
#include <cmath>

namespace dspace {

namespace {

double Unit(double value) {
  return std::clamp(value, 0.0, 1.0);
}

template<typename Vector, typename Field> std::vector<Vector> Copy(const Field& field) {
  std::vector<Vector> result;
  const int n = field.getNum();
  result.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    result.emplace_back(field[i].getValue());
  }
  return result;
}

} // namespace

Eigen::Vector3d ToEigen(const SbVec3f& v) {
  return {v[0], v[1], v[2]};
}

Eigen::Vector2d ToEigen(const SbVec2f& v) {
  return {v[0], v[1]};
}

Eigen::Quaterniond ToEigen(const SbRotation& r) {
  float x = 0.0f;
  float y = 0.0f;
  float z = 0.0f;
  float w = 1.0f;
  r.getValue(x, y, z, w);
  const Eigen::Quaterniond q(w, x, y, z);
  const double norm = q.norm();
  return std::isfinite(norm) && norm > 1e-6 ? q.normalized() : Eigen::Quaterniond::Identity();
}

std::array<double, 3> ToColor(const SbColor& c) {
  return {Unit(c[0]), Unit(c[1]), Unit(c[2])};
}

std::array<std::uint8_t, 4> ToBytes(const SbColor& c, double opacity) {
  const auto byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(Unit(v) * 255.0));
  };
  return {byte(c[0]), byte(c[1]), byte(c[2]), byte(opacity)};
}

std::vector<Eigen::Vector3f> ToVector(const SoMFVec3f& field) {
  return Copy<Eigen::Vector3f>(field);
}

std::vector<Eigen::Vector2f> ToVector(const SoMFVec2f& field) {
  return Copy<Eigen::Vector2f>(field);
}

std::vector<std::array<std::uint8_t, 4>> ToVector(const SoMFColor& field) {
  std::vector<std::array<std::uint8_t, 4>> result;
  result.reserve(static_cast<std::size_t>(field.getNum()));
  for (int i = 0; i < field.getNum(); ++i) {
    result.push_back(ToBytes(field[i]));
  }
  return result;
}

std::vector<int> ToVector(const SoMFInt32& field) {
  const int n = field.getNum();
  return n > 0 ? std::vector<int>(field.getValues(0), field.getValues(0) + n) : std::vector<int>();
}

std::vector<std::string> ToVector(const SoMFString& field) {
  std::vector<std::string> result;
  result.reserve(static_cast<std::size_t>(field.getNum()));
  for (int i = 0; i < field.getNum(); ++i) {
    result.emplace_back(field[i].getString());
  }
  return result;
}

std::shared_ptr<const Image> ToImage(const SoSFImage& field, const std::string& name) {
  SbVec2s size(0, 0);
  int channels = 0;
  const unsigned char* pixels = field.getValue(size, channels);
  if (!pixels || size[0] <= 0 || size[1] <= 0 || channels < 1 || channels > 4) {
    return nullptr;
  }
  auto image = std::make_shared<Image>();
  image->name = name;
  image->width = size[0];
  image->height = size[1];
  image->channels = channels;
  const std::size_t row = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(channels);
  for (int y = size[1] - 1; y >= 0; --y) {
    const unsigned char* begin = pixels + static_cast<std::size_t>(y) * row;
    image->pixels.insert(image->pixels.end(), begin, begin + row);
  }
  return image;
}

Eigen::Affine3d VrmlTransform(const SbVec3f& translation, const SbVec3f& center,
                              const SbRotation& rotation, const SbVec3f& scale,
                              const SbRotation& scaleOrientation) {
  const Eigen::Quaterniond orientation = ToEigen(scaleOrientation);
  Eigen::Affine3d m = Eigen::Affine3d::Identity();
  m.translate(ToEigen(translation));
  m.translate(ToEigen(center));
  m.rotate(ToEigen(rotation));
  m.rotate(orientation);
  m.scale(ToEigen(scale));
  m.rotate(orientation.conjugate());
  m.translate(-ToEigen(center));
  return m;
}

double RoughnessOf(double shininess) {
  return std::sqrt(2.0 / (128.0 * Unit(shininess) + 2.0));
}

} // namespace dspace
