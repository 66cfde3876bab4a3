// A process of its own for TestLinkKills: serves a plain interpreter, or drives one until it is
// killed.
//   LinkProcess serve ADDRESS
//   LinkProcess drive ADDRESS
#include "LinkTestSupport.h"

#include <cstdio>
#include <cstring>

int main(int argc, char** argv) {
  using namespace dspace;
  using namespace dspace::testing;
  if (argc != 3) {
    return 2;
  }
  try {
    if (std::strcmp(argv[1], "serve") == 0) {
      session::ServerOptions options;
      options.listen = argv[2];
      session::Server server(options);
      ServedInterpreter served;
      served.server = &server;
      std::puts("ready");
      std::fflush(stdout);
      while (server.Run(served.Work(), 10)) {
      }
    } else {
      session::RemoteClientOptions options;
      options.address = argv[2];
      options.takeOver = true;
      session::RemoteClient client(options);
      client.Execute(MakeScene());
      client.Execute(MakeFrame(2));
      client.Execute(MakeFrame(3));
      std::puts("ready");
      std::fflush(stdout);
      v1::Command get = AskPoses({2});
      const v1::Reply last = client.Execute(get);
      double value = last.poses().pose_size() == 8 ? last.poses().pose(0) : 0;
      while (true) { // both frames always at the same place, a step further each time
        value += 1;
        const v1::Reply reply = client.Send(MakeStep({2, 3}, value));
        if (reply.has_error()) {
          return 3;
        }
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
