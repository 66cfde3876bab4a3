// Wheel tracks: made, cleared, saved, loaded.
#include <cmath>
#include <optional>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/TrackMessages.h>

namespace dspace::session {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr int ContactSize = 5; // x y heading_deg sinkage rolled
constexpr int BodySize = 6;    // x y z ...
// Of a file, in one command: 32 bytes each.
constexpr std::size_t MostLoaded = std::size_t(16) << 20;

// Changes the tracks of a terrain, then its drawing.
template<typename Change>
void ChangeTracks(const Context& context, const std::string& name, const Change& change) {
  TerrainObject& terrain = FindTerrain(context, name);
  change(terrain.Ground());
  if (terrain.FollowTracks()) {
    GraphicsObject drawn;
    terrain.Draw(drawn);
    context.GetScene().SetObjectLevels(terrain.Object(), std::move(drawn.levels));
  }
}

// Longitude and latitude of a vertical of a body [deg].
Eigen::Vector2d Angles(const Eigen::Vector3d& up) {
  return Eigen::Vector2d(std::atan2(up.y(), up.x()), std::atan2(up.z(), up.head<2>().norm())) /
         Degree;
}

std::optional<Eigen::Vector3d> AnchorOf(const v1::RestoreTracks& message) {
  if (message.anchor_size() == 0) {
    return std::nullopt;
  }
  RowsOf(message.anchor_size(), 3, "terrain '" + message.terrain() + "'", "anchor");
  return Eigen::Vector3d(message.anchor(0), message.anchor(1), message.anchor(2));
}

void TrackWheels(const Context& context, v1::TrackWheels& command) {
  const TerrainObject& terrain = FindTerrain(context, command.terrain());
  TrackProfile profile;
  profile.width = command.width();
  profile.wall = command.has_wall() ? command.wall() : profile.wall;
  profile.rimWidth = command.rim_width();
  profile.rimHeight = command.rim_height();
  profile.treadPitch = command.tread_pitch();
  profile.treadDepth = command.tread_depth();
  std::vector<TrackAddition> additions;
  for (const v1::TrackWheels::Wheel& wheel : command.wheel()) {
    TrackAddition addition;
    addition.name = wheel.name();
    addition.profile = profile;
    addition.begin = command.begin();
    const int size = terrain.OnBody() ? BodySize : ContactSize;
    const std::size_t n =
        RowsOf(wheel.contact_size(), size, "terrain '" + command.terrain() + "'", "contact");
    for (std::size_t i = 0; i < n; ++i) {
      const double* value = wheel.contact().data() + i * std::size_t(size);
      TrackContact contact;
      contact.place = {value[0], value[1]};
      if (terrain.OnBody()) {
        const Eigen::Vector3d point(value[0], value[1], value[2]);
        if (point.norm() < 1.0) {
          Reject("terrain '" + command.terrain() + "'",
                 "a contact of track '" + wheel.name() +
                     "' is within a metre of the body's centre, where no direction is up; "
                     "accepted: points on the ground");
        }
        contact.place = Angles(terrain.Surface().Up(point));
        ++value;
      }
      contact.heading = value[2] * Degree;
      contact.sinkage = value[3];
      contact.rolled = value[4];
      addition.contacts.push_back(contact);
    }
    additions.push_back(std::move(addition));
  }
  ChangeTracks(context, command.terrain(),
               [&](TrackedGround& ground) { ground.AddTracks(additions); });
}

void ClearTracks(const Context& context, v1::ClearTracks& command) {
  ChangeTracks(context, command.terrain(), [](TrackedGround& ground) { ground.ClearTracks(); });
}

void SaveTracks(const Context& context, v1::SaveTracks& command) {
  FindTerrain(context, command.terrain()).Ground().SaveTracks(command.path());
}

void LoadTracks(const Context& context, v1::LoadTracks& command) {
  ChangeTracks(context, command.terrain(), [&](TrackedGround& ground) {
    if (command.has_read()) {
      ground.RestoreTracks(ToStrokes(command.read()), false, AnchorOf(command.read()));
      return;
    }
    command.set_path(AbsolutePath(command.path()));
    const std::size_t before = ground.Tracks().StrokeCount();
    ground.LoadTracks(command.path(), MostLoaded);
    Put(ground.Tracks().Strokes(before), ground.TracksAnchor(), command.mutable_read());
  });
}

void RestoreTracks(const Context& context, v1::RestoreTracks& command) {
  ChangeTracks(context, command.terrain(), [&](TrackedGround& ground) {
    ground.RestoreTracks(ToStrokes(command), command.goes_on(), AnchorOf(command));
  });
}

} // namespace

void AddTerrainTrackCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kTrackWheels, &C::mutable_track_wheels, TrackWheels);
  registry.Add(C::kClearTracks, &C::mutable_clear_tracks, ClearTracks);
  registry.Add(C::kSaveTracks, &C::mutable_save_tracks, SaveTracks);
  registry.Add(C::kLoadTracks, &C::mutable_load_tracks, LoadTracks);
  registry.Add(C::kRestoreTracks, &C::mutable_restore_tracks, RestoreTracks);
}

} // namespace dspace::session
