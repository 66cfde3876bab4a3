// A cart that goes round a circle, a thousand steps a second, in a server's scene:
//   dspace serve --listen unix:/tmp/dspace &   dspace watch unix:/tmp/dspace --out pictures &
//   drive unix:/tmp/dspace [SECONDS]
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include <dspace/link/client/RemoteClient.h>

namespace v1 = dspace::v1;

namespace {

constexpr double Step = 1e-3;  // s
constexpr double Radius = 4.0; // m
constexpr double Rate = 0.5;   // rad/s

// A reply may hold an error of this command, or of an earlier one whose reply was not awaited.
const v1::Reply& Good(const v1::Reply& reply) {
  if (reply.has_error()) {
    throw std::runtime_error(reply.error().message());
  }
  return reply;
}

void Put(v1::Vector3* to, double x, double y, double z) {
  to->set_x(x);
  to->set_y(y);
  to->set_z(z);
}

// Creates the scene again and returns the cart's frame.
std::uint64_t Build(dspace::session::RemoteClient& client) {
  v1::Command command;
  command.mutable_remove_viewport()->set_viewport("view"); // of an earlier run, if there was one
  client.Execute(command);
  command.mutable_remove_scene();
  client.Execute(command);
  command.mutable_create_scene();
  Good(client.Execute(command));
  command.mutable_create_frame()->set_name("cart");
  const std::uint64_t cart = Good(client.Execute(command)).frame().frame();
  v1::CreatePrimitive& box = *command.mutable_create_primitive();
  box.mutable_object()->set_frame(cart);
  Put(box.mutable_box()->mutable_size(), 1.2, 0.8, 0.5);
  Good(client.Execute(command));
  v1::SetCamera& camera = *command.mutable_set_camera();
  camera.set_name("above");
  Put(camera.mutable_mount()->mutable_look_at()->mutable_eye(), -9, -9, 7);
  Put(camera.mutable_mount()->mutable_look_at()->mutable_target(), 0, 0, 0);
  Good(client.Execute(command));
  v1::CreateViewport& view = *command.mutable_create_viewport();
  view.set_name("view");
  view.set_width(640);
  view.set_height(360);
  Good(client.Execute(command));
  return cart;
}

// A step is sent without waiting: the time, and the poses of everything that moves in one message.
void SendStep(dspace::session::RemoteClient& client, std::uint64_t cart, double time) {
  v1::Command command;
  command.mutable_set_time()->set_time_s(time);
  Good(client.Send(command));
  v1::SetPoses& poses = *command.mutable_set_poses();
  poses.add_frame(cart);
  const double angle = Rate * time;
  for (const double value : {Radius * std::cos(angle), Radius * std::sin(angle), 0.25,
                             std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle), 1.0}) {
    poses.add_pose(value);
  }
  Good(client.Send(command));
}

} // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "usage: drive ADDRESS [SECONDS]\n";
    return 2;
  }
  const long steps = std::lround((count > 2 ? std::atof(arguments[2]) : 20.0) / Step);
  try {
    dspace::session::RemoteClientOptions options;
    options.address = arguments[1];
    options.name = "cart";
    options.pace = 1.0; // no faster than the clock
    dspace::session::RemoteClient client(options);
    const std::uint64_t cart = Build(client);
    for (long i = 0; i <= steps; ++i) {
      SendStep(client, cart, double(i) * Step);
      client.TakeEvents([](const v1::ViewerEvent& event) { // what people do at viewers
        std::cout << event.from() << ": " << event.ShortDebugString() << std::endl;
      });
    }
    v1::Command where;
    where.mutable_get_poses()->add_frame(cart);
    const v1::Reply there = Good(client.Execute(where));
    const auto& pose = there.poses().pose(); // x y z qw qx qy qz scale
    std::cout.precision(17);
    std::cout << "cart at " << pose[0] << ' ' << pose[1] << ' ' << pose[2] << std::endl;
  } catch (const std::exception& error) { // of connecting, too
    std::cerr << "drive: " << error.what() << std::endl;
    return 1;
  }
}
