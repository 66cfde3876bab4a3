// The kernels that are loaded, and what follows from them.
#ifndef DSPACE_SKY_KERNEL_SET_H
#define DSPACE_SKY_KERNEL_SET_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/kernels/KernelPool.h>
#include <dspace/orientation/Frames.h>
#include <dspace/sky/KernelContents.h>

namespace dspace {

// An ephemeris and reference frames out of SPICE kernels of any kind, in the order of loading: what
// is loaded later wins. After all kernels come JPL's DE405 where it is installed, and ERFA.
// Immutable: With() makes another one, and shares the files that are open.
class KernelSet {
public:
  // One segment of a binary kernel.
  struct Segment {
    std::string file;
    const char* kind = ""; // "SPK", "PCK", "CK"
    std::string name;
    int body = 0;   // NAIF id: the target, the class id of the body-fixed frame, the structure
    int center = 0; // of an SPK
    int frame = 0;  // NAIF id of the frame that its numbers are given in
    int type = 0;
    double begin = 0.0; // TDB [s past J2000]; NaN: of a CK whose clock is not loaded
    double end = 0.0;
  };

  KernelSet(); // no kernels

  // This set and one more file, or for a meta-kernel the files that it names. A table of the
  // Earth's orientation (EarthOrientation.h) counts as a kernel; the last one alone is used. The
  // path of a file that is loaded already is taken again, last. Throws Error(NotFound, Io, Corrupt,
  // Unsupported), and Error(InvalidArgument) for meta-kernels that load each other.
  std::shared_ptr<const KernelSet> With(const std::string& path) const;
  // Throws Error(NotFound) with the paths that are loaded.
  std::shared_ptr<const KernelSet> Without(const std::string& path) const;

  const std::vector<std::string>& Paths() const { return this->Paths_; } // as given to With
  // All files, those of meta-kernels among them, in the order in which they count.
  std::vector<std::string> Files() const;
  std::vector<Segment> Segments() const;       // of all binary kernels, in their order
  std::vector<KernelContent> Contents() const; // of the other files, in their order

  const Ephemeris& GetEphemeris() const { return *this->Ephemeris_; }
  const Frames& GetFrames() const { return *this->Frames_; }
  const KernelPool& Pool() const { return this->Frames_->Pool(); }
  const TimeScales& Scales() const { return this->Frames_->Sources().scales; }

private:
  struct File;
  void Open(const std::string& path, int depth);
  void Build();

  std::vector<std::string> Paths_;
  std::vector<std::shared_ptr<const File>> Files_;
  std::shared_ptr<Ephemeris> Ephemeris_;
  std::shared_ptr<const Frames> Frames_;
};

} // namespace dspace

#endif
