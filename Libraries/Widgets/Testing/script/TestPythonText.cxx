// Values as Python writes them.
#include <dspace/widgets/script/PythonText.h>

#include <limits>

#include <gtest/gtest.h>

using dspace::widgets::PythonOf;
using dspace::widgets::Quoted;

TEST(PythonText, IsWhatPythonReads) {
  EXPECT_EQ(Quoted("a \"b\" \\ c\nd").toStdString(), R"("a \"b\" \\ c\nd")");
  EXPECT_EQ(PythonOf(0.1).toStdString(), "0.1"); // the shortest
  EXPECT_EQ(PythonOf(29 / 100.0).toStdString(), "0.29");
  EXPECT_EQ(PythonOf(std::numeric_limits<double>::infinity()).toStdString(), "float(\"inf\")");
  EXPECT_EQ(PythonOf(true).toStdString(), "True");
}
