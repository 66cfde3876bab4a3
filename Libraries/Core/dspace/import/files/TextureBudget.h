// Counts the decoded bytes of the textures of one model.
#pragma once

#include <cstdint>
#include <string>

#include <dspace/import/model/Model.h>

namespace dspace {

class TextureBudget {
public:
  // Once for each image; null counts nothing. Throws Error(Resource) that names `object` and
  // Budget::TextureBytes (Budgets.h) where all of them have more.
  void Add(const Image* image, const std::string& object);

private:
  std::uint64_t Bytes_ = 0;
};

} // namespace dspace
