// Binary kernels: byte orders, damage, and how much of a large file is read.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <MissingPackage.h>
#include <TemporaryFolder.h>
#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/ephemeris/De405Source.h>
#include <dspace/kernels/BinaryPck.h>
#include <dspace/kernels/CkFile.h>
#include <dspace/kernels/SpkFile.h>

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void Write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

template<class Work> Error::Kind KindOf(Work work, std::string* message = nullptr) {
  try {
    work();
  } catch (const Error& error) {
    if (message) {
      *message = error.what();
    }
    return error.GetKind();
  }
  return Error::Kind::Internal; // no error
}

TEST(DafFile, ByteOrdersGiveTheSameStates) {
  DSPACE_REAL_DATA(littlePath, "ephemeris/spice_test_kernels/de405s_littleendian.bsp");
  DSPACE_REAL_DATA(bigPath, "ephemeris/spice_test_kernels/de405s_bigendian.bsp");
  const SpkFile little(littlePath), big(bigPath);
  EXPECT_FALSE(little.File().IsBigEndian());
  EXPECT_TRUE(big.File().IsBigEndian());
  EXPECT_EQ(little.File().Kind(), ""); // both have the old id word NAIF/DAF
  ASSERT_EQ(little.Segments().size(), big.Segments().size());
  ASSERT_EQ(little.Segments().size(), 15u);
  for (std::size_t i = 0; i < little.Segments().size(); ++i) {
    const SpkFile::Segment& segment = little.Segments()[i];
    EXPECT_EQ(segment.target, big.Segments()[i].target);
    for (int k = 0; k <= 50; ++k) {
      const double tdb =
          std::min(segment.end, segment.begin + (segment.end - segment.begin) * k / 50.0);
      EXPECT_EQ(little.At(i, tdb).position, big.At(i, tdb).position);
      EXPECT_EQ(little.At(i, tdb).velocity, big.At(i, tdb).velocity);
    }
  }
}

TEST(DafFile, TruncatedFilesAreRejected) {
  TemporaryFolder folder;
  for (const char* name : {"jup310_excerpt_2053-10-08.bsp", "de430_excerpt_2015-03-02.bsp",
                           "spice_test_kernels/earthstns_itrf93_050714.bsp"}) {
    DSPACE_REAL_DATA(path, std::string("ephemeris/") + name);
    const std::string whole = BytesOf(path);
    const DafFile file(path);
    std::int64_t needed = 0; // bytes
    for (const DafFile::Array& array : file.Arrays()) {
      needed = std::max(needed, 8 * array.last);
    }
    ASSERT_LE(std::size_t(needed), whole.size());
    std::mt19937_64 random(1);
    for (int i = 0; i < 300; ++i) {
      const std::size_t size = i == 0   ? 0
                               : i == 1 ? std::size_t(needed) - 1
                                        : random() % std::size_t(needed);
      Write(folder / "cut.bsp", whole.substr(0, size));
      std::string message;
      ASSERT_EQ(KindOf([&] { SpkFile cut(folder / "cut.bsp"); }, &message), Error::Kind::Corrupt)
          << name << " cut to " << size << " bytes";
      ASSERT_NE(message.find("cut.bsp"), std::string::npos);
    }
  }
}

TEST(DafFile, OtherFilesAndWrongByteOrdersAreRejected) {
  DSPACE_REAL_DATA(path, "ephemeris/jup310_excerpt_2053-10-08.bsp");
  TemporaryFolder folder;
  const auto kindOf = [&](const std::string& bytes, std::string* message = nullptr) {
    Write(folder / "a.bsp", bytes);
    return KindOf([&] { SpkFile file(folder / "a.bsp"); }, message);
  };
  const std::string whole = BytesOf(path);
  std::string swapped = whole;
  swapped.replace(88, 8, "BIG-IEEE"); // its numbers are not
  EXPECT_EQ(kindOf(swapped), Error::Kind::Corrupt);
  std::string vax = whole;
  vax.replace(88, 8, "VAX-GFLT");
  std::string message;
  EXPECT_EQ(kindOf(vax, &message), Error::Kind::Corrupt);
  EXPECT_NE(message.find("accepted: BIG-IEEE, LTL-IEEE"), std::string::npos);
  // A transfer as text turns "\r\n" into "\n".
  const std::size_t mark = whole.find("FTPSTR");
  ASSERT_NE(mark, std::string::npos);
  std::string text = whole;
  text.replace(text.find("\r\n", mark), 2, "\n\n");
  EXPECT_EQ(kindOf(text, &message), Error::Kind::Corrupt);
  EXPECT_NE(message.find("transferred as text"), std::string::npos);
  EXPECT_EQ(kindOf("KPL/LSK" + std::string(2000, ' ')), Error::Kind::Corrupt);
  std::string circle = whole; // the summary record is its own successor
  std::uint32_t first = 0;
  std::memcpy(&first, whole.data() + 76, 4);
  const double next = first;
  std::memcpy(circle.data() + (first - 1) * 1024, &next, 8);
  EXPECT_EQ(kindOf(circle), Error::Kind::Corrupt);
  EXPECT_EQ(KindOf([&] { SpkFile file(folder / "absent.bsp"); }), Error::Kind::NotFound);
  EXPECT_EQ(KindOf([&] { SpkFile file(folder.Path().string()); }), Error::Kind::Io);
  EXPECT_EQ(KindOf([&] { BinaryPck file(path); }, &message), Error::Kind::Corrupt);
  EXPECT_NE(message.find("accepted: a binary PCK"), std::string::npos);
  EXPECT_EQ(KindOf([&] { CkFile file(path); }), Error::Kind::Corrupt);

  // A type that is not read is listed, and named when it is asked for.
  std::string other = whole;
  const std::int32_t type = 5;
  std::memcpy(other.data() + (first - 1) * 1024 + 24 + 16 + 12, &type, 4);
  Write(folder / "b.bsp", other);
  const SpkFile file(folder / "b.bsp");
  EXPECT_FALSE(file.Segments()[0].IsRead());
  EXPECT_EQ(KindOf([&] { file.At(0, file.Segments()[0].begin); }, &message),
            Error::Kind::Unsupported);
  EXPECT_NE(message.find("SPK type 5; accepted: types 1, 2, 3, 8, 9, 13 and 21"), std::string::npos)
      << message;
}

// A sparse file of 1 GiB: one segment of type 2, of which two records are there.
TEST(DafFile, ALargeKernelReadsOnlyWhatIsAsked) {
  TemporaryFolder folder;
  const std::string path = folder / "large.bsp";
  constexpr std::int64_t Words = 41, Count = 3300000; // 13 coefficients a component
  constexpr std::int64_t First = 385, Last = First + Words * Count + 3; // behind 3 records
  constexpr std::int64_t Size = 8 * Last;
  static_assert(Size > (std::int64_t(1) << 30));
  const int out = ::open(path.c_str(), O_CREAT | O_RDWR, 0600);
  ASSERT_GE(out, 0);
  ASSERT_EQ(::ftruncate(out, Size), 0);
  const auto put = [&](std::int64_t offset, const void* bytes, std::size_t count) {
    ASSERT_EQ(::pwrite(out, bytes, count, offset), ::ssize_t(count));
  };
  std::string head(1024, '\0');
  head.replace(0, 8, "DAF/SPK ");
  const std::int32_t counts[2] = {2, 6}, records[3] = {2, 2, std::int32_t(Last + 1)};
  std::memcpy(head.data() + 8, counts, 8);
  std::memcpy(head.data() + 76, records, 12);
  head.replace(88, 8, "LTL-IEEE");
  put(0, head.data(), head.size());
  const double summary[5] = {0.0, 0.0, 1.0, 0.0, 100.0 * Count};
  const std::int32_t integers[6] = {-7, 0, 1, 2, std::int32_t(First), std::int32_t(Last)};
  put(1024, summary, sizeof(summary));
  put(1024 + 40, integers, sizeof(integers));
  put(2048, "LARGE   ", 8);
  const double tail[4] = {0.0, 100.0, double(Words), double(Count)};
  put(8 * (Last - 4), tail, sizeof(tail));
  for (const std::int64_t record : {std::int64_t(1000000), std::int64_t(3000000)}) {
    // x = 1 + s, y = 2, z = 3 T2(s) km, s in [-1, 1].
    std::vector<double> words(Words, 0.0);
    words[0] = 100.0 * double(record) + 50.0;
    words[1] = 50.0;
    words[2] = 1.0;
    words[3] = 1.0;
    words[2 + 13] = 2.0;
    words[2 + 26 + 2] = 3.0;
    put(8 * (First - 1 + record * Words), words.data(), 8 * Words);
  }
  ::close(out);

  const SpkFile file(path);
  EXPECT_LE(file.File().BytesRead(), 4096u); // opening
  for (const double record : {1000000.0, 3000000.0}) {
    const State state = file.At(0, 100.0 * record + 75.0); // s = 0.5
    EXPECT_NEAR(state.position.x(), 1500.0, 1e-9);
    EXPECT_NEAR(state.position.y(), 2000.0, 1e-9);
    EXPECT_NEAR(state.position.z(), -1500.0, 1e-9); // T2(0.5) = -0.5
    EXPECT_NEAR(state.velocity.x(), 20.0, 1e-9);    // 1 km / 50 s
    EXPECT_NEAR(state.velocity.z(), 120.0, 1e-9);   // 3 * 4 s / 50 s
  }
  EXPECT_LE(file.File().BytesRead(), 64u * 1024);
  EXPECT_EQ(KindOf([&] { file.At(0, 50.0); }), Error::Kind::Corrupt); // a hole
}

TEST(DafFile, De405sTableIsCheckedToo) {
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  TemporaryFolder folder;
  const std::string whole = BytesOf(De405Source::StandardPath());
  Write(folder / "short", whole.substr(0, whole.size() - 8));
  std::string message;
  EXPECT_EQ(KindOf([&] { De405Source source(folder / "short"); }, &message), Error::Kind::Corrupt);
  EXPECT_NE(message.find("9326884 bytes; accepted: the 9326892"), std::string::npos) << message;
  std::string other = whole;
  std::fill(other.begin() + 12, other.begin() + 12 + 8160, '\0'); // no Earth in its first record
  Write(folder / "other", other);
  EXPECT_EQ(KindOf([&] { De405Source source(folder / "other"); }), Error::Kind::Corrupt);
  std::string nan = whole;
  std::fill(nan.begin() + 12 + 8160 * 500, nan.begin() + 12 + 8160 * 501, '\xff');
  Write(folder / "nan", nan);
  const De405Source source(folder / "nan");
  const double inRecord = (36912.0 + 32.0 * 500 + 16.0 - 51544.5) * 86400.0;
  EXPECT_EQ(KindOf([&] { source.Find(10, inRecord); }), Error::Kind::Corrupt);
  EXPECT_TRUE(source.Find(10, inRecord + 33.0 * 86400.0)); // the others are good
  EXPECT_FALSE(source.Find(10, 1.9e9));                    // after 2060
}

} // namespace
