#include <dspace/import/files/TextureBudget.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>

namespace dspace {

void TextureBudget::Add(const Image* image, const std::string& object) {
  this->Bytes_ += image ? image->pixels.size() : 0;
  if (this->Bytes_ > BudgetOf(Budget::TextureBytes)) {
    throw Error(Error::Kind::Resource, object,
                "its textures have " + std::to_string(this->Bytes_) + " bytes or more, decoded; " +
                    BudgetText(Budget::TextureBytes));
  }
}

} // namespace dspace
