// The names, ids and kinds of reference frames.
#ifndef DSPACE_ORIENTATION_FRAME_TABLE_H
#define DSPACE_ORIENTATION_FRAME_TABLE_H

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <dspace/ephemeris/FrameTurns.h>
#include <dspace/kernels/KernelPool.h>

namespace dspace {

// How a frame is defined, with NAIF's numbers of frame classes.
enum class FrameClass { Inertial = 1, Pck = 2, Ck = 3, Tk = 4, Dynamic = 5, Switch = 6 };

struct FrameInfo {
  std::string name;
  int id = 0;
  FrameClass kind = FrameClass::Inertial;
  int classId = 0;    // within its class: the body of a PCK, the structure of a CK
  int center = 0;     // NAIF id of the body at its origin
  std::string kernel; // the file that defines it; empty: built in
};

// The frames that SPICE has built in (its 21 inertial frames, IAU_* and ITRF93), MOON_PA and
// MOON_ME, and those of frame kernels (NAIF, "Frames Required Reading"), which cannot replace a
// built-in frame but MOON_PA and MOON_ME. The case of names does not matter.
class FrameTable {
public:
  // Throws
  // Error(Corrupt), naming the variable, for an incomplete definition.
  explicit FrameTable(const KernelPool& pool);

  // Null: there is no such frame.
  const FrameInfo* Find(const std::string& name) const;
  const FrameInfo* Find(int id) const;
  // Throws Error(NotFound) with the names that are close.
  const FrameInfo& Get(const std::string& name) const;
  const FrameInfo& Get(int id) const;
  // The frame that turns with a body: MOON_ME for the Moon, ITRF93 for the Earth, else the built-in
  // IAU_ frame, else a PCK frame of a kernel. Throws Error(NotFound).
  const FrameInfo& BodyFixed(int body) const;
  std::vector<std::string> Names() const;
  // Those of frame kernels.
  std::vector<const FrameInfo*> Loaded() const;

private:
  void Add(FrameInfo info);

  std::map<int, FrameInfo> Frames_;
  std::map<std::string, int> Ids_; // by upper-case name
};

constexpr int FrameItrf93 = 13000;
constexpr int FrameEarthFixed = 10081;
constexpr int FrameMoonPa = 31000; // as NAIF's lunar frame kernels number them
constexpr int FrameMoonMe = 31001;

} // namespace dspace

#endif
