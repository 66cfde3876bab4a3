// Rows in several threads: each row once, and errors.
#include <dspace/RowThreads.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>

using namespace dspace;

TEST(RowThreads, EachRowIsInOnePart) {
  for (const int rows : {0, 1, 2, 3, 7, 100, 4001}) {
    for (const int columns : {1, 1000, 100'000}) {
      std::vector<int> visits(std::size_t(rows), 0);
      std::atomic<int> parts{0};
      ForRows(rows, columns, [&](int first, int last) {
        ++parts;
        for (int r = first; r < last; ++r) {
          ++visits[std::size_t(r)];
        }
      });
      EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), rows) << rows << " x " << columns;
      EXPECT_GE(parts, 1);
      if (rows * columns < 2 * 32768) {
        EXPECT_EQ(parts, 1) << rows << " x " << columns;
      }
    }
  }
}

TEST(RowThreads, AnErrorIsThrownAfterAllPartsHaveEnded) {
  std::atomic<int> ended{0}, begun{0};
  const auto work = [&](int first, int last) {
    ++begun;
    if (first == 0) {
      ++ended;
      throw Error(Error::Kind::Corrupt, "row", "0 is damaged");
    }
    for (int r = first; r < last; ++r) {
    }
    ++ended;
  };
  EXPECT_THROW(ForRows(5000, 1000, work), Error);
  EXPECT_EQ(ended, begun);
}
