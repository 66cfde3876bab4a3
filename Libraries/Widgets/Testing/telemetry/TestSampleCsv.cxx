// Tables of samples are RFC 4180's, hold each number exactly, and appear as a whole or not at all.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <QTemporaryDir>

#include "FullDisk.h"

#include <dspace/Error.h>
#include <dspace/widgets/telemetry/SampleCsv.h>

using dspace::widgets::CsvColumn;
using dspace::widgets::SampleSeries;
using dspace::widgets::WriteCsv;

namespace {

const double CsvNaN = std::numeric_limits<double>::quiet_NaN();
const double Infinity = std::numeric_limits<double>::infinity();

std::string Content(const std::string& path) {
  std::ostringstream all;
  all << std::ifstream(path, std::ios::binary).rdbuf();
  return all.str();
}

// RFC 4180, section 2, rules 1 to 7.
std::vector<std::vector<std::string>> Parse(const std::string& text) {
  std::vector<std::vector<std::string>> lines(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      lines.back().back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (quoted) {
      lines.back().back() += c;
    } else if (c == ',') {
      lines.back().emplace_back();
    } else if (c == '\r' && i + 1 < text.size() && text[i + 1] == '\n') {
      lines.emplace_back(1);
      ++i;
    } else {
      lines.back().back() += c;
    }
  }
  EXPECT_EQ(lines.back(), std::vector<std::string>(1)); // the last line ends, too
  lines.pop_back();
  return lines;
}

struct TestSampleCsv : ::testing::Test {
  QTemporaryDir folder;
  std::string path = folder.filePath("table.csv").toStdString();
};

} // namespace

TEST_F(TestSampleCsv, ALineForEachTimeAndQuotesAroundWhatNeedsThem) {
  CsvColumn torque{"wheel \"fl\", torque [N.m]", {}};
  CsvColumn state{"state", {}};
  torque.samples.Append(-1.0, 99.0); // before the interval
  torque.samples.Append(0.0, 0.1);
  torque.samples.Append(1.0, CsvNaN);
  torque.samples.Append(2.0, -3e-7);
  torque.samples.Append(2.0, 5.0); // a second one at that time
  state.samples.Append(0.5, 1.0);
  state.samples.Append(2.0, 2.0);
  state.samples.Append(9.0, 99.0);
  ASSERT_TRUE(WriteCsv(path, {torque, state}, 0.0, 5.0));
  EXPECT_EQ(Content(path), "time [s],\"wheel \"\"fl\"\", torque [N.m]\",state\r\n"
                           "0,0.1,\r\n"
                           "0.5,,1\r\n"
                           "1,nan,\r\n"
                           "2,-3e-07,2\r\n"
                           "2,5,\r\n");
}

TEST_F(TestSampleCsv, EveryNumberIsReadBackToItsLastBit) {
  std::mt19937_64 random(3);
  SampleSeries samples;
  std::vector<double> times;
  std::vector<double> values;
  double time_s = 8.1e8;
  for (int i = 0; i < 20000; ++i) {
    time_s += 1e-4 * (double(random() >> 11) / 9007199254740992.0);
    const double value =
        std::ldexp(double(std::int64_t(random())), int(random() % 1900) - 1000 - 60);
    samples.Append(time_s, value);
    times.push_back(time_s);
    values.push_back(value);
  }
  ASSERT_TRUE(WriteCsv(path, {{"x", samples}}, -Infinity, Infinity));
  const auto lines = Parse(Content(path));
  ASSERT_EQ(lines.size(), times.size() + 1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    ASSERT_EQ(lines[i + 1].size(), 2u);
    ASSERT_EQ(std::strtod(lines[i + 1][0].c_str(), nullptr), times[i]);
    ASSERT_EQ(std::strtod(lines[i + 1][1].c_str(), nullptr), values[i]);
  }
}

TEST_F(TestSampleCsv, AFullDiskOrACancelLeavesTheOldTable) {
  std::ofstream(path) << "old";
  CsvColumn column{"x", {}};
  for (int i = 0; i < 20000; ++i) {
    column.samples.Append(i, 0.1 * i);
  }
  {
    const dspace::testing::FullDisk full(100000);
    try {
      WriteCsv(path, {column}, -Infinity, Infinity);
      ADD_FAILURE() << "it was written";
    } catch (const dspace::Error& error) {
      EXPECT_EQ(error.GetKind(), dspace::Error::Kind::Io);
      EXPECT_NE(std::string(error.what()).find("table.csv"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(Content(path), "old");
  int asked = 0;
  EXPECT_FALSE(WriteCsv(path, {column}, -Infinity, Infinity, [&] { return ++asked == 2; }));
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(Content(path), "old");
  EXPECT_EQ(QDir(folder.path()).entryList(QDir::Files | QDir::Hidden).size(), 1);
}
