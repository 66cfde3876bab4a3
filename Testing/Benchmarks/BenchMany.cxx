// Many objects and frames: 100,000 objects without names against as many with names, and a million
// frames by one command against 100,000 by one command each (for each frame). A ledger follows, as
// in every session.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/Ledger.h>

#include "Alternate.h"

namespace {

using namespace dspace;

constexpr int Objects = 100000;
constexpr int FramesAtOnce = 1000000;
constexpr int FramesOneByOne = 100000;
constexpr int Pairs = 5;

class Session {
public:
  Session() {
    this->Interpreter_.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->Ledger_.Add(command, reply);
    });
    v1::Command command;
    command.mutable_create_scene();
    this->Run(command);
  }
  void Run(v1::Command& command) {
    const v1::Reply reply = this->Interpreter_.Execute(command);
    if (reply.has_error()) {
      std::fprintf(stderr, "%s\n", reply.error().message().c_str());
      std::exit(1);
    }
  }

private:
  session::Interpreter Interpreter_;
  session::Ledger Ledger_;
};

void AddObjects(bool named) {
  Session session;
  for (int i = 0; i < Objects; ++i) {
    v1::Command command;
    v1::CreatePrimitive* create = command.mutable_create_primitive();
    if (named) {
      create->mutable_object()->set_name("thing " + std::to_string(i));
    }
    create->mutable_box()->mutable_size()->set_x(1.0);
    create->mutable_box()->mutable_size()->set_y(1.0);
    create->mutable_box()->mutable_size()->set_z(1.0);
    session.Run(command);
  }
}

void AddFramesAtOnce() {
  Session session;
  v1::Command command;
  v1::CreateFrames* create = command.mutable_create_frames();
  for (int i = 0; i < FramesAtOnce; ++i) {
    create->add_name("f" + std::to_string(i));
    for (const double value : {double(i), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      create->add_pose(value);
    }
  }
  session.Run(command);
}

void AddFramesOneByOne() {
  Session session;
  for (int i = 0; i < FramesOneByOne; ++i) {
    v1::Command command;
    command.mutable_create_frame()->set_name("f" + std::to_string(i));
    command.mutable_create_frame()->mutable_pose()->mutable_position()->set_x(i);
    session.Run(command);
  }
}

} // namespace

int main() {
  bench::Print("objects without names",
               bench::Alternate(
                   Pairs, [] { AddObjects(false); }, [] { AddObjects(true); }),
               1, (std::to_string(Objects) + " boxes, against as many with names").c_str());
  bench::Print("frames by one command", bench::Alternate(Pairs, AddFramesAtOnce, AddFramesOneByOne),
               1,
               (std::to_string(FramesAtOnce) + " frames, against " +
                std::to_string(FramesOneByOne) + " by one command each")
                   .c_str());
  return 0;
}
