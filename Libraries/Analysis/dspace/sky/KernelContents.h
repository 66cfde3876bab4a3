// What text kernels and tables of the Earth's orientation contain, in words.
#ifndef DSPACE_SKY_KERNEL_CONTENTS_H
#define DSPACE_SKY_KERNEL_CONTENTS_H

#include <string>
#include <vector>

#include <dspace/ephemeris/BodyNames.h>
#include <dspace/kernels/TextKernel.h>
#include <dspace/time/EarthOrientation.h>

namespace dspace {

struct KernelContent {
  std::string file;
  std::string kind;               // TextKernel::Kind, or "EOP"
  int variables = 0;              // number of variables that it assigns
  std::vector<std::string> items; // in words: "radii of SUN, MERCURY, ..."
};

// `names`: what the bodies of its variables are called.
KernelContent ContentOf(const TextKernel& kernel, const BodyNames& names);
KernelContent ContentOf(const EarthOrientation& earth);

} // namespace dspace

#endif
