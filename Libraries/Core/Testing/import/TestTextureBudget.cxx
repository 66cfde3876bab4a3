// The decoded bytes of a model's textures together.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/import/files/TextureBudget.h>

namespace {

TEST(TextureBudget, RejectsTheFirstImageThatIsTooMuch) {
  dspace::SetBudget("texture_bytes", 100);
  dspace::Image image;
  image.pixels.resize(50);
  dspace::TextureBudget budget;
  budget.Add(&image, "file 'a'");
  budget.Add(nullptr, "file 'a'");
  budget.Add(&image, "file 'a'"); // as many as are accepted
  image.pixels.resize(1);
  try {
    budget.Add(&image, "file 'a'");
    ADD_FAILURE() << "it was accepted";
  } catch (const dspace::Error& error) {
    EXPECT_EQ(error.GetKind(), dspace::Error::Kind::Resource);
    EXPECT_EQ(std::string(error.what()),
              "file 'a': its textures have 101 bytes or more, decoded; the limit texture_bytes is "
              "100, which dspace.limits.set raises");
  }
  using dspace::Budget;
  dspace::SetBudget("texture_bytes",
                    dspace::Budgets()[static_cast<std::size_t>(Budget::TextureBytes)].standard);
}

} // namespace
