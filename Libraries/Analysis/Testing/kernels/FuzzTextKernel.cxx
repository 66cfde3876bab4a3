// What the text-kernel parser and what is made from its variables do with files from anywhere. A
// fuzz target: input is a text kernel's bytes. Nothing in it may crash, hang, or throw anything but
// Error; and what is accepted is finite and is read the same from its own printout.
//
// With clang and -DDSPACE_LIBFUZZER=ON it is libFuzzer's program. Else it makes 20,000 inputs from
// valid kernels, seed 1 (for five minutes with DSPACE_LONG), or runs the files that it is given. An
// input that fails is left in the working folder.
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <dspace/Error.h>
#include <dspace/kernels/ClockKernel.h>
#include <dspace/kernels/FieldOfView.h>
#include <dspace/kernels/LeapSecondKernel.h>
#include <dspace/kernels/MetaKernel.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/orientation/Frames.h>

#include "FuzzMain.h"

using namespace dspace;
using dspace::testing::Fail;
using dspace::testing::Try;

namespace {

std::string Print(const TextKernel& kernel) {
  std::ostringstream out;
  out.precision(17);
  out << "\\begindata\n";
  for (const KernelAssignment& a : kernel.Assignments()) {
    out << a.name << (a.append ? " += (" : " = (");
    for (const double number : a.numbers) {
      if (!std::isfinite(number)) {
        Fail("a number that is not finite was accepted");
      }
      out << "\n" << number;
    }
    for (const std::string& text : a.texts) {
      out << "\n'";
      for (const char c : text) {
        out << (c == '\'' ? "''" : std::string(1, c));
      }
      out << "'";
    }
    out << ")\n";
  }
  return out.str();
}

void Use(const TextKernel& kernel) {
  auto pool = std::make_shared<KernelPool>();
  Try([&] { KernelsToLoad(kernel); });
  pool->Add(kernel);
  FrameSources sources;
  Try([&] { sources.scales = TimeScalesOf(*pool); });
  for (const int clock : ClockKernel::Clocks(*pool)) {
    Try([&] {
      const ClockKernel made(*pool, clock, sources.scales);
      Try([&] { made.TicksOf(made.TdbOf(made.LastTick() / 2)); });
      Try([&] { made.TicksOfText(made.TextOf(made.LastTick() / 2)); });
    });
  }
  for (const int instrument : Instruments(*pool)) {
    Try([&] { FieldOfViewOf(*pool, instrument).RadiusDeg(); });
  }
  Try([&] { BodyRotation(*pool, 301, 1e8); });
  Try([&] { BodyRadii(*pool, 301); });
  sources.pool = pool;
  const Frames frames(sources);
  for (const FrameInfo* info : frames.Table().Loaded()) {
    Try([&] { frames.Turn(info->name, "J2000", 1e8); });
  }
}

// Valid kernels of every kind, to begin with.
const std::vector<std::string>& Seeds() {
  static const std::vector<std::string> seeds = {
      "KPL/LSK\n\\begindata\nDELTET/DELTA_T_A = 32.184 DELTET/K = 1.657D-3 DELTET/EB = 1.671D-2\n"
      "DELTET/M = ( 6.239996D0 1.99096871D-7 )\nDELTET/DELTA_AT = ( 10, @1972-JAN-1\n 11, "
      "@1972-JUL-1 )\n\\begintext\n",
      "KPL/SCLK\n\\begindata\nSCLK_KERNEL_ID = ( @2016-05-10/23:26:03.40 )\nSCLK_DATA_TYPE_77 = 1\n"
      "SCLK01_TIME_SYSTEM_77 = 2\nSCLK01_N_FIELDS_77 = 2\nSCLK01_MODULI_77 = ( 1000 10 )\n"
      "SCLK01_OFFSETS_77 = ( 0 1 )\nSCLK01_OUTPUT_DELIM_77 = 2\nSCLK_PARTITION_START_77 = ( 100 0 "
      ")\n"
      "SCLK_PARTITION_END_77 = ( 600 1000 )\nSCLK01_COEFFICIENTS_77 = ( 0 1000 1.0  500 1050 2.0 "
      ")\n",
      "KPL/FK\n\\begindata\nFRAME_A = 1400000\nFRAME_1400000_NAME = 'A'\nFRAME_1400000_CLASS = 4\n"
      "FRAME_1400000_CLASS_ID = 1400000\nFRAME_1400000_CENTER = 'EARTH'\nTKFRAME_1400000_SPEC = "
      "'ANGLES'\n"
      "TKFRAME_1400000_RELATIVE = 'J2000'\nTKFRAME_1400000_ANGLES = ( 30 0 0 )\n"
      "TKFRAME_1400000_AXES = ( 3 1 3 )\nTKFRAME_1400000_UNITS = 'DEGREES'\nFRAME_B = 1400001\n"
      "FRAME_1400001_NAME = 'B'\nFRAME_1400001_CLASS = 4\nFRAME_1400001_CLASS_ID = 1400001\n"
      "FRAME_1400001_CENTER = 399\nTKFRAME_B_SPEC = 'MATRIX'\nTKFRAME_B_RELATIVE = 'A'\n"
      "TKFRAME_B_MATRIX = ( 1 0 0 0 1 0 0 0 1 )\n",
      "KPL/IK\n\\begindata\nINS-1_FOV_FRAME = 'A'\nINS-1_FOV_SHAPE = 'RECTANGLE'\nINS-1_BORESIGHT "
      "= ( 0 0 1 )\n"
      "INS-1_FOV_CLASS_SPEC = 'ANGLES'\nINS-1_FOV_REF_VECTOR = ( 1 0 0 )\nINS-1_FOV_REF_ANGLE = 1\n"
      "INS-1_FOV_CROSS_ANGLE = 2\nINS-1_FOV_ANGLE_UNITS = 'DEGREES'\n",
      "KPL/PCK\n\\begindata\nBODY301_POLE_RA = ( 269.9949 0.0031 0. )\nBODY301_POLE_DEC = ( "
      "66.5392 0.0130 0. )\n"
      "BODY301_PM = ( 38.3213 13.17635815 -1.4D-12 )\nBODY301_NUT_PREC_RA = ( -3.8787 -0.1204 )\n"
      "BODY3_NUT_PREC_ANGLES = ( 125.045 -1935.5364525 250.089 -3871.072905 )\n"
      "BODY301_RADII = ( 1737.4 1737.4 1737.4 )\n",
      "KPL/MK\n\\begindata\nPATH_VALUES = ( '/data' )\nPATH_SYMBOLS = ( 'K' )\n"
      "KERNELS_TO_LOAD = ( '$K/a.bsp' 'b.+' 'tls' 'it''s' )\n",
  };
  return seeds;
}

std::string Mutate(std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  std::string text = Seeds()[below(Seeds().size())];
  if (below(4) == 0) {
    text += Seeds()[below(Seeds().size())];
  }
  static const char* const Words[] = {"(",
                                      ")",
                                      "'",
                                      "''",
                                      ",",
                                      "=",
                                      "+=",
                                      "@",
                                      "-",
                                      "1e308",
                                      "-1e309",
                                      "nan",
                                      "0",
                                      "99999999999",
                                      "\\begindata\n",
                                      "\\begintext\n",
                                      "J2000",
                                      "A",
                                      "B",
                                      "2147483648",
                                      "@9999-DEC-31",
                                      "\r\n",
                                      "\t",
                                      "1D",
                                      ".",
                                      "MATRIX",
                                      "QUATERNION",
                                      "POLYGON"};
  for (std::size_t n = 1 + below(6); n > 0 && !text.empty(); --n) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
    case 0:
      text[at] = char(random());
      break;
    case 1:
      text.erase(at, 1 + below(20));
      break;
    case 2:
      text.insert(at, text.substr(below(text.size()), below(60)));
      break;
    case 3:
      text.insert(at, Words[below(sizeof(Words) / sizeof(*Words))]);
      break;
    default:
      text[at] = "0123456789-+.eD'(),= "[below(21)];
    }
  }
  return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Try([&] {
    const TextKernel kernel =
        TextKernel::Parse(std::string(reinterpret_cast<const char*>(data), size), "input");
    const TextKernel again = TextKernel::Parse(Print(kernel), "again");
    if (again.Assignments().size() != kernel.Assignments().size()) {
      Fail("the printout has another number of assignments");
    }
    for (std::size_t i = 0; i < again.Assignments().size(); ++i) {
      const KernelAssignment& a = kernel.Assignments()[i];
      const KernelAssignment& b = again.Assignments()[i];
      if (a.name != b.name || a.append != b.append || a.numbers != b.numbers ||
          a.texts != b.texts) {
        Fail("the printout is read differently");
      }
    }
    Use(kernel);
  });
  return 0;
}

#ifndef DSPACE_LIBFUZZER
int main(int argc, char** argv) {
  return dspace::testing::FuzzMain(argc, argv, "fuzz-text-kernel", Seeds(), Mutate);
}
#endif
