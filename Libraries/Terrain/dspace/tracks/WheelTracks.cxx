#include <dspace/tracks/WheelTracks.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr double CellSide = 2.0; // [m]
constexpr double Farthest = 1e9; // [m]
constexpr std::size_t ContactBytes = 33;
constexpr std::size_t EntryBytes = 16; // vectors grow ahead
constexpr std::size_t CellBytes = 96;
constexpr std::size_t StrokeBytes = 4096;

std::uint64_t CellAt(std::int64_t x, std::int64_t y) {
  return (std::uint64_t(std::uint32_t(x)) << 32) | std::uint32_t(y);
}

struct CellRange {
  std::int64_t x0, y0, x1, y1; // inclusive
  explicit CellRange(const Eigen::AlignedBox2d& box) {
    const auto cell = [](double v) {
      return std::int64_t(std::floor(std::clamp(v, -2.0 * Farthest, 2.0 * Farthest) / CellSide));
    };
    this->x0 = cell(box.min().x());
    this->y0 = cell(box.min().y());
    this->x1 = cell(box.max().x());
    this->y1 = cell(box.max().y());
  }
  double Count() const { return double(this->x1 - this->x0 + 1) * double(this->y1 - this->y0 + 1); }
  template<typename Visit> void ForEach(const Visit& visit) const {
    for (std::int64_t y = this->y0; y <= this->y1; ++y) {
      for (std::int64_t x = this->x0; x <= this->x1; ++x) {
        visit(CellAt(x, y));
      }
    }
  }
};

} // namespace

WheelTracks::WheelTracks(std::string name, const WheelTracksOptions& options)
    : Name_(std::move(name)), Options_(options) {
  if (options.byteBudget < (std::size_t(64) << 10)) {
    throw Error(Error::Kind::InvalidArgument, this->Name_,
                "a budget of " + std::to_string(options.byteBudget) +
                    " bytes for wheel tracks is rejected; accepted is 64 KiB (65536) or more");
  }
  if (!(options.tolerance >= 0.0 && options.tolerance <= 0.1)) {
    throw Error(Error::Kind::InvalidArgument, this->Name_,
                "a tolerance of " + std::to_string(options.tolerance) +
                    " m for wheel tracks is rejected; accepted is 0 to 0.1");
  }
}

TrackContact WheelTracks::Whole(const KeptContact& c) {
  return {{c.x, c.y}, double(c.sinkage), double(c.heading), c.rolled};
}

TrackSegment WheelTracks::SegmentOf(const Stroke& stroke, std::size_t index) const {
  const std::size_t next = std::min(index + 1, stroke.contacts.size() - 1);
  return this->SegmentOf(stroke.profile, stroke.contacts[index], stroke.contacts[next]);
}

TrackSegment WheelTracks::SegmentOf(const TrackProfile& profile, const KeptContact& from,
                                    const KeptContact& to) const {
  double stretch = 1.0;
  if (this->Chart_) {
    stretch = 1.01 * TrackChart::Widest *
              std::max(this->ScaleAt(from.x, from.y), this->ScaleAt(to.x, to.y));
  }
  return {profile, Whole(from), Whole(to), stretch};
}

double WheelTracks::ScaleAt(double x, double y) const {
  return this->Chart_ ? this->Chart_->Scale(Eigen::Vector2d(x, y)) : 1.0;
}

void WheelTracks::SetChart(std::shared_ptr<const TrackChart> chart) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (!this->Strokes_.empty()) {
    throw Error(Error::Kind::Internal, this->Name_, "it has wheel tracks in another chart");
  }
  this->Chart_ = std::move(chart);
}

std::shared_ptr<const TrackChart> WheelTracks::Chart() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Chart_;
}

// At most, and no more where all its lines are new: of its new contacts and of every cell that they
// reach. `taken`: new cells of drafts before it.
std::size_t WheelTracks::CostOf(const TrackDraft& draft, std::unordered_set<Cell>& taken) const {
  const bool isNew = draft.stroke >= this->Strokes_.size();
  const std::size_t there =
      isNew ? 0 : this->Strokes_[draft.stroke].contacts.size() - draft.kept; // of its contacts
  std::size_t bytes = isNew ? StrokeBytes : 0;
  bytes += (draft.contacts.size() - there) * ContactBytes;
  std::vector<Cell> cells;
  const std::size_t lines = std::max<std::size_t>(draft.contacts.size(), 2) - 1;
  for (std::size_t i = 0; i < lines; ++i) {
    const std::size_t next = std::min(i + 1, draft.contacts.size() - 1);
    const TrackSegment segment =
        this->SegmentOf(draft.profile, draft.contacts[i], draft.contacts[next]);
    const CellRange range(segment.Box());
    if (range.Count() * double(EntryBytes) > double(this->Options_.byteBudget)) {
      return this->Options_.byteBudget + 1; // a line around the world
    }
    range.ForEach([&](Cell cell) { cells.push_back(cell); });
  }
  bytes += cells.size() * EntryBytes;
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  for (const Cell cell : cells) {
    bytes += !this->Cells_.count(cell) && taken.insert(cell).second ? CellBytes : 0;
  }
  return bytes;
}

void WheelTracks::RequireBudget(std::size_t cost) const {
  if (this->Bytes_ + cost > this->Options_.byteBudget) {
    throw Error(Error::Kind::Resource, this->Name_,
                "its wheel tracks hold " + std::to_string(this->Bytes_) +
                    " bytes and would need up to " + std::to_string(cost) +
                    " more, of a budget of " + std::to_string(this->Options_.byteBudget) +
                    "; clear them, or give a larger budget when the terrain is opened");
  }
}

void WheelTracks::AllocateSquares(Cell cell) {
  std::int64_t x = std::int32_t(cell >> 32);
  std::int64_t y = std::int32_t(cell & 0xffffffffu);
  for (auto& squares : this->Squares_) {
    x = x >> 3; // rounded down
    y = y >> 3;
    if (++squares[CellAt(x, y)] > 1) {
      return; // nor are larger ones new
    }
  }
}

void WheelTracks::ReleaseSquares(Cell cell) {
  std::int64_t x = std::int32_t(cell >> 32);
  std::int64_t y = std::int32_t(cell & 0xffffffffu);
  for (auto& squares : this->Squares_) {
    x = x >> 3;
    y = y >> 3;
    const auto found = squares.find(CellAt(x, y));
    if (--found->second > 0) {
      return; // larger ones hold it still
    }
    squares.erase(found);
  }
}

// A line that is no more: what is kept depends on the lines that there are, not on how they came.
void WheelTracks::Forget(std::uint64_t entry, const Eigen::AlignedBox2d& box) {
  CellRange(box).ForEach([&](Cell cell) {
    const auto found = this->Cells_.find(cell);
    if (found == this->Cells_.end()) {
      return;
    }
    std::vector<std::uint64_t>& entries = found->second;
    const auto at = std::find(entries.rbegin(), entries.rend(), entry);
    if (at == entries.rend()) {
      return;
    }
    entries.erase(std::next(at).base());
    this->Bytes_ -= EntryBytes;
    if (entries.empty()) {
      this->Cells_.erase(found);
      this->ReleaseSquares(cell);
      this->Bytes_ -= CellBytes;
    }
  });
}

bool WheelTracks::Reaches(const Eigen::AlignedBox2d& box) const {
  CellRange range(box);
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const auto any = [&range](const auto& squares) {
    for (std::int64_t y = range.y0; y <= range.y1; ++y) {
      for (std::int64_t x = range.x0; x <= range.x1; ++x) {
        if (squares.count(CellAt(x, y)) != 0) {
          return true;
        }
      }
    }
    return false;
  };
  constexpr double Few = 25.0;
  if (range.Count() <= Few) {
    return any(this->Cells_);
  }
  for (const auto& squares : this->Squares_) {
    for (std::int64_t* end : {&range.x0, &range.y0, &range.x1, &range.y1}) {
      *end = *end >> 3;
    }
    if (range.Count() <= Few) {
      return any(squares);
    }
  }
  return any(this->Squares_.back());
}

std::array<double, 2> WheelTracks::Changes() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Changes_;
}

void WheelTracks::Commit(TrackDraft& draft, std::vector<TrackReach>& changed) {
  if (draft.stroke == this->Strokes_.size()) {
    this->Strokes_.push_back({draft.name, draft.profile, {}, {}});
    this->Bytes_ += StrokeBytes;
  }
  Stroke& stroke = this->Strokes_[draft.stroke];
  this->Latest_[draft.name] = draft.stroke;
  const std::size_t before = stroke.contacts.size();
  const auto same = [](const KeptContact& a, const KeptContact& b) {
    return a.x == b.x && a.y == b.y && a.rolled == b.rolled && a.sinkage == b.sinkage;
  };
  // A last line that stays as it is has not changed.
  std::size_t first = draft.kept;
  if (before - draft.kept == 2 && draft.contacts.size() >= 2 &&
      same(stroke.contacts.back(), draft.contacts[1])) {
    ++first;
  }
  const std::size_t had = before == 0 ? 0 : std::max<std::size_t>(before, 2) - 1; // lines
  if (first == draft.kept && first < had) { // its line, as it was
    const Eigen::AlignedBox2d box = this->SegmentOf(stroke, first).Box();
    changed.push_back({box, 2.0 * stroke.profile.Reach()});
    this->Forget((std::uint64_t(draft.stroke) << 32) | first, box);
  }
  stroke.contacts.resize(draft.kept);
  stroke.contacts.insert(stroke.contacts.end(), draft.contacts.begin(), draft.contacts.end());
  stroke.skipped = std::move(draft.skipped);
  for (const KeptContact& contact : draft.contacts) {
    this->Changes_[0] =
        std::min(this->Changes_[0], -double(contact.sinkage) - stroke.profile.treadDepth);
  }
  this->Changes_[1] = std::max(this->Changes_[1], stroke.profile.rimHeight);
  this->Bytes_ += (stroke.contacts.size() - before) * ContactBytes;
  const std::size_t lines = std::max<std::size_t>(stroke.contacts.size(), 2) - 1;
  for (std::size_t i = first; i < lines; ++i) {
    const Eigen::AlignedBox2d box = this->SegmentOf(stroke, i).Box();
    const std::uint64_t entry = (std::uint64_t(draft.stroke) << 32) | i;
    CellRange(box).ForEach([&](Cell cell) {
      const auto [found, isNew] = this->Cells_.try_emplace(cell);
      std::vector<std::uint64_t>& entries = found->second;
      if (isNew) {
        this->Bytes_ += CellBytes;
        this->AllocateSquares(cell);
      }
      entries.push_back(entry);
      this->Bytes_ += EntryBytes;
    });
    changed.push_back({box, 2.0 * stroke.profile.Reach()});
  }
}

std::vector<TrackReach> WheelTracks::Add(const std::vector<TrackAddition>& additions) {
  std::set<std::string> names;
  for (const TrackAddition& addition : additions) {
    CheckStroke(addition, this->Name_);
    if (!names.insert(addition.name).second && !addition.begin) {
      throw Error(Error::Kind::InvalidArgument, this->Name_,
                  "track '" + addition.name + "' is given twice; accepted: once, or with `begin`");
    }
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  std::vector<TrackReach> changed;
  std::size_t cost = 0;
  std::unordered_set<Cell> taken;
  std::vector<TrackDraft> drafts;
  std::size_t strokes = this->Strokes_.size();
  for (const TrackAddition& addition : additions) {
    if (addition.contacts.empty()) {
      continue;
    }
    TrackDraft draft = this->Begin(addition);
    for (const TrackContact& contact : addition.contacts) {
      draft.Append(contact, addition.exact, this->Options_.tolerance,
                   this->ScaleAt(contact.place.x(), contact.place.y()));
    }
    cost += this->CostOf(draft, taken);
    this->RequireBudget(cost);
    if (draft.stroke == this->Strokes_.size()) {
      draft.stroke = strokes++;
    }
    drafts.push_back(std::move(draft));
  }
  for (TrackDraft& draft : drafts) {
    this->Commit(draft, changed);
  }
  return changed;
}

std::vector<TrackReach> WheelTracks::Clear() {
  constexpr std::size_t Most = 256; // boxes; then one
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  std::vector<TrackReach> changed;
  for (const Stroke& stroke : this->Strokes_) {
    const std::size_t lines = std::max<std::size_t>(stroke.contacts.size(), 2) - 1;
    for (std::size_t i = 0; i < lines; ++i) {
      const Eigen::AlignedBox2d box = this->SegmentOf(stroke, i).Box();
      const double width = 2.0 * stroke.profile.Reach();
      if (changed.size() < Most) {
        changed.push_back({box, width});
      } else {
        changed.back().box.extend(box);
        changed.back().width = std::max(changed.back().width, width);
      }
    }
  }
  this->Strokes_.clear();
  this->Latest_.clear();
  this->Cells_.clear();
  for (auto& squares : this->Squares_) {
    squares.clear();
  }
  this->Changes_ = {0.0, 0.0};
  this->Bytes_ = 0;
  return changed;
}

std::vector<TrackSegment> WheelTracks::Near(const Eigen::AlignedBox2d& box, double width) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  std::vector<std::uint64_t> entries;
  const CellRange range(box);
  if (range.Count() > double(this->Cells_.size())) {
    for (const auto& [cell, within] : this->Cells_) {
      const auto x = std::int64_t(std::int32_t(cell >> 32));
      const auto y = std::int64_t(std::int32_t(cell & 0xffffffffu));
      if (x >= range.x0 && x <= range.x1 && y >= range.y0 && y <= range.y1) {
        entries.insert(entries.end(), within.begin(), within.end());
      }
    }
  } else {
    range.ForEach([&](Cell cell) {
      const auto found = this->Cells_.find(cell);
      if (found != this->Cells_.end()) {
        entries.insert(entries.end(), found->second.begin(), found->second.end());
      }
    });
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  std::vector<TrackSegment> segments;
  for (const std::uint64_t entry : entries) {
    const Stroke& stroke = this->Strokes_[std::size_t(entry >> 32)];
    if (2.0 * stroke.profile.Reach() < width) {
      continue;
    }
    TrackSegment segment = this->SegmentOf(stroke, std::size_t(entry & 0xffffffffu));
    if (segment.Box().intersects(box)) {
      segments.push_back(std::move(segment));
    }
  }
  return segments;
}

TrackDraft WheelTracks::Begin(const TrackAddition& addition) const {
  TrackDraft draft;
  draft.name = addition.name;
  draft.profile = addition.profile;
  draft.stroke = this->Strokes_.size();
  const auto latest = this->Latest_.find(addition.name);
  if (addition.begin || latest == this->Latest_.end()) {
    return draft;
  }
  const Stroke& stroke = this->Strokes_[latest->second];
  if (!(stroke.profile == addition.profile)) {
    draft.contacts = {stroke.contacts.back()};
    return draft;
  }
  draft.stroke = latest->second;
  draft.kept = stroke.contacts.size() - std::min<std::size_t>(stroke.contacts.size(), 2);
  draft.contacts.assign(stroke.contacts.begin() + std::ptrdiff_t(draft.kept),
                        stroke.contacts.end());
  draft.skipped = stroke.skipped;
  return draft;
}

bool WheelTracks::Empty() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Strokes_.empty();
}

TrackStatistics WheelTracks::Statistics() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  TrackStatistics statistics;
  statistics.bytes = this->Bytes_;
  statistics.strokes = this->Strokes_.size();
  for (const Stroke& stroke : this->Strokes_) {
    statistics.contacts += stroke.contacts.size();
    for (std::size_t i = 1; i < stroke.contacts.size(); ++i) {
      const KeptContact& from = stroke.contacts[i - 1];
      const KeptContact& to = stroke.contacts[i];
      statistics.length += std::hypot(to.x - from.x, to.y - from.y) / this->ScaleAt(to.x, to.y);
    }
  }
  return statistics;
}

std::size_t WheelTracks::StrokeCount() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Strokes_.size();
}

std::vector<TrackStroke> WheelTracks::Strokes(std::size_t first) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  std::vector<TrackStroke> strokes;
  for (std::size_t i = first; i < this->Strokes_.size(); ++i) {
    const Stroke& stroke = this->Strokes_[i];
    TrackStroke& whole = strokes.emplace_back();
    whole.name = stroke.name;
    whole.profile = stroke.profile;
    std::transform(stroke.contacts.begin(), stroke.contacts.end(),
                   std::back_inserter(whole.contacts), Whole);
    std::transform(stroke.skipped.begin(), stroke.skipped.end(), std::back_inserter(whole.skipped),
                   Whole);
  }
  return strokes;
}

std::vector<TrackReach> WheelTracks::Restore(const std::vector<TrackStroke>& strokes,
                                             bool continues) {
  const auto reject = [this](const TrackStroke& stroke, const std::string& what) {
    throw Error(Error::Kind::InvalidArgument, "track '" + stroke.name + "' on " + this->Name_,
                what);
  };
  for (const TrackStroke& stroke : strokes) {
    CheckStroke(stroke, this->Name_);
    if (stroke.contacts.empty()) {
      reject(stroke, "it has no contact; accepted to be restored: one or more");
    }
    if (stroke.skipped.size() > TrackDraft::MaximumSkipped) {
      reject(stroke, "it has " + std::to_string(stroke.skipped.size()) +
                         " contacts on its last line; accepted: up to " +
                         std::to_string(TrackDraft::MaximumSkipped));
    }
    for (const auto* list : {&stroke.contacts, &stroke.skipped}) {
      for (const TrackContact& contact : *list) {
        if (std::isnan(contact.rolled)) {
          reject(stroke, "the distance rolled is nan; accepted to be restored: finite numbers");
        }
      }
    }
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (continues &&
      (strokes.empty() || this->Strokes_.empty() || this->Strokes_.back().name != strokes[0].name ||
       !(this->Strokes_.back().profile == strokes[0].profile))) {
    throw Error(Error::Kind::InvalidArgument, this->Name_,
                "its last wheel track is not of the name and the sizes of the one that is to go on "
                "with it; accepted: parts of one track, one after the other");
  }
  const auto half = [](const TrackContact& c) {
    return KeptContact{c.place.x(), c.place.y(), c.rolled, float(c.heading), float(c.sinkage)};
  };
  std::vector<TrackDraft> drafts;
  std::unordered_set<Cell> taken;
  std::size_t cost = 0;
  for (const TrackStroke& stroke : strokes) {
    TrackDraft& draft = drafts.emplace_back();
    draft.name = stroke.name;
    draft.profile = stroke.profile;
    draft.stroke = this->Strokes_.size() + drafts.size() - 1;
    if (continues) {
      --draft.stroke;
      if (drafts.size() == 1) { // from its last contact on
        draft.kept = this->Strokes_.back().contacts.size() - 1;
        draft.contacts.push_back(this->Strokes_.back().contacts.back());
      }
    }
    std::transform(stroke.contacts.begin(), stroke.contacts.end(),
                   std::back_inserter(draft.contacts), half);
    std::transform(stroke.skipped.begin(), stroke.skipped.end(), std::back_inserter(draft.skipped),
                   half);
    cost += this->CostOf(draft, taken);
    this->RequireBudget(cost);
  }
  std::vector<TrackReach> changed;
  for (TrackDraft& draft : drafts) {
    this->Commit(draft, changed);
  }
  return changed;
}

} // namespace dspace
