// The kernels that are loaded, and what follows from them.
#ifndef DSPACE_SKY_KERNEL_SET_H
#define DSPACE_SKY_KERNEL_SET_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/kernels/KernelPool.h>
#include <dspace/orientation/Frames.h>

namespace dspace {

// An ephemeris and reference frames out of SPICE kernels of any kind, in the order of loading: what
// is loaded later wins. After all kernels come JPL's DE405 where it is installed, and ERFA.
// Immutable: With() makes another one, and shares the files that are open.
class KernelSet {
public:
  KernelSet(); // no kernels

  // This set and one more file, or for a meta-kernel the files that it names. The path of a file
  // that is loaded already is taken again, last. Throws Error(NotFound, Io, Corrupt, Unsupported),
  // and Error(InvalidArgument) for meta-kernels that load each other.
  std::shared_ptr<const KernelSet> With(const std::string& path) const;
  // Throws Error(NotFound) with the paths that are loaded.
  std::shared_ptr<const KernelSet> Without(const std::string& path) const;

  const std::vector<std::string>& Paths() const { return this->Paths_; } // as given to With
  // All files, those of meta-kernels among them, in the order in which they count.
  std::vector<std::string> Files() const;

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
