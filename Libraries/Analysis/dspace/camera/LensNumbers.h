// Takes the numbers of a lens one by one, and rejects what is wrong or left.
#ifndef DSPACE_CAMERA_LENS_NUMBERS_H
#define DSPACE_CAMERA_LENS_NUMBERS_H

#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/camera/LensModel.h>

namespace dspace {

class LensNumbers {
public:
  // `label` names the model in errors.
  LensNumbers(const LensValues& values, const std::string& label);

  const std::string& Label() const { return this->Label_; }
  double One(const std::string& name);
  Eigen::Vector2d Two(const std::string& name);
  Eigen::Vector3d Three(const std::string& name);
  // `least` to `most` numbers, followed by zeros up to `most`; none: zeros.
  std::vector<double> UpTo(const std::string& name, std::size_t least, std::size_t most);
  // Rows of `columns` numbers each, `least` to `most` rows.
  std::vector<double> Rows(const std::string& name, std::size_t columns, std::size_t least,
                           std::size_t most);
  std::vector<double> Exactly(const std::string& name, std::size_t count);
  // Throws Error(InvalidArgument) where a number was not taken.
  void Finish() const;

private:
  const LensValues& Values_;
  std::string Label_;
  std::set<std::string> Taken_;
};

// Focal lengths in pixels: positive.
Eigen::Vector2d TakeFocal(LensNumbers& numbers);

// What Scaled() returns for a lens whose size in pixels is in its numbers `focal` and `center`.
LensPtr ScaledByFocal(const LensModel& lens, double x, double y);

} // namespace dspace

#endif
