#include <dspace/tracks/GroundTracks.h>

#include <cmath>
#include <utility>

#include <dspace/Error.h>
#include <dspace/tracks/TrackFile.h>
#include <dspace/tracks/TrackMap.h>

#include <dspace/pyramid/JoinRectangles.h>

namespace dspace {
namespace {

// Each is compared with every tile in memory, while all who read tiles wait.
constexpr std::size_t MaximumRectangles = 256;
constexpr double OneDegree = M_PI / 180.0;

} // namespace

GroundTracks::GroundTracks(const std::string& name, std::shared_ptr<const PostSource> bare,
                           const Eigen::Affine2d& postToScene, const SceneFrame& frame,
                           const Crs& crs, const WheelTracksOptions& options)
    : Name_(name), Frame_(frame), Crs_(crs), Bare_(std::move(bare)),
      Tracks_(std::make_shared<WheelTracks>(name, options)),
      Posts_(std::make_shared<const TrackPosts>(this->Bare_, this->Tracks_, postToScene)) {}

GroundTracks::GroundTracks(const std::string& name, std::shared_ptr<const PostSource> bare,
                           const PostPlacement& placement, const Eigen::Affine2d& mapToPost,
                           const Crs& crs, const WheelTracksOptions& options)
    : Name_(name), Placement_(placement), MapToPost_(mapToPost), Crs_(crs), Bare_(std::move(bare)),
      Tracks_(std::make_shared<WheelTracks>(name, options)),
      Posts_(std::make_shared<const TrackPosts>(this->Bare_, this->Tracks_, placement)) {}

std::shared_ptr<const TrackPosts> GroundTracks::PostsOn(std::shared_ptr<const PostSource> bare,
                                                        const PostPlacement& placement) const {
  return std::make_shared<const TrackPosts>(std::move(bare), this->Tracks_, placement);
}

std::vector<TrackReach> GroundTracks::Add(const std::vector<TrackAddition>& additions) {
  if (this->Frame_) {
    return this->Tracks_->Add(additions);
  }
  std::shared_ptr<const TrackChart> chart =
      this->Tracks_->Empty() ? nullptr : this->Tracks_->Chart();
  std::vector<TrackAddition> charted = additions;
  for (TrackAddition& addition : charted) {
    for (std::vector<TrackContact>* contacts : {&addition.contacts, &addition.skipped}) {
      for (TrackContact& contact : *contacts) {
        const Eigen::Vector2d angles = contact.place * OneDegree;
        if (!angles.allFinite() || std::abs(contact.place.y()) > 90.0) {
          throw Error(Error::Kind::InvalidArgument, this->Name_,
                      "a contact of track '" + addition.name + "' is at longitude " +
                          std::to_string(contact.place.x()) + " and latitude " +
                          std::to_string(contact.place.y()) +
                          " deg; accepted: finite numbers, latitudes from -90 to 90");
        }
        const Eigen::Vector3d up = TrackMap::UpOf(angles);
        if (!chart) {
          chart = std::make_shared<const TrackChart>(this->Placement_.Body(), up);
        }
        if (chart->Distance(up) > TrackChart::Reach) {
          throw Error(Error::Kind::InvalidArgument, this->Name_,
                      "a contact of track '" + addition.name + "' is " +
                          std::to_string(chart->Distance(up) / OneDegree) +
                          " deg of arc from the first contact of all tracks; accepted: up to 120. "
                          "After all tracks are cleared, new ones may start anywhere");
        }
        contact.place = chart->ToChart(up);
        contact.heading += chart->East(up); // NaN stays
      }
    }
  }
  if (chart && this->Tracks_->Empty()) {
    this->Tracks_->SetChart(chart);
  }
  return this->Tracks_->Add(charted);
}

std::vector<TrackReach> GroundTracks::Restore(const std::vector<TrackStroke>& strokes,
                                              bool continues,
                                              const std::optional<Eigen::Vector3d>& anchor) {
  if (!this->Frame_ && !strokes.empty()) {
    if (!anchor || !anchor->allFinite() || std::abs(anchor->norm() - 1.0) > 1e-9) {
      throw Error(Error::Kind::InvalidArgument, this->Name_,
                  "its wheel tracks are restored without the vertical of their anchor; accepted on "
                  "a body: a unit vector");
    }
    if (this->Tracks_->Empty()) {
      this->Tracks_->SetChart(std::make_shared<const TrackChart>(this->Placement_.Body(), *anchor));
    } else if (this->Tracks_->Chart()->Anchor() != *anchor) {
      throw Error(Error::Kind::InvalidArgument, this->Name_,
                  "its wheel tracks have another anchor than those that are to be restored; "
                  "accepted: the same, or no tracks");
    }
  }
  return this->Tracks_->Restore(strokes, continues);
}

std::optional<Eigen::Vector3d> GroundTracks::Anchor() const {
  const std::shared_ptr<const TrackChart> chart = this->Tracks_->Chart();
  return chart && !this->Tracks_->Empty() ? std::optional(chart->Anchor()) : std::nullopt;
}

std::vector<PostRectangle> GroundTracks::RectanglesOf(const TrackPosts& posts,
                                                      const std::vector<TrackReach>& changed) {
  return JoinRectangles(posts.RectanglesOf(changed), MaximumRectangles);
}

std::vector<TrackReach> GroundTracks::Clear() {
  return this->Tracks_->Clear();
}

Eigen::Vector2d GroundTracks::ToAngles(const Eigen::Vector2d& map) const {
  return this->Placement_.Angles(this->MapToPost_ * map) / OneDegree;
}

Eigen::Vector2d GroundTracks::ToMap(const Eigen::Vector2d& angles) const {
  return this->MapToPost_.inverse() * this->Placement_.PostAt(angles * OneDegree);
}

void GroundTracks::Save(const std::string& path) const {
  std::vector<TrackStroke> strokes = this->Tracks_->Strokes();
  if (this->Frame_) {
    WriteTracks(path, strokes, this->Crs_, [this](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(this->Frame_->SceneToMap({p.x(), p.y(), 0.0}).head<2>());
    });
    return;
  }
  const std::shared_ptr<const TrackChart> chart = this->Tracks_->Chart();
  for (TrackStroke& stroke : strokes) {
    double before = 0.0; // longitude [deg], so that a line takes the shorter way
    for (TrackContact& contact : stroke.contacts) {
      const Eigen::Vector3d up = chart->ToUp(contact.place);
      const double longitude = std::atan2(up.y(), up.x()) / OneDegree;
      before += std::remainder(longitude - before, 360.0);
      contact.place = {before, std::atan2(up.z(), up.head<2>().norm()) / OneDegree};
      contact.heading -= chart->East(up);
    }
  }
  WriteTracks(path, strokes, this->Crs_,
              [this](const Eigen::Vector2d& angles) { return this->ToMap(angles); });
}

std::vector<TrackAddition> GroundTracks::Read(const std::string& path, std::size_t most) const {
  std::vector<TrackAddition> tracks =
      ReadTracks(path, this->Crs_, [this](const Eigen::Vector2d& p) {
        return this->Frame_
                   ? Eigen::Vector2d(this->Frame_->MapToScene({p.x(), p.y(), 0.0}).head<2>())
                   : this->ToAngles(p);
      });
  std::size_t contacts = 0;
  for (const TrackAddition& track : tracks) {
    contacts += track.contacts.size();
  }
  if (contacts > most) {
    throw Error(Error::Kind::Resource, "file '" + path + "'",
                "its tracks have " + std::to_string(contacts) + " contacts; accepted: up to " +
                    std::to_string(most) + " of a file");
  }
  return tracks;
}

} // namespace dspace
