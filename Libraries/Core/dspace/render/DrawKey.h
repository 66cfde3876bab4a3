// What a depth picture was drawn from.
#ifndef DSPACE_RENDER_DRAW_KEY_H
#define DSPACE_RENDER_DRAW_KEY_H

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// Equal keys mean equal pictures, to the bit: a picture that is there need not be drawn again.
class DrawKey {
public:
  // A number, a truth value or a pointer that something shared below keeps from being used again.
  template<class Number> void Add(Number value) {
    static_assert(std::is_scalar_v<Number>, "structures may have bytes that mean nothing");
    this->AddBytes(&value, sizeof value);
  }
  template<class Matrix> void AddMatrix(const Matrix& matrix) {
    const auto plain = matrix.eval();
    for (Eigen::Index column = 0; column < plain.cols(); ++column) { // however it stores them
      for (Eigen::Index row = 0; row < plain.rows(); ++row) {
        this->Add(plain(row, column));
      }
    }
  }
  void AddBytes(const void* bytes, std::size_t size) {
    this->Bytes_.append(static_cast<const char*>(bytes), size);
  }
  // Data that do not change while they exist; others at the same address later are not equal.
  void AddShared(const std::shared_ptr<const void>& data) { this->Shared_.push_back(data); }

  bool operator==(const DrawKey& other) const {
    const auto same = [](const std::weak_ptr<const void>& a, const std::weak_ptr<const void>& b) {
      return !a.owner_before(b) && !b.owner_before(a);
    };
    return this->Bytes_ == other.Bytes_ && this->Shared_.size() == other.Shared_.size() &&
           std::equal(this->Shared_.begin(), this->Shared_.end(), other.Shared_.begin(), same);
  }

private:
  std::string Bytes_;
  std::vector<std::weak_ptr<const void>> Shared_;
};

} // namespace dspace

#endif
