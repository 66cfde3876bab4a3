#include <dspace/kernels/CkFile.h>

#include <algorithm>
#include <cmath>

#include <dspace/kernels/KernelWords.h>

namespace dspace {
namespace {

// The parts of an array of type 3: pointings, their times, every hundredth of these, the begins of
// the intervals, every hundredth of these, and the two counts.
struct Type3 {
  Type3(const DafFile& daf, const DafFile::Array& array, bool hasRates)
      : file(daf), words(daf, array), size(hasRates ? 7 : 4) {
    this->words.RequireCount(2 + this->size + 2);
    this->count = this->words.Whole(array.last, 1, array.Count(), "the number of pointings");
    this->intervals = this->words.Whole(array.last - 1, 1, this->count, "the number of intervals");
    this->pointings = array.first;
    this->times = this->pointings + this->size * this->count;
    this->begins = this->times + this->count + (this->count - 1) / 100;
    const std::int64_t end = this->begins + this->intervals + (this->intervals - 1) / 100 + 2;
    if (this->count > array.Count() / this->size || end - 1 > array.last) {
      this->words.Damaged(std::to_string(this->count) + " pointings in " +
                          std::to_string(this->intervals) + " intervals do not fit into " +
                          std::to_string(array.Count()) + " words");
    }
  }

  double Time(std::int64_t index) const { return this->file.Read(this->times + index); }

  CkFile::Pointing At(std::int64_t index) const {
    double word[7];
    this->file.Read(this->pointings + index * this->size, this->size, word);
    const Eigen::Quaterniond q(word[0], word[1], word[2], word[3]); // scalar first
    if (!(std::abs(q.norm() - 1.0) < 1e-3)) {
      this->words.Damaged("the quaternion of its pointing " + std::to_string(index) +
                          " has a norm of " + NumberText(q.norm()));
    }
    CkFile::Pointing pointing;
    pointing.ticks = this->Time(index);
    pointing.rotation = q.normalized().toRotationMatrix();
    if (this->size == 7) {
      pointing.rate = Eigen::Vector3d(word[4], word[5], word[6]);
      if (!pointing.rate->allFinite()) {
        this->words.Damaged("the rate of its pointing " + std::to_string(index) + " is not finite");
      }
    }
    return pointing;
  }

  const DafFile& file;
  KernelWords words;
  std::int64_t size;
  std::int64_t count = 0, intervals = 0;
  std::int64_t pointings = 0, times = 0, begins = 0; // addresses
};

} // namespace

CkFile::CkFile(const std::string& path) : CkFile(std::make_shared<const DafFile>(path)) {}

CkFile::CkFile(std::shared_ptr<const DafFile> file) : File_(std::move(file)) {
  const DafFile& daf = *this->File_;
  if ((!daf.Kind().empty() && daf.Kind() != "CK") || daf.DoubleCount() != 2 ||
      daf.IntegerCount() != 6) {
    throw Error(Error::Kind::Corrupt, daf.Label(),
                "it is " + (daf.Kind().empty() ? std::string("another file") : "of " + daf.Kind()) +
                    "; accepted: a CK, whose summaries have 2 doubles and 6 integers");
  }
  for (const DafFile::Array& array : daf.Arrays()) {
    Segment segment;
    segment.name = array.name;
    segment.instrument = array.integers[0];
    segment.frame = array.integers[1];
    segment.type = array.integers[2];
    segment.hasRates = array.integers[3] != 0;
    segment.begin = array.doubles[0];
    segment.end = array.doubles[1];
    if (!std::isfinite(segment.begin) || !std::isfinite(segment.end) ||
        segment.begin > segment.end) {
      throw Error(Error::Kind::Corrupt, daf.Label(),
                  "segment '" + segment.name + "' covers " + NumberText(segment.begin) + " to " +
                      NumberText(segment.end) + " ticks; accepted: a span");
    }
    this->Segments_.push_back(std::move(segment));
  }
}

std::optional<CkFile::Pointing> CkFile::At(std::size_t index, double ticks,
                                           double tolerance) const {
  const Segment& segment = this->Segments_.at(index);
  Require(tolerance >= 0.0 && std::isfinite(ticks), this->File_->Label(), "the tolerance",
          tolerance, "0 or more ticks, at a finite time");
  if (segment.type != 3) {
    throw Error(Error::Kind::Unsupported, this->File_->Label(),
                "segment '" + segment.name + "' is of CK type " + std::to_string(segment.type) +
                    "; accepted: type 3");
  }
  if (ticks + tolerance < segment.begin || ticks - tolerance > segment.end) {
    return std::nullopt;
  }
  const Type3 array(*this->File_, this->File_->Arrays()[index], segment.hasRates);
  const std::int64_t after = FirstNotBefore(*this->File_, array.times, array.count, ticks);
  if (after < array.count && array.Time(after) == ticks) {
    return array.At(after);
  }
  if (after > 0 && after < array.count && ticks >= segment.begin && ticks <= segment.end) {
    const double left = array.Time(after - 1);
    const double right = array.Time(after);
    // Both belong to one interval if none begins behind the left one and up to the right one.
    const std::int64_t begin =
        FirstNotBefore(*this->File_, array.begins, array.intervals, std::nextafter(left, right));
    const bool apart = begin < array.intervals && array.file.Read(array.begins + begin) <= right;
    if (!apart && left < ticks && ticks < right) {
      const Pointing from = array.At(after - 1);
      const Pointing to = array.At(after);
      const double part = (ticks - left) / (right - left);
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.rotation * from.rotation.transpose()));
      Pointing pointing;
      pointing.ticks = ticks;
      pointing.rotation =
          Eigen::AngleAxisd(part * turn.angle(), turn.axis()).toRotationMatrix() * from.rotation;
      if (from.rate && to.rate) {
        pointing.rate = (1.0 - part) * *from.rate + part * *to.rate;
      }
      return pointing;
    }
  }
  std::int64_t nearest = std::min(after, array.count - 1);
  if (after > 0 &&
      (after == array.count || ticks - array.Time(after - 1) <= array.Time(after) - ticks)) {
    nearest = after - 1;
  }
  if (!(std::abs(array.Time(nearest) - ticks) <= tolerance)) {
    return std::nullopt;
  }
  return array.At(nearest);
}

std::vector<std::pair<double, double>> CkFile::Intervals(std::size_t index) const {
  const Segment& segment = this->Segments_.at(index);
  if (segment.type != 3) {
    return {{segment.begin, segment.end}};
  }
  const Type3 array(*this->File_, this->File_->Arrays()[index], segment.hasRates);
  const std::vector<double> begins = this->File_->Read(array.begins, array.intervals);
  std::vector<std::pair<double, double>> intervals;
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const std::int64_t next = i + 1 < begins.size() ? FirstNotBefore(*this->File_, array.times,
                                                                     array.count, begins[i + 1])
                                                    : array.count;
    intervals.emplace_back(begins[i], next > 0 ? array.Time(next - 1) : begins[i]);
  }
  return intervals;
}

} // namespace dspace
