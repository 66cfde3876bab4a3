// States from a SPICE kernel.
#ifndef DSPACE_ANALYSIS_SPK_SOURCE_H
#define DSPACE_ANALYSIS_SPK_SOURCE_H

#include <memory>
#include <unordered_map>

#include <dspace/ephemeris/StateSource.h>
#include <dspace/kernels/SpkFile.h>

namespace dspace {

// Of several segments that know a body at a time, the last in the file counts, as in SPICE.
class SpkSource final : public StateSource {
public:
  // Throws as SpkFile does.
  explicit SpkSource(const std::string& path);
  explicit SpkSource(std::shared_ptr<const SpkFile> file);

  const SpkFile& File() const { return *this->File_; }
  const std::string& Name() const override { return this->Name_; }
  std::string Accuracy(int body) const override; // not stated
  const std::vector<Coverage>& Coverages() const override { return this->Coverages_; }
  std::optional<Link> Find(int body, double tdb) const override;

private:
  std::shared_ptr<const SpkFile> File_;
  std::string Name_;
  std::vector<Coverage> Coverages_;                          // one per segment
  std::unordered_map<int, std::vector<std::size_t>> ByBody_; // segments in the order of search
};

} // namespace dspace

#endif
