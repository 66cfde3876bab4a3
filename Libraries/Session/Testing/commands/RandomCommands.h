// Commands of all kinds at random, most of which are accepted, for tests of what replays them.
#ifndef DSPACE_RANDOM_COMMANDS_H
#define DSPACE_RANDOM_COMMANDS_H

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::testing {

class RandomCommands {
public:
  RandomCommands(unsigned seed, std::string urdf) : Random_(seed), Urdf_(std::move(urdf)) {}

  // Names and ids come from small sets, so that what exists is hit, replaced, removed, made again.
  v1::Command Next();
  void Note(const v1::Command& accepted, const v1::Reply& reply);

private:
  std::uint32_t Up(std::uint32_t n) { return std::uint32_t(this->Random_() % n); }
  double Real() { return std::uniform_real_distribution<>(-3.0, 3.0)(this->Random_); }
  std::string Name(const char* what, std::uint32_t n = 4) {
    return what + std::to_string(this->Up(n));
  }
  template<class T> T One(const std::vector<T>& all, T other) {
    return all.empty() ? other : all[this->Up(std::uint32_t(all.size()))];
  }
  std::uint64_t Frame() { return this->One<std::uint64_t>(this->Frames_, 1); }
  std::uint32_t Object() { return this->One<std::uint32_t>(this->Objects_, 1); }
  std::string Fragment() {
    static const char* const names[] = {"physical", "ornamental", "f0", "f1", "f2"};
    return names[this->Up(5)];
  }
  void Put(v1::Vector3* to) {
    to->set_x(this->Real());
    to->set_y(this->Real());
    to->set_z(this->Real());
  }
  void Put(v1::Pose* to);
  void Put(v1::ObjectSettings* to);
  void Put(v1::Material* to);
  void Frames(v1::Command& c);
  template<class Command> void Mesh(Command* command);
  void Objects(v1::Command& c);
  void Looks(v1::Command& c);
  void Names(v1::Command& c);
  void Cameras(v1::Command& c);
  void Telemetry(v1::Command& c);
  void Messages(v1::Command& c);

  std::mt19937 Random_;
  std::string Urdf_;
  std::vector<std::uint64_t> Frames_ = {1};
  std::vector<std::uint32_t> Objects_;
  std::vector<std::uint64_t> Channels_;
  double Time_ = 0;
};

inline void RandomCommands::Put(v1::Pose* to) {
  this->Put(to->mutable_position());
  const double half = this->Real();
  to->mutable_rotation()->set_w(std::cos(half));
  to->mutable_rotation()->set_z(std::sin(half));
}

inline void RandomCommands::Put(v1::ObjectSettings* to) {
  if (this->Up(2)) {
    to->set_name(this->Name("o", 12));
  }
  to->set_frame(this->Frame());
  to->set_nature(v1::Nature(this->Up(2)));
  if (this->Up(2)) {
    to->set_fragment(this->Fragment());
  }
  to->set_hidden(this->Up(4) == 0);
  if (this->Up(2)) {
    this->Put(to->mutable_material());
  }
}

inline void RandomCommands::Put(v1::Material* to) {
  const std::uint32_t bits = this->Up(32);
  if (bits & 1) {
    to->mutable_color()->set_r(this->Up(2)); // zeros are values too
    to->mutable_color()->set_g(this->Up(3) / 2.0);
  }
  if (bits & 2) {
    to->set_opacity(this->Up(11) / 10.0);
  }
  if (bits & 4) {
    to->set_roughness(this->Up(11) / 10.0);
  }
  if (bits & 8) {
    to->set_wireframe(this->Up(2));
  }
  if (bits & 16) {
    to->set_lit(this->Up(2));
  }
}

inline void RandomCommands::Frames(v1::Command& c) {
  switch (this->Up(10)) {
  case 0:
  case 1:
  case 2:
    c.mutable_create_frame()->set_name(this->Name("g", 9));
    c.mutable_create_frame()->set_parent(this->Frame());
    if (this->Up(2)) {
      this->Put(c.mutable_create_frame()->mutable_pose());
    }
    return;
  case 3:
    c.mutable_remove_frame()->set_frame(this->Frame());
    return;
  case 4:
  case 5:
    c.mutable_reparent_frame()->set_frame(this->Frame());
    c.mutable_reparent_frame()->set_parent(this->Frame());
    c.mutable_reparent_frame()->set_keep_world_pose(this->Up(2));
    return;
  case 6:
    c.mutable_rename_frame()->set_frame(this->Frame());
    c.mutable_rename_frame()->set_name(this->Up(3) ? this->Name("g", 9) : this->Name("arm", 3));
    return;
  case 7:
    if (this->Up(3) == 0) {
      c.mutable_load_robot()->set_path(this->Urdf_);
      c.mutable_load_robot()->set_name(this->Name("arm", 3));
      c.mutable_load_robot()->set_frame(this->Frame());
      c.mutable_load_robot()->set_fragment(this->Up(2) ? "physical" : "f0");
      return;
    }
    if (this->Up(6) == 0) {
      c.mutable_remove_robot()->set_robot(this->Name("arm", 3));
      return;
    }
    c.mutable_set_joints()->set_robot(this->Name("arm", 3));
    c.mutable_set_joints()->add_joint(0);
    c.mutable_set_joints()->add_position(this->Up(3) ? 40 * this->Real() : 20.0);
    c.mutable_set_joints()->set_clamp(true);
    return;
  default: {
    v1::SetPoses* set = c.mutable_set_poses();
    set->add_frame(this->Frame());
    for (int i = 0; i < 3; ++i) {
      set->add_pose(this->Real());
    }
    const double half = this->Real();
    for (const double value : {std::cos(half), 0.0, std::sin(half), 0.0, 1.0 + this->Up(2)}) {
      set->add_pose(value);
    }
  }
  }
}

// One or two parts of one triangle each.
template<class Command> void RandomCommands::Mesh(Command* command) {
  v1::MeshLevel* level = command->add_level();
  for (std::uint32_t n = 1 + this->Up(2); n > 0; --n) {
    v1::MeshData* mesh = level->add_mesh();
    mesh->set_part(this->Name("p", 3));
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, float(1 + this->Up(3)), 0};
    mesh->set_position(std::string(reinterpret_cast<const char*>(points.data()), 36));
  }
}

inline void RandomCommands::Objects(v1::Command& c) {
  switch (this->Up(8)) {
  case 0: {
    this->Put(c.mutable_create_primitive()->mutable_object());
    this->Put(c.mutable_create_primitive()->mutable_box()->mutable_size());
    v1::Vector3* size = c.mutable_create_primitive()->mutable_box()->mutable_size();
    size->set_x(1 + std::abs(size->x()));
    size->set_y(1);
    size->set_z(2);
    return;
  }
  case 1:
    this->Put(c.mutable_create_primitive()->mutable_object());
    c.mutable_create_primitive()->mutable_tilt()->set_radius(1 + this->Up(3));
    c.mutable_create_primitive()->mutable_tilt()->set_tilt_deg(this->Up(90));
    return;
  case 2:
    this->Put(c.mutable_create_trail()->mutable_object());
    c.mutable_create_trail()->set_capacity(2 + this->Up(5));
    c.mutable_create_trail()->set_minimum_spacing(this->Up(3));
    return;
  case 3:
    c.mutable_remove_object()->set_object(this->Object());
    return;
  case 4:
    c.mutable_clear_trail()->set_object(this->Object());
    return;
  case 5:
    this->Put(c.mutable_create_mesh()->mutable_object());
    this->Mesh(c.mutable_create_mesh());
    return;
  case 6:
    c.mutable_set_mesh()->set_object(this->Object());
    this->Mesh(c.mutable_set_mesh());
    return;
  default:
    c.mutable_append_trail()->set_object(this->Object());
    for (std::uint32_t i = 0; i < 3 * (1 + this->Up(4)); ++i) {
      c.mutable_append_trail()->add_point(this->Real());
    }
  }
}

inline void RandomCommands::Looks(v1::Command& c) {
  const std::uint32_t id = this->Object();
  switch (this->Up(10)) {
  case 0:
    c.mutable_set_object_visible()->set_object(id);
    c.mutable_set_object_visible()->set_visible(this->Up(2));
    return;
  case 1:
  case 2:
    c.mutable_set_material()->set_object(id);
    this->Put(c.mutable_set_material()->mutable_material());
    c.mutable_set_material()->set_replace(this->Up(4) == 0);
    return;
  case 3:
    c.mutable_set_object_offset()->set_object(id);
    this->Put(c.mutable_set_object_offset()->mutable_offset()->mutable_position());
    return;
  case 4:
    c.mutable_attach_object()->set_object(id);
    c.mutable_attach_object()->set_frame(this->Frame());
    return;
  case 5:
    c.mutable_move_to_fragment()->set_object(id);
    c.mutable_move_to_fragment()->set_fragment(this->Fragment());
    return;
  case 8:
  case 9:
    c.mutable_set_part()->set_object(id);
    c.mutable_set_part()->set_part(this->Name("p", 3));
    this->Put(c.mutable_set_part()->mutable_material());
    c.mutable_set_part()->set_replace(this->Up(4) == 0);
    if (this->Up(2)) {
      c.mutable_set_part()->set_visible(this->Up(2));
    }
    return;
  case 6:
    c.mutable_set_tilt()->set_object(id);
    c.mutable_set_tilt()->set_tilt_deg(this->Up(90));
    return;
  default:
    c.mutable_set_primitive()->set_object(id);
    if (this->Up(2)) {
      c.mutable_set_primitive()->mutable_shape()->mutable_sphere()->set_radius(1 + this->Up(4));
    } else {
      c.mutable_set_primitive()->mutable_shape()->mutable_tilt()->set_radius(1 + this->Up(4));
    }
  }
}

inline void RandomCommands::Names(v1::Command& c) {
  static const char* const lights[] = {"sun", "sky", "l0", "l1"};
  switch (this->Up(9)) {
  case 0:
    c.mutable_create_fragment()->set_name(this->Name("f", 3));
    c.mutable_create_fragment()->set_nature(v1::Nature(this->Up(2)));
    return;
  case 1:
    c.mutable_remove_fragment()->set_name(this->Fragment());
    return;
  case 2:
    c.mutable_set_fragment_visible()->set_name(this->Fragment());
    c.mutable_set_fragment_visible()->set_visible(this->Up(2));
    return;
  case 3:
  case 4:
    c.mutable_set_light()->set_name(lights[this->Up(4)]);
    c.mutable_set_light()->set_kind(v1::SetLight::Kind(this->Up(5)));
    c.mutable_set_light()->set_frame(this->Up(2) ? this->Frame() : 0);
    this->Put(c.mutable_set_light()->mutable_direction());
    return;
  case 5:
    c.mutable_remove_light()->set_name(lights[this->Up(4)]);
    return;
  case 6: {
    v1::SunState* sun = c.mutable_set_sun()->mutable_sun();
    if (this->Up(2)) {
      this->Put(sun->mutable_direction());
      sun->set_frame(this->Up(2) ? this->Frame() : 0);
    }
    if (this->Up(2)) {
      sun->set_radius_deg(this->Up(9));
    }
    if (this->Up(2)) {
      sun->set_irradiance(this->Up(3000));
    }
    return;
  }
  default:
    this->Time_ += this->Up(12) == 0 ? -2.0 : 0.25 * this->Up(3);
    c.mutable_set_time()->set_time_s(this->Time_);
  }
}

inline void RandomCommands::Cameras(v1::Command& c) {
  const std::string vantage = this->Up(3) ? "main" : this->Name("v", 2);
  switch (this->Up(7)) {
  case 0:
    c.mutable_create_vantage()->set_name(vantage);
    return;
  case 1:
    if (this->Up(3) == 0) {
      c.mutable_remove_vantage()->set_name(vantage);
      return;
    }
    c.mutable_remove_camera()->set_vantage(vantage);
    c.mutable_remove_camera()->set_name(this->Name("c", 3));
    return;
  case 2:
    c.mutable_set_active_camera()->set_vantage(vantage);
    c.mutable_set_active_camera()->set_name(this->Name("c", 3));
    return;
  default: {
    v1::SetCamera* set = c.mutable_set_camera();
    set->set_vantage(vantage);
    set->set_name(this->Name("c", 3));
    if (this->Up(2)) {
      set->mutable_projection()->mutable_perspective()->set_vertical_fov_deg(20 + this->Up(50));
    }
    if (this->Up(4) == 0) {
      return;
    }
    v1::Mount* mount = set->mutable_mount();
    if (this->Up(2)) { // on the root mostly: nobody removes a frame with a camera
      mount->set_frame(this->Up(4) ? 0 : this->Frame());
      this->Put(mount->mutable_look_at()->mutable_eye());
      return;
    }
    mount->set_frame(this->Frame());
    v1::Mount::Chase* chase = mount->mutable_chase();
    chase->set_axes(v1::Mount::Chase::Axes(this->Up(3)));
    this->Put(chase->mutable_offset());
    chase->set_smoothing_s(this->Up(3));
  }
  }
}

inline v1::Command RandomCommands::Next() {
  v1::Command c;
  const std::uint32_t kind = this->Up(120);
  if (kind >= 110) {
    this->Messages(c);
  } else if (kind >= 100) {
    this->Telemetry(c);
  } else if (kind < 40) {
    this->Frames(c);
  } else if (kind < 55) {
    this->Objects(c);
  } else if (kind < 75) {
    this->Looks(c);
  } else if (kind < 90) {
    this->Names(c);
  } else {
    this->Cameras(c);
  }
  return c;
}

inline void RandomCommands::Note(const v1::Command& accepted, const v1::Reply& reply) {
  if (accepted.has_create_telemetry()) {
    this->Channels_.push_back(accepted.create_telemetry().id());
  }
  for (const std::uint64_t gone : accepted.remove_telemetry().id()) {
    this->Channels_.erase(std::remove(this->Channels_.begin(), this->Channels_.end(), gone),
                          this->Channels_.end());
  }
  if (reply.has_frame()) {
    this->Frames_.push_back(reply.frame().frame());
  }
  if (reply.has_object()) {
    this->Objects_.push_back(reply.object().object());
  }
  for (const v1::LinkInfo& link : reply.robot().link()) {
    this->Frames_.push_back(link.frame());
    this->Objects_.insert(this->Objects_.end(), link.object().begin(), link.object().end());
  }
  if (reply.has_robot()) {
    this->Frames_.push_back(reply.robot().base());
  }
  for (const std::uint64_t gone : reply.removed_frames().frame()) {
    this->Frames_.erase(std::remove(this->Frames_.begin() + 1, this->Frames_.end(), gone),
                        this->Frames_.end());
  }
}

} // namespace dspace::testing

#include "RandomMessages.h"

#endif
