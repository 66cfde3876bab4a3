// What the readers of OEM and xyzv files, and of the IERS's tables of the Earth's orientation, do
// with files from anywhere. A fuzz target: input is the bytes of a file, which all readers get.
// Nothing in it may crash, hang, or throw anything but Error; and the states at the times of an
// accepted file are finite and those of the file.
//
// How it is built and run: FuzzMain.h.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <dspace/time/EarthOrientation.h>
#include <dspace/trajectories/OemFile.h>
#include <dspace/trajectories/XyzvFile.h>

#include "FuzzMain.h"
#include "TemporaryFolder.h"

using namespace dspace;
using dspace::testing::Fail;
using dspace::testing::Try;

namespace {

// Of each table: its own states, and those in between.
void Use(const StateTable& table) {
  const StateTable::Content& content = table.Get();
  for (std::size_t i = 0; i < content.times.size(); ++i) {
    const double time = content.times[i];
    if (time < table.Span().begin || time > table.Span().end) {
      continue;
    }
    const Eigen::Vector3d position = table.At(time).position;
    const double size = content.positions[i].norm();
    if (!position.allFinite() || !((position - content.positions[i]).norm() <= 1e-6 * (1 + size))) {
      if (content.interpolation.kind != Interpolation::Kind::Lagrange) {
        Fail("a state at a time of the table is not that of the table");
      }
    }
    if (i + 1 < content.times.size()) {
      Try([&] { table.At(0.5 * (time + content.times[i + 1])); });
    }
  }
}

void Use(const std::string& path) {
  static const TimeScales scales(LeapSeconds::FromErfa());
  Try([&] {
    const OemFile file(path, scales);
    for (const OemFile::Block& block : file.Blocks()) {
      Use(*block.table);
    }
    file.Frame();
    Try([&] { file.GetTrajectory()->Parts(); });
  });
  Try([&] {
    const XyzvFile file(path);
    Use(*file.GetTrajectory());
  });
  Try([&] {
    EarthOrientation::Recognizes(path);
    const EarthOrientation earth = EarthOrientation::Read(path);
    for (const EarthOrientation::Row& row : earth.Rows()) {
      if (!((earth.PoleAt(row.mjd) - row.pole).norm() <= 1e-12) ||
          !std::isfinite(row.ut1MinusUtc)) {
        Fail("a pole at a day of the table is not that of the table");
      }
    }
  });
}

const std::vector<std::string>& Seeds() {
  static const std::string meta =
      "META_START\nOBJECT_NAME = CRAFT\nOBJECT_ID = 2020-001A\nCENTER_NAME = EARTH\n"
      "REF_FRAME = EME2000\nTIME_SYSTEM = ";
  static const std::string span =
      "\nSTART_TIME = 2020-01-01T12:00:00\nSTOP_TIME = 2020-01-01T12:03:00\n";
  static const std::string states =
      "2020-01-01T12:00:00 7000 0 0 0 7.5 0\n2020-01-01T12:01:00 6990 450 0 -0.5 7.5 0\n"
      "2020-01-01T12:02:00.5 6960 898 0 -1.0 7.4 0\n2020-001T12:03:00Z 6911 1341 0 -1.4 7.3 0\n";
  static const std::vector<std::string> seeds = {
      "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2020-01-01T00:00:00\nORIGINATOR = TEST\n" + meta +
          "UTC" + span + "META_STOP\nCOMMENT a comment\n" + states,
      "CCSDS_OEM_VERS = 1.0\n" + meta + "TDB" + span +
          "USEABLE_START_TIME = 2020-01-01T12:00:30\nUSEABLE_STOP_TIME = 2020-01-01T12:02:30\n"
          "INTERPOLATION = LAGRANGE\nINTERPOLATION_DEGREE = 3\nMETA_STOP\n" +
          states +
          "COVARIANCE_START\nEPOCH = 2020-01-01T12:00:00\nCOV_REF_FRAME = RTN\n1e-3\n0 1e-3\n"
          "COVARIANCE_STOP\n",
      "CCSDS_OEM_VERS = 3.0\n" + meta + "GPS" + span +
          "INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 5\nMETA_STOP\n" + states + meta +
          "GPS\nSTART_TIME = 2020-01-02T00:00:00\nSTOP_TIME = 2020-01-02T00:01:00\n"
          "INTERPOLATION = LINEAR\nMETA_STOP\n2020-01-02T00:00:00 1 2 3 4 5 6 7 8 9\n"
          "2020-01-02T00:01:00 2 3 4 5 6 7 8 9 10\n",
      "# Target: MSL (-76)\n# Observer: MARS (499)\n# Frame: IAU_MARS\n"
      "2456145.70833 3396 0 100 0.1 -2 0.3\n2456145.70834 3396 -2 100 0.1 -2 0.3\n"
      "2456145.70834 3396 -2 100 0.1 -2 0.3\n2456145.70836 3396 -6 100 0.1 -2 0.3\n",
      "1962   1   1  37665  -0.012700   0.213000   0.0326338   0.0017230\n"
      "1962   1   2  37666  -0.015900   0.214100   0.0320547   0.0016690\n",
      "16 730 57599.00 I  0.214232 0.008236  0.442454 0.011701  I-0.2000000 0.0086754\n"
      "16 731 57600.00 P  0.215232 0.008236  0.441454 0.011701  P-0.2020000 0.0086754\n"
      "16 8 1 57601.00\n",
  };
  return seeds;
}

std::string Mutate(std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  static const char* const Words[] = {"META_START\n",
                                      "META_STOP\n",
                                      "COVARIANCE_START\n",
                                      "=",
                                      "1e18",
                                      "-1e308",
                                      "nan",
                                      "inf",
                                      "1e-320",
                                      "INTERPOLATION_DEGREE = 31\n",
                                      "9999-12-31T23:59:59",
                                      "2016-12-31T23:59:60.5",
                                      "0000-00-00",
                                      "#",
                                      "\r\n",
                                      "\t",
                                      "COMMENT",
                                      "0",
                                      "99999999999",
                                      "2451545.0",
                                      "0x10",
                                      "+",
                                      "UTC",
                                      "LAGRANGE"};
  std::string text = Seeds()[below(Seeds().size())];
  for (std::size_t n = 1 + below(6); n > 0 && !text.empty(); --n) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
    case 0:
      text[at] = char(random());
      break;
    case 1:
      text.erase(at, 1 + below(40));
      break;
    case 2:
      text.insert(at, text.substr(below(text.size()), below(120)));
      break;
    case 3:
      text.insert(at, Words[below(std::size(Words))]);
      break;
    default:
      text[at] = "0123456789-+.eT: =\n"[below(19)];
    }
  }
  return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const dspace::testing::TemporaryFolder folder;
  static const std::string path = folder / "input";
  {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(data), std::streamsize(size));
  }
  Use(path);
  return 0;
}

#ifndef DSPACE_LIBFUZZER
int main(int argc, char** argv) {
  return dspace::testing::FuzzMain(argc, argv, "fuzz-state-files", Seeds(), Mutate);
}
#endif
