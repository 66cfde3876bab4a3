// Samples in the order of time, and what columns of pixels show of them, against a search through
// all samples.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <dspace/Error.h>
#include <dspace/widgets/telemetry/SampleSeries.h>

using dspace::widgets::SampleColumn;
using dspace::widgets::SampleExtent;
using dspace::widgets::SampleSeries;

namespace {

const double SeriesNaN = std::numeric_limits<double>::quiet_NaN();

void ExpectSame(double a, double b, const std::string& what) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << what << ": " << a << ", not " << b;
}

// The samples one by one.
struct Reference {
  std::vector<double> times;
  std::vector<double> values;

  void Check(const SampleColumn& column, const std::vector<std::size_t>& samples,
             const std::string& what) const {
    ASSERT_EQ(column.end - column.begin, samples.size()) << what;
    if (samples.empty()) {
      ExpectSame(column.first, SeriesNaN, what + " first");
      ExpectSame(column.last, SeriesNaN, what + " last");
      ExpectSame(column.extent.min, SeriesNaN, what + " min");
      ExpectSame(column.extent.max, SeriesNaN, what + " max");
      return;
    }
    EXPECT_EQ(column.begin, samples.front()) << what;
    double min = std::numeric_limits<double>::infinity();
    double max = -min;
    for (const std::size_t i : samples) {
      min = std::fmin(min, values[i]);
      max = std::fmax(max, values[i]);
    }
    ExpectSame(column.extent.min, std::isinf(min) ? SeriesNaN : min, what + " min");
    ExpectSame(column.extent.max, std::isinf(max) ? SeriesNaN : max, what + " max");
    ExpectSame(column.first, values[samples.front()], what + " first");
    ExpectSame(column.last, values[samples.back()], what + " last");
  }
};

std::string Rejected(SampleSeries& series, double time_s, double value) {
  try {
    series.Append(time_s, value);
  } catch (const dspace::Error& error) {
    EXPECT_EQ(error.GetKind(), dspace::Error::Kind::InvalidArgument);
    return error.what();
  }
  return "accepted";
}

} // namespace

TEST(SampleSeries, ColumnsHaveWhatASearchThroughAllSamplesFinds) {
  std::mt19937 random(1);
  for (const std::size_t size : {0, 1, 2, 15, 16, 17, 255, 256, 257, 4095, 4096, 4097, 70000}) {
    SampleSeries series;
    Reference all;
    double eighths = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      eighths += double(random() % 3); // several at one time, and pauses
      if (random() % 500 == 0) {
        eighths += 4000.0;
      }
      const double value = random() % 20 == 0
                               ? SeriesNaN
                               : std::ldexp(double(random()) - 2e9, int(random() % 40) - 20);
      series.Append(eighths / 8.0, value);
      all.times.push_back(eighths / 8.0);
      all.values.push_back(value);
    }
    ASSERT_EQ(series.Size(), size);
    // Columns of a power of two of eighths: the column of a time is exact in doubles.
    for (const int columns : {1, 2, 7, 64, 1000}) {
      for (const double width : {0.125, 1.0, 16.0, 1024.0}) {
        const double from = double(int(random() % 4000)) - 100.0 - 0.0625 * double(random() % 2);
        const double to = from + width * columns;
        const std::vector<SampleColumn> found = series.Decimate(from, to, columns);
        ASSERT_EQ(found.size(), std::size_t(columns));
        std::vector<std::vector<std::size_t>> wanted(found.size());
        for (std::size_t i = 0; i < size; ++i) {
          if (all.times[i] >= from && all.times[i] <= to) {
            const double column = std::floor((all.times[i] - from) / width);
            wanted[std::min(std::size_t(column), found.size() - 1)].push_back(i);
          }
        }
        for (std::size_t c = 0; c < found.size(); ++c) {
          all.Check(found[c], wanted[c],
                    std::to_string(size) + " samples, column " + std::to_string(c) + " of " +
                        std::to_string(columns));
          if (HasFailure()) {
            return;
          }
        }
      }
    }
  }
}

TEST(SampleSeries, NoSampleIsLostOrTwiceBetweenColumnsOfAnyWidth) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  SampleSeries series;
  double time_s = 8.1e8; // seconds past J2000
  for (int i = 0; i < 50000; ++i) {
    time_s += 1e-3 * unit(random);
    series.Append(time_s, std::sin(1e-3 * i) + 0.1 * unit(random));
  }
  for (int turn = 0; turn < 200; ++turn) {
    const double from = 8.1e8 - 1.0 + 27.0 * unit(random);
    const double to = from + 30.0 * std::pow(unit(random), 4.0) + 1e-5;
    const int columns = 1 + int(random() % 1500);
    const std::vector<SampleColumn> found = series.Decimate(from, to, columns);
    std::size_t next = 0;
    while (next < series.Size() && series.Time(next) < from) {
      ++next;
    }
    for (const SampleColumn& column : found) {
      ASSERT_EQ(column.begin, next);
      ASSERT_GE(column.end, column.begin);
      next = column.end;
      double min = std::numeric_limits<double>::infinity();
      double max = -min;
      for (std::size_t i = column.begin; i < column.end; ++i) {
        min = std::min(min, series.Value(i));
        max = std::max(max, series.Value(i));
      }
      if (column.begin < column.end) {
        ASSERT_EQ(column.extent.min, min);
        ASSERT_EQ(column.extent.max, max);
      }
    }
    ASSERT_TRUE(next == series.Size() || series.Time(next) > to);
    ASSERT_TRUE(next == 0 || series.Time(next - 1) <= to);
  }
}

TEST(SampleSeries, RejectsWhatIsEarlierOrInfinite) {
  SampleSeries series;
  series.Append(10.0, 1.0);
  series.Append(10.0, 2.0); // the same time is no earlier one
  EXPECT_EQ(Rejected(series, 9.75, 3.0),
            "samples: a time is 9.75; accepted: at least that of the last sample, 10");
  EXPECT_EQ(Rejected(series, SeriesNaN, 3.0), "samples: a time is nan; accepted: a finite number");
  EXPECT_EQ(Rejected(series, 11.0, -std::numeric_limits<double>::infinity()),
            "samples: a value is -inf; accepted: a finite number, or NaN for a gap");
  EXPECT_EQ(series.Size(), 2u);
  EXPECT_EQ(series.Time(1), 10.0);
  EXPECT_EQ(series.Value(1), 2.0);
  EXPECT_THROW(series.Decimate(1.0, 1.0, 10), dspace::Error);
  EXPECT_THROW(series.Decimate(0.0, SeriesNaN, 10), dspace::Error);
  EXPECT_THROW(series.Decimate(-1.5e308, 1.5e308, 10), dspace::Error);
  EXPECT_THROW(series.Decimate(0.0, 1.0, 0), dspace::Error);
  EXPECT_THROW(series.Decimate(0.0, 1.0, 1000001), dspace::Error);
}

TEST(SampleSeries, AfterRemovingItIsASeriesOfTheRest) {
  for (const int kept : {0, 1, 16, 255, 4096, 5000, 8192}) {
    SampleSeries cut;
    SampleSeries whole;
    for (int i = 0; i < 9000; ++i) {
      cut.Append(i, 1000.0 + i); // greater than all that come later
    }
    cut.RemoveFrom(kept);
    ASSERT_EQ(cut.Size(), std::size_t(kept));
    for (int i = 0; i < kept + 9000; ++i) {
      whole.Append(i, i < kept ? 1000.0 + i : -i);
      if (i >= kept) {
        cut.Append(i, -i);
      }
    }
    for (std::size_t begin = 0; begin < whole.Size(); begin += 997) {
      for (std::size_t end = begin; end <= whole.Size(); end += 1733) {
        const SampleExtent a = cut.Extent(begin, end);
        double min = SeriesNaN;
        double max = SeriesNaN;
        for (std::size_t i = begin; i < end; ++i) {
          min = std::fmin(min, whole.Value(i));
          max = std::fmax(max, whole.Value(i));
        }
        ExpectSame(a.min, min, "min");
        ExpectSame(a.max, max, "max");
      }
    }
  }
  SampleSeries series;
  series.Append(1.0, 1.0);
  series.RemoveFrom(1.5); // after all
  EXPECT_EQ(series.Size(), 1u);
  series.Clear();
  EXPECT_TRUE(series.IsEmpty());
  series.Append(-5.0, 0.0); // again from anywhere
  EXPECT_EQ(series.Size(), 1u);
}

TEST(SampleSeries, ACopyStaysWhileAnotherThreadChangesTheSeries) {
  SampleSeries series;
  for (int i = 0; i < 10000; ++i) {
    series.Append(i, i);
  }
  const SampleSeries copy = series;
  std::thread reader([&] {
    for (int turn = 0; turn < 50; ++turn) {
      for (std::size_t i = 0; i < copy.Size(); ++i) {
        ASSERT_EQ(copy.Value(i), double(i));
      }
      ASSERT_EQ(copy.Extent(0, copy.Size()).max, 9999.0);
    }
  });
  for (int turn = 0; turn < 50; ++turn) {
    series.RemoveFrom(9000.0 - 37.0 * turn);
    for (int i = 9000 - 37 * turn; i < 12000; ++i) {
      series.Append(i, -1.0);
    }
  }
  reader.join();
  EXPECT_EQ(copy.Size(), 10000u);
  EXPECT_EQ(series.Extent(0, series.Size()).min, -1.0);
}

TEST(SampleSeries, ValuesBetweenSamples) {
  SampleSeries series;
  series.Append(1.0, 10.0);
  series.Append(3.0, 20.0);
  series.Append(3.0, 40.0);
  series.Append(5.0, SeriesNaN);
  series.Append(6.0, 7.0);
  const auto at = [&](double time_s) { return series.At(time_s, false); };
  ExpectSame(at(0.9), SeriesNaN, "before the first");
  EXPECT_EQ(at(1.0), 10.0);
  EXPECT_EQ(at(2.5), 17.5);
  EXPECT_EQ(at(3.0), 40.0); // the last of two
  ExpectSame(at(4.0), SeriesNaN, "beside a gap");
  ExpectSame(at(5.5), SeriesNaN, "beside a gap");
  EXPECT_EQ(at(6.0), 7.0);
  ExpectSame(at(6.1), SeriesNaN, "after the last");
  EXPECT_EQ(series.At(2.5, true), 10.0);
  EXPECT_EQ(series.At(4.0, true), 40.0);
  EXPECT_EQ(series.At(99.0, true), 7.0);
}
