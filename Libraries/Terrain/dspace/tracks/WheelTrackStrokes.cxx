// What is kept of wheel tracks, given out and taken back.
#include <dspace/tracks/WheelTracks.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace {

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
      statistics.length += std::hypot(stroke.contacts[i].x - stroke.contacts[i - 1].x,
                                      stroke.contacts[i].y - stroke.contacts[i - 1].y);
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

std::vector<TrackReach> WheelTracks::Restore(const std::vector<TrackStroke>& strokes, bool goesOn) {
  const auto refuse = [this](const TrackStroke& stroke, const std::string& what) {
    throw Error(Error::Kind::InvalidArgument, "track '" + stroke.name + "' on " + this->Name_,
                what);
  };
  for (const TrackStroke& stroke : strokes) {
    this->Check(stroke);
    if (stroke.contacts.empty()) {
      refuse(stroke, "it has no contact; accepted to be restored: one or more");
    }
    if (stroke.skipped.size() > MostSkipped) {
      refuse(stroke, "it has " + std::to_string(stroke.skipped.size()) +
                         " contacts on its last line; accepted: up to " +
                         std::to_string(MostSkipped));
    }
    for (const auto* list : {&stroke.contacts, &stroke.skipped}) {
      for (const TrackContact& contact : *list) {
        if (std::isnan(contact.rolled)) {
          refuse(stroke, "the distance rolled is nan; accepted to be restored: finite numbers");
        }
      }
    }
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (goesOn &&
      (strokes.empty() || this->Strokes_.empty() || this->Strokes_.back().name != strokes[0].name ||
       !(this->Strokes_.back().profile == strokes[0].profile))) {
    throw Error(Error::Kind::InvalidArgument, this->Name_,
                "its last wheel track is not of the name and the sizes of the one that is to go on "
                "with it; accepted: parts of one track, one after the other");
  }
  const auto half = [](const TrackContact& c) {
    return Contact{c.place.x(), c.place.y(), c.rolled, float(c.heading), float(c.sinkage)};
  };
  std::vector<Draft> drafts;
  std::unordered_set<Cell> taken;
  std::size_t cost = 0;
  for (const TrackStroke& stroke : strokes) {
    Draft& draft = drafts.emplace_back();
    draft.name = stroke.name;
    draft.profile = stroke.profile;
    draft.stroke = this->Strokes_.size() + drafts.size() - 1;
    if (goesOn) {
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
    this->RequireRoom(cost);
  }
  std::vector<TrackReach> changed;
  for (Draft& draft : drafts) {
    this->Commit(draft, changed);
  }
  return changed;
}

} // namespace dspace
