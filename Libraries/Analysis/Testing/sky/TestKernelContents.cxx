// What text kernels contain, in words. Real ones:
// Testing/Python/command_line/test_kernels_command.py.
#include <gtest/gtest.h>

#include <dspace/sky/KernelContents.h>

namespace dspace {
namespace {

KernelContent Of(const std::string& text) {
  return ContentOf(TextKernel::Parse(text, "a.tk"), BodyNames());
}

TEST(KernelContents, ListsWhatIsAssigned) {
  const KernelContent found =
      Of("KPL/PCK\n\\begindata\nBODY499_RADII = (3396.19 3396.19 3376.20)\n"
         "BODY301_PM = (38.3 13.2 0)\nBODY10_PM = (84.2 14.2 0)\nBODY399_GM = (398600.4)\n"
         "NAIF_BODY_NAME = ('ONE', 'TWO')\nNAIF_BODY_CODE = (-1001, -1002)\n"
         "INS-82360_BORESIGHT = (0 0 1)\nSCLK_DATA_TYPE_82 = (1)\nBODYX_PM = (1 2 3)\n");
  EXPECT_EQ(found.file, "a.tk");
  EXPECT_EQ(found.kind, "PCK");
  EXPECT_EQ(found.variables, 9);
  EXPECT_EQ(found.items,
            (std::vector<std::string>{"radii of MARS", "orientation of SUN, MOON", "GM of EARTH",
                                      "names of 2 bodies", "fields of view of instruments -82360",
                                      "clocks -82"}));
}

TEST(KernelContents, CountsAVariableOnceAndKeepsDamagedLeapSecondsInWords) {
  EXPECT_EQ(Of("\\begindata\nA = 1\nA += 2\n").variables, 1);
  EXPECT_TRUE(Of("\\begindata\nA = 1\n").items.empty());
  // The rest of DELTET is in another file.
  EXPECT_EQ(Of("\\begindata\nDELTET/DELTA_AT = (10, @1972-JAN-1)\n").items,
            std::vector<std::string>{"leap seconds"});
  EXPECT_EQ(Of("\\begindata\nKERNELS_TO_LOAD = ('a', 'b')\n").items,
            std::vector<std::string>{"names 2 kernels to load"});
}

} // namespace
} // namespace dspace
