#include <dspace/messages/TrackMessages.h>

#include <algorithm>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

using Stroke = v1::RestoreTracks::Stroke;

constexpr std::size_t MostContacts = 30000; // of a command: 32 bytes each

void PutHead(const TrackStroke& stroke, Stroke* message) {
  message->set_name(stroke.name);
  message->set_width(stroke.profile.width);
  message->set_wall(stroke.profile.wall);
  message->set_rim_width(stroke.profile.rimWidth);
  message->set_rim_height(stroke.profile.rimHeight);
  message->set_tread_pitch(stroke.profile.treadPitch);
  message->set_tread_depth(stroke.profile.treadDepth);
}

void PutContact(const TrackContact& contact, Stroke* message) {
  message->add_place(contact.place.x());
  message->add_place(contact.place.y());
  message->add_rolled(contact.rolled);
  message->add_heading(float(contact.heading)); // as which it is kept
  message->add_sinkage(float(contact.sinkage));
}

void PutAnchor(const std::optional<Eigen::Vector3d>& anchor, v1::RestoreTracks* message) {
  if (anchor) {
    message->mutable_anchor()->Add(anchor->data(), anchor->data() + 3);
  }
}

void PutSkipped(const TrackStroke& stroke, Stroke* message) {
  for (const TrackContact& contact : stroke.skipped) {
    PutContact(contact, message);
  }
  message->set_skipped(std::uint32_t(stroke.skipped.size()));
}

} // namespace

std::vector<TrackStroke> ToStrokes(const v1::RestoreTracks& message) {
  std::vector<TrackStroke> strokes;
  for (const Stroke& given : message.stroke()) {
    const int n = given.rolled_size();
    if (given.place_size() != 2 * n || given.heading_size() != n || given.sinkage_size() != n ||
        given.skipped() > std::uint32_t(n)) {
      throw Error(Error::Kind::InvalidArgument, "track '" + given.name() + "'",
                  "it has " + std::to_string(n) + " distances rolled, " +
                      std::to_string(given.place_size()) + " coordinates, " +
                      std::to_string(given.heading_size()) + " headings and " +
                      std::to_string(given.sinkage_size()) + " sinkages, and says that " +
                      std::to_string(given.skipped()) +
                      " contacts are not its ends; accepted: as many of each, coordinates twice");
    }
    TrackStroke& stroke = strokes.emplace_back();
    stroke.name = given.name();
    stroke.profile = {given.width(),      given.wall(),        given.rim_width(),
                      given.rim_height(), given.tread_pitch(), given.tread_depth()};
    const int kept = n - int(given.skipped());
    for (int i = 0; i < n; ++i) {
      TrackContact contact;
      contact.place = {given.place(2 * i), given.place(2 * i + 1)};
      contact.rolled = given.rolled(i);
      contact.heading = double(given.heading(i));
      contact.sinkage = double(given.sinkage(i));
      (i < kept ? stroke.contacts : stroke.skipped).push_back(contact);
    }
  }
  return strokes;
}

void Put(const std::vector<TrackStroke>& strokes, const std::optional<Eigen::Vector3d>& anchor,
         v1::RestoreTracks* message) {
  PutAnchor(anchor, message);
  for (const TrackStroke& stroke : strokes) {
    Stroke* put = message->add_stroke();
    PutHead(stroke, put);
    for (const TrackContact& contact : stroke.contacts) {
      PutContact(contact, put);
    }
    PutSkipped(stroke, put);
  }
}

void PutTracks(const TrackedGround& ground, const std::string& scene, const std::string& terrain,
               std::vector<v1::Command>& out) {
  const std::optional<Eigen::Vector3d> anchor = ground.TracksAnchor();
  v1::RestoreTracks* restore = nullptr;
  std::size_t room = 0;
  const auto begin = [&](bool continues) {
    v1::Command& command = out.emplace_back();
    command.set_scene(scene);
    restore = command.mutable_restore_tracks();
    restore->set_terrain(terrain);
    PutAnchor(anchor, restore);
    restore->set_goes_on(continues);
    room = MostContacts;
  };
  for (const TrackStroke& stroke : ground.Tracks().Strokes()) {
    constexpr std::size_t Fewest = 2; // so that a stroke's first line is whole where it is cut
    if (room < Fewest) {
      begin(false);
    }
    Stroke* put = restore->add_stroke();
    PutHead(stroke, put);
    for (std::size_t i = 0; i < stroke.contacts.size(); ++i) {
      if (room == 0) {
        begin(true);
        put = restore->add_stroke();
        PutHead(stroke, put);
      }
      PutContact(stroke.contacts[i], put);
      --room;
    }
    PutSkipped(stroke, put);
    room -= std::min(room, stroke.skipped.size() + Fewest); // its head
  }
}

} // namespace dspace::session
