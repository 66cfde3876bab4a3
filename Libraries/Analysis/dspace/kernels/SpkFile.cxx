#include <dspace/kernels/SpkFile.h>

#include <cmath>
#include <mutex>

#include <dspace/Checks.h>
#include <dspace/kernels/SpkArray.h>

namespace dspace {

// A segment's reader, made when it is first asked.
struct SpkFile::Opened {
  std::once_flag once;
  std::unique_ptr<SpkArray> array;
};

bool SpkFile::Segment::IsRead() const {
  return SpkArray::IsRead(this->type);
}

SpkFile::SpkFile(const std::string& path) : SpkFile(std::make_shared<const DafFile>(path)) {}

SpkFile::SpkFile(std::shared_ptr<const DafFile> file) : File_(std::move(file)) {
  const DafFile& daf = *this->File_;
  if ((!daf.Kind().empty() && daf.Kind() != "SPK") || daf.DoubleCount() != 2 ||
      daf.IntegerCount() != 6) {
    throw Error(Error::Kind::Corrupt, daf.Label(),
                "it is " + (daf.Kind().empty() ? std::string("another file") : "of " + daf.Kind()) +
                    "; accepted: an SPK, whose summaries have 2 doubles and 6 integers");
  }
  for (const DafFile::Array& array : daf.Arrays()) {
    Segment segment;
    segment.name = array.name;
    segment.target = array.integers[0];
    segment.center = array.integers[1];
    segment.frame = array.integers[2];
    segment.type = array.integers[3];
    segment.begin = array.doubles[0];
    segment.end = array.doubles[1];
    if (!std::isfinite(segment.begin) || !std::isfinite(segment.end) ||
        segment.begin > segment.end || segment.target == segment.center) {
      throw Error(Error::Kind::Corrupt, daf.Label(),
                  "segment '" + segment.name + "' of body " + std::to_string(segment.target) +
                      " from " + std::to_string(segment.center) + " covers " +
                      NumberText(segment.begin) + " to " + NumberText(segment.end) +
                      " s past J2000; accepted: two bodies, and a span");
    }
    this->Segments_.push_back(std::move(segment));
  }
  this->Opened_ = std::make_unique<Opened[]>(this->Segments_.size());
}

SpkFile::~SpkFile() = default;

const SpkArray& SpkFile::ArrayOf(std::size_t index) const {
  Opened& opened = this->Opened_[index];
  std::call_once(opened.once, [&] {
    opened.array =
        SpkArray::Open(*this->File_, this->File_->Arrays()[index], this->Segments_[index].type);
  });
  return *opened.array;
}

State SpkFile::At(std::size_t index, double tdb) const {
  const Segment& segment = this->Segments_.at(index);
  if (!(tdb >= segment.begin && tdb <= segment.end)) {
    Reject(this->File_->Label(), NumberText(tdb) + " s past J2000 is outside segment '" +
                                     segment.name + "'; accepted: " + NumberText(segment.begin) +
                                     " to " + NumberText(segment.end));
  }
  const State state = this->ArrayOf(index).At(tdb);
  if (!state.position.allFinite() || !state.velocity.allFinite()) {
    throw Error(Error::Kind::Corrupt, this->File_->Label(),
                "segment '" + segment.name + "' has no finite state at " + NumberText(tdb) +
                    " s past J2000");
  }
  return state;
}

} // namespace dspace
