// The fonts' files are TrueType fonts, and errors name them.
#include <dspace/letters/FontFiles.h>

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <dspace/Error.h>

using namespace dspace;

TEST(FontFiles, AreTrueTypeFontsOrNamedInTheError) {
  EXPECT_STRNE(FontFile(Font::Sans), FontFile(Font::Mono));
  for (const Font font : {Font::Sans, Font::Mono}) {
    std::ifstream file(FontFile(font), std::ios::binary);
    char head[4] = {};
    file.read(head, 4);
    EXPECT_EQ(std::string(head, 4), std::string("\0\1\0\0", 4)) << FontFile(font);
    try {
      RejectFont(font);
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
      EXPECT_NE(std::string(error.what()).find(FontFile(font)), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("fonts-dejavu-core"), std::string::npos);
    }
  }
}
