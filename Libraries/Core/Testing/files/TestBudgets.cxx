// Limits by name: what is accepted, and what an error says.
#include <dspace/Budgets.h>
#include <dspace/Error.h>

#include <gtest/gtest.h>

namespace dspace {
namespace {

TEST(Budgets, HaveTheirStandardValuesInTheirRanges) {
  ASSERT_GE(Budgets().size(), 5u);
  for (std::size_t i = 0; i < Budgets().size(); ++i) {
    const BudgetInfo& info = Budgets()[i];
    EXPECT_EQ(static_cast<std::size_t>(info.budget), i) << info.name; // the order is the index
    EXPECT_EQ(BudgetOf(info.budget), info.standard) << info.name;
    EXPECT_GE(info.standard, info.least) << info.name;
    EXPECT_LE(info.standard, info.most) << info.name;
  }
  EXPECT_EQ(BudgetOf(Budget::ImagePixels), 134217728u); // 16,384 x 8,192
}

TEST(Budgets, AreSetByName) {
  const std::uint64_t before = BudgetOf(Budget::BlockBytes);
  SetBudget("block_bytes", 12345);
  EXPECT_EQ(BudgetOf(Budget::BlockBytes), 12345u);
  EXPECT_EQ(BudgetText(Budget::BlockBytes),
            "the limit block_bytes is 12345, which dspace.limits.set raises");
  SetBudget("block_bytes", before);
}

TEST(Budgets, RejectWhatIsNoLimit) {
  try {
    SetBudget("pixels", 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "limit 'pixels': there is no such limit; accepted: image_pixels, block_bytes, "
              "message_elements, import_memory, import_seconds, raster_pixels, mosaic_files, "
              "mosaic_bytes, open_memory, texture_bytes, open_seconds");
  }
  try {
    SetBudget("import_seconds", 0);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "limit 'import_seconds': is 0; accepted: 1 to 1000000");
  }
  EXPECT_EQ(BudgetOf(Budget::ImportSeconds), 300u);
}

} // namespace
} // namespace dspace
