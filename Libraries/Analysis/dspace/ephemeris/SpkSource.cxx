#include <dspace/ephemeris/SpkSource.h>

namespace dspace {

SpkSource::SpkSource(const std::string& path) : SpkSource(std::make_shared<const SpkFile>(path)) {}

SpkSource::SpkSource(std::shared_ptr<const SpkFile> file)
    : File_(std::move(file)), Name_("kernel '" + this->File_->File().Path() + "'") {
  const auto& segments = this->File_->Segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const SpkFile::Segment& segment = segments[i];
    this->Coverages_.push_back(
        {segment.target, segment.center, segment.frame, segment.begin, segment.end, segment.name});
    auto& order = this->ByBody_[segment.target];
    order.insert(order.begin(), i);
  }
}

std::string SpkSource::Accuracy(int /*body*/) const {
  return {};
}

std::optional<StateSource::Link> SpkSource::Find(int body, double tdb) const {
  const auto found = this->ByBody_.find(body);
  if (found == this->ByBody_.end()) {
    return std::nullopt;
  }
  for (const std::size_t index : found->second) {
    const Coverage& coverage = this->Coverages_[index];
    if (tdb >= coverage.begin && tdb <= coverage.end) {
      return Link{coverage.center, coverage.frame, this->File_->At(index, tdb), int(index)};
    }
  }
  return std::nullopt;
}

} // namespace dspace
