#include <dspace/kernels/BinaryPck.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/kernels/ChebyshevRecords.h>

namespace dspace {

BinaryPck::BinaryPck(const std::string& path) : BinaryPck(std::make_shared<const DafFile>(path)) {}

BinaryPck::BinaryPck(std::shared_ptr<const DafFile> file) : File_(std::move(file)) {
  const DafFile& daf = *this->File_;
  if ((!daf.Kind().empty() && daf.Kind() != "PCK") || daf.DoubleCount() != 2 ||
      daf.IntegerCount() != 5) {
    throw Error(Error::Kind::Corrupt, daf.Label(),
                "it is " + (daf.Kind().empty() ? std::string("another file") : "of " + daf.Kind()) +
                    "; accepted: a binary PCK, whose summaries have 2 doubles and 5 integers");
  }
  for (const DafFile::Array& array : daf.Arrays()) {
    Segment segment;
    segment.name = array.name;
    segment.frameClass = array.integers[0];
    segment.inertial = array.integers[1];
    segment.type = array.integers[2];
    segment.begin = array.doubles[0];
    segment.end = array.doubles[1];
    if (!std::isfinite(segment.begin) || !std::isfinite(segment.end) ||
        segment.begin > segment.end) {
      throw Error(Error::Kind::Corrupt, daf.Label(),
                  "segment '" + segment.name + "' covers " + NumberText(segment.begin) + " to " +
                      NumberText(segment.end) + " s past J2000; accepted: a span");
    }
    this->Segments_.push_back(std::move(segment));
  }
}

BinaryPck::Angles BinaryPck::At(std::size_t index, double tdb) const {
  const Segment& segment = this->Segments_.at(index);
  if (segment.type != 2) {
    throw Error(Error::Kind::Unsupported, this->File_->Label(),
                "segment '" + segment.name + "' is of PCK type " + std::to_string(segment.type) +
                    "; accepted: type 2");
  }
  if (!(tdb >= segment.begin && tdb <= segment.end)) {
    Reject(this->File_->Label(), NumberText(tdb) + " s past J2000 is outside segment '" +
                                     segment.name + "'; accepted: " + NumberText(segment.begin) +
                                     " to " + NumberText(segment.end));
  }
  Eigen::Vector3d angles, rates;
  ChebyshevRecords(*this->File_, this->File_->Arrays()[index], 3).At(tdb, angles, rates);
  if (!angles.allFinite() || !rates.allFinite()) {
    throw Error(Error::Kind::Corrupt, this->File_->Label(),
                "segment '" + segment.name + "' has no finite angles at " + NumberText(tdb) +
                    " s past J2000");
  }
  return {angles.x(), angles.y(), angles.z(), rates.x(), rates.y(), rates.z()};
}

} // namespace dspace
