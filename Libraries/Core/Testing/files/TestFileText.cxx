// Texts of files in several encodings, against their bytes as UTF-8 written out.
#include <dspace/FileText.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

using dspace::DeclaredEncoding;
using dspace::ForeignTextScope;
using dspace::ToFileText;

TEST(FileText, IsReadInTheEncodingThatItDeclares) {
  const ForeignTextScope scope;
  EXPECT_EQ(ToFileText("plain", "file 'a'"), "plain");
  EXPECT_EQ(ToFileText("M\xC3\xA4st", "file 'a'", "ISO-8859-2"), "M\xC3\xA4st"); // UTF-8 it is
  EXPECT_EQ(ToFileText("M\xE4st", "file 'a'", "ISO-8859-1"), "M\xC3\xA4st");
  EXPECT_EQ(ToFileText("5 \x80", "file 'a'", "iso-8859-1"), "5 \xE2\x82\xAC"); // a euro, as in 1252
  EXPECT_EQ(ToFileText("\xB1\xEA", "file 'a'", "ISO-8859-2"), "\xC4\x85\xC4\x99");   // Polish
  EXPECT_EQ(ToFileText("\xCD\xE0", "file 'a'", "windows-1251"), "\xD0\x9D\xD0\xB0"); // Russian
  EXPECT_EQ(ToFileText("\x93\xFA\x96\x7B", "file 'a'", "Shift_JIS"), "\xE6\x97\xA5\xE6\x9C\xAC");
  EXPECT_TRUE(scope.Warnings().empty());
}

TEST(FileText, IsWindows1252OtherwiseAndSaysSo) {
  const ForeignTextScope outer;
  {
    const ForeignTextScope scope;
    EXPECT_EQ(ToFileText("M\xE4st", "file 'a'"), "M\xC3\xA4st");
    EXPECT_EQ(ToFileText("M\xE4st", "file 'a'", "UTF-8"), "M\xC3\xA4st"); // which it is not
    EXPECT_EQ(ToFileText("M\xE4st", "file 'b'", "no such encoding"), "M\xC3\xA4st");
    EXPECT_EQ(ToFileText("M\xE4st", "file 'c'", std::string(10000, 'x')), "M\xC3\xA4st");
    EXPECT_EQ(ToFileText("\x93", "file 'd'", "Shift_JIS"), "\xE2\x80\x9C"); // half a letter there
    const std::vector<std::string> warnings = scope.Warnings();
    ASSERT_EQ(warnings.size(), 4u); // one a file
    EXPECT_NE(warnings[0].find("file 'a': its text is not UTF-8"), std::string::npos);
    EXPECT_NE(warnings[0].find("Windows-1252"), std::string::npos);
  }
  EXPECT_EQ(outer.Warnings().size(), 4u);
  EXPECT_EQ(ToFileText("M\xE4st", "file 'e'"), "M\xC3\xA4st");
  EXPECT_EQ(outer.Warnings().size(), 5u);
}

TEST(FileText, DeclaresItsEncodingInXml) {
  EXPECT_EQ(DeclaredEncoding("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a/>"), "ISO-8859-1");
  EXPECT_EQ(DeclaredEncoding("<?xml version='1.0' encoding = 'x' standalone='yes'?>"), "x");
  EXPECT_EQ(DeclaredEncoding("\xEF\xBB\xBF<?xml version='1.0' encoding='UTF-8'?>"), "UTF-8");
  for (const char* none :
       {"", "<a/>", "<?xml version='1.0'?>", "<?xml encoding='x", "<?xml encoding",
        "<?xml encoding=x?>", "<a><?xml encoding='x'?></a>", "<?xml encoding='?>"}) {
    EXPECT_EQ(DeclaredEncoding(none), "") << none;
  }
}

} // namespace
