// UTF-8 and the way into it, against texts whose bytes are written out.
#include <dspace/Utf8.h>

#include <string>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>

using namespace dspace;

TEST(Utf8, IsKnownFromOtherBytes) {
  for (const char* good : {"", "plain", "M\xC3\xA4st", "\xE2\x82\xAC", "\xF0\x9F\x9A\x80",
                           "\xED\x9F\xBF", "\xEE\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(IsUtf8(good)) << good;
    EXPECT_EQ(ToUtf8(good), good);
  }
  // Latin-1; cut; a byte that only goes on; overlong; surrogates; beyond U+10FFFF.
  for (const char* bad : {"M\xE4st", "M\xC3", "\xE2\x82", "\xBF", "\xC0\xAF", "\xE0\x80\xAF",
                          "\xED\xA0\x80", "\xED\xBF\xBF", "\xF0\x80\x80\xAF", "\xF4\x90\x80\x80",
                          "\xF8\x88\x80\x80\x80", "\xFF", "eight by\xE4te"}) {
    EXPECT_FALSE(IsUtf8(bad));
    EXPECT_TRUE(IsUtf8(ToUtf8(bad)));
  }
  EXPECT_TRUE(IsUtf8(std::string("a\0b", 3)));
}

TEST(Utf8, TakesOtherBytesAsWindows1252) {
  EXPECT_EQ(ToUtf8("M\xE4st \xFF"), "M\xC3\xA4st \xC3\xBF");
  EXPECT_EQ(ToUtf8("3 \x80 \x96 \x9F"), "3 \xE2\x82\xAC \xE2\x80\x93 \xC5\xB8"); // euro, dash, Y
  EXPECT_EQ(ToUtf8("\x81"), "\xEF\xBF\xBD");                       // open in Windows-1252
  EXPECT_EQ(ToUtf8("\xC3\xA4 and \xE4"), "\xC3\xA4 and \xC3\xA4"); // what is UTF-8 stays
  EXPECT_EQ(ToUtf8(std::string("a\0\xE4", 3)), std::string("a\0\xC3\xA4", 4));
  // Every byte alone, behind texts of every length up to two words of eight bytes.
  for (std::size_t before = 0; before < 17; ++before) {
    for (int byte = 0x80; byte < 0x100; ++byte) {
      const std::string text = std::string(before, 'x') + char(byte) + "y";
      const std::string made = ToUtf8(text);
      EXPECT_TRUE(IsUtf8(made)) << byte;
      EXPECT_EQ(made.substr(0, before), std::string(before, 'x'));
      EXPECT_EQ(made.back(), 'y');
      EXPECT_EQ(ToUtf8(made), made);
    }
  }
}

TEST(Utf8, IsNotCutWithinACharacter) {
  const std::string text = "a\xC3\xA4\xE2\x82\xAC";
  const char* const beginnings[] = {"", "a", "a", "a\xC3\xA4", "a\xC3\xA4", "a\xC3\xA4"};
  for (std::size_t bytes = 0; bytes < 6; ++bytes) {
    EXPECT_EQ(Utf8Beginning(text, bytes), beginnings[bytes]);
  }
  EXPECT_EQ(Utf8Beginning(text, 6), text);
  EXPECT_EQ(Utf8Beginning(text, 100), text);
}

TEST(Utf8, IsTheTextOfEveryError) {
  const Error error(Error::Kind::Corrupt, "file 'M\xE4st'", "names 'F\xFC\xDF'");
  EXPECT_EQ(std::string(error.what()), "file 'M\xC3\xA4st': names 'F\xC3\xBC\xC3\x9F'");
  EXPECT_EQ(error.GetObjectName(), "file 'M\xC3\xA4st'");
}

TEST(Utf8, IsTheTextOfEveryPath) {
  FilesReadScope scope;
  NoteFileRead("/tmp/M\xC3\xA4st.obj");
  try {
    NoteFileRead("/tmp/M\xE4st.obj");
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Unsupported);
    EXPECT_EQ(std::string(error.what()).find("file '/tmp/M\xC3\xA4st.obj': its name"), 0u);
  }
  EXPECT_EQ(scope.Files().size(), 1u);
}
