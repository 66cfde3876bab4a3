// Wheel tracks: made, cleared, saved, loaded.
#include <cmath>

#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/TrackMessages.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr int ContactSize = 5; // x y heading_deg sinkage rolled
// Of a file, in one command: 32 bytes each.
constexpr std::size_t MostLoaded = std::size_t(16) << 20;

StreamedTerrain& FindTracked(const Context& context, const std::string& name) {
  auto* terrain = dynamic_cast<ClipmapTerrainObject*>(&FindTerrain(context, name));
  if (!terrain) {
    throw Error(Error::Kind::Unsupported, "terrain '" + name + "'",
                "it is drawn as triangles, which take no wheel tracks; accepted: mode clipmap");
  }
  return terrain->ChangedSurface();
}

void TrackWheels(const Context& context, v1::TrackWheels& command) {
  StreamedTerrain& terrain = FindTracked(context, command.terrain());
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
    const std::size_t n =
        RowsOf(wheel.contact_size(), ContactSize, "terrain '" + command.terrain() + "'", "contact");
    for (std::size_t i = 0; i < n; ++i) {
      const double* value = wheel.contact().data() + i * ContactSize;
      TrackContact contact;
      contact.place = {value[0], value[1]};
      contact.heading = value[2] * Degree;
      contact.sinkage = value[3];
      contact.rolled = value[4];
      addition.contacts.push_back(contact);
    }
    additions.push_back(std::move(addition));
  }
  terrain.AddTracks(additions);
}

void ClearTracks(const Context& context, v1::ClearTracks& command) {
  FindTracked(context, command.terrain()).ClearTracks();
}

void SaveTracks(const Context& context, v1::SaveTracks& command) {
  FindTracked(context, command.terrain()).SaveTracks(command.path());
}

void LoadTracks(const Context& context, v1::LoadTracks& command) {
  StreamedTerrain& terrain = FindTracked(context, command.terrain());
  if (command.has_read()) {
    terrain.RestoreTracks(ToStrokes(command.read()));
    return;
  }
  command.set_path(AbsolutePath(command.path()));
  const std::size_t before = terrain.Tracks().StrokeCount();
  terrain.LoadTracks(command.path(), MostLoaded);
  Put(terrain.Tracks().Strokes(before), command.mutable_read());
}

void RestoreTracks(const Context& context, v1::RestoreTracks& command) {
  FindTracked(context, command.terrain()).RestoreTracks(ToStrokes(command), command.goes_on());
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
