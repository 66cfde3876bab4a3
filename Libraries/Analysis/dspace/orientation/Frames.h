// Reference frames: how they are turned against each other at a time.
#ifndef DSPACE_ORIENTATION_FRAMES_H
#define DSPACE_ORIENTATION_FRAMES_H

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/ephemeris/De405Source.h>
#include <dspace/ephemeris/FrameTurns.h>
#include <dspace/kernels/BinaryPck.h>
#include <dspace/kernels/CkFile.h>
#include <dspace/kernels/ClockKernel.h>
#include <dspace/kernels/KernelPool.h>
#include <dspace/orientation/FrameTable.h>
#include <dspace/time/EarthOrientation.h>
#include <dspace/time/TimeScales.h>

namespace dspace {

// What frames follow from. What comes later in a list is asked first, as in SPICE.
struct FrameSources {
  std::shared_ptr<const KernelPool> pool; // null: none
  std::vector<std::shared_ptr<const BinaryPck>> orientations;
  std::vector<std::shared_ptr<const CkFile>> attitudes;
  std::shared_ptr<const De405Source> de405; // null: none
  TimeScales scales;
  std::shared_ptr<const EarthOrientation> earth; // polar motion for ITRF93; null: none
};

// Answers for every frame of FrameTable.h:
// - inertial frames: fixed matrices;
// - PCK frames: a binary PCK where one covers the time, else the body's rotation elements
//   (BodyConstants.h); ITRF93 without a binary PCK: EarthRotation.h;
// - MOON_PA and MOON_ME where no frame kernel defines them: DE405's libration, and for MOON_ME the
//   turn De405MeFromPa; MOON_ME without DE405: IAU_MOON;
// - TK frames: fixed offsets of frame kernels;
// - CK frames: the attitude kernels, through the clock CK_<id>_SCLK, or the id divided by 1000.
// Dynamic and switch frames are named in the error.
//
// Where IAU_MOON stands in for MOON_ME, or other data for a binary PCK at a time outside of what it
// covers, a FallbackScope (Fallbacks.h) has a warning. Principal axes of the Moon of a kernel
// (MOON_PA_DE421) follow then from MOON_ME without kernels and the kernel's turn to MOON_ME_DE421.
//
// R = Rotation(from, to, tdb) takes components in `from` to those in `to`: v_to = R v_from.
//
// Frames whose chains meet before J2000 need data only up to there. Immutable after construction,
// and safe in several threads.
class Frames final : public FrameTurns {
public:
  // One step of a chain, for reports.
  struct Step {
    std::string frame;
    std::string relative; // the frame that it is given against
    std::string source;   // "binary PCK 'a.bpc'", "pck00011", "frame kernel 'b.tf'"
    std::string accuracy; // as the source states it; empty: not stated
  };

  Frames() : Frames(FrameSources()) {}
  // Throws Error(Corrupt) for frame kernels that make no sense.
  explicit Frames(FrameSources sources);
  ~Frames() override;

  const FrameTable& Table() const { return this->Table_; }
  const KernelPool& Pool() const { return *this->Sources_.pool; }
  const FrameSources& Sources() const { return this->Sources_; }
  // The id of the clock of a structure whose attitude CKs have: CK_<id>_SCLK, or the id / 1000.
  int ClockOf(int structure) const;

  // Throws Error(NotFound) for unknown frames, with near matches, and for missing data, naming the
  // kernel that is needed; Error(InvalidArgument) for a time out of coverage, with the spans that
  // are covered, for loops, and for a time that is not finite; Error(Unsupported) for dynamic and
  // switch frames.
  Eigen::Matrix3d Rotation(const std::string& from, const std::string& to, double tdb) const;
  // Velocities too. The rate is NaN where a CK has neither rates nor two pointings around the time.
  StateTurn Turn(const std::string& from, const std::string& to, double tdb) const;
  // The steps from `from` up to the common frame, then those down to `to`.
  std::vector<Step> Explain(const std::string& from, const std::string& to, double tdb) const;

  int FrameId(const std::string& name) const override;
  std::string FrameName(int frame) const override;
  bool IsInertial(int frame) const override;
  int Center(int frame) const override;
  StateTurn Turn(int from, int to, double tdb) const override;

private:
  // A frame against its base.
  struct Link {
    int base = 0;
    StateTurn turn; // components in the base to those in the frame
    std::string source;
    std::string accuracy;
    std::string warning; // data of lower accuracy stand in for others; empty: none
  };
  struct Chain;
  Link LinkOf(const FrameInfo& info, double tdb) const;
  Link PckLink(const FrameInfo& info, double tdb) const;
  // Of MOON_PA or MOON_ME without kernels.
  Link MoonLink(const FrameInfo& info, double tdb) const;
  // Of a kernel's principal axes of the Moon where its binary PCK does not cover the time; none:
  // no fixed turn of the kernels leads from them to mean Earth axes.
  std::optional<Link> MoonStandIn(const FrameInfo& info, double tdb) const;
  Link CkLink(const FrameInfo& info, double tdb) const;
  Link TkLink(const FrameInfo& info) const;
  // From `frame` up, until J2000, `stop` (0: none) or a link that cannot be made.
  Chain ChainOf(int frame, int stop, double tdb) const;
  // The chains of both up to the frame in common.
  std::pair<Chain, Chain> Meet(int from, int to, double tdb) const;

  FrameSources Sources_;
  FrameTable Table_;
  std::map<int, Link> Fixed_;                                // TK frames by id
  std::map<int, std::shared_ptr<const ClockKernel>> Clocks_; // of CK frames by clock
};

// From the components in DE405's principal axes of the Moon to those in the mean Earth axes of
// DE421, which the error of 0.28 arcsec is relative to.
Eigen::Matrix3d De405MeFromPa();

} // namespace dspace

#endif
