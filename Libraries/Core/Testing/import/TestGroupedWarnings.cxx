// Warnings of one kind are one text.
#include <dspace/import/files/GroupedWarnings.h>

#include <gtest/gtest.h>

using namespace dspace;

TEST(GroupedWarnings, AreOneTextAKind) {
  GroupedWarnings warnings;
  EXPECT_TRUE(warnings.Empty());
  EXPECT_TRUE(warnings.Texts().empty());
  for (const char* name : {"'a'", "'b'", "'c'", "'d'", "'e'", "'f'", "'g'"}) {
    warnings.Add("holes are filled", std::string("mesh ") + name);
  }
  warnings.Add("names are changed", "link 'x'");
  warnings.Add("holes are filled", "mesh 'h'");
  EXPECT_FALSE(warnings.Empty());
  EXPECT_EQ(warnings.Texts(),
            (std::vector<std::string>{"holes are filled: mesh 'a', mesh 'b', mesh 'c', mesh 'd', "
                                      "mesh 'e' and 3 more",
                                      "names are changed: link 'x'"}));
}
